// SPDX-License-Identifier: Apache-2.0
// The light field as data: what every part of the library hands to the next.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "slf/plane_transform.h"

namespace slf {

using Voxel = std::array<std::int32_t, 3>;  ///< x, y, z; 0 .. 2^bits - 1
using Vec3 = std::array<double, 3>;         ///< world units

/// The cubic grid. world = origin + step * voxel, the centre of the voxel's cell.
struct Grid {
  Vec3 origin{0, 0, 0};  ///< world position of voxel (0, 0, 0); finite
  double step = 1;       ///< world units; finite, > 0
  int bits = 1;          ///< 1 .. 21 per axis; also the depth of the octree

  /// Are coordinates, steps and what is made of their squares finite floats, above 0? A stream may
  /// say any finite doubles (spec 6.2). Renderers draw nothing of other grids, exports refuse them.
  /// The encoder makes none.
  bool fits_floats() const {
    constexpr double kGridLeast = 1e-12;
    bool fits = step >= kGridLeast && step * (1 << bits) <= kMostCoordinate;
    for (const double x : origin) fits = fits && x >= -kMostCoordinate && x <= kMostCoordinate;
    return fits;
  }
  static constexpr double kMostCoordinate = 1e12;  ///< world units from 0

  Vec3 world(const Voxel& v) const {
    return {origin[0] + step * v[0], origin[1] + step * v[1], origin[2] + step * v[2]};
  }
};

/// Coded basis identifiers. Spec 6.3.
enum class BasisId : std::uint8_t { kBspline = 0, kHarmonics = 1 };

/// The functions of direction a view map is a sum of. For kBspline the paper's periodic B-spline
/// wavelets, as its equations give them (not normalised): function k = i1 * 2^s0 + i0 is
/// w_i0(theta / 2 pi) * w_i1(gamma / 2).  Source: paper Eq. 4-6 with the readings of spec 6.3.
/// For kHarmonics real spherical harmonics of mean square 1: function l * l + l + m is Y_lm.
struct Basis {
  BasisId id = BasisId::kBspline;
  int order = 2;         ///< kBspline: o, 1 .. 4: constant, linear, quadratic, cubic
  int scales_theta = 4;  ///< kBspline: s0, 0 .. 6; 2^s0 functions of azimuth
  int scales_gamma = 3;  ///< kBspline: s1, 0 .. 6; 2^s1 functions of gamma = sin(elevation)
  int degree = 0;        ///< kHarmonics: L, 0 .. 10

  int num_functions() const {
    return id == BasisId::kHarmonics ? (degree + 1) * (degree + 1)
                                     : 1 << (scales_theta + scales_gamma);
  }
  bool operator==(const Basis&) const = default;
};

/// What the functions of direction take. Spec 6.4.
enum class Directions : std::uint8_t {
  kWorld = 0,      ///< directions of the world
  kReflected = 1,  ///< mirrored at the surface (6.6), which keeps a highlight in place along it
};

/// How the three coded channels give red, green and blue. Spec 6.5.
enum class ColourTransform : std::uint8_t {
  kNone = 0,      ///< R, G, B
  kOpponent = 1,  ///< orthonormal: (R+G+B)/sqrt 3, (R-B)/sqrt 2, (R-2G+B)/sqrt 6
};

/// What a colour value stands for. 8-bit full scale is 255 in both.
enum class Transfer : std::uint8_t {
  kDisplay = 0,  ///< display values as stored in photographs (sRGB-like)
  kLinear = 1,   ///< linear light, 255 = display white; a renderer applies the sRGB curve
};

/// The world axis that points up. So that no file is ever upside down.
enum class UpAxis : std::uint8_t { kPlusX, kMinusX, kPlusY, kMinusY, kPlusZ, kMinusZ, kUnknown };

/// Where the slices of a scene start from. Spec 7.3.
enum class SliceStart : std::uint8_t {
  kShared = 0,  ///< what slice 0 has learnt: smallest; slice 0 is decoded with any other
  kBase = 1,    ///< the base alone
  kApart = 2,   ///< nothing: a slice is coded knowing its own points alone, and added to the base
};

/// What values of a point mean that are no view map. Spec 6.8.
enum class AttributeId : std::uint8_t {
  kNone = 0,     ///< nothing that this library knows
  kOpacity = 1,  ///< one function: a logit
  kShape = 2,    ///< two functions: the logarithm of a Gaussian's deviations and axes
};

/// Some of the last functions of a light field.
struct Attribute {
  AttributeId id = AttributeId::kNone;
  int num_functions = 1;
  bool operator==(const Attribute&) const = default;
};

/// Everything about a light field but its points. Coded in the sequence unit.
struct LightFieldHeader {
  Grid grid;
  int levels_left_out = 0;  ///< of the file's octree, below those of the grid
  Basis basis;
  Directions directions = Directions::kWorld;
  int normal_cell_log2 = 0;  ///< kReflected: normals are of cells of 2^n voxels, 0 .. bits - 1
  ColourTransform colour = ColourTransform::kNone;
  Transfer transfer = Transfer::kDisplay;
  UpAxis up = UpAxis::kPlusZ;
  bool right_handed = true;
  double metres_per_unit = 0;  ///< 0: not known
  /// Directions of the input cameras span these gammas; a renderer clamps gamma to them, so that a
  /// direction no camera saw repeats the nearest one that a camera saw. In 1/127, -127 .. 127.
  int gamma_min_q7 = -127;
  int gamma_max_q7 = 127;
  /// K: basis.num_functions() and those of attributes, or any K for planes without a meaning
  int num_functions = 0;
  std::vector<Attribute> attributes;  ///< of the last functions, in their order
  bool has_basis = true;   ///< false: integer planes without a meaning (slf pack); K may be 0
  std::vector<int> shift;  ///< [K] plane = round(coefficient * 2^shift), 0 .. 15
  /// [R] index of the function whose place component r takes, ascending; empty: all K, r = k.
  /// Unless a transform covers it, component r is the weight of that function.
  std::vector<std::uint16_t> coded;
  std::vector<PlaneTransform> transforms;  ///< what the other components are; spec 8.7.5

  /// Functions of direction, before those of attributes.
  int num_view_functions() const {
    int count = num_functions;
    for (const Attribute& attribute : attributes) count -= attribute.num_functions;
    return count;
  }
  /// R
  int num_components() const {
    return coded.empty() ? num_functions : static_cast<int>(coded.size());
  }
};

/// Normals as coded: octahedral map, two components of `bits` bits each.
struct CodedNormals {
  int bits = 0;                                          ///< 0: not coded; else 4 .. 12
  std::vector<std::array<std::uint16_t, 2>> octahedral;  ///< [P][2]
};

/// The integer conformance point: what a decoder returns, bit exact everywhere.
struct LightField {
  LightFieldHeader header;
  std::vector<Voxel> positions;          ///< [P], Morton order (x least significant), no duplicates
  std::vector<std::int32_t> components;  ///< [P][R][3], row-major; R = header.num_components()
  CodedNormals normals;
  bool partial = false;  ///< units were missing or left out; absent coefficients count as zero

  std::size_t num_points() const { return positions.size(); }
  int num_planes() const { return 3 * header.num_components(); }
};

/// Key-value pairs carried in the metadata unit: source, encoder settings, suggested cameras.
using Metadata = std::vector<std::pair<std::string, std::string>>;

/// Called from time to time, always from the thread that called the long function.
/// stage: literal, e.g. "fit"; fraction: 0 .. 1 of that stage. An exception ends the function, and
/// is thrown by it.
using Progress = std::function<void(const char* stage, double fraction)>;

}  // namespace slf
