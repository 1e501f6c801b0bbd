// SPDX-License-Identifier: Apache-2.0
#include "codec/frame_header.h"

#include <algorithm>
#include <array>

#include "bitstream/checked_syntax.h"
#include "entropy/binarisation.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "geometry/reference_walk.h"

namespace slf {
namespace {

constexpr std::int32_t kUnit = 4;  // sixteenths of a voxel of what is coded
constexpr std::uint32_t kMostVector = 1 << 16;

/// Decisions about the parts of a vector: by axis, and by the sizes of the vectors before.
struct LatticeContexts {
  static constexpr std::uint32_t kLimit = 255;
  std::array<std::array<AdaptiveBit, 3>, 3> nonzero;
  std::array<MagnitudeContexts, 3> magnitude;
};

/// Has the reference a cell within two steps of the lattice from its point?
bool is_coded(const ReferenceCells& reference, int bits, const Motion& motion,
              const std::array<std::int32_t, 3>& point) {
  const int level = bits - motion.lattice_log2;
  if (level < 0) return true;
  Voxel first;
  for (std::size_t i = 0; i < 3; ++i) first[i] = motion.lattice_first[i] + point[i] - 2;
  return ReferenceWalk(reference.level(level)).window(first) != 0;
}

/// Vectors that are not coded stay zero. Written once for decoder and encoder.
/// @return false where the decoder met a vector that is too long
template <class Coder>
bool code_lattice(Coder& coder, const ReferenceCells& reference, int bits, Motion& motion) {
  LatticeContexts contexts;
  const auto& size = motion.lattice_size;
  std::size_t at = 0;
  std::array<std::int32_t, 3> point{};
  const std::array<std::size_t, 3> stride = {
      1, static_cast<std::size_t>(size[0]),
      static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1])};
  for (point[2] = 0; point[2] < size[2]; ++point[2])
    for (point[1] = 0; point[1] < size[1]; ++point[1])
      for (point[0] = 0; point[0] < size[0]; ++point[0], ++at) {
        Displacement& vector = motion.lattice[at];
        if (!is_coded(reference, bits, motion, point)) {
          vector = {};
          continue;
        }
        std::array<std::int32_t, 3> sum{};
        std::int32_t before = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (point[axis] == 0) continue;
          ++before;
          for (std::size_t i = 0; i < 3; ++i)
            sum[i] += motion.lattice[at - stride[axis]][i] / kUnit;
        }
        std::size_t busy = 0;  // parts before that are not as predicted
        for (std::size_t i = 0; i < 3; ++i) {
          const std::int32_t predicted = before > 0 ? sum[i] / before : 0;
          const std::int32_t given = Coder::kDecodes ? 0 : vector[i] / kUnit - predicted;
          auto m = static_cast<std::uint32_t>(given < 0 ? -given : given);
          bool negative = given < 0;
          if (coder.bit(contexts.nonzero[i][busy], LatticeContexts::kLimit, m != 0)) {
            m = code_magnitude(coder, contexts.magnitude[i], LatticeContexts::kLimit, m);
            if (m == 0 || m > kMostVector) return false;
            negative = coder.raw(1, negative) != 0;
            ++busy;
          } else {
            m = 0;
          }
          const auto rest = static_cast<std::int32_t>(m);
          const std::int32_t value = predicted + (negative ? -rest : rest);
          if (value > static_cast<std::int32_t>(kMostVector) ||
              value < -static_cast<std::int32_t>(kMostVector))
            return false;
          vector[i] = kUnit * value;
        }
        if constexpr (Coder::kDecodes)
          if (coder.exhausted()) return true;
      }
  return true;
}

std::size_t lattice_points(const Motion& motion) {
  return static_cast<std::size_t>(motion.lattice_size[0]) *
         static_cast<std::size_t>(motion.lattice_size[1]) *
         static_cast<std::size_t>(motion.lattice_size[2]);
}

}  // namespace

Result<FrameHeader> parse_frame_header(std::span<const std::uint8_t> payload,
                                       std::span<const std::uint8_t>& vectors) {
  BitReader in(payload);
  ParseSyntax parse{in};
  FrameHeader header;
  frame_unit(parse, header);
  vectors = in.align_and_rest("alignment_zero_bits");
  if (in.ok() && header.frame_lattice_flag == 0 && !vectors.empty())
    in.fail(Errc::kOutOfRange, "frame_vectors");
  if (!in.ok()) return in.error();
  if (header.frame_lattice_flag != 0)
    for (auto& size : header.motion.lattice_size) ++size;
  return header;
}

Result<Done> read_lattice(std::span<const std::uint8_t> vectors, const ReferenceCells& reference,
                          int bits, Motion& motion) {
  if (motion.lattice_log2 == 0) return Done{};
  if (!reference.has(bits - motion.lattice_log2))
    return Error{Errc::kOutOfRange, "frame_predicted_flag"};
  motion.lattice.resize(lattice_points(motion));
  RangeDecoder decoder(vectors);
  if (!code_lattice(decoder, reference, bits, motion))
    return decoder.exhausted() ? decoder.finish("frame_vectors")
                               : decoder.here(Errc::kOutOfRange, "frame_vectors");
  return decoder.finish("frame_vectors");
}

Result<std::vector<std::uint8_t>, InputError> frame_payload(FrameHeader header,
                                                            std::span<const std::uint8_t> vectors) {
  if (header.frame_lattice_flag != 0)
    for (auto& size : header.motion.lattice_size) --size;
  SLF_TRY(auto payload, checked_header([&](auto& v) { frame_unit(v, std::as_const(header)); }));
  payload.insert(payload.end(), vectors.begin(), vectors.end());
  return payload;
}

Result<std::vector<std::uint8_t>, InputError> write_frame_header(FrameHeader& header,
                                                                 const ReferenceCells* reference,
                                                                 int bits) {
  Motion& motion = header.motion;
  header.frame_motion_flag = motion.is_zero() ? 0 : 1;
  header.frame_lattice_flag = motion.lattice_log2 > 0 ? 1 : 0;
  std::vector<std::uint8_t> vectors;
  if (header.frame_lattice_flag != 0) {
    RangeEncoder encoder;
    code_lattice(encoder, *reference, bits, motion);
    vectors = encoder.finish();
  }
  return frame_payload(header, vectors);
}

}  // namespace slf
