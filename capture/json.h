// SPDX-License-Identifier: Apache-2.0
// JSON documents with errors that name the file and the place in it. The adapter of nlohmann-json.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slf/error.h"

namespace slf {

struct JsonMember;

/// A parsed value. Plain data.
struct JsonValue {
  enum class Kind : std::uint8_t { kNull, kBoolean, kNumber, kString, kArray, kObject };
  Kind kind = Kind::kNull;
  bool boolean = false;
  double number = 0;  ///< finite
  std::string string;
  std::vector<JsonValue> items;
  std::vector<JsonMember> members;  ///< in the order of the file, names distinct
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
  Result<std::vector<JsonView>, InputError> items() const;
  Result<std::vector<JsonView>, InputError> items(std::size_t count) const;  ///< exactly so many
  Result<Done, InputError> expect_object() const;
  /// Names and values of an object, in the order of the file; none of anything else.
  std::vector<std::pair<std::string, JsonView>> members() const;

  InputError error(const std::string& cause) const;  ///< kInvalidInput: "file: path: cause"

 private:
  JsonView(const JsonValue& value, std::string file, std::string path)
      : value_(&value), file_(std::move(file)), path_(std::move(path)) {}

  const JsonValue* value_;
  std::string file_;
  std::string path_;  // "cameras[3].K"
};

}  // namespace slf
