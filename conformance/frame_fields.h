// SPDX-License-Identifier: Apache-2.0
// Small light fields that move, and motions that foretell them.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "conformance/cases.h"
#include "conformance/edit_frames.h"

namespace slf::conformance {

inline constexpr int kFrameBits = 5;

/// A field of some points in the middle, moved; colours go with them.
LightField frame_field(const std::function<Voxel(const Voxel&)>& to, int functions = 2);
LightField still(int functions = 2);

Voxel turned(const Voxel& v);
Motion turn();
Voxel bent(const Voxel& v);
/// A lattice whose vectors are of quarters of a voxel.
Motion lattice_motion(int log2, const std::array<std::int32_t, 3>& first,
                      const std::array<std::int32_t, 3>& size);

/// Function 0, and the others.
CodingParameters frame_parameters(int functions);
Case frame_case(const char* id, const char* purpose, const FrameWriter& writer,
                std::vector<std::string> clauses = {"7.13", "8.12.3", "8.12.4"});

}  // namespace slf::conformance
