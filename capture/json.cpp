// SPDX-License-Identifier: Apache-2.0
#include "capture/json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

namespace slf {

namespace {

constexpr std::size_t kMaxDepth = 64;

std::string member_path(const std::string& path, const std::string& name) {
  return path.empty() ? name : path + "." + name;
}
std::string item_path(const std::string& path, std::size_t index) {
  return path + "[" + std::to_string(index) + "]";
}

std::optional<std::string> name_that_occurs_twice(const JsonValue& object) {
  std::vector<std::string_view> names;
  for (const auto& member : object.members()) names.push_back(member.name);
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  return twice == names.end() ? std::nullopt : std::optional<std::string>(*twice);
}

// Takes nlohmann's events. They do not recurse, so neither depth nor anything else of a hostile
// document reaches the stack before it has passed kMaxDepth.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
  JsonValue root;
  std::string cause;  // of the failure
  std::string path;   // where

  bool null() override { return add({}) != nullptr; }
  bool boolean(bool value) override { return add({value}) != nullptr; }
  bool number_integer(number_integer_t value) override { return add_number(double(value)); }
  bool number_unsigned(number_unsigned_t value) override { return add_number(double(value)); }
  bool number_float(number_float_t value, const string_t&) override { return add_number(value); }
  bool string(string_t& value) override {
    return add({std::make_unique<std::string>(std::move(value))}) != nullptr;
  }
  bool binary(binary_t&) override { return false; }  // does not occur in text
  bool start_object(std::size_t) override { return open({std::make_unique<JsonValue::Members>()}); }
  bool start_array(std::size_t) override { return open({std::make_unique<JsonValue::Items>()}); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    members_of(*open_.back()).push_back({std::move(name), {}});
    return true;
  }

  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception& error) override {
    // "[json.exception…] parse error at line …: cause; last read: 'what stands there'", or
    // "[json.exception…] cause"
    std::string_view what = error.what();
    what = what.substr(0, what.find("; last read: "));
    if (const std::size_t name = what.find("] "); name != std::string_view::npos)
      what.remove_prefix(name + 2);
    const std::size_t colon = what.find(": ");
    return fail("not valid JSON at byte " + std::to_string(position) + ": " +
                std::string(colon == std::string_view::npos ? what : what.substr(colon + 2)));
  }

 private:
  static JsonValue::Members& members_of(JsonValue& object) {
    return *std::get<std::unique_ptr<JsonValue::Members>>(object.content);
  }

  // Where the next value goes: the last member's value, a new item, or the root.
  JsonValue* add(JsonValue value) {
    if (open_.empty()) return &(root = std::move(value));
    JsonValue& parent = *open_.back();
    if (parent.kind() == JsonValue::Kind::kObject)
      return &(members_of(parent).back().value = std::move(value));
    return &std::get<std::unique_ptr<JsonValue::Items>>(parent.content)
                ->emplace_back(std::move(value));
  }

  bool add_number(double value) {
    if (!std::isfinite(value)) return fail("a number is not finite");
    return add({value}) != nullptr;
  }

  // Pointers to open values stay valid: while one is open nothing is added to its parent.
  bool open(JsonValue value) {
    if (open_.size() == kMaxDepth) return fail("nested deeper than " + std::to_string(kMaxDepth));
    open_.push_back(add(std::move(value)));
    return true;
  }
  bool close() {
    const auto name = name_that_occurs_twice(*open_.back());
    open_.pop_back();
    return !name || fail("the name '" + *name + "' occurs twice", true);
  }

  // @param in_last  the failure is in the value added last, not at the one that would come next
  bool fail(std::string why, bool in_last = false) {
    cause = std::move(why);
    for (const JsonValue* value : open_) {
      if (value->kind() == JsonValue::Kind::kArray) {
        const bool inside = in_last || value != open_.back();
        path = item_path(path, value->items().size() - (inside ? 1 : 0));
      } else if (!value->members().empty()) {
        path = member_path(path, value->members().back().name);
      }
    }
    return false;
  }

  std::vector<JsonValue*> open_;  // outermost first
};

const char* name_of(JsonValue::Kind kind) {
  switch (kind) {
    case JsonValue::Kind::kNull:
      return "null";
    case JsonValue::Kind::kBoolean:
      return "a boolean";
    case JsonValue::Kind::kNumber:
      return "a number";
    case JsonValue::Kind::kString:
      return "a string";
    case JsonValue::Kind::kArray:
      return "an array";
    case JsonValue::Kind::kObject:
      return "an object";
  }
  return "unknown";
}

InputError wrong_kind(const JsonView& view, JsonValue::Kind wanted, JsonValue::Kind found) {
  return view.error(std::string(name_of(wanted)) + " is expected, not " + name_of(found));
}

}  // namespace

std::span<const JsonValue> JsonValue::items() const {
  const auto* items = std::get_if<std::unique_ptr<Items>>(&content);
  return items == nullptr ? std::span<const JsonValue>{} : **items;
}

std::span<const JsonMember> JsonValue::members() const {
  const auto* members = std::get_if<std::unique_ptr<Members>>(&content);
  return members == nullptr ? std::span<const JsonMember>{} : **members;
}

Result<JsonValue, InputError> parse_json(const std::string& file,
                                         std::span<const std::uint8_t> text) {
  TreeBuilder tree;
  bool parsed = false;
  try {
    parsed = nlohmann::json::sax_parse(text.begin(), text.end(), &tree);
  } catch (const nlohmann::json::exception& error) {
    tree.cause = error.what();
  }
  if (parsed) return std::move(tree.root);
  const std::string at = tree.path.empty() ? "" : tree.path + ": ";
  return InputError{Errc::kInvalidInput, file + ": " + at + tree.cause};
}

InputError JsonView::error(const std::string& cause) const {
  return {Errc::kInvalidInput, file_ + ": " + (path_.empty() ? "" : path_ + ": ") + cause};
}

std::optional<JsonView> JsonView::find(const std::string& name) const {
  for (const auto& member : value_->members())
    if (member.name == name) return JsonView(member.value, file_, member_path(path_, name));
  return std::nullopt;
}

Result<JsonView, InputError> JsonView::at(const std::string& name) const {
  SLF_CHECK(expect_object());
  if (auto found = find(name)) return *found;
  return error("'" + name + "' is missing");
}

Result<double, InputError> JsonView::number() const {
  if (const auto* content = std::get_if<double>(&value_->content)) return *content;
  return wrong_kind(*this, JsonValue::Kind::kNumber, value_->kind());
}

Result<bool, InputError> JsonView::boolean() const {
  if (const auto* content = std::get_if<bool>(&value_->content)) return bool{*content};
  return wrong_kind(*this, JsonValue::Kind::kBoolean, value_->kind());
}

Result<std::string, InputError> JsonView::string() const {
  if (const auto* content = std::get_if<std::unique_ptr<std::string>>(&value_->content))
    return **content;
  return wrong_kind(*this, JsonValue::Kind::kString, value_->kind());
}

Result<JsonItems, InputError> JsonView::items() const {
  if (value_->kind() != JsonValue::Kind::kArray)
    return wrong_kind(*this, JsonValue::Kind::kArray, value_->kind());
  return JsonItems(value_->items(), file_, path_);
}

Result<JsonItems, InputError> JsonView::items(std::size_t count) const {
  SLF_TRY(auto found, items());
  if (found.size() == count) return found;
  return error(std::to_string(count) + " items are expected, not " + std::to_string(found.size()));
}

Result<Done, InputError> JsonView::expect_object() const {
  if (value_->kind() == JsonValue::Kind::kObject) return Done{};
  return wrong_kind(*this, JsonValue::Kind::kObject, value_->kind());
}

std::vector<std::pair<std::string, JsonView>> JsonView::members() const {
  std::vector<std::pair<std::string, JsonView>> views;
  for (const auto& member : value_->members())
    views.emplace_back(member.name, JsonView(member.value, file_, member_path(path_, member.name)));
  return views;
}

}  // namespace slf
