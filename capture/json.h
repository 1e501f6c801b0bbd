// SPDX-License-Identifier: Apache-2.0
// JSON documents with errors that name the file and the place in it. The adapter of nlohmann-json.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "slf/error.h"

namespace slf {

struct JsonMember;

/// A parsed value: 16 bytes, of which a hostile file has one for two of its own.
struct JsonValue {
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };
  using Items = std::vector<JsonValue>;
  using Members = std::vector<JsonMember>;  ///< in the order of the file, names distinct

  /// In the order of Kind; numbers are finite, pointers not null.
  std::variant<std::monostate, bool, double, std::unique_ptr<std::string>, std::unique_ptr<Items>,
               std::unique_ptr<Members>>
      content;

  Kind kind() const { return static_cast<Kind>(content.index()); }
  /// Those of an array, of an object; a value of another kind has none.
  std::span<const JsonValue> items() const;
  std::span<const JsonMember> members() const;
};

struct JsonMember {
  std::string name;
  JsonValue value;
};

/// Refuses what is no JSON (RFC 8259), NaN and numbers beyond a double among it, names that occur
/// twice in an object, and nesting deeper than 64. No exception leaves it.
/// @param file  for messages
/// @errors kInvalidInput
Result<JsonValue, InputError> parse_json(const std::string& file,
                                         std::span<const std::uint8_t> text);

class JsonItems;

/// A value together with where it stands, so that every misuse of it can be told to the person.
/// Refers to the value it was made from.
class JsonView {
 public:
  /// @param file  the file's name, for messages
  JsonView(const JsonValue& value, std::string file) : JsonView(value, std::move(file), "") {}

  std::optional<JsonView> find(const std::string& name) const;  ///< nothing if absent or no object
  Result<JsonView, InputError> at(const std::string& name) const;
  Result<double, InputError> number() const;
  Result<bool, InputError> boolean() const;
  Result<std::string, InputError> string() const;
  Result<JsonItems, InputError> items() const;
  Result<JsonItems, InputError> items(std::size_t count) const;  ///< exactly so many
  Result<Done, InputError> expect_object() const;
  /// Names and values of an object, in the order of the file; none of anything else.
  std::vector<std::pair<std::string, JsonView>> members() const;

  InputError error(const std::string& cause) const;  ///< kInvalidInput: "file: path: cause"

 private:
  friend class JsonItems;
  JsonView(const JsonValue& value, std::string file, std::string path)
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  const JsonValue* value_;
  std::string file_;
  std::string path_;  // "cameras[3].K"
};

/// The items of an array, each with its place, made when it is asked for. Refers to the array.
class JsonItems {
 public:
  class Iterator {
   public:
    Iterator(const JsonItems& items, std::size_t at) : items_(&items), at_(at) {}
    JsonView operator*() const { return (*items_)[at_]; }
    Iterator& operator++() { return ++at_, *this; }
    bool operator==(const Iterator& other) const { return at_ == other.at_; }

   private:
    const JsonItems* items_;
    std::size_t at_;
  };

  JsonItems() = default;
  JsonItems(std::span<const JsonValue> items, std::string file, std::string path)
      : items_(items), file_(std::move(file)), path_(std::move(path)) {}

  std::size_t size() const { return items_.size(); }
  bool empty() const { return items_.empty(); }
  JsonView operator[](std::size_t i) const {
    return {items_[i], file_, path_ + "[" + std::to_string(i) + "]"};
  }
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  std::span<const JsonValue> items_;
  std::string file_;
  std::string path_;
};

}  // namespace slf
