// SPDX-License-Identifier: Apache-2.0
#include "capture/xml.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace slf {

namespace {

constexpr int kMostNesting = 32;
constexpr std::size_t kMostElements = std::size_t{1} << 20;  // 120 bytes each, of 4 in a file
constexpr std::string_view kSpace = " \t\r\n", kData = "<![CDATA[";

class XmlParser {
 public:
  XmlParser(const std::string& file, std::string_view text) : file_(file), text_(text) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  Result<XmlElement, InputError> parse() {
    SLF_CHECK(skip_misc());
    if (!at("<")) return invalid("an element is expected");
    SLF_TRY(XmlElement root, element(0));
    SLF_CHECK(skip_misc());
    if (at_ < text_.size()) return invalid("something stands behind the last element");
    return root;
  }

 private:
  /// From its "<" to behind its end.
  Result<XmlElement, InputError> element(int depth) {
    if (depth >= kMostNesting)
      return invalid("elements are nested deeper than " + std::to_string(kMostNesting));
    if (++elements_ > kMostElements) return invalid("more than 1,048,576 elements");
    XmlElement result;
    result.line = line();
    advance(1);
    result.name = name();
    if (result.name.empty()) return invalid("an element without a name");
    SLF_CHECK(attributes(result));
    if (at("/>")) {
      advance(2);
      return result;
    }
    if (!at(">")) return invalid("<" + result.name + "> is not closed");
    advance(1);
    SLF_CHECK(content(result, depth));
    return result;
  }

  Result<Done, InputError> attributes(XmlElement& of) {
    for (skip_space(); at_ < text_.size() && !at(">") && !at("/>"); skip_space()) {
      std::string key = name();
      skip_space();
      if (key.empty() || !at("=")) return invalid("an attribute of <" + of.name + "> is damaged");
      advance(1);
      skip_space();
      const char quote = at_ < text_.size() ? text_[at_] : '\0';
      const std::size_t end =
          quote == '"' || quote == '\'' ? text_.find(quote, at_ + 1) : text_.npos;
      if (end == text_.npos) return invalid("an attribute of <" + of.name + "> is damaged");
      SLF_TRY(std::string value, unescaped(text_.substr(at_ + 1, end - at_ - 1)));
      advance(end + 1 - at_);
      of.attributes.emplace_back(std::move(key), std::move(value));
    }
    return Done{};
  }

  /// Text and children, to behind "</name>".
  Result<Done, InputError> content(XmlElement& of, int depth) {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('<', at_), text_.size());
      SLF_TRY(const std::string piece, unescaped(text_.substr(at_, end - at_)));
      of.text += piece;
      advance(end - at_);
      if (at("</")) {
        advance(2);
        if (name() != of.name) return invalid("<" + of.name + "> ends with another name");
        skip_space();
        if (!at(">")) return invalid("the end of <" + of.name + "> is damaged");
        advance(1);
        return Done{};
      }
      if (at(kData)) {
        const std::size_t close = text_.find("]]>", at_);
        if (close == text_.npos) return invalid("CDATA does not end");
        of.text += text_.substr(at_ + kData.size(), close - at_ - kData.size());
        advance(close + 3 - at_);
        continue;
      }
      SLF_TRY(const bool skipped, skip_aside());
      if (skipped || at_ >= text_.size()) continue;
      SLF_TRY(XmlElement child, element(depth + 1));
      of.children.push_back(std::move(child));
    }
    return invalid("<" + of.name + "> does not end");
  }

  Result<Done, InputError> skip_misc() {
    for (;;) {
      skip_space();
      SLF_TRY(const bool skipped, skip_aside());
      if (!skipped) return Done{};
    }
  }

  /// A comment or a processing instruction.
  Result<bool, InputError> skip_aside() {
    const bool comment = at("<!--"), instruction = at("<?");
    if (!comment && !instruction) {
      if (at("<!")) return invalid("document types are not read");
      return false;
    }
    const std::string_view close = comment ? "-->" : "?>";
    const std::size_t end = text_.find(close, at_ + (comment ? 4 : 2));
    if (end == text_.npos) return invalid("a comment or instruction does not end");
    advance(end + close.size() - at_);
    return true;
  }

  Result<std::string, InputError> unescaped(std::string_view raw) const {
    constexpr std::array<std::pair<std::string_view, char>, 5> kEntities{
        {{"&lt;", '<'}, {"&gt;", '>'}, {"&amp;", '&'}, {"&quot;", '"'}, {"&apos;", '\''}}};
    std::string out;
    while (!raw.empty()) {
      const std::size_t plain = std::min(raw.find('&'), raw.size());
      out += raw.substr(0, plain);
      raw.remove_prefix(plain);
      if (raw.empty()) break;
      const auto found = std::find_if(kEntities.begin(), kEntities.end(),
                                      [&](const auto& e) { return raw.starts_with(e.first); });
      if (found == kEntities.end()) return invalid("an entity that is not one of XML's five");
      out += found->second;
      raw.remove_prefix(found->first.size());
    }
    return out;
  }

  std::string name() {
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n/>=<\"'", at_), text_.size());
    std::string found(text_.substr(at_, end - at_));
    advance(end - at_);
    return found;
  }

  bool at(std::string_view what) const { return text_.substr(at_).starts_with(what); }
  void skip_space() { advance(std::min(text_.find_first_not_of(kSpace, at_), text_.size()) - at_); }
  void advance(std::size_t count) { at_ += count; }

  /// Counted on from where it was asked for last: that only goes forward.
  std::size_t line() const {
    line_ += static_cast<std::size_t>(std::count(text_.begin() + std::ptrdiff_t(counted_),
                                                 text_.begin() + std::ptrdiff_t(at_), '\n'));
    counted_ = at_;
    return line_;
  }

  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput,
            file_ + ": line " + std::to_string(line()) + ": " + cause.substr(0, 120)};
  }

  const std::string& file_;
  std::string_view text_;
  std::size_t at_ = 0, elements_ = 0;
  mutable std::size_t counted_ = 0, line_ = 1;
};

}  // namespace

const XmlElement* XmlElement::child(const char* named) const {
  for (const XmlElement& each : children)
    if (each.name == named) return &each;
  return nullptr;
}

const std::string* XmlElement::attribute(const char* named) const {
  for (const auto& [key, value] : attributes)
    if (key == named) return &value;
  return nullptr;
}

Result<XmlElement, InputError> parse_xml(const std::string& file,
                                         std::span<const std::uint8_t> text) {
  return XmlParser(file, {reinterpret_cast<const char*>(text.data()), text.size()}).parse();
}

}  // namespace slf
