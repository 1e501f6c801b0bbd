// SPDX-License-Identifier: Apache-2.0
// XML as far as files of cameras have it: elements, attributes, text. Source: XML 1.0, 2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slf/error.h"

namespace slf {

/// A tree takes up to 60 times the bytes of its text.
inline constexpr std::uint64_t kMaxXmlBytes = std::uint64_t{32} << 20;

struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  ///< all of it that stands directly in the element
  std::vector<XmlElement> children;
  std::size_t line = 0;  ///< from 1

  const XmlElement* child(const char* named) const;  ///< the first; or null
  const std::string* attribute(const char* named) const;
};

/// The root element. Comments and processing instructions are left out; refused are document types,
/// entities but for the five of XML itself, and nesting deeper than 32.
/// @param file  for messages
/// @errors kInvalidInput: names the line
Result<XmlElement, InputError> parse_xml(const std::string& file,
                                         std::span<const std::uint8_t> text);

}  // namespace slf
