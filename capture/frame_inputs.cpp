// SPDX-License-Identifier: Apache-2.0
// Frames by their names, and what all captures of a sequence have in common.
#include "slf/frame_inputs.h"

#include <algorithm>
#include <charconv>
#include <tuple>

#include "capture/file_names.h"
#include "capture/frame_files.h"
#include "capture/frame_names.h"
#include "capture/frame_photographs.h"
#include "slf/capture.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

constexpr const char* kCapturePrefix = "frame_";

/// An entry whose name is that of a frame.
struct Candidate {
  FramePattern pattern;
  FrameInput frame;
  FrameKind kind;
};

std::optional<Candidate> candidate_of(const fs::directory_entry& entry,
                                      const std::optional<FramePattern>& wanted) {
  std::error_code ignored;
  const bool directory = entry.is_directory(ignored);
  const fs::path& path = entry.path();
  const std::string name = path.filename().string();
  auto pattern = wanted;
  if (!wanted && directory && name.starts_with(kCapturePrefix)) pattern = pattern_of(name, "");
  if (!wanted && !directory && (extension_of(path) == ".ply" || is_splat_name(path)))
    pattern = pattern_of(path.stem().string(), path.extension().string());
  if (!pattern) return std::nullopt;
  const auto number = pattern->number_of(name);
  if (!number) return std::nullopt;
  if (!wanted && directory && pattern->before != kCapturePrefix) return std::nullopt;
  return Candidate{
      *pattern, {*number, path}, directory ? FrameKind::kCaptures : FrameKind::kClouds};
}

/// By number, then by name. Beside captures, splats in other files than PLY are none.
Result<std::vector<Candidate>, InputError> candidates_in(
    const fs::path& directory, const std::optional<FramePattern>& wanted) {
  std::vector<Candidate> found;
  std::error_code error;
  fs::directory_iterator entry(directory, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (auto candidate = candidate_of(*entry, wanted)) found.push_back(*candidate);
  }
  const auto is_of_captures = [](const Candidate& c) { return c.kind == FrameKind::kCaptures; };
  if (!wanted && std::any_of(found.begin(), found.end(), is_of_captures))
    std::erase_if(found, [&](const Candidate& c) {
      return !is_of_captures(c) && extension_of(c.frame.path) != ".ply";
    });
  if (error) return InputError{Errc::kUnreadable, directory.string() + ": " + error.message()};
  std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.frame.number, a.frame.path) < std::tie(b.frame.number, b.frame.path);
  });
  return found;
}

/// All are of one kind and one name.
Result<Done, InputError> check_one_sequence(const std::vector<Candidate>& found) {
  const Candidate& first = found.front();
  for (const Candidate& c : found) {
    if (c.kind != first.kind)
      return bad_frame(c.frame.path,
                       std::string(c.kind == FrameKind::kClouds ? "a cloud" : "a capture") +
                           " beside " + first.frame.path.filename().string() +
                           ": frames are all captures or all clouds");
    if (c.pattern.before != first.pattern.before || c.pattern.behind != first.pattern.behind)
      return bad_frame(c.frame.path, "another name than " + first.frame.path.filename().string() +
                                         "; a pattern as " + first.pattern.before + "%04d" +
                                         first.pattern.behind + " says which frames are meant");
  }
  return Done{};
}

/// What frames are called, as the first that is padded has it.
FramePattern common_pattern(const std::vector<Candidate>& found) {
  for (const Candidate& c : found)
    if (c.pattern.width > 1) return c.pattern;
  return found.front().pattern;
}

/// Numbers go up by one, over all of the range.
Result<std::vector<FrameInput>, InputError> without_gaps(const std::vector<Candidate>& found,
                                                         const fs::path& directory,
                                                         const FrameRange& range) {
  const FramePattern pattern = common_pattern(found);
  const auto missing = [&](std::uint32_t number) {
    return bad_frame(directory / pattern.name_of(number),
                     "frame " + std::to_string(number) + " is missing");
  };
  std::vector<FrameInput> frames;
  for (const Candidate& c : found) {
    if (c.frame.number < range.first || c.frame.number > range.last) continue;
    const std::uint32_t next = frames.empty() ? range.first : frames.back().number + 1;
    if (c.frame.number < next)
      return bad_frame(c.frame.path, "frame " + std::to_string(c.frame.number) +
                                         " is there twice, as " +
                                         frames.back().path.filename().string() + " too");
    if (c.frame.number > next) return missing(next);
    frames.push_back(c.frame);
  }
  if (frames.empty()) return missing(range.first);
  if (frames.back().number != range.last) return missing(frames.back().number + 1);
  return frames;
}

/// Frames of a capture whose images are numbered.
Result<FrameInputs, InputError> frames_of_images(const fs::path& directory,
                                                 std::optional<FrameRange> range) {
  SLF_TRY(const auto files, numbered_images(directory));
  SLF_TRY(const auto found, candidates_in(files.front().directory, files.front().pattern));
  if (found.empty())
    return bad_frame(files.front().directory,
                     "no file has a name as " + files.front().pattern.text());
  const FrameRange all{found.front().frame.number, found.back().frame.number};
  FrameInputs inputs{FrameKind::kCaptures, {}};
  SLF_TRY(inputs.frames, without_gaps(found, files.front().directory, range.value_or(all)));
  for (FrameInput& frame : inputs.frames) {
    frame.path = directory;
    frame.of_all = true;
    std::error_code ignored;
    for (const NumberedFile& file : files)
      if (!fs::is_regular_file(file.file(frame.number), ignored))
        return bad_frame(file.file(frame.number),
                         "the photograph is missing of frame " + std::to_string(frame.number));
  }
  return inputs;
}

struct NamedSize {
  std::string name;
  int width, height;
};

/// Cameras of a capture by name.
Result<std::vector<NamedSize>, InputError> cameras_of(const fs::path& directory) {
  std::error_code ignored;
  if (fs::is_empty(directory, ignored)) return bad_frame(directory, "the frame is empty");
  SLF_TRY(const auto capture,
          load_capture(directory, {.points = {}, .check_images = false, .cloud = false}));
  std::vector<NamedSize> cameras;
  for (const Camera& camera : capture.cameras)
    cameras.push_back({camera.name, camera.width, camera.height});
  std::sort(cameras.begin(), cameras.end(),
            [](const NamedSize& a, const NamedSize& b) { return a.name < b.name; });
  return cameras;
}

Result<Done, InputError> check_same_cameras(const FrameInput& frame,
                                            const std::vector<NamedSize>& cameras,
                                            const FrameInput& first,
                                            const std::vector<NamedSize>& expected) {
  const std::string reference = first.path.filename().string();
  for (std::size_t i = 0; i < std::max(cameras.size(), expected.size()); ++i) {
    // The first place where the sorted lists part: the lesser name is in one of them alone.
    const bool ends = i >= cameras.size(), more = i >= expected.size();
    if (ends || (!more && expected[i].name < cameras[i].name))
      return bad_frame(frame.path,
                       "no camera " + expected[i].name + ", which " + reference + " has");
    if (more || cameras[i].name < expected[i].name)
      return bad_frame(frame.path,
                       "camera " + cameras[i].name + ", which " + reference + " has not");
    const NamedSize &a = cameras[i], &b = expected[i];
    if (a.width != b.width || a.height != b.height)
      return bad_frame(frame.path, "camera " + a.name + " is of " + std::to_string(a.width) +
                                       " x " + std::to_string(a.height) + ", in " + reference +
                                       " of " + std::to_string(b.width) + " x " +
                                       std::to_string(b.height));
  }
  return Done{};
}

Result<Done, InputError> check_frames(FrameInputs& inputs) {
  if (inputs.kind == FrameKind::kClouds) return check_frame_files(inputs);
  std::vector<NamedSize> expected;
  for (const FrameInput& frame : inputs.frames) {
    SLF_TRY(auto cameras, cameras_of(frame.path));
    if (&frame == &inputs.frames.front())
      expected = std::move(cameras);
    else
      SLF_CHECK(check_same_cameras(frame, cameras, inputs.frames.front(), expected));
  }
  return Done{};
}

bool is_capture(const fs::path& directory) {
  std::error_code ignored;
  for (const char* mark : {"cameras.json", "transforms.json", "transforms_train.json", "index.cams",
                           "cameras.bin", "cameras.txt", "sparse", "colmap"})
    if (fs::exists(directory / mark, ignored)) return true;
  return false;
}

/// A cameras.json whose images are numbered stands for the folder that it is in.
fs::path folder_of_numbered(const fs::path& input) {
  if (input.filename() != "cameras.json") return input;
  const fs::path folder = input.has_parent_path() ? input.parent_path() : fs::path(".");
  return has_numbered_images(folder) ? folder : input;
}

}  // namespace

std::string FrameInput::name() const {
  return of_all ? FramePattern{kCapturePrefix, "", 4}.name_of(number) : path.filename().string();
}

bool holds_frames(const fs::path& given) {
  std::error_code ignored;
  const fs::path input = folder_of_numbered(given);
  if (parse_pattern(input.filename().string())) return !fs::exists(input, ignored);
  if (!fs::is_directory(input, ignored)) return false;
  if (is_capture(input)) return has_numbered_images(input);
  const auto found = candidates_in(input, std::nullopt);
  return found && !found->empty();
}

Result<FrameInputs, InputError> list_frames(const fs::path& given,
                                            std::optional<FrameRange> range) {
  const fs::path input = folder_of_numbered(given);
  if (range && (range->first > range->last || range->last > kMostFrameNumber))
    return InputError{Errc::kInvalidArgument, "frames " + std::to_string(range->first) + ":" +
                                                  std::to_string(range->last) +
                                                  ": not a range of 0 .. 999999999"};
  if (has_numbered_images(input)) return frames_of_images(input, range);
  std::error_code ignored;
  std::optional<FramePattern> pattern;
  fs::path directory = input;
  if (!fs::is_directory(input, ignored)) {
    pattern = parse_pattern(input.filename().string());
    if (!pattern)
      return InputError{Errc::kInvalidArgument,
                        input.string() + ": neither a directory nor a pattern as frame_%04d.ply"};
    directory = input.has_parent_path() ? input.parent_path() : fs::path(".");
  }
  SLF_TRY(const auto found, candidates_in(directory, pattern));
  if (found.empty())
    return bad_frame(input, pattern ? "no file has such a name"
                                    : "no frames: neither frame_0001 and so on, nor clouds or "
                                      "splats whose names end in numbers");
  SLF_CHECK(check_one_sequence(found));
  const FrameRange all{found.front().frame.number, found.back().frame.number};
  FrameInputs inputs{found.front().kind, {}};
  SLF_TRY(inputs.frames, without_gaps(found, directory, range.value_or(all)));
  SLF_CHECK(check_frames(inputs));
  return inputs;
}

Result<FrameRange, InputError> parse_frame_range(const std::string& text) {
  FrameRange range;
  const char *at = text.data(), *end = text.data() + text.size();
  auto parsed = std::from_chars(at, end, range.first);
  bool sound = parsed.ec == std::errc() && parsed.ptr != at;
  range.last = range.first;
  if (sound && parsed.ptr != end) {
    at = parsed.ptr + 1;
    sound = *parsed.ptr == ':';
    parsed = std::from_chars(at, end, range.last);
    sound = sound && parsed.ec == std::errc() && parsed.ptr == end;
  }
  if (!sound || range.first > range.last || range.last > kMostFrameNumber)
    return InputError{Errc::kInvalidArgument,
                      "frames " + text + ": not A:B with 0 <= A <= B <= 999999999"};
  return range;
}

}  // namespace slf
