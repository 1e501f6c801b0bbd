// SPDX-License-Identifier: Apache-2.0
// What an encode says about the exposure and the poses of its photographs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "slf/camera_poses.h"
#include "slf/exposure.h"

namespace slf::tools {

nlohmann::ordered_json exposure_json(const ExposureReport& report);
std::string exposure_text(const ExposureReport& report);  ///< empty where photographs stay

nlohmann::ordered_json poses_json(const PoseReport& report);
std::string poses_text(const PoseReport& report);  ///< empty where cameras stay

}  // namespace slf::tools
