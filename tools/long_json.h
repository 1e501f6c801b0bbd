// SPDX-License-Identifier: Apache-2.0
// JSON with lists that files of strangers make long: printed an element at a time, since an element
// takes ten times the memory of what it says.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "tools/failure.h"

namespace slf::tools {

/// Puts together what a list has, for standard output.
class ListPrinter {
 public:
  /// @param indent  columns that the list itself stands at
  explicit ListPrinter(std::size_t indent) : indent_(indent, ' ') {}
  Outcome add(const nlohmann::ordered_json& element);
  /// The bracket that closes the list, and what follows it.
  Outcome end(const std::string& behind);

 private:
  Outcome flush(std::size_t least);

  std::string indent_, text_;
  bool any_ = false;
};

struct LongList {
  const char* name;  ///< of a member of the object that is null
  std::size_t size = 0;
  std::function<nlohmann::ordered_json(std::size_t)> element;
};

/// What print() makes of the object with the lists in it, which come in the order of its members.
Outcome print(const nlohmann::ordered_json& json, const std::vector<LongList>& lists);

}  // namespace slf::tools
