// SPDX-License-Identifier: Apache-2.0
// One line of progress on a terminal; nothing in a pipe or a log.
#pragma once

#include <chrono>
#include <string>

#include "slf/types.h"

namespace slf::tools {

/// "fit 42 %", and what is left of the stage once it has run long enough to tell: "fit 42 %, 1:05
/// left".
/// @param seconds  since the stage began
std::string progress_text(const std::string& stage, double fraction, double seconds);

/// Draws that on standard error, over itself, at most ten times a second, and wipes it when
/// it goes out of scope. Silent if standard error is no terminal, or if told to be.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// For the library; refers to this object. Empty where nothing would be drawn.
  Progress callback();
  /// Wipes what is drawn, for a message in its place.
  void clear();

 private:
  void draw(const char* stage, double fraction);

  bool active_;
  bool drawn_ = false;
  std::string stage_;
  std::chrono::steady_clock::time_point began_{}, last_{};  // the stage; drawing
};

}  // namespace slf::tools
