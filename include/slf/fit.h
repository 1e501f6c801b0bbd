// SPDX-License-Identifier: Apache-2.0
// From photographs to view maps: the encoder's floating-point half.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// Paper III-A.
struct ObserveSettings {
  double delta_degrees = 10;  ///< δ, 0 .. 90: a view is valid up to 90° - δ from the normal
  double occlusion_resolution = 1;  ///< depth buffer pixels per image pixel, 0.05 .. 8
  double depth_tolerance =
      2.5;  ///< in spacings of the occluders (over the cosine of the view angle):
            ///< deeper than the buffer by more is hidden. 0: the paper's strict test
  Transfer transfer = Transfer::kDisplay;
  int threads = 0;  ///< 0: all cores
};

/// What the cameras saw of each point, grouped by point, cameras ascending within a point.
/// Deterministic for any thread count.
struct Observations {
  std::vector<std::uint64_t>
      first;  ///< [P + 1]: observations of point p are first[p] .. first[p+1]-1
  std::vector<std::array<float, 2>>
      direction;  ///< (θ in [-π, π], γ = sin φ in [-1, 1]), point -> camera
  std::vector<std::array<float, 3>> colour;  ///< 0 .. 255 (of the chosen transfer)
  std::vector<std::uint16_t> camera;         ///< index into the capture's cameras
  double gamma_min = -1, gamma_max = 1;      ///< over all observations
};

/// The points to observe, from the capture's origin.
struct ObservedPoints {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<float, 3>> normals;
};

/// Projects every point into every given camera; keeps what is inside the image, not masked, inside
/// the cone and not hidden by `occluders`; samples bilinearly (pixel centres at + 0.5, distortion
/// honoured).
/// @param spacing  typical distance between neighbouring occluders, world units
/// @errors those of load_image; kInvalidInput: no camera sees any point (says what was tried).
/// O(cameras * P); images are read one at a time per thread.
Result<Observations, InputError> observe(const Capture& capture, std::span<const int> cameras,
                                         const ObservedPoints& points,
                                         std::span<const std::array<float, 3>> occluders,
                                         double spacing, const ObserveSettings& settings,
                                         const Progress& progress = {});

enum class FitMethod : std::uint8_t {
  kPaper,         ///< paper II, Eq. 2-3 and Algorithm 1: ridge, then smoothing over neighbours
  kHierarchical,  ///< a prior from octree blocks, which share what they reflect
};

/// The hierarchical fit: a point's view map is its mean colour, what the blocks around it and those
/// above have in common, interpolated at the point, and what is left. Functions count with mean
/// square 1; the penalty of one grows with its fineness (the degree of a harmonic, the sum of the
/// scales of a wavelet).
struct HierarchySettings {
  int block_log2 =
      3;  ///< side of the finest blocks in voxels (encode: in spacings of points), 0 .. 21
  double strength = 0.3;      ///< > 0: pull of a block towards the one above, per observation
  double growth = 1.3;        ///< >= 1: of its penalties, 0.8 growth^fineness
  double point_penalty = 12;  ///< > 0: pull of a point towards the blocks around it
  double point_growth = 1.5;  ///< >= 1: of its penalties
};

/// What the object reflects, of the hierarchical fit: light on a sphere about it, one for all
/// points, taken before the blocks take the rest. It tells what cameras between those of the
/// capture see.
struct KnownLight {
  Vec3 centre{};             ///< of the object's box, voxels
  double half = 0;           ///< of its longest side, voxels; 0: the light is not known
  std::vector<float> light;  ///< [(degree + 1)^2][3], element 0 is not used
};

struct EnvironmentSettings {
  int degree = 16;         ///< of the harmonics of the light, 1 .. 16; 0: no environment
  double radius = 0;       ///< of the sphere, 2 or more halves of the object's longest side; 0: the
                           ///< best on held-out input cameras, or none if none is better
  double strength = 0.01;  ///< > 0: pull towards no light, per observation
  KnownLight known = {};   ///< found before, of these degree and radius: of a scene that is fitted
                           ///< in parts
};

/// The fit to pictures, after that to points: coefficients move until the renderer's pictures look
/// like the photographs (encoder/fit/fit_pictures.h). In units of squared grey levels per pixel.
struct PictureFitSettings {
  int rounds = 0;  ///< 0 .. 20, each with the trust that what it starts from gives; 0: none
  int steps = 8;   ///< 1 .. 100 of conjugate gradients, in a round
  double mean_penalty = 1;  ///< > 0: pull of a point's mean colour to where it started
  double penalty = 12;      ///< > 0: of the other functions, times growth^fineness
  double growth = 1.5;      ///< >= 1
  double outlier = 80;      ///< > 0: a pixel so many grey levels off counts a quarter
};

/// What a picture fit did. PSNR of input pictures where points alone make them, dB.
struct PictureFit {
  double psnr_before = 0, psnr_after = 0;
  double pull = 0;  ///< on the penalties; 0: no picture fit, or held-out cameras did not gain by it
  /// Errors at cameras held out from this fit, where its pull was searched: without and with it.
  double held_out_before = 0, held_out_after = 0;
};

struct FitSettings {
  FitMethod method = FitMethod::kPaper;
  Basis basis;  ///< kPaper: B-splines alone
  Directions directions = Directions::kWorld;
  int normal_cell_log2 = 0;     ///< LightFieldHeader; the encoder measures it
  double lambda = 0.8;          ///< kPaper: λ >= 0 (0 is solved as a least-norm problem)
  double beta = 1.3;            ///< kPaper: β >= 0
  int iterations = 3;           ///< kPaper: T, 0 .. 100 Jacobi sweeps
  int neighbours = 8;           ///< k nearest points, 1 .. 64, ties by Morton order, self excluded
  bool penalise_dc = false;     ///< the paper: true. false leaves function 0 out of λ and β
  HierarchySettings hierarchy;  ///< kHierarchical
  EnvironmentSettings environment;  ///< kHierarchical
  PictureFitSettings pictures;      ///< either
  int threads = 0;

  /// Harmonics of degree 10 along reflected directions: the default preset's.
  static FitSettings hierarchical() {
    FitSettings settings;
    settings.method = FitMethod::kHierarchical;
    settings.basis = {BasisId::kHarmonics, 2, 0, 0, 10};
    settings.directions = Directions::kReflected;
    settings.pictures.rounds = 2;
    return settings;
  }
};

/// Fits a view map to every point, to what the cameras saw of it. The fit to pictures is a step of
/// its own, of encode().
/// @param positions  [P] voxels in Morton order
/// @return [P][K][3] float, K = basis.num_functions(); RGB in the units of the observations.
///         Points without observations take the mean of their neighbours that have some (and, where
///         those have none either, of the nearest that has).
/// The same for any thread count of one binary. kPaper: each point is factorised once for λ and
/// once for λ + β, which all sweeps share, in the M x M dual form where it has fewer observations
/// than functions. kHierarchical: O(observations K^2) for the blocks' normal equations, O(K^3) a
/// block, O(M^3 + M^2 K) a point; memory 4 K^2 bytes a block.
Result<std::vector<float>, InputError> fit_view_maps(const Observations& observations,
                                                     std::span<const Voxel> positions,
                                                     const FitSettings& settings,
                                                     const Progress& progress = {});

/// What cross-validation may change of the hierarchical fit: held-out clusters of input cameras are
/// predicted from the others, on some of the points, one setting after the other in this order. A
/// change stays if it lowers the squared error by more than 0.5 %, of directions or basis by more
/// than 15 %, or 3 % where every cluster gains: other directions may take twice the bytes.
struct FitSearch {
  bool strength = true;        ///< hierarchy.strength of 0.1, 0.3, 1
  bool growth = true;          ///< hierarchy.growth of 1.15, 1.3, 1.5
  bool point_penalty = true;   ///< hierarchy.point_penalty, or five times as much
  bool directions = true;      ///< reflected or of the world
  bool basis = false;          ///< harmonics, or as many B-splines, to a power of two
  std::size_t points = 12000;  ///< > 0: of the sample, whole blocks
  /// The fit to pictures: its penalties, eight times as much, or none, by the pictures of cameras
  /// that are held out from it
  bool pictures = true;

  /// Something for choose_fit to do; pictures are not its.
  bool any() const { return directions || basis || strength || growth || point_penalty; }
  static FitSearch none() {
    return {.strength = false,
            .growth = false,
            .point_penalty = false,
            .directions = false,
            .pictures = false};
  }
};

/// Settings without anything left to choose.
struct ChosenFit {
  enum Outcome : std::uint8_t {
    kNothingToSearch,
    kTooFewCameras,  ///< fewer than 8, or than 3 clusters of them: the settings stay
    kSearched,
  };
  FitSettings settings;  ///< environment.radius > 0, or environment.degree = 0
  Outcome outcome = kNothingToSearch;
  double psnr_given = 0, psnr_chosen = 0;  ///< kSearched: on held-out input cameras, dB
};

/// Finds the settings by cross-validation, and the environment's radius where it is 0.
/// @param observations  of world directions, of all points
/// @errors those of fit_view_maps; kInvalidArgument: a search with kPaper
/// The same for any thread count of one binary. As much as fits of search.points, some 40 times;
/// sums of blocks as in fit_view_maps, up to 8 times those of the sample at once.
Result<ChosenFit, InputError> choose_fit(const Observations& observations,
                                         std::span<const Voxel> positions,
                                         const FitSettings& settings, const FitSearch& search,
                                         const Progress& progress = {});

/// The observations with the local directions of each point (spec 6.4), gamma range too.
/// @param cell_log2  LightFieldHeader::normal_cell_log2
Observations in_local(Observations observations, Directions directions,
                      std::span<const Voxel> positions, int cell_log2, int threads);

}  // namespace slf
