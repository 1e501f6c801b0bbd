#include "tools/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace slf::tools {

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
  stage_ = stage;
  last_ = now;
  const int percent = static_cast<int>(std::lround(100 * std::clamp(fraction, 0.0, 1.0)));
  std::fprintf(stderr, "\r\033[K%s %d %%", stage, percent);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace slf::tools
