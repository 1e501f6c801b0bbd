// SPDX-License-Identifier: Apache-2.0
// What `slf html` writes into the viewer's page: text of files of strangers among it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "slf/capture.h"
#include "slf/types.h"

namespace slf::tools {

/// Addresses of the pictures that show until the file is decoded; `night` is empty where it is that
/// of the day.
struct Posters {
  std::string day, night;
};

/// The title that a file has; none: empty. Long ones are cut.
std::string page_title(const Metadata& metadata);

/// The camera as the viewer reads it: rows right, down, forward, and where the eye is.
nlohmann::ordered_json view_json(const Camera& camera);

/// @param page     the template, with a place for each of title, poster, night, options and file
/// @param options  of the viewer
std::string html_page(std::string_view page, const std::string& title, const Posters& posters,
                      const nlohmann::ordered_json& options, std::span<const std::uint8_t> stream);

}  // namespace slf::tools
