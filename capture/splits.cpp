// SPDX-License-Identifier: Apache-2.0
// Which cameras are input and which are held out.
#include <algorithm>
#include <charconv>

#include "slf/capture.h"

namespace slf {

namespace {

constexpr int kHeldOutEvery = 4;  // the fourth, the eighth, ...

bool held_out(int camera) { return camera % kHeldOutEvery == kHeldOutEvery - 1; }

/// n of "1/n", 1 .. 9999; 0: another name.
int thinning(const std::string& name) {
  int n = 0;
  if (!name.starts_with("1/") || name.size() > 6) return 0;
  const auto [end, error] = std::from_chars(name.data() + 2, name.data() + name.size(), n);
  return error == std::errc() && end == name.data() + name.size() ? std::max(n, 0) : 0;
}

}  // namespace

Result<std::vector<int>, InputError> split_cameras(const Capture& capture,
                                                   const std::string& name) {
  const bool by_default = name.empty() || name == "default";
  const auto named = capture.splits.find(by_default ? "dense" : name);
  if (named != capture.splits.end()) return named->second;
  const int every = by_default ? 1 : thinning(name);
  const bool evaluation = name == "evaluation";
  if (every == 0 && !evaluation && name != "all") {
    std::string known = "all, default, evaluation, 1/n";
    for (const auto& [split, cameras] : capture.splits)
      if (split != "evaluation" && split != "all") known += ", " + split;
    return InputError{Errc::kInvalidArgument,
                      "split '" + name + "': the capture has no such split, only " + known};
  }
  // Without `dense`, the input is all that `evaluation`, or every fourth, leaves; or 1/n of it.
  const auto kept_out = capture.splits.find("evaluation");
  std::vector<bool> is_kept_out(capture.cameras.size(), false);
  if (kept_out != capture.splits.end())
    for (const int i : kept_out->second)
      if (const auto at = static_cast<std::size_t>(i); at < is_kept_out.size())
        is_kept_out[at] = true;
  std::vector<int> cameras;
  int left = 0;  // cameras that are not held out, so far
  for (int i = 0; i < static_cast<int>(capture.cameras.size()); ++i) {
    const bool out =
        kept_out == capture.splits.end() ? held_out(i) : is_kept_out[static_cast<std::size_t>(i)];
    const bool chosen = name == "all" || (evaluation ? out : !out && left % every == 0);
    left += !out;
    if (chosen) cameras.push_back(i);
  }
  return cameras;
}

}  // namespace slf
