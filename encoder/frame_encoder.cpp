// SPDX-License-Identifier: Apache-2.0
// Frames of a moving light field, each predicted from what a decoder has of the one before.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "bitstream/level.h"
#include "codec/decoder/frame_chain.h"
#include "codec/encoder/pack_frame.h"
#include "codec/encoder/pack_parameters.h"
#include "encoder/find_motion.h"
#include "encoder/match_points.h"
#include "geometry/morton.h"
#include "slf/frames.h"
#include "slf/gaussians.h"
#include "slf/view_map.h"

namespace slf {

/// Codes and colours of a frame in Morton order.
struct FrameColours {
  std::vector<std::uint64_t> codes;
  std::vector<std::array<float, 3>> colours;

  FramePoints points(bool scattered) const { return {codes, colours, scattered}; }
};

namespace {

constexpr float kAlike = 4;  // grey levels
constexpr double kStillShare = 0.98;
// Points that move one by one take less than this of the group's first frame: no other way is
// tried.
constexpr double kMuchLess = 0.9;

InputError invalid_frame(const std::string& what) {
  return {Errc::kInvalidArgument, "frames: " + what};
}

CodingParameters parameters_of_frames(CodingParameters parameters) {
  parameters.base_levels = 0;
  parameters.max_slice_points = kMostSlicePoints;
  parameters.index = false;
  return parameters;
}

FrameColours colours_of(const LightField& field, int threads) {
  std::vector<std::array<float, 3>> given(field.num_points());
  if (field.header.has_basis) {
    given = mean_colours(field, threads);
  } else if (const auto planes = static_cast<std::size_t>(field.num_planes()); planes > 0) {
    const float scale = std::ldexp(1.0F, field.header.shift.empty() ? 0 : -field.header.shift[0]);
    for (std::size_t i = 0; i < given.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        given[i][c] = scale * static_cast<float>(field.components[i * planes + c]);
  }
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < field.num_points(); ++i)
    order.emplace_back(morton(field.positions[i]), i);
  if (!std::is_sorted(order.begin(), order.end())) std::sort(order.begin(), order.end());
  FrameColours colours;
  for (const auto& [code, i] : order) {
    colours.codes.push_back(code);
    colours.colours.push_back(given[i]);
  }
  return colours;
}

/// Do all points but a few stand where they stood, in about their colours?
bool hardly_moves(const FrameColours& now, const FrameColours& before) {
  std::size_t still = 0;
  for (std::size_t i = 0, j = 0; i < now.codes.size() && j < before.codes.size();) {
    const auto [code, other] = std::pair(now.codes[i], before.codes[j]);
    if (code == other) {
      const auto &a = now.colours[i], &b = before.colours[j];
      still += std::abs(a[0] + a[1] + a[2] - b[0] - b[1] - b[2]) < 3 * kAlike;
    }
    i += code <= other, j += other <= code;
  }
  return double(still) > kStillShare * double(std::max(now.codes.size(), before.codes.size()));
}

/// Spec 9: the lowest level with room for frames of twice as many points, 30 of them a second.
std::uint32_t level_of_group(const LightField& field) {
  const std::uint64_t points = 2 * field.num_points();
  for (std::uint32_t level = 1; level < kLevels.size(); ++level)
    if (kLevels[level].admits(points, static_cast<std::uint64_t>(field.header.num_functions)) &&
        30 * points <= kLevels[level].points_a_second)
      return level;
  return 0;
}

}  // namespace

struct FrameEncoder::Impl {
  CodingParameters parameters;
  int group_length = 16;
  std::uint32_t number = 0;
  double time = 0;
  std::vector<std::uint8_t> header;  // of all frames, as it is coded
  GroupCoding group;
  bool outgrown = false;  // a frame was more than the level promised: its group promises nothing
  FrameChain chain;
  std::vector<std::uint8_t> first;  // bytes of the group's first frame: the chain goes back to them
  FrameColours before;              // as decoded
  Motion motion;                    // of the frame before
  Motion onward;                    // the same from its places: of points that move one by one

  Result<Done, InputError> check(const LightField& field, double at) const {
    if (parameters.quality_layers > 1 || !parameters.group_layers.empty())
      return invalid_frame("they have one quality layer");
    if (parameters.geometry != GeometryCoder::kOctree ||
        parameters.coefficients != CoefficientCoder::kVector)
      return invalid_frame("they are coded by the octree and vector coders");
    if (field.num_points() > kMostSlicePoints)
      return invalid_frame("one has more than " + std::to_string(kMostSlicePoints) + " points");
    if (!std::isfinite(at) || (!header.empty() && at <= time))
      return invalid_frame("times do not ascend");
    return Done{};
  }

  /// The gammas that cameras saw may differ; those of the first frame of a group stay.
  Result<std::vector<std::uint8_t>, InputError> coded_header(const LightField& field) const {
    SLF_TRY(SequenceParameterSet set, sequence_of_frame(field, parameters));
    set.sps_gamma_min = set.sps_gamma_max = 0;
    return write_sequence_parameter_set(set);
  }

  /// What predicted frames take. A group without such is read by decoders of 1.0.
  std::uint32_t features_of(const LightField& field) const {
    const bool used =
        parameters.reference_contexts && group_length > 1 && field.header.num_functions > 0;
    if (!used) return 0;
    return has_gaussians(field.header) ? kReferenceContexts | kMovedPoints : kReferenceContexts;
  }

  /// Is the frame more than the level of its group promised?
  /// @param bytes  of its largest unit at the most
  bool exceeds_level(const LightField& field, const FrameHeader& frame, std::size_t bytes) const {
    const LevelLimits& most = level_limits(group.set.sps_level);
    const auto points = static_cast<double>(field.num_points());
    const bool slow = !frame.predicted() || points <= static_cast<double>(most.points_a_second) *
                                                          (frame.frame_time - time);
    return field.num_points() > 0 && group.set.sps_level != 0 &&
           !(slow && bytes <= most.unit_bytes &&
             most.admits(field.num_points(),
                         static_cast<std::uint64_t>(field.header.num_functions)));
  }

  /// What begins a group: the first of so many, one without points and the one behind it.
  bool begins_group(const LightField& field) const {
    return number % static_cast<std::uint32_t>(group_length) == 0 || field.num_points() == 0 ||
           before.codes.empty();
  }

  /// Coded and decoded, with the unit that an application adds; coded alone where that is too much.
  struct Coded {
    std::vector<std::uint8_t> bytes;
    std::size_t largest = 0;  // bytes of units, at the most
    LightField decoded;
  };

  /// A frame that is too much for the level of its group begins one that has none.
  Result<Coded, InputError> code(const LightField& field, FrameHeader& frame,
                                 const UnitOfFrame& unit) {
    if (number % static_cast<std::uint32_t>(group_length) == 0) outgrown = false;
    SLF_TRY(Coded coded, code_once(field, frame, unit));
    if (!exceeds_level(field, frame, coded.largest)) return coded;
    outgrown = true;
    frame.frame_predicted_flag = 0;
    return code_once(field, frame, unit);
  }

  Result<Coded, InputError> code_once(const LightField& field, FrameHeader& frame,
                                      const UnitOfFrame& unit) {
    Coded coded;
    SLF_TRY(coded.bytes, field.num_points() == 0 ? pack_empty(field, parameters, frame)
                                                 : code_in_level(field, frame));
    coded.largest = coded.bytes.size();
    if (exceeds_level(field, frame, coded.largest)) return coded;
    SLF_TRY(coded.decoded, decoded_of(coded.bytes));
    const auto payload = unit ? unit(coded.decoded) : std::vector<std::uint8_t>{};
    if (payload.empty()) return coded;
    coded.largest = std::max(coded.largest, payload.size());
    auto all = with_unit(coded.bytes, kApplicationUnit, payload);
    if (!all) return invalid_frame("one is too large: " + to_string(all.error()));
    coded.bytes = *std::move(all);
    return coded;
  }

  Result<LightField, InputError> decoded_of(const std::vector<std::uint8_t>& bytes) {
    const auto coded = read_frame(bytes, 0);
    const bool begins = coded && !coded->header.predicted();
    if (begins) first = bytes;
    DecodeOptions options;
    options.limits = DecodeLimits::none();
    options.threads = parameters.threads;
    auto decoded = coded ? chain.decode(begins ? first : bytes, *coded, options)
                         : Result<LightField>(coded.error());
    if (!decoded) return invalid_frame("one does not decode: " + to_string(decoded.error()));
    return *std::move(decoded);
  }

  Result<std::vector<std::uint8_t>, InputError> code_in_level(const LightField& field,
                                                              FrameHeader& frame) {
    if (!frame.predicted()) {
      group.features = features_of(field);
      group.level = outgrown ? 0 : level_of_group(field);
      frame.motion = motion = onward = {};
      return pack_frame(field, parameters, &frame, &group);
    }
    const FrameColours now = colours_of(field, parameters.threads);
    if (!group.set.has_moved_points() || hardly_moves(now, before))
      return code_displaced(field, now, frame);
    FrameHeader other = frame;
    SLF_TRY(auto moved, code_moved(field, now, other));
    if (double(moved.size()) > kMuchLess * double(first.size())) {
      SLF_TRY(auto displaced, code_displaced(field, now, frame));
      if (displaced.size() <= moved.size()) return displaced;
    }
    frame = std::move(other);
    return moved;
  }

  /// By the reference as it stands, at displaced places.
  Result<std::vector<std::uint8_t>, InputError> code_displaced(const LightField& field,
                                                               const FrameColours& now,
                                                               FrameHeader& frame) {
    const bool scattered = has_gaussians(field.header);
    frame.motion = motion = choose_motion(now.points(scattered), before.points(scattered),
                                          field.header.grid.bits, motion);
    return pack_predicted(field, parameters, group, chain.state(), frame);
  }

  /// The same by points of the reference that move one by one.
  Result<std::vector<std::uint8_t>, InputError> code_moved(const LightField& field,
                                                           const FrameColours& now,
                                                           FrameHeader& frame) {
    const int bits = field.header.grid.bits;
    frame.motion = onward = choose_motion(before.points(true), now.points(true), bits, onward);
    const FrameState& state = chain.state();
    const auto choose = [&](std::span<const std::uint64_t> codes,
                            std::span<const std::int32_t> components) {
      return match_points({codes, components}, {state.cells.codes(bits), state.means.back()},
                          group.steps, frame.motion, bits, parameters.threads);
    };
    return pack_predicted(field, parameters, group, state, frame, choose);
  }
};

FrameEncoder::FrameEncoder(const CodingParameters& parameters, int group, std::uint32_t first)
    : impl_(std::make_unique<Impl>()) {
  impl_->number = first;
  impl_->parameters = parameters_of_frames(parameters);
  impl_->group_length = std::max(group, 1);
}

Result<std::vector<std::uint8_t>, InputError> FrameEncoder::add(const LightField& field,
                                                                double time,
                                                                const UnitOfFrame& unit) {
  Impl& self = *impl_;
  SLF_CHECK(self.check(field, time));
  SLF_TRY(std::vector<std::uint8_t> header, self.coded_header(field));
  if (!self.header.empty() && header != self.header)
    return invalid_frame("grid, functions or attributes are not those of the first");
  FrameHeader frame;
  frame.frame_number = self.number;
  frame.frame_time = time;
  frame.frame_predicted_flag = self.begins_group(field) ? 0 : 1;
  SLF_TRY(Impl::Coded coded, self.code(field, frame, unit));
  self.before = colours_of(coded.decoded, self.parameters.threads);
  self.header = std::move(header);
  self.time = time;
  ++self.number;
  return std::move(coded.bytes);
}

FrameEncoder::FrameEncoder(FrameEncoder&&) noexcept = default;
FrameEncoder& FrameEncoder::operator=(FrameEncoder&&) noexcept = default;
FrameEncoder::~FrameEncoder() = default;

}  // namespace slf
