// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/derive_transforms.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "attributes/encoder/raht_forward.h"
#include "base/signed_index.h"
#include "bitstream/checked_syntax.h"
#include "bitstream/transform_header.h"
#include "codec/encoder/forward_columns.h"
#include "codec/transform_units.h"
#include "entropy/range_encoder.h"

namespace slf {
namespace {

using Samples = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Square = Eigen::MatrixXd;
using Square3 = Eigen::Matrix3d;

constexpr double kMostWork = 4294967296.0;  // samples n^2
/// Squared steps of distortion that a bit of a value is worth, and bits of a value of one step.
constexpr double kSquaredStepsPerBit = 0.1, kBitsOfValue = 5;
/// The same for a bit of the matrix. Lower: what falls outside its span is lost at every quality,
/// and by measurement dropping components earlier than at this saves less than a larger step does;
/// keeping more costs decoders time and memory, and no quality that a smaller step would not give.
constexpr double kSquaredStepsPerMatrixBit = 0.05;
/// Share of the error of rounding that may be lost to make columns whole functions.
constexpr double kLittle = 0.125;
/// Quantised to zero below this many steps, about.
constexpr double kZeroBelow = 0.6;

/// What one transform is derived from, in units of the step.
struct Statistics {
  Samples samples;     // [vectors][n] of coefficients, by norm
  double scale = 1;    // vectors there are for every one sampled
  double largest = 0;  // root of the greatest energy of a slice: no component is above it
};

/// Rate and distortion of values of `size` steps, in squared steps.
double cost(double size) {
  if (size < kZeroBelow) return size * size;
  return 0.08 + kSquaredStepsPerBit * (kBitsOfValue + 2 * std::log2(size / kZeroBelow));
}

class Derivation {
 public:
  Derivation(const TransformInput& input, const std::vector<double>& weights,
             const std::vector<std::uint32_t>& steps, int threads)
      : input_(input), weights_(weights), steps_(steps), threads_(threads) {}

  /// Nothing in `transform.matrix` where it does not pay.
  ForwardTransform derive(PlaneTransform shape) {
    ForwardTransform forward;
    forward.inverse = std::move(shape);
    PlaneTransform& t = forward.inverse;
    t.rank = t.functions.size();
    step_ = steps_[std::size_t{3} * t.functions[0]];
    forward.weights = weights_of_rows(t, weights_);
    Statistics s = collect(t, forward.weights);
    if (!(s.largest * step_ < double{1 << 25}) || s.samples.rows() == 0) return forward;
    if (t.lanes == 3) choose_colour(t, s.samples);
    choose_columns(forward, s);
    if (t.matrix.empty()) return forward;
    return forward_transform(std::move(t), std::move(forward.precision), weights_);
  }

 private:
  /// Coefficients of the transform's planes of every slice.
  Statistics collect(const PlaneTransform& t, const std::vector<double>& weights) const {
    Statistics s;
    const std::size_t planes = 3 * t.functions.size(), all = steps_.size(), n = t.rows();
    const double vectors = static_cast<double>(input_.morton.size() * t.lanes);
    const auto stride = static_cast<std::size_t>(
        std::max(1.0, std::ceil(vectors * static_cast<double>(n * n) / kMostWork)));
    s.scale = static_cast<double>(stride) * input_.scale;
    s.samples.resize(index(sampled_points(stride) * t.lanes), index(n));
    float* to = s.samples.data();
    std::vector<double> of_plane(planes), roots(n);
    for (std::size_t j = 0; j < planes; ++j) of_plane[j] = weights[j * n / planes];
    for (std::size_t i = 0; i < n; ++i) roots[i] = std::sqrt(weights[i]);
    for (const SliceCut& cut : input_.cuts) {
      const std::size_t points = cut.end - cut.begin;
      std::vector<std::int32_t> values(points * planes);
      for (std::size_t p = 0; p < points; ++p)
        for (std::size_t j = 0; j < planes; ++j)
          values[p * planes + j] =
              input_.components[(cut.begin + p) * all + 3u * t.functions[j / 3] + j % 3];
      const RahtTree tree = build_raht_tree(input_.morton.subspan(cut.begin, points));
      raht_forward(tree, static_cast<int>(planes), values, threads_);
      double energy = 0;
      for (std::size_t p = 0; p < points; ++p)
        for (std::size_t j = 0; j < planes; ++j) {
          const double v = values[p * planes + j] / step_;
          energy += of_plane[j] * v * v;
        }
      s.largest = std::max(s.largest, std::sqrt(energy));
      // Row 0, the mean, is one of them: it must not fall outside a span of lower rank. It counts
      // once, the others for those between them.
      for (std::size_t p = 0; p < points; p += p == 0 ? 1 : stride)
        for (std::size_t lane = 0; lane < t.lanes; ++lane)
          for (std::size_t i = 0; i < n; ++i)
            *to++ =
                static_cast<float>(values[p * planes + i * t.lanes + lane] *
                                   (p == 0 ? std::sqrt(weights[i] / s.scale) : roots[i]) / step_);
    }
    return s;
  }

  /// The first point of each slice, and every stride-th of the others.
  std::size_t sampled_points(std::size_t stride) const {
    std::size_t sampled = 0;
    for (const SliceCut& cut : input_.cuts)
      if (const std::size_t points = cut.end - cut.begin; points > 0)
        sampled += 1 + (points - 1 + stride - 1) / stride;
    return sampled;
  }

  /// Channels that are not correlated, where they cost less than those given; in place.
  static void choose_colour(PlaneTransform& t, Samples& samples) {
    Square3 covariance = Square3::Zero();
    const Eigen::Index rows = samples.rows() / 3, n = samples.cols();
    for (Eigen::Index r = 0; r < rows; ++r) {
      const Eigen::Matrix<double, 3, Eigen::Dynamic> v =
          samples.middleRows(3 * r, 3).cast<double>();
      covariance += v * v.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Square3> solver(covariance);
    Square3 coded;
    for (int i = 0; i < 3; ++i)
      for (int d = 0; d < 3; ++d) {
        const double v = solver.eigenvectors()(i, 2 - d);  // largest first
        coded(i, d) = std::round(v * (1 << PlaneTransform::kColourBits));
      }
    const Square3 matrix = coded / double{1 << PlaneTransform::kColourBits};
    const Square3 inverse = matrix.inverse();
    double before = 0, after = 0;
    // Mixed twice, and not kept beside those given: they are most of what an encoder holds.
    for (Eigen::Index r = 0; r < rows; ++r) {
      const Eigen::Matrix<float, 3, Eigen::Dynamic> v = samples.middleRows(3 * r, 3);
      const Eigen::Matrix<float, 3, Eigen::Dynamic> m = inverse.cast<float>() * v;
      for (Eigen::Index i = 0; i < 3; ++i)
        for (Eigen::Index k = 0; k < n; ++k) {
          before += cost(std::abs(double{v(i, k)}));
          after += cost(std::abs(double{m(i, k)}));
        }
    }
    if (after >= before) return;
    for (Eigen::Index r = 0; r < rows; ++r) {
      const Eigen::Matrix<float, 3, Eigen::Dynamic> v = samples.middleRows(3 * r, 3);
      const Eigen::Matrix<float, 3, Eigen::Dynamic> m = inverse.cast<float>() * v;
      samples.middleRows(3 * r, 3) = m;
    }
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t d = 0; d < 3; ++d)
        t.colour[i][d] = static_cast<std::int32_t>(coded(static_cast<int>(i), static_cast<int>(d)));
  }

  /// Eigenvectors that save more than their columns cost, rounded as finely as their energy asks.
  void choose_columns(ForwardTransform& forward, const Statistics& s) const {
    PlaneTransform& t = forward.inverse;
    const std::size_t n = t.rows(), per_function = 3 / t.lanes;
    Square covariance = Square::Zero(index(n), index(n));
    constexpr Eigen::Index kBlock = 512;
    for (Eigen::Index r = 0; r < s.samples.rows(); r += kBlock) {
      const auto block = s.samples.middleRows(r, std::min(kBlock, s.samples.rows() - r));
      covariance += (block.transpose() * block).cast<double>();
    }
    const Eigen::SelfAdjointEigenSolver<Square> solver(covariance);
    const Square vectors = solver.eigenvectors().rowwise().reverse();
    const std::vector<double> saved = savings(s, vectors);
    const double root = std::sqrt(static_cast<double>(n));
    double reach = 0;  // of the rounding of an entry of the matrix, against one of the eigenvector
    for (const double w : forward.weights) reach += w / static_cast<double>(n);
    reach = std::sqrt(reach);
    std::vector<std::size_t> kept;
    for (std::size_t c = 0; c < n; ++c) {
      const double energy = std::max(s.scale * solver.eigenvalues()(index(n - 1 - c)), 1e-9);
      // The rounding of a column costs about a squared step over all rows, or an eighth of what is
      // in it, whichever is finer.
      const int finest = static_cast<int>(std::ceil(std::log2(reach * std::sqrt(energy)))) - 1;
      const int least = static_cast<int>(std::ceil(std::log2(reach * root))) + 1;
      const int bits = std::clamp(std::max(finest, least), 0, PlaneTransform::kFractionBits);
      const double column = static_cast<double>(n) *
                            std::max(1.0, std::log2(4.1 / root * std::ldexp(1 / reach, bits)));
      if (n > 3 && saved[c] < column) continue;
      kept.push_back(c);
      forward.precision.push_back(
          static_cast<std::uint8_t>(n > 3 ? bits : std::min(bits, PlaneTransform::kColourBits)));
    }
    make_whole(s, solver.eigenvalues(), per_function, kept);
    if (kept.empty()) return;
    t.rank = (kept.size() + per_function - 1) / per_function;
    forward.precision.resize(t.columns(), 0);
    t.matrix.assign(n * t.columns(), 0);
    for (std::size_t c = 0; c < kept.size(); ++c)
      for (std::size_t i = 0; i < n; ++i) {
        const int bits = forward.precision[c];
        const double entry = vectors(index(i), index(kept[c])) / std::sqrt(forward.weights[i]);
        const double limit = std::ldexp(64, bits);
        const auto m = static_cast<std::int32_t>(
            std::lround(std::clamp(std::ldexp(entry, bits), -limit, limit)));
        t.matrix[c * n + i] = m * (1 << (PlaneTransform::kFractionBits - bits));
      }
  }

  /// Columns make whole functions. Those that are over are dropped where that costs little against
  /// rounding, or where there are no others (then the planes are coded as they are). Else they
  /// stay, and columns of zeros stand beside them.
  static void make_whole(const Statistics& s, const Eigen::VectorXd& eigenvalues,
                         std::size_t per_function, std::vector<std::size_t>& kept) {
    const std::size_t over = kept.size() % per_function,
                      n = static_cast<std::size_t>(s.samples.cols());
    double lost = 0;
    for (std::size_t i = kept.size() - over; i < kept.size(); ++i)
      lost += eigenvalues(index(n - 1 - kept[i]));
    const double rounding = static_cast<double>(s.samples.size()) / 12;
    if (lost <= kLittle * rounding || kept.size() == over) kept.resize(kept.size() - over);
  }

  /// Bits that each component is worth: its energy, less what is left of it when it is coded.
  static std::vector<double> savings(const Statistics& s, const Square& vectors) {
    std::vector<double> saved(static_cast<std::size_t>(vectors.cols()), 0);
    const Samples basis = vectors.cast<float>();
    constexpr Eigen::Index kBlock = 512;
    for (Eigen::Index r = 0; r < s.samples.rows(); r += kBlock) {
      const Samples block = s.samples.middleRows(r, std::min(kBlock, s.samples.rows() - r)) * basis;
      for (Eigen::Index i = 0; i < block.rows(); ++i)
        for (Eigen::Index c = 0; c < block.cols(); ++c) {
          const double size = std::abs(double{block(i, c)});
          if (size >= kZeroBelow)
            saved[static_cast<std::size_t>(c)] +=
                s.scale * (size * size - cost(size)) / kSquaredStepsPerMatrixBit;
        }
    }
    return saved;
  }

  const TransformInput& input_;
  const std::vector<double>& weights_;
  const std::vector<std::uint32_t>& steps_;
  int threads_;
  double step_ = 1;
};

}  // namespace

std::vector<ForwardTransform> derive_transforms(const TransformInput& input,
                                                const PlaneGroups& groups, std::size_t first,
                                                const std::vector<double>& weights,
                                                const std::vector<std::uint32_t>& steps,
                                                TransformMode mode, int threads) {
  std::vector<ForwardTransform> transforms;
  Derivation derivation(input, weights, steps, threads);
  for (std::size_t group = first; group < std::min(groups.size(), first + 2); ++group) {
    PlaneTransform shape;
    shape.first_group = group;
    shape.num_groups = group == first ? 1 : groups.size() - group;
    shape.functions = functions_of_groups(groups, group, shape.num_groups);
    shape.lanes = mode == TransformMode::kJoint ? 1 : 3;
    ForwardTransform forward = derivation.derive(std::move(shape));
    const bool nothing =
        forward.inverse.rows() == 1 && forward.inverse.colour == PlaneTransform::kNoColour;
    if (!nothing && !forward.inverse.matrix.empty()) transforms.push_back(std::move(forward));
  }
  return transforms;
}

Result<std::vector<std::uint8_t>, InputError> write_transform(const ForwardTransform& transform,
                                                              std::uint32_t num_groups) {
  const PlaneTransform& t = transform.inverse;
  TransformHeader header;
  header.tr_first_group = static_cast<std::uint32_t>(t.first_group);
  header.tr_num_groups_minus1 = static_cast<std::uint32_t>(t.num_groups - 1);
  header.tr_joint_flag = t.lanes == 1;
  header.tr_rank_minus1 = static_cast<std::uint32_t>(t.rank - 1);
  header.tr_colour_flag = t.colour != PlaneTransform::kNoColour;
  header.tr_colour = t.colour;
  return checked_header([&](auto& v) { transform_header(v, std::as_const(header), num_groups); });
}

std::vector<std::uint8_t> write_columns(const ForwardTransform& transform, ColumnRange columns) {
  PlaneTransform t = transform.inverse;
  RangeEncoder encoder;
  code_columns(encoder, t, columns, transform.precision);
  return encoder.finish();
}

}  // namespace slf
