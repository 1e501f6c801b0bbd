// SPDX-License-Identifier: Apache-2.0
#include "tools/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace slf::tools {

std::string progress_text(const std::string& stage, double fraction, double seconds) {
  constexpr double kTelling = 3;  // seconds
  fraction = std::clamp(fraction, 0.0, 1.0);
  std::string line = stage + " " + std::to_string(std::lround(100 * fraction)) + " %";
  if (seconds < kTelling || fraction < 0.02 || fraction >= 1) return line;
  const long left = std::lround(std::ceil(seconds * (1 - fraction) / fraction));
  char text[40];
  std::snprintf(text, sizeof text, ", %ld:%02ld left", left / 60, left % 60);
  return line + text;
}

ProgressLine::ProgressLine(bool quiet) : active_(!quiet && isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() { clear(); }

Progress ProgressLine::callback() {
  if (!active_) return {};
  return [this](const char* stage, double fraction) { draw(stage, fraction); };
}

void ProgressLine::clear() {
  if (drawn_) std::fputs("\r\033[K", stderr);
  drawn_ = false;
}

void ProgressLine::draw(const char* stage, double fraction) {
  const auto now = std::chrono::steady_clock::now();
  if (stage_ == stage && now - last_ < std::chrono::milliseconds(100)) return;
  if (stage_ != stage) began_ = now;
  stage_ = stage;
  last_ = now;
  const std::chrono::duration<double> taken = now - began_;
  std::fprintf(stderr, "\r\033[K%s", progress_text(stage_, fraction, taken.count()).c_str());
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace slf::tools
