// SPDX-License-Identifier: Apache-2.0
#include "capture/frame_files.h"

#include "capture/file_names.h"
#include "capture/ply_reader.h"
#include "slf/gaussian_files.h"

namespace slf {

namespace fs = std::filesystem;

InputError bad_frame(const fs::path& path, const std::string& cause) {
  return {Errc::kInvalidInput, path.string() + ": " + cause};
}

bool is_splat_name(const fs::path& path) {
  const std::string extension = extension_of(path);
  return extension == ".spz" || extension == ".splat" || extension == ".ksplat" ||
         extension == ".sog" || (extension == ".glb" && looks_like_gaussians(path));
}

namespace {

/// What a file of a frame holds: clouds and splats are told by content.
Result<FrameKind, InputError> kind_of_file(FrameInput& frame) {
  const fs::path& file = frame.path;
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  if (error) return InputError{Errc::kUnreadable, file.string() + ": " + error.message()};
  if (size == 0) return bad_frame(file, "the frame is empty");
  const bool splats = looks_like_gaussians(file);
  if (splats && extension_of(file) != ".ply") return FrameKind::kSplats;
  if (is_splat_name(file)) return bad_frame(file, kNoSplats);
  SLF_TRY(const std::uint64_t points, ply_vertices(file));
  frame.is_empty = points == 0;
  return splats ? FrameKind::kSplats : FrameKind::kClouds;
}

}  // namespace

Result<Done, InputError> check_frame_files(FrameInputs& inputs) {
  const FrameInput* first = nullptr;
  for (FrameInput& frame : inputs.frames) {
    SLF_TRY(const FrameKind kind, kind_of_file(frame));
    if (frame.is_empty) {
      if (first == nullptr) inputs.kind = kind;
      continue;
    }
    if (first == nullptr) {
      first = &frame;
      inputs.kind = kind;
    }
    if (kind != inputs.kind)
      return bad_frame(frame.path,
                       std::string(kind == FrameKind::kSplats ? "Gaussian splats" : "a cloud") +
                           " beside " + first->path.filename().string() +
                           ": frames are all clouds or all splats");
  }
  return Done{};
}

}  // namespace slf
