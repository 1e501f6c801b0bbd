// SPDX-License-Identifier: Apache-2.0
#include "tools/info_syntax.h"

#include <nlohmann/json.hpp>

#include "slf/syntax_listing.h"
#include "tools/long_json.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

nlohmann::ordered_json syntax_json(const ListedUnit& unit) {
  auto elements = nlohmann::ordered_json::array();
  for (const ListedElement& e : unit.elements)
    elements.push_back(
        {{"name", e.name}, {"kind", e.kind}, {"bit", e.bit}, {"bits", e.bits}, {"value", e.value}});
  return {{"type", unit.type},
          {"offset", unit.offset},
          {"bytes", unit.bytes},
          {"elements", std::move(elements)}};
}

/// Byte and bit of every element, how it is coded, its name and its value.
std::string syntax_text(const ListedUnit& unit) {
  std::string out = text("%s unit, byte %llu, %llu bytes\n", unit.type.c_str(),
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
  return out;
}

}  // namespace

Outcome print_syntax(std::span<const std::uint8_t> stream, const std::string& file,
                     const DecodeLimits& limits, bool json) {
  // Nothing is shown of what has an error somewhere.
  const auto look = [](const ListedUnit&) { return true; };
  SLF_CHECK(from(input_name(file), visit_syntax(stream, limits, look)));
  ListPrinter printer(0);
  Outcome printed = Done{};
  const auto show = [&](const ListedUnit& unit) {
    printed = json ? printer.add(syntax_json(unit)) : print(syntax_text(unit));
    return static_cast<bool>(printed);
  };
  SLF_CHECK(from(input_name(file), visit_syntax(stream, limits, show)));
  if (printed && json) return printer.end("\n");
  return printed;
}

}  // namespace slf::tools
