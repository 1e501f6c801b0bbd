// SPDX-License-Identifier: Apache-2.0
// Pictures that follow one another, as a file that plays: Motion JPEG in AVI.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/failure.h"
#include "tools/film_timing.h"

namespace slf {
struct Image;
}

namespace slf::tools {

class Film {
 public:
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1}
                                              << 30;  ///< readers of AVI go wrong beyond

  /// Does the name promise a film: x.avi?
  static bool is_named(const std::string& file);

  /// image: RGB, of the size of the first. Its JPEG is that of `-o x.jpg`, byte for byte.
  /// @errors another size; more than kMostBytes in all. The film is as before.
  Outcome add(const Image& image);
  /// Are pictures that are repeated so within kMostBytes in all?
  bool has_room(const FilmTiming& timing) const;
  /// timing: of as many pictures as were added
  std::vector<std::uint8_t> avi(const FilmTiming& timing) const;

  std::size_t size() const { return pictures_.size(); }

 private:
  std::vector<std::vector<std::uint8_t>> pictures_;
  std::uint64_t bytes_ = 0;  // of them
  int width_ = 0, height_ = 0;
};

}  // namespace slf::tools
