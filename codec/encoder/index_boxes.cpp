// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/index_boxes.h"

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

}  // namespace slf
