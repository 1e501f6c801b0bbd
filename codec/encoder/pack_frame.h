// SPDX-License-Identifier: Apache-2.0
// A frame of several, from integers to bytes. Mirrors codec/decoder/frame_decoder.cpp.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "attributes/encoder/forward_transform.h"
#include "bitstream/units.h"
#include "codec/encoder/coded_unit.h"
#include "codec/frame_header.h"
#include "slf/encoder.h"

namespace slf {

/// What the frames of a group have in common.
struct GroupCoding {
  std::uint32_t level = 0;     ///< sps_level of the next, given
  std::uint32_t features = 0;  ///< of the next, given
  SequenceParameterSet set;
  PlaneGroups groups;
  std::vector<std::uint32_t> steps;
  std::vector<ForwardTransform> transforms;
  std::vector<std::uint16_t> coded;  ///< [R] where there are transforms
};

/// pack(), of a frame that is not predicted where one is given.
/// @param frame  its length is filled in
/// @param group  receives what predicted frames go on from
Result<std::vector<std::uint8_t>, InputError> pack_frame(const LightField& field,
                                                         const CodingParameters& parameters,
                                                         FrameHeader* frame, GroupCoding* group);

/// How the points of the reference move, given those of a frame and their components.
using ChooseMoves = std::function<std::vector<PointMove>(std::span<const std::uint64_t> codes,
                                                         std::span<const std::int32_t> components)>;

/// A frame that is predicted.
/// @param frame   its length is filled in, its motion becomes what a decoder has
/// @param choose  points of the reference move one by one, its motion is from there; else nullptr
/// @errors those of pack()
Result<std::vector<std::uint8_t>, InputError> pack_predicted(
    const LightField& field, const CodingParameters& parameters, const GroupCoding& group,
    const FrameState& before, FrameHeader& frame, const ChooseMoves& choose = nullptr);

/// A frame without points, a group of frames of its own. Spec 7.13
/// @param field  its header alone
/// @param frame  its length is filled in
/// @errors kInvalidArgument: names the parameter
Result<std::vector<std::uint8_t>, InputError> pack_empty(const LightField& field,
                                                         const CodingParameters& parameters,
                                                         FrameHeader& frame);

/// The frame unit of an intra frame with these units: it says how many bytes they have.
Result<CodedUnit, InputError> frame_unit_before(std::span<const CodedUnit> units,
                                                FrameHeader& frame);

/// The units of a light field that does not move, or of a frame.
/// @param stream  its bytes alone
/// @errors those of split_units, or of a predicted frame
Result<Units> units_alone(std::span<const std::uint8_t> stream);

/// The frame with one more unit, before its end unit.
/// @param frame  its bytes alone, up to its end
/// @errors those of units_alone
Result<std::vector<std::uint8_t>> with_unit(std::span<const std::uint8_t> frame, UnitType type,
                                            std::span<const std::uint8_t> payload);

/// pack of a field that nobody needs afterwards: its components are not held twice.
Result<std::vector<std::uint8_t>, InputError> pack_taken(LightField field,
                                                         const CodingParameters& parameters);

}  // namespace slf
