// SPDX-License-Identifier: Apache-2.0
#include "codec/frame_vectors.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "entropy/binarisation.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "geometry/reference_walk.h"

namespace slf {
namespace {

constexpr std::int32_t kUnit = 4;  // sixteenths of a voxel of a lattice's vectors, as coded
constexpr std::uint32_t kMostVector = 1 << 16, kMostMove = 1 << 21;
constexpr std::uint32_t kPartLimit = 255;

/// Decisions about the parts of a vector: by axis, and by how many before are not as predicted.
struct PartContexts {
  std::array<std::array<AdaptiveBit, 3>, 3> nonzero;
  std::array<MagnitudeContexts, 3> magnitude;
};

/// What a part has beyond what is predicted. Written once for decoder and encoder.
/// @param given  of an encoder
/// @param busy   parts before that are not as predicted; this one is counted
/// @return false where the decoder met one that is too long
template <class Coder>
bool code_part(Coder& coder, PartContexts& contexts, std::size_t axis, std::uint32_t most,
               std::size_t& busy, std::int32_t& given) {
  auto m = static_cast<std::uint32_t>(given < 0 ? -given : given);
  bool negative = given < 0;
  if (!coder.bit(contexts.nonzero[axis][busy], kPartLimit, m != 0)) {
    given = 0;
    return true;
  }
  m = code_magnitude(coder, contexts.magnitude[axis], kPartLimit, m);
  if (Coder::kDecodes && (m == 0 || m > most)) return false;
  negative = coder.raw(1, negative) != 0;
  given = negative ? -static_cast<std::int32_t>(m) : static_cast<std::int32_t>(m);
  ++busy;
  return true;
}

/// Has the reference a cell within two steps of the lattice from its point?
bool is_coded(const ReferenceCells& reference, int bits, const Motion& motion,
              const std::array<std::int32_t, 3>& point) {
  const int level = bits - motion.lattice_log2;
  if (level < 0) return true;
  Voxel first;
  for (std::size_t i = 0; i < 3; ++i) first[i] = motion.lattice_first[i] + point[i] - 2;
  return ReferenceWalk(reference.level(level)).window(first) != 0;
}

/// Mean of the vectors one step before along each axis that has one, as coded.
Displacement predicted_vector(const Motion& motion, std::size_t at,
                              const std::array<std::int32_t, 3>& point) {
  const auto& size = motion.lattice_size;
  const std::array<std::size_t, 3> stride = {
      1, static_cast<std::size_t>(size[0]),
      static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1])};
  Displacement sum{};
  std::int32_t before = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (point[axis] == 0) continue;
    ++before;
    for (std::size_t i = 0; i < 3; ++i) sum[i] += motion.lattice[at - stride[axis]][i] / kUnit;
  }
  for (std::int32_t& part : sum) part = before > 0 ? part / before : 0;
  return sum;
}

/// Vectors that are not coded stay zero.
/// @return false where the decoder met a vector that is too long
template <class Coder>
bool code_lattice(Coder& coder, const ReferenceCells& reference, int bits, Motion& motion) {
  constexpr auto kMost = static_cast<std::int32_t>(kMostVector);
  PartContexts contexts;
  const auto& size = motion.lattice_size;
  std::size_t at = 0;
  std::array<std::int32_t, 3> point{};
  for (point[2] = 0; point[2] < size[2]; ++point[2])
    for (point[1] = 0; point[1] < size[1]; ++point[1])
      for (point[0] = 0; point[0] < size[0]; ++point[0], ++at) {
        Displacement& vector = motion.lattice[at];
        if (!is_coded(reference, bits, motion, point)) {
          vector = {};
          continue;
        }
        const Displacement predicted = predicted_vector(motion, at, point);
        std::size_t busy = 0;
        for (std::size_t i = 0; i < 3; ++i) {
          std::int32_t rest = Coder::kDecodes ? 0 : vector[i] / kUnit - predicted[i];
          if (!code_part(coder, contexts, i, kMostVector, busy, rest)) return false;
          const std::int32_t value = predicted[i] + rest;
          if (value > kMost || value < -kMost) return false;
          vector[i] = kUnit * value;
        }
        if constexpr (Coder::kDecodes)
          if (coder.exhausted()) return true;
      }
  return true;
}

/// @return false where the decoder met a vector that is too long
template <class Coder>
bool code_moves(Coder& coder, std::vector<PointMove>& moves) {
  PartContexts contexts;
  std::array<AdaptiveBit, 3> moving;  // by how many of the two points before do
  unsigned last = 0;                  // bits of the points before
  for (PointMove& move : moves) {
    const unsigned moves_on =
        coder.bit(moving[(last & 1) + (last >> 1 & 1)], kPartLimit, move == PointMove{} ? 0 : 1);
    last = last << 1 | moves_on;
    std::size_t busy = 0;
    for (std::size_t i = 0; i < 3 && moves_on != 0; ++i)
      if (!code_part(coder, contexts, i, kMostMove, busy, move[i])) return false;
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

Result<Done> read_vectors(std::span<const std::uint8_t> codeword, const ReferenceCells& reference,
                          int bits, FrameHeader& header) {
  if (!header.has_lattice() && !header.moves_points) return Done{};
  if (!reference.has(header.moves_points ? bits : bits - header.motion.lattice_log2))
    return Error{Errc::kOutOfRange, "frame_predicted_flag"};
  RangeDecoder decoder(codeword);
  bool good = true;
  if (header.has_lattice()) {
    header.motion.lattice.resize(lattice_points(header.motion));
    good = code_lattice(decoder, reference, bits, header.motion);
  }
  if (good && header.moves_points && !decoder.exhausted()) {
    header.moves.resize(reference.codes(bits).size());
    good = code_moves(decoder, header.moves);
  }
  if (!good)
    return decoder.exhausted() ? decoder.finish("frame_vectors")
                               : decoder.here(Errc::kOutOfRange, "frame_vectors");
  return decoder.finish("frame_vectors");
}

std::vector<std::uint8_t> write_vectors(const ReferenceCells& reference, int bits,
                                        FrameHeader& header) {
  RangeEncoder encoder;
  if (header.has_lattice()) code_lattice(encoder, reference, bits, header.motion);
  if (header.moves_points) code_moves(encoder, header.moves);
  return encoder.finish();
}

}  // namespace slf
