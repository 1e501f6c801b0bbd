// SPDX-License-Identifier: Apache-2.0
// Frames of a stream that is still on its way: bytes in, light fields out. Spec 7.13, 8.12.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "slf/decoder.h"
#include "slf/error.h"
#include "slf/frames.h"
#include "slf/types.h"

namespace slf {

/// Takes the bytes of a stream as they come and decodes any frame that has arrived with its group.
/// Damage costs a group: frames that cannot be found are one lost frame of the list, and reading
/// goes on at the next intra frame. One thread at a time.
///
/// A light field that does not move is one frame, which is listed with its headers and grows by
/// units: FrameInfo::arriving. decode(0) gives what they allow (spec 8.9), each time from the
/// beginning: nothing is kept but its bytes. decode() of decoder.h is open, push, finish,
/// decode(0).
class FrameReader {
 public:
  /// @param options  of every frame, as of FrameDecoder. limits.max_stream_bytes: of bytes held
  /// @errors kInvalidArgument: max_bytes
  static Result<FrameReader> open(const DecodeOptions& options = {});
  FrameReader(FrameReader&&) noexcept;
  FrameReader& operator=(FrameReader&&) noexcept;
  ~FrameReader();

  /// Copies the bytes that follow those of the call before. O(bytes)
  /// @errors kNotSlf; those of the first frame's sequence and frame unit, and of the units of a
  ///         light field that does not move, for good; kLimitExceeded: nothing was taken, and can
  ///         be after drop_before(); kInvalidArgument: after finish()
  Result<Done> push(std::span<const std::uint8_t> bytes);
  /// The stream ends here: lists a last frame that was cut short, and a light field that does not
  /// move whose headers did not come.
  /// @errors kNotSlf, kTruncated: no frame began, or one that does not move ends inside a unit;
  ///         those of push()
  Result<Done> finish();

  /// Frames that have arrived whole, and one that does not move as soon as its headers have. They
  /// stay in the list when their bytes are dropped.
  const std::vector<FrameInfo>& frames() const;
  /// Bytes of memory that frames and what is not yet one take.
  std::uint64_t held_bytes() const;
  /// Bytes of a frame, until the next call that is not const; empty where they were dropped, no
  /// frame was found, or `frame` is not in frames(). Of one that is arriving: units that are whole.
  std::span<const std::uint8_t> bytes_of(std::size_t frame) const;
  /// The intra frame that the group of `frame` begins with; frames().size() of a place that is
  /// not in frames().
  std::size_t group_of(std::size_t frame) const;

  /// A predicted frame costs the decode of those before it, back to its intra frame or to the one
  /// decoded last: in order each frame is decoded once.
  /// @param frame  place in frames()
  /// @errors as decode(); those of a frame that it is predicted from; of a lost frame what was
  ///         found in its place. kUnreadable: bytes of its group were dropped. kInvalidArgument
  Result<LightField> decode(std::size_t frame);

  /// For frames that are decoded from here on. The next that is predicted is decoded from its intra
  /// frame on.
  /// @errors kInvalidArgument: max_bytes
  Result<Done> set_options(const DecodeOptions& options);

  /// Drops the bytes of groups before that of `frame`.
  void drop_before(std::size_t frame);
  /// The bytes pushed next are those from an intra frame of the list on. All that is held is
  /// dropped.
  /// @errors kInvalidArgument: no such place, or one that is predicted or lost
  Result<Done> seek(std::size_t frame);

 private:
  struct Impl;
  explicit FrameReader(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace slf
