// SPDX-License-Identifier: Apache-2.0
// Gaussian splats: a light field as the discs with harmonics that other programs draw. Lossy, one
// way; docs/export.md says what is lost.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "slf/error.h"
#include "slf/view_map.h"

namespace slf {

/// Which way is up in the file. Axes are right-handed, whatever the light field's are.
enum class SplatAxes : std::uint8_t {
  kWorld,  ///< the light field's own, mirrored in x where they are left-handed
  kYUp,    ///< x right, y up, z back: glTF, SPZ
  kYDown,  ///< x right, y down, z forward: what 3-D Gaussian splatting writes as PLY
};

struct SplatSettings {
  int degree = 3;  ///< of the harmonics, 0 .. 3
  SplatAxes axes = SplatAxes::kYUp;
  /// Standard deviation of a disc, in distances between neighbouring points, 0.1 .. 4. Larger: no
  /// holes. Smaller: sharper.
  double size = 0.55;
  int threads = 0;
};

/// One splat per point, in point order: a Gaussian in the plane of the point's normal, a tenth as
/// thick. Opacity is kSplatOpacity of all.
struct SplatCloud {
  Vec3 origin{0, 0, 0};  ///< world; positions are from it. Not 0 where floats would lose digits
  /// Rows: axes of the file in world axes. Orthonormal; determinant -1 for a left-handed world.
  std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  double step = 1;  ///< of the grid, world units
  int degree = 3;
  std::vector<std::array<float, 3>> positions;  ///< [P] axes of the file
  std::vector<std::array<float, 3>> normals;    ///< [P] unit, towards the side that is seen; 0: not
                                                ///< known
  std::vector<float> deviations;                ///< [P] world units, > 0
  std::vector<float> front;  ///< [P] 0.5 .. 1: share of what is seen that is on the normal's side
  std::vector<float> harmonics;  ///< [P][(degree + 1)^2][3]: see radiance_of

  std::size_t size() const { return positions.size(); }
  std::size_t num_harmonics() const { return std::size_t(degree + 1) * std::size_t(degree + 1); }
};

inline constexpr float kSplatOpacity = 254.0f / 255;  ///< 1 has no logit
inline constexpr float kSplatFlatness = 0.1f;         ///< thickness over deviation

/// Fits the harmonics point by point to the colours that the point has in directions from which its
/// surface is seen (weighted by the cosine to the normal, as pixels are), in display values. Frames
/// that mirror directions, and functions of any kind, are sampled and so need no case.
/// @errors kInvalidInput: no points. kInvalidArgument: a setting out of range.
/// O(P (R + degree^4)) for each of 256 directions. The same for any thread count.
Result<SplatCloud, InputError> make_splats(const ViewMaps& maps, const SplatSettings& settings);

/// R, G, B, 0 .. 255, display values, of splat p seen along a unit vector from the eye to the
/// splat, axes of the file, as 3-D Gaussian splatting has it: 0.5 + sum of coefficient times real
/// harmonic (orthonormal over the sphere, Condon-Shortley), not below 0; and not above 255.
std::array<float, 3> radiance_of(const SplatCloud& splats, std::size_t p, const Vec3& viewing);

enum class SplatFormat : std::uint8_t {
  kPly,   ///< binary PLY as 3-D Gaussian splatting writes it
  kGlb,   ///< glTF 2.0 binary with KHR_gaussian_splatting
  kSpz,   ///< SPZ version 2
  kSpz3,  ///< SPZ version 3, which has ten bits for each component of a turn and not eight
  kSpz4,  ///< SPZ version 4: the same in zstd, and harmonics of degree 4
  kSog,   ///< SOG version 2, bundled: pictures in WebP, harmonics by a palette
};

/// Axes of a file by the convention of its format: y down of PLY and SOG, y up of the others.
SplatAxes axes_of(SplatFormat format);

/// What a reader of the format gets: rounded and clamped where it has fewer bits.
SplatCloud as_stored(SplatCloud splats, SplatFormat format, int threads = 0);

/// The file. The same bytes for the same splats and any thread count.
/// @errors kInvalidInput: SOG, no splats; SPZ and SOG, a coordinate or a deviation beyond what they
/// can
///         hold; glTF and SOG, more than 4 GiB, which is 17.6 million splats of degree 3 of glTF.
///         kUnsupported: SPZ 4 and SOG in builds without zstd and WebP.
Result<std::vector<std::uint8_t>, InputError> splat_file(const SplatCloud& splats,
                                                         SplatFormat format, int threads = 0);

/// Colours of splats against those of the light field, over points and directions that were not
/// fitted to, weighted as the fit is. dB; infinite where nothing differs.
struct SplatLoss {
  double psnr = 0;
  double psnr_one_colour = 0;  ///< of the best colour for each point that is the same everywhere
  std::array<double, 3> channel_psnr{};
};

/// @param splats  made of `maps`
SplatLoss splat_loss(const ViewMaps& maps, const SplatCloud& splats, int threads = 0);

}  // namespace slf
