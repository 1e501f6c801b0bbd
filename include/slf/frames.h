// SPDX-License-Identifier: Apache-2.0
// Moving light fields: a stream of frames, an instant each. Spec 7.13, 8.12.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// Element of the error (kUnsupported) of what takes one light field, of a stream of frames.
inline constexpr const char* kOneLightField = "a stream of several frames";
/// Element of the error (kInvalidArgument) of fewer levels of splats that move (8.12.7).
inline constexpr const char* kEveryLevel = "levels: every frame needs all of the one before";

/// A frame of a stream, as its frame unit says.
struct FrameInfo {
  std::uint32_t number = 0;  ///< ascending by one
  double time = 0;           ///< seconds, ascending
  bool predicted = false;    ///< from the frame before it
  std::uint64_t offset = 0;  ///< of its first byte in the stream
  std::uint64_t bytes = 0;
  /// FrameReader could read no frame here. The entry stands for one or several; its number is that
  /// of the last of them, its time lies between its neighbours'.
  bool lost = false;
  /// FrameReader has a light field that does not move, and its end unit has not come yet: `bytes`
  /// are those of units that have, and a decode gives what they allow.
  bool arriving = false;
};

/// The frames of a stream, by the lengths that their frame units say: units are not opened. A light
/// field that does not move is one frame.
/// @return what is there of them: the last may be cut short. Bytes behind it are the beginning of
///         one that was cut off, or is damaged in its first units' lengths
/// @errors kNotSlf, kTruncated: no frame begins. Those of a frame unit; kOutOfRange also: numbers
/// or
///         times that do not ascend, a predicted frame first. kLimitExceeded: max_memory, of the
///         list and of what is looked at for it. O(frames)
Result<std::vector<FrameInfo>> list_frames(std::span<const std::uint8_t> stream,
                                           const DecodeLimits& limits = DecodeLimits::none());

/// Points of each of list_frames(), by the headers of its slices; nothing where these are damaged
/// or cut off, or those of its group.
/// @errors those of list_frames; kLimitExceeded: max_memory. O(units)
Result<std::vector<std::optional<std::uint64_t>>> list_points(std::span<const std::uint8_t> stream,
                                                              const DecodeLimits& limits = {});

/// Decodes any frame of a stream held in memory. A predicted frame needs those before it, back to
/// one that is not: in order each frame is decoded once.
class FrameDecoder {
 public:
  /// @param stream   kept by reference
  /// @param options  of every frame. Fewer levels and groups are those of every frame, without
  ///                 drift; a region is cut from frames decoded whole
  /// @errors those of list_frames; kInvalidArgument: max_bytes
  static Result<FrameDecoder> open(std::span<const std::uint8_t> stream,
                                   const DecodeOptions& options = {});
  FrameDecoder(FrameDecoder&&) noexcept;
  FrameDecoder& operator=(FrameDecoder&&) noexcept;
  ~FrameDecoder();

  const std::vector<FrameInfo>& frames() const;  ///< [F]
  /// @param frame  place, 0 .. F - 1
  /// @errors as decode(); those of a frame that it is predicted from. kInvalidArgument: no such
  ///         place. Frames from the next on that is not predicted are not affected.
  Result<LightField> decode(std::size_t frame);

 private:
  struct Impl;
  explicit FrameDecoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Leaves out frames, and in each of the others levels and groups that options do not ask for:
/// truncate() of streams that move. Frames keep their numbers and times.
/// @param first, last  places, both included; a last beyond the stream's is the stream's. Frames of
///                     its group before the first are kept too: it is predicted from them
/// @param options  as of truncate(); max_bytes: as many whole frames as fit
/// @errors as truncate(); kInvalidArgument: region, which a frame that is predicted from another
///         needs whole; no such frame; max_bytes without room for one. O(bytes)
Result<std::vector<std::uint8_t>> truncate_frames(std::span<const std::uint8_t> stream,
                                                  std::size_t first, std::size_t last,
                                                  const DecodeOptions& options = {});

/// What an application has to add to a frame, of what a decoder has of it: the payload of a unit of
/// type 192 with its identifier in front (spec 7.1.1), which stands before the end of the frame.
/// Empty: none.
using UnitOfFrame = std::function<std::vector<std::uint8_t>(const LightField& decoded)>;

/// Codes the frames of a stream, one after the other.
class FrameEncoder {
 public:
  /// @param parameters  of every frame: one layer, octree and vector coder. Frames have no base,
  ///                    one slice and no index, whatever is said of these. A transform is that of
  ///                    the first frame of a group
  /// @param group       frames from one that is not predicted to the next; below 1 counts as 1
  /// @param first       number of the first frame; those that `group` divides begin groups
  FrameEncoder(const CodingParameters& parameters, int group = 16, std::uint32_t first = 0);
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;
  ~FrameEncoder();

  /// @param field  of the same functions, grid and basis as those before; its points are its own,
  ///               and may be none: that frame is a group of its own (format 1.2)
  /// @param time   seconds, more than that of the frame before
  /// @param unit   or null
  /// @return the bytes of the frame, which follow those of the frame before
  /// @errors kInvalidArgument: a parameter that frames do not have, another header, time; those of
  ///         pack(). The same bytes for any thread count. Holds one frame, and the coded bytes of
  ///         the first of its group.
  Result<std::vector<std::uint8_t>, InputError> add(const LightField& field, double time,
                                                    const UnitOfFrame& unit = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// How a list of frames becomes a stream.
struct FrameSettings {
  int group = 16;    ///< frames from one that is not predicted to the next
  double rate = 30;  ///< frames a second
  /// Points that stand where they stood, and where no photograph shows a change beyond its noise,
  /// keep the view maps that they had.
  bool hold_still = true;
  /// Else they keep those of their own group alone, so that groups are coded without each other.
  bool hold_over_groups = true;
  /// Part `part` of `parts`, from 0: groups of about as many frames. All parts, one after the
  /// other, are the bytes of one part that is all (hold_over_groups is false in all of them).
  int part = 0, parts = 1;
};

/// Places of the frames of a part.
struct FramesOfPart {
  std::size_t first = 0, count = 0;
};
/// Whole groups; `count` is 0 where there are fewer groups than parts, and of settings that are
/// none (a group below 1, a part that is not one of `parts`).
FramesOfPart frames_of_part(std::size_t frames, const FrameSettings& settings);

/// What one frame is made of, loaded when it is its turn.
struct LoadedFrame {
  Capture capture;
  std::vector<int> cameras;  ///< input cameras; none of a coloured cloud
};
using LoadFrame = std::function<Result<LoadedFrame, InputError>(std::size_t)>;
/// Takes the bytes of a frame; an error ends the encoding.
using TakeFrame =
    std::function<Result<Done, InputError>(std::size_t, std::span<const std::uint8_t>)>;

/// A list of frames before anything is coded.
struct PlannedFrames {
  std::vector<std::size_t> points;   ///< [F] as given; those of one voxel are merged
  std::vector<std::size_t> cameras;  ///< [F] that are input
  Grid grid;                         ///< of all of them; not known of splats that are trained
  FramesOfPart part;                 ///< those that are to be coded
  bool trained = false;              ///< as splats, by photographs
};

/// What encode_frames() does first: checks settings, loads each frame and finds the grid.
/// Photographs are not read, nothing is fitted.
/// @errors those of encode_frames() but for take's and the coder's
Result<PlannedFrames, InputError> plan_frames(std::size_t frames, const LoadFrame& load,
                                              const EncoderSettings& settings,
                                              const FrameSettings& frame_settings,
                                              const Progress& progress = {});

/// What became of a frame.
struct EncodedFrame {
  bool predicted = false;
  std::size_t points = 0, held = 0;  ///< held: with the view map of the frame before
  std::uint64_t bytes = 0;
  double seconds = 0;
  std::size_t left_out = 0;  ///< splats that no pixel shows
};
struct EncodedFrames {
  std::vector<EncodedFrame> frames;
  Grid grid;             ///< of all of them
  double q = 0;          ///< of all of them
  bool trained = false;  ///< their points are splats that photographs trained
  std::vector<std::string> warnings;
  std::string as;      ///< clouds of views: "planes" or "viewmaps"
  bool exact = false;  ///< clouds of views: every byte comes back; q is that of planes
};

/// Codes frames: view maps of each are fitted by themselves, on one grid, in the settings that the
/// first frame chose. Points are as given: nothing is mended or made up. What stands still
/// keeps its view map (FrameSettings::hold_still).
/// With Surface::kSplats, and with kAuto where photographs have no points or points that leave
/// holes, splats are trained instead: those of the first frame, and then, frame after frame, those
/// that changed pixels show. The others stay as they are. All frames' splats are held.
/// With EncoderSettings::target_bitrate the step is the one for which all frames together have 97
/// to 100 % of it: they are coded some five times, and the bytes of two such runs are held.
/// @param frames  how many there are, 1 or more. Each is loaded twice: for the grid, and to be
/// coded
/// Where a frame has no points it is empty (format 1.2); the first that has some chooses.
/// @errors kInvalidArgument: settings that frames do not have (a target, quality layers, Draco,
///         textures, a base, points that are mended, trained or made up), no frame with points;
///         those of load, take, encode() and FrameEncoder
/// One frame is in memory at a time, what is left of the one before, and a photograph of every
/// camera to compare with. The same bytes for any
/// thread count of one binary.
Result<EncodedFrames, InputError> encode_frames(std::size_t frames, const LoadFrame& load,
                                                const EncoderSettings& settings,
                                                const FrameSettings& frame_settings,
                                                const TakeFrame& take,
                                                const Progress& progress = {});

}  // namespace slf
