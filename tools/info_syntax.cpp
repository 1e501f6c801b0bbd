// SPDX-License-Identifier: Apache-2.0
#include "tools/info_syntax.h"

#include <nlohmann/json.hpp>

#include "slf/syntax_listing.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

nlohmann::ordered_json syntax_json(const std::vector<ListedUnit>& units) {
  auto list = nlohmann::ordered_json::array();
  for (const ListedUnit& unit : units) {
    auto elements = nlohmann::ordered_json::array();
    for (const ListedElement& e : unit.elements)
      elements.push_back({{"name", e.name},
                          {"kind", e.kind},
                          {"bit", e.bit},
                          {"bits", e.bits},
                          {"value", e.value}});
    list.push_back({{"type", unit.type},
                    {"offset", unit.offset},
                    {"bytes", unit.bytes},
                    {"elements", std::move(elements)}});
  }
  return list;
}

/// Byte and bit of every element, how it is coded, its name and its value.
std::string syntax_text(const std::vector<ListedUnit>& units) {
  std::string out;
  for (const ListedUnit& unit : units) {
    out += text("%s unit, byte %llu, %llu bytes\n", unit.type.c_str(),
                static_cast<unsigned long long>(unit.offset),
                static_cast<unsigned long long>(unit.bytes));
    for (const ListedElement& e : unit.elements) {
      const bool bytes = e.kind == "bytes";
      const std::string kind = bytes || e.kind != "u" ? e.kind : text("u(%d)", int(e.bits));
      const std::string value =
          bytes ? text("%llu bytes", static_cast<unsigned long long>(e.bits / 8)) : e.value;
      out += text("%10llu.%d  %-6s %-36s %s\n", static_cast<unsigned long long>(e.bit / 8),
                  static_cast<int>(e.bit % 8), kind.c_str(), e.name.c_str(), value.c_str());
    }
  }
  return out;
}

}  // namespace

Outcome print_syntax(std::span<const std::uint8_t> stream, const std::string& file, bool json) {
  SLF_TRY(const auto units, from(input_name(file), list_syntax(stream)));
  return json ? print(syntax_json(units)) : print(syntax_text(units));
}

}  // namespace slf::tools
