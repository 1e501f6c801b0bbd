// SPDX-License-Identifier: Apache-2.0
#include "tools/describe_exposure.h"

#include <algorithm>
#include <cmath>

#include "tools/text.h"

namespace slf::tools {
namespace {

double percent(double log) { return 100 * (std::exp(log) - 1); }

}  // namespace

nlohmann::ordered_json exposure_json(const ExposureReport& r) {
  return {{"matched", !r.gains.empty()},
          {"pairs", r.pairs},
          {"differ", r.differ},
          {"differ_matched", r.differ_matched},
          {"gains", r.gains}};
}

std::string exposure_text(const ExposureReport& r) {
  if (r.gains.empty()) return {};
  float least = 1, most = 1;
  for (const auto& gain : r.gains)
    for (const float g : gain) least = std::min(least, g), most = std::max(most, g);
  return text(
      "exposure      matched: photographs times %.2f to %.2f; neighbours differed by %.1f %%, "
      "now by %.1f %%\n",
      double(least), double(most), percent(r.differ), percent(r.differ_matched));
}

nlohmann::ordered_json poses_json(const PoseReport& r) {
  nlohmann::ordered_json json = {{"refined", !r.cameras.empty()},
                                 {"median_pixels", r.median_pixels},
                                 {"most_pixels", r.most_pixels}};
  if (!r.cameras.empty()) json["moved_most"] = r.cameras[std::size_t(r.moved_most)].name;
  return json;
}

std::string poses_text(const PoseReport& r) {
  if (r.cameras.empty()) return {};
  return text("poses         refined: pictures moved by %.2f pixels (median), %s by %.2f\n",
              r.median_pixels, r.cameras[std::size_t(r.moved_most)].name.c_str(), r.most_pixels);
}

}  // namespace slf::tools
