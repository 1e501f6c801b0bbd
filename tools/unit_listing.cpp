// SPDX-License-Identifier: Apache-2.0
#include "tools/unit_listing.h"

#include "tools/text.h"

namespace slf::tools {

nlohmann::ordered_json unit_json(const UnitInfo& unit) {
  nlohmann::ordered_json entry = {
      {"type", unit.type}, {"offset", unit.offset}, {"bytes", unit.bytes}};
  if (unit.base) entry["base"] = true;
  if (unit.slice >= 0) entry["slice"] = unit.slice;
  if (unit.group >= 0) entry["group"] = unit.group;
  if (unit.layer > 0) entry["layer"] = unit.layer;
  if (unit.level_first >= 0) entry["levels"] = {unit.level_first, unit.level_last};
  if (!unit.prediction.empty()) entry["prediction"] = unit.prediction;
  return entry;
}

nlohmann::ordered_json slice_json(const SliceInfo& slice) {
  nlohmann::ordered_json entry = {
      {"cells", slice.cells}, {"points", slice.points}, {"bytes", slice.bytes}};
  if (slice.box) entry["voxels"] = {slice.box->low, slice.box->high};
  return entry;
}

std::string units_text(const StreamInfo& info) {
  std::string out = "\nunits\n      offset       bytes  type\n";
  for (const UnitInfo& unit : info.units) {
    out += text("%12llu %11llu  %s", static_cast<unsigned long long>(unit.offset),
                static_cast<unsigned long long>(unit.bytes), unit.type.c_str());
    if (unit.base) out += "  base";
    if (unit.slice >= 0) out += text("  slice %d", unit.slice);
    if (unit.group >= 0) out += text("  group %d", unit.group);
    if (unit.layer > 0) out += text("  layer %d", unit.layer);
    if (unit.level_first >= 0) out += text("  levels %d to %d", unit.level_first, unit.level_last);
    for (std::size_t i = 0; i < unit.prediction.size(); ++i)
      out += text(i == 0 ? "  prediction %d" : " %d", unit.prediction[i]);
    out += '\n';
  }
  return out;
}

std::string slices_text(const StreamInfo& info) {
  std::string out = "\nslices\n       cells      points       bytes  voxels\n";
  for (const SliceInfo& slice : info.slices) {
    out += text("%12llu %11llu %11llu", static_cast<unsigned long long>(slice.cells),
                static_cast<unsigned long long>(slice.points),
                static_cast<unsigned long long>(slice.bytes));
    if (slice.box)
      out += text("  %d %d %d to %d %d %d", slice.box->low[0], slice.box->low[1], slice.box->low[2],
                  slice.box->high[0], slice.box->high[1], slice.box->high[2]);
    out += '\n';
  }
  return out;
}

}  // namespace slf::tools
