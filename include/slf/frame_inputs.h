// SPDX-License-Identifier: Apache-2.0
// Frames of a moving light field as files: which there are, and in what order.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slf/capture.h"
#include "slf/error.h"

namespace slf {

enum class FrameKind : std::uint8_t {
  kCaptures,
  kClouds,
  kSplats,    ///< Gaussian splats, files of looks_like_gaussians()
  kPlanes,    ///< clouds of views that are to be coded as planes; list_frames() says kClouds
  kViewMaps,  ///< clouds of views that are to be coded as view maps; the same
};

struct FrameInput {
  std::uint32_t number = 0;    ///< as its name has it; from one frame to the next 1 more
  std::filesystem::path path;  ///< a directory that load_capture reads, a PLY or a file of splats
  bool of_all = false;         ///< path is one capture whose files have %d for the number
  bool is_empty = false;       ///< a PLY without vertices

  /// For messages, and for a folder of its own: frame_0001, NAME_0001.ply.
  std::string name() const;
};

struct FrameInputs {
  FrameKind kind{};
  std::vector<FrameInput> frames;  ///< [F] by number, F >= 1
};

/// Numbers of the first and the last frame that are wanted, both included.
struct FrameRange {
  std::uint32_t first = 0, last = 0;
};

/// load_capture() of one frame. Where its path is of all frames, images, masks and the cloud are
/// those of its number; cameras keep their names.
/// @errors as load_capture; kInvalidInput: an image without %d
Result<Capture, InputError> load_frame(const FrameInput& frame, const CaptureOptions& options = {});

/// Is this what list_frames reads, rather than one capture or one cloud? A name with a pattern; or
/// a directory that is no capture itself and has frame_NUMBER/, or clouds or splats whose names end
/// in numbers; or one whose cameras.json has images with a pattern.
bool holds_frames(const std::filesystem::path& input);

/// Finds the frames of an input and checks that they are of one sequence. Headers and cameras are
/// read; points and photographs are not.
///
/// @param input  a directory of captures frame_NUMBER/, or of clouds NAME + NUMBER.ply, one NAME
///               in all, or of splats: NAME + NUMBER.ply or, where there is no PLY, .spz, .sog,
///               .splat, .ksplat, .glb; or a path whose last part has one pattern %d, %4d or %04d
///               for the number
///               ("loot_vox10_%04d.ply", "take/frame_%04d"), which leaves other names out; or a
///               directory with one cameras.json, each of whose images has such a pattern
///               ("cam1/%04d.png"): frames have the numbers of the first camera's photographs.
///               Numbers begin anywhere in 0 .. 999,999,999. Other files are not looked at.
/// @param range  frames that are wanted; without: all
/// @return F frames, F >= 1, numbers without a gap. A cloud may have no points, a PLY no splats;
///         without points it goes with both.
/// @errors kUnreadable: the directory, or a file of a frame. kInvalidArgument: a pattern that is
///         none of these, a range that ends before it begins. kInvalidInput, names the file:
///         no frames; one that is missing between the first and the last; two of one number;
///         captures, clouds and splats in one directory, or clouds of two names; an empty file;
///         captures that have other cameras (names, in any order) or other sizes of images than the
///         first; what load_capture or a PLY's header refuses.
/// O(E log E + F C log C) for E entries of the directory and C cameras. Thread-safe.
Result<FrameInputs, InputError> list_frames(const std::filesystem::path& input,
                                            std::optional<FrameRange> range = {});

/// "A:B" or "A", whole numbers with A <= B.
/// @errors kInvalidArgument
Result<FrameRange, InputError> parse_frame_range(const std::string& text);

}  // namespace slf
