#include "fit/fit_hierarchical.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <cmath>
#include <optional>

#include "base/signed_index.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

constexpr double kPenalty = 0.8;

std::vector<double> penalties(const DirectionRows& rows, double scale, double growth) {
  std::vector<double> penalty;
  for (const int fineness : rows.fineness()) penalty.push_back(scale * std::pow(growth, fineness));
  return penalty;
}

/// The rows of one point, read from the observations.
/// @param light  [observations][3] subtracted from the colours, or empty
void read_rows(const Observations& seen, std::span<const float> light, std::size_t point,
               const DirectionRows& basis, PointRows& rows) {
  const auto first = static_cast<std::size_t>(seen.first[point]),
             last = static_cast<std::size_t>(seen.first[point + 1]);
  rows.count = last - first;
  rows.functions.resize(rows.count * basis.size());
  rows.colours.clear();
  basis.evaluate(std::span(seen.direction).subspan(first, rows.count), rows.functions.data());
  for (std::size_t i = first; i < last; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      rows.colours.push_back(seen.colour[i][c] - (light.empty() ? 0.0f : light[3 * i + c]));
}

/// min |c - G a|^2 + sum_k penalty_k (a_k - m_k)^2, a_0 free: in the dual form, M x M.
class PointSystem {
 public:
  /// @param inverse_root  of the penalties; [0] is 0; kept by reference, as rows
  PointSystem(const PointRows& rows, std::span<const float> inverse_root)
      : g_(rows.functions.data(), index(rows.count), index(inverse_root.size())),
        c_(rows.colours.data(), index(rows.count), 3),
        root_(inverse_root.data(), index(inverse_root.size())),
        scaled_(g_ * root_.asDiagonal()),
        s_(one_plus_square(scaled_)),
        factor_(s_),
        w_(factor_.solve(Eigen::VectorXf::Ones(index(rows.count)))) {}

  /// @param coefficients  [K][3] m before, a after
  void solve(float* coefficients) const {
    Eigen::Map<Columns> a(coefficients, root_.size(), 3);
    a.row(0).setZero();
    Columns residual = c_ - g_ * a;
    const Eigen::RowVector3f dc = w_.transpose() * residual / w_.sum();
    residual.rowwise() -= dc;
    const Eigen::Matrix<float, Eigen::Dynamic, 3> z = factor_.solve(residual);
    a.noalias() += root_.asDiagonal() * (scaled_.transpose() * z);
    a.row(0) = dc;
  }

 private:
  /// 1 + m m^T, the lower triangle.
  static Eigen::MatrixXf one_plus_square(const Matrix& m) {
    Eigen::MatrixXf s = Eigen::MatrixXf::Identity(m.rows(), m.rows());
    s.selfadjointView<Eigen::Lower>().rankUpdate(m);
    return s;
  }

  Eigen::Map<const Matrix> g_;
  Eigen::Map<const Columns> c_;
  Eigen::Map<const Eigen::VectorXf> root_;
  Matrix scaled_;
  Eigen::MatrixXf s_;
  Eigen::LLT<Eigen::Ref<Eigen::MatrixXf>, Eigen::Lower> factor_;  // in s_
  Eigen::VectorXf w_;
};

}  // namespace

template <class Each>
void HierarchicalFit::for_points(double from, double to, const Progress& progress,
                                 const Each& each) const {
  const std::size_t blocks = prior_.num_blocks();
  parallel_ranges(
      blocks, 1, threads_,
      [&](std::size_t begin, std::size_t end) {
        PointRows rows;
        for (std::size_t b = begin; b < end; ++b)
          for (std::size_t p = prior_.first_point(b); p < prior_.first_point(b + 1); ++p) {
            read_rows(observations_, light_, p, basis_, rows);
            if (rows.count > 0) each(b, p, rows);
          }
      },
      [&](std::size_t done) {
        if (progress) progress("fit", from + (to - from) * double(done) / double(blocks));
      });
}

HierarchicalFit::HierarchicalFit(const Observations& observations, std::span<const Voxel> positions,
                                 const FitSettings& settings, const EnvironmentPrior& environment,
                                 const Progress& progress)
    : observations_(observations),
      light_(environment.along(observations, settings.threads)),
      threads_(settings.threads),
      basis_(settings.basis),
      prior_(positions, settings.hierarchy.block_log2, basis_.size()) {
  for_points(0, 0.5, progress,
             [&](std::size_t b, std::size_t, const PointRows& rows) { prior_.add(b, rows); });
  prior_.sum_up(threads_);
}

void HierarchicalFit::solve(std::span<const HierarchySettings> tried, const Body& body,
                            const Progress& progress) const {
  std::vector<std::vector<float>> blocks;
  for (const HierarchySettings& h : tried)
    blocks.push_back(prior_.solve(h.strength, penalties(basis_, kPenalty, h.growth), threads_));
  std::vector<float> inverse_root;
  for (const double p : penalties(basis_, tried[0].point_penalty, tried[0].point_growth))
    inverse_root.push_back(static_cast<float>(1 / std::sqrt(p)));
  inverse_root[0] = 0;
  const std::size_t size = 3 * basis_.size();
  for_points(0.5, 1, progress, [&](std::size_t b, std::size_t p, const PointRows& rows) {
    const PointSystem system(rows, inverse_root);
    std::vector<float> solutions;
    for (const auto& prior : blocks) {
      const auto mean = prior.begin() + static_cast<std::ptrdiff_t>(b * size);
      solutions.insert(solutions.end(), mean, mean + static_cast<std::ptrdiff_t>(size));
      system.solve(&solutions[solutions.size() - size]);
    }
    body(p, solutions);
  });
}

std::vector<float> fit_hierarchical(const Observations& observations,
                                    std::span<const Voxel> positions, const FitSettings& settings,
                                    const Progress& progress) {
  MirrorPoints points;
  std::optional<Environment> light;
  if (settings.environment.degree > 0) {
    points = mirror_points(positions, settings.normal_cell_log2, settings.threads,
                           settings.environment.known);
    light = fit_environment(observations, points, settings);
  }
  const EnvironmentPrior environment(light, points, settings.frame);
  const HierarchicalFit fit(observations, positions, settings, environment, progress);
  const std::size_t size = 3 * fit.basis().size();
  std::vector<float> coefficients(positions.size() * size, 0.0f);
  if (light) coefficients = environment.projected(observations, fit.basis(), settings.threads);
  const auto norms = fit.basis().norms();
  fit.solve(
      std::span(&settings.hierarchy, 1),
      [&](std::size_t p, std::span<const float> a) {
        float* of_point = coefficients.data() + p * size;
        for (std::size_t i = 0; i < size; ++i)
          of_point[i] = (of_point[i] + a[i]) / static_cast<float>(norms[i / 3]);
      },
      progress);
  return coefficients;
}

}  // namespace slf
