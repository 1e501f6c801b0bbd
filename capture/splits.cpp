// Which cameras are input and which are held out.
#include <algorithm>

#include "slf/capture.h"

namespace slf {

namespace {

constexpr int kHeldOutEvery = 4;  // the fourth, the eighth, ...

bool held_out(int camera) { return camera % kHeldOutEvery == kHeldOutEvery - 1; }

}  // namespace

Result<std::vector<int>, InputError> split_cameras(const Capture& capture,
                                                   const std::string& name) {
  const bool by_default = name.empty() || name == "default";
  const auto named = capture.splits.find(by_default ? "dense" : name);
  if (named != capture.splits.end()) return named->second;
  const bool rest = by_default, evaluation = name == "evaluation";
  if (!rest && !evaluation && name != "all") {
    std::string known = "all, default, evaluation";
    for (const auto& [split, cameras] : capture.splits)
      if (split != "evaluation" && split != "all") known += ", " + split;
    return InputError{Errc::kInvalidArgument,
                      "split '" + name + "': the capture has no such split, only " + known};
  }
  // Without `dense`, the input is all that `evaluation`, or every fourth, leaves.
  const auto kept_out = capture.splits.find("evaluation");
  std::vector<int> cameras;
  for (int i = 0; i < static_cast<int>(capture.cameras.size()); ++i) {
    const bool out = kept_out == capture.splits.end()
                         ? held_out(i)
                         : std::count(kept_out->second.begin(), kept_out->second.end(), i) > 0;
    if (name == "all" || out == evaluation) cameras.push_back(i);
  }
  return cameras;
}

}  // namespace slf
