// SPDX-License-Identifier: Apache-2.0
#include "attributes/reference_means.h"

#include <algorithm>

#include "base/multiversion.h"
#include "geometry/morton.h"
#include "geometry/reference_walk.h"

namespace slf {
namespace {

constexpr std::size_t kMostTerms = 8;   // of a node
constexpr std::size_t kAtATime = 1024;  // nodes that room is made for

/// n / d, rounded down, for n at most 2^21 and d = 1 .. 512: the error of the factor, below d,
/// times n stays below 2^32.
constexpr auto kReciprocals = [] {
  std::array<std::uint32_t, 513> table{};
  for (std::uint64_t d = 2; d < table.size(); ++d)
    table[d] = static_cast<std::uint32_t>(((std::uint64_t{1} << 32) + d - 1) / d);
  return table;
}();
std::uint32_t divided(std::uint32_t n, std::uint32_t d) {
  return d == 1 ? n : static_cast<std::uint32_t>(std::uint64_t{n} * kReciprocals[d] >> 32);
}

/// Weights of 512 to those of 4096, the last what is left of it.
/// @return behind the last
ReferenceTerm* share(const std::array<std::uint32_t, kMostTerms>& node,
                     const std::array<std::uint32_t, kMostTerms>& weight, std::size_t count,
                     std::uint32_t sum, ReferenceTerm* to) {
  if (count == 0) return to;
  std::uint32_t left = 4096;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    const std::uint32_t part = divided(4096 * weight[i], sum);
    *to++ = {node[i], static_cast<std::int32_t>(part)};
    left -= part;
  }
  *to++ = {node[count - 1], static_cast<std::int32_t>(left)};
  return to;
}

/// The up to eight nodes around a place, of those that are there.
/// @param at_q3  place in eighths of a node from the centre of node 0 on
ReferenceTerm* terms_around(ReferenceWalk& walk, const std::array<std::int32_t, 3>& at_q3,
                            ReferenceTerm* to) {
  Voxel lower{};
  std::array<std::array<std::uint32_t, 2>, 3> part{};
  unsigned next_brick = 0;  // bit i: the upper cells along axis i, if any count, are in the next
  for (std::size_t i = 0; i < 3; ++i) {
    const auto in = static_cast<std::uint32_t>(at_q3[i] & 7);
    lower[i] = at_q3[i] >> 3;
    part[i] = {8 - in, in};
    next_brick |= static_cast<unsigned>(in != 0 && (lower[i] & 3) == 3) << i;
  }
  std::array<const ReferenceBrick*, 8> brick{};  // by the bits of next_brick
  for (unsigned b = next_brick;; b = (b - 1) & next_brick) {
    brick[b] = &walk.brick({(lower[0] >> 2) + static_cast<std::int32_t>(b & 1),
                            (lower[1] >> 2) + static_cast<std::int32_t>(b >> 1 & 1),
                            (lower[2] >> 2) + static_cast<std::int32_t>(b >> 2)});
    if (b == 0) break;
  }
  std::array<std::uint32_t, kMostTerms> node{}, weight{};
  std::size_t count = 0;
  std::uint32_t sum = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const unsigned x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const std::uint32_t w = part[0][x] * part[1][y] * part[2][z];
    const ReferenceBrick& there = *brick[corner & next_brick];
    const unsigned bit = ReferenceWalk::bit_of({lower[0] + static_cast<std::int32_t>(x),
                                                lower[1] + static_cast<std::int32_t>(y),
                                                lower[2] + static_cast<std::int32_t>(z)});
    const std::uint32_t counts = static_cast<std::uint32_t>(there.morton >> bit & 1) & (w != 0);
    node[count] = ReferenceWalk::place_in(there, bit);  // no branch: it is hard to foresee
    weight[count] = w;
    sum += w * counts;
    count += counts;
  }
  return share(node, weight, count, sum, to);
}

/// to: room for kMostTerms of every node. first: behind the terms of each, counted from `to`
SLF_MULTIVERSION_ALL
ReferenceTerm* find_terms(const MovedReference& reference, ReferenceWalk& walk,
                          std::span<const std::uint64_t> codes, int level, ReferenceTerm* to,
                          std::uint32_t* first) {
  const int side_log2 = reference.bits - level + 4;  // of a node, in sixteenths of a voxel
  const ReferenceTerm* const begin = to;
  for (const std::uint64_t code : codes) {
    const Voxel node = from_morton(code);
    const Displacement moved = reference.at(node, level);
    std::array<std::int32_t, 3> at_q3;
    for (std::size_t i = 0; i < 3; ++i)
      at_q3[i] = 8 * node[i] + ((moved[i] + (1 << (side_log2 - 4))) >> (side_log2 - 3));
    to = terms_around(walk, at_q3, to);
    *first++ = static_cast<std::uint32_t>(to - begin);
  }
  return to;
}

}  // namespace

ReferenceTerms find_reference_terms(const MovedReference& reference,
                                    std::span<const std::uint64_t> codes, int level) {
  ReferenceWalk walk(reference.cells.level(level));
  std::vector<ReferenceTerm> some(kMostTerms * std::min(kAtATime, codes.size()));
  ReferenceTerms found;
  found.first.resize(codes.size() + 1);
  for (std::size_t begin = 0; begin < codes.size(); begin += kAtATime) {
    const std::size_t count = std::min(kAtATime, codes.size() - begin);
    const auto before = static_cast<std::uint32_t>(found.terms.size());
    std::uint32_t* const first = &found.first[begin + 1];
    ReferenceTerm* const end =
        find_terms(reference, walk, codes.subspan(begin, count), level, some.data(), first);
    for (std::size_t i = 0; i < count; ++i) first[i] += before;
    found.terms.insert(found.terms.end(), some.data(), end);
  }
  return found;
}

}  // namespace slf
