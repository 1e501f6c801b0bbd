#include "codec/scene_frame.h"

#include <algorithm>

#include "codec/decode_cost.h"
#include "geometry/cell_box.h"

namespace slf {

std::vector<CellBox> boxes_of(const SceneLayout& layout) {
  std::vector<CellBox> boxes;
  if (layout.base_levels == 0) return boxes;
  std::size_t end = 0;
  for (const SliceEntry& slice : layout.table.slices) {
    const std::size_t begin = end;
    end += slice.cells();
    boxes.push_back(box_of_cells(std::span(layout.cells).subspan(begin, end - begin)));
  }
  return boxes;
}

void add_filler(std::vector<CodedUnit>& units, const std::vector<CodedUnit>& parts,
                std::uint64_t cells, std::uint64_t points, std::uint64_t planes) {
  std::uint64_t bytes = 0, of_base = 0, all = 0;
  for (const CodedUnit& unit : units) bytes += unit_bytes(unit.payload.size());
  for (const CodedUnit& unit : parts) {
    if (unit.type != UnitType::kGeometry) continue;
    (unit.ids.of_base() ? of_base : all) += unit_bytes(unit.payload.size());
  }
  all += of_base;
  const auto lacking = [&](std::uint64_t rows, std::uint64_t there) {
    const std::uint64_t values = rows * std::max<std::uint64_t>(planes, 1);
    const std::uint64_t least = values / kLevelValuesOfByte + 1 - kLevelValues / kLevelValuesOfByte;
    return values <= kLevelValues || least <= bytes + there ? 0 : least - bytes - there;
  };
  const std::uint64_t filler = std::max(lacking(points + cells, all), lacking(cells, of_base));
  if (filler > 0)
    units.push_back({UnitType::kFiller, std::vector<std::uint8_t>(std::size_t{filler}), {}});
}

}  // namespace slf
