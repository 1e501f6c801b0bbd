// SPDX-License-Identifier: Apache-2.0
#include "tools/long_json.h"

#include "tools/text.h"

namespace slf::tools {
namespace {

constexpr std::size_t kPrintedAtOnce = 1 << 16;

}  // namespace

Outcome ListPrinter::add(const nlohmann::ordered_json& element) {
  text_ += any_ ? ",\n" : "[\n";
  any_ = true;
  // Line ends stand between elements alone: those of strings are escaped.
  const std::string lines = to_text(element);
  for (std::size_t at = 0; at < lines.size();) {
    const std::size_t end = lines.find('\n', at);
    text_ += (at == 0 ? "" : "\n") + indent_ + "  ";
    text_.append(lines, at, end - at);
    at = end + 1;
  }
  return flush(kPrintedAtOnce);
}

Outcome ListPrinter::end(const std::string& behind) {
  text_ += (any_ ? "\n" + indent_ : std::string("[")) + "]" + behind;
  return flush(0);
}

Outcome ListPrinter::flush(std::size_t least) {
  if (text_.size() < least) return Done{};
  SLF_CHECK(print(text_));
  text_.clear();
  return Done{};
}

Outcome print(const nlohmann::ordered_json& json, const std::vector<LongList>& lists) {
  const std::string frame = to_text(json);
  std::size_t at = 0;
  for (const LongList& list : lists) {
    // At two columns there are members of the object itself alone.
    const std::string name = "\n  \"" + std::string(list.name) + "\": ";
    const std::size_t begin = frame.find(name + "null", at) + name.size();
    SLF_CHECK(print(frame.substr(at, begin - at)));
    ListPrinter printer(2);
    for (std::size_t i = 0; i < list.size; ++i) SLF_CHECK(printer.add(list.element(i)));
    SLF_CHECK(printer.end(""));
    at = begin + std::string("null").size();
  }
  return print(frame.substr(at));
}

}  // namespace slf::tools
