#include "lightfield/fit_hierarchical.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <utility>

#include "lightfield/block_prior.h"
#include "lightfield/direction_rows.h"
#include "lightfield/environment_fit.h"
#include "lightfield/environment_projection.h"
#include "lightfield/frame.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr double kPenalty = 0.8;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

std::vector<double> penalties(const DirectionRows& rows, double scale, double growth) {
  std::vector<double> penalty;
  for (const int fineness : rows.fineness()) penalty.push_back(scale * std::pow(growth, fineness));
  return penalty;
}

/// The rows of one point, read from the observations.
void read_rows(const Observations& seen, std::size_t point, const DirectionRows& basis,
               PointRows& rows) {
  const auto first = static_cast<std::size_t>(seen.first[point]),
             last = static_cast<std::size_t>(seen.first[point + 1]);
  rows.count = last - first;
  rows.functions.resize(rows.count * basis.size());
  rows.colours.clear();
  for (std::size_t i = first; i < last; ++i) {
    basis.evaluate(seen.direction[i], rows.functions.data() + (i - first) * basis.size());
    rows.colours.insert(rows.colours.end(), seen.colour[i].begin(), seen.colour[i].end());
  }
}

/// What the environment tells of the points.
class EnvironmentPrior {
 public:
  EnvironmentPrior(const Observations& seen, std::span<const Voxel> positions,
                   const DirectionRows& basis, const FitSettings& settings)
      : positions_(positions), box_(positions), frame_(settings.frame) {
    if (settings.environment.degree == 0) return;
    normals_ = frame_normals(FrameId::kReflected, positions, settings.threads);
    light_ = fit_environment(seen, positions, normals_, settings);
    if (!light_) return;
    auto outward = normals_;
    for (std::size_t p = 0; p < outward.size(); ++p) {
      double towards_cameras = 0;  // the cosine of the reflected direction is that of the view
      for (auto j = seen.first[p]; j < seen.first[p + 1]; ++j) {
        const Vec3 v = vector_of(seen.direction[j]);
        for (std::size_t a = 0; a < 3; ++a) towards_cameras += v[a] * double(outward[p][a]);
      }
      if (towards_cameras < 0)
        for (float& x : outward[p]) x = -x;
    }
    projected_ = project_environment(*light_, positions, outward, frame_, basis, settings.threads);
  }

  /// What is left of the colours of point p.
  void subtract(const Observations& seen, std::size_t p, PointRows& rows) const {
    if (!light_) return;
    const Vec3 at = box_(positions_[p]);
    for (std::size_t i = 0; i < rows.count; ++i) {
      const auto& d = seen.direction[static_cast<std::size_t>(seen.first[p]) + i];
      const auto light =
          (*light_)(at, vector_of(frame_ == FrameId::kReflected ? d : to_frame(normals_, p, d)));
      for (std::size_t c = 0; c < 3; ++c) rows.colours[3 * i + c] -= light[c];
    }
  }

  /// [P][K][3] its part of the view maps; zeros where there is none.
  std::vector<float> take_projected(std::size_t size) {
    if (!light_) projected_.assign(size, 0.0f);
    return std::move(projected_);
  }

 private:
  std::span<const Voxel> positions_;
  ObjectBox box_;
  FrameId frame_;
  std::vector<std::array<float, 3>> normals_;
  std::optional<Environment> light_;
  std::vector<float> projected_;
};

/// min |c - G a|^2 + sum_k penalty_k (a_k - m_k)^2, a_0 free: in the dual form, M x M.
/// @param coefficients  [K][3] m before, a after
void solve_point(const PointRows& rows, std::span<const float> inverse_penalty,
                 float* coefficients) {
  const std::size_t k = inverse_penalty.size();
  const Eigen::Map<const Matrix> g(rows.functions.data(), index(rows.count), index(k));
  const Eigen::Map<const Columns> c(rows.colours.data(), index(rows.count), 3);
  const Eigen::Map<const Eigen::VectorXf> inverse(inverse_penalty.data(), index(k));
  Eigen::Map<Columns> a(coefficients, index(k), 3);
  const Matrix scaled = g * inverse.asDiagonal();  // column 0 is zero
  Eigen::MatrixXf s = Eigen::MatrixXf::Identity(index(rows.count), index(rows.count));
  s.noalias() += scaled * g.transpose();
  const Eigen::LLT<Eigen::MatrixXf> factor(s);
  a.row(0).setZero();
  const Eigen::VectorXf w = factor.solve(Eigen::VectorXf::Ones(index(rows.count)));
  Columns residual = c - g * a;
  const Eigen::RowVector3f dc = w.transpose() * residual / w.sum();
  residual.rowwise() -= dc;
  const Eigen::Matrix<float, Eigen::Dynamic, 3> z = factor.solve(residual);
  a.noalias() += scaled.transpose() * z;
  a.row(0) = dc;
}

}  // namespace

std::vector<float> fit_hierarchical(const Observations& observations,
                                    std::span<const Voxel> positions, const FitSettings& settings,
                                    const Progress& progress) {
  const HierarchySettings& h = settings.hierarchy;
  const DirectionRows basis(settings.basis);
  EnvironmentPrior environment(observations, positions, basis, settings);
  BlockPrior prior(positions, h.block_log2, basis.size());
  const auto for_points = [&](double from, double to, const auto& body) {
    parallel_ranges(
        prior.num_blocks(), 1, settings.threads,
        [&](std::size_t begin, std::size_t end) {
          PointRows rows;
          for (std::size_t b = begin; b < end; ++b)
            for (std::size_t p = prior.first_point(b); p < prior.first_point(b + 1); ++p) {
              read_rows(observations, p, basis, rows);
              environment.subtract(observations, p, rows);
              if (rows.count > 0) body(b, p, rows);
            }
        },
        [&](std::size_t done) {
          if (progress)
            progress("fit", from + (to - from) * double(done) / double(prior.num_blocks()));
        });
  };
  for_points(0, 0.5,
             [&](std::size_t b, std::size_t, const PointRows& rows) { prior.add(b, rows); });
  prior.sum_up(settings.threads);
  const auto blocks =
      prior.solve(h.strength, penalties(basis, kPenalty, h.growth), settings.threads);

  std::vector<float> inverse;
  for (const double p : penalties(basis, h.point_penalty, h.point_growth))
    inverse.push_back(static_cast<float>(1 / p));
  inverse[0] = 0;
  const std::size_t size = 3 * basis.size();
  std::vector<float> coefficients = environment.take_projected(positions.size() * size);
  for_points(0.5, 1, [&](std::size_t b, std::size_t p, const PointRows& rows) {
    std::vector<float> rest(blocks.data() + b * size, blocks.data() + (b + 1) * size);
    solve_point(rows, inverse, rest.data());
    float* of_point = coefficients.data() + p * size;
    for (std::size_t i = 0; i < size; ++i)
      of_point[i] = (of_point[i] + rest[i]) / static_cast<float>(basis.norms()[i / 3]);
  });
  return coefficients;
}

}  // namespace slf
