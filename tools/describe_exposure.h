// SPDX-License-Identifier: Apache-2.0
// What an encode says about the exposure of its photographs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "slf/exposure.h"

namespace slf::tools {

nlohmann::ordered_json exposure_json(const ExposureReport& report);
std::string exposure_text(const ExposureReport& report);  ///< empty where photographs stay

}  // namespace slf::tools
