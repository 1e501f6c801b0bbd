// SPDX-License-Identifier: Apache-2.0
// Streams of frames, coded by motions that are given, and changed.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "codec/decoder/frame_chain.h"
#include "codec/encoder/pack_frame.h"
#include "conformance/edit_units.h"

namespace slf::conformance {

/// Codes frames one after the other: integers alone, so the same for every compiler.
class FrameWriter {
 public:
  explicit FrameWriter(const CodingParameters& parameters, std::uint32_t level = 0,
                       std::uint32_t features = 0);
  /// A frame that is not predicted.
  void add(const LightField& field);
  /// One that is, with this motion.
  void add(const LightField& field, const Motion& motion);
  /// One whose reference's points move, each as a function says.
  void add_moved(const LightField& field, const Motion& motion,
                 const std::function<PointMove(std::size_t point)>& of);
  /// One without points, with the header of a field.
  void add_empty(LightField field);

  const std::vector<Bytes>& frames() const { return frames_; }
  Bytes stream() const;

 private:
  FrameHeader next_header() const;
  void append(Bytes bytes);

  CodingParameters parameters_;
  GroupCoding group_;
  FrameChain chain_;
  std::vector<Bytes> frames_;
};

Bytes joined(const std::vector<Bytes>& frames);

/// Another version in a stream that is sound but for it.
Bytes of_version(Bytes stream, int major, int minor);

/// A frame, its units changed; counts and frame_bytes are then sound.
/// header: changes the frame unit after that
Bytes edited_frame(const Bytes& frame, const UnitEdit& edit,
                   const std::function<void(FrameHeader&)>& header = {});

}  // namespace slf::conformance
