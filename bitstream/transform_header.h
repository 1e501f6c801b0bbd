// SPDX-License-Identifier: Apache-2.0
// The header of a transform unit, visited to parse and to write. Spec 7.11.
#pragma once

#include <array>
#include <cstdint>

#include "bitstream/syntax.h"

namespace slf {

/// Spec 7.11: what stands before the matrix of a transform across planes.
struct TransformHeader {
  std::uint32_t tr_first_group = 0, tr_num_groups_minus1 = 0;
  std::uint32_t tr_joint_flag = 0;
  std::uint32_t tr_rank_minus1 = 0;
  std::uint32_t tr_colour_flag = 0;
  std::array<std::array<std::int32_t, 3>, 3> tr_colour{{{512, 0, 0}, {0, 512, 0}, {0, 0, 512}}};
};

// Spec 7.11  transform_unit( ). The caller knows the functions of the groups.
template <class V, class Header>
void transform_header(V& v, Header& h, std::uint32_t num_groups) {
  v.ue("tr_first_group", h.tr_first_group, Range{0, std::int64_t{num_groups} - 1});
  v.ue("tr_num_groups_minus1", h.tr_num_groups_minus1,
       Range{0, std::int64_t{num_groups} - 1 - h.tr_first_group});
  v.u(1, "tr_joint_flag", h.tr_joint_flag, Range{0, 1});
  v.ue("tr_rank_minus1", h.tr_rank_minus1, Range{0, 4095});
  if (h.tr_joint_flag) return;
  v.u(1, "tr_colour_flag", h.tr_colour_flag, Range{0, 1});
  if (!h.tr_colour_flag) return;
  for (auto& row : h.tr_colour)
    for (auto& entry : row) v.se("tr_colour", entry, Range{-512, 512});
}

}  // namespace slf
