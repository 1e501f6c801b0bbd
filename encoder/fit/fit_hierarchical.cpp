// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_hierarchical.h"

#include <cmath>
#include <optional>

#include "encoder/fit/fit_cholesky.h"
#include "encoder/fit/lane_products.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kPenalty = 0.8;

std::vector<double> penalties(const DirectionRows& rows, double scale, double growth) {
  std::vector<double> penalty;
  for (const int fineness : rows.fineness()) penalty.push_back(scale * std::pow(growth, fineness));
  return penalty;
}

/// What was seen of one point, less the light that it reflects.
/// @param light  [3] of each observation; called in their order
template <class Light>
void read_columns(const SeenPoint& from, const Light& light, const DirectionRows& basis,
                  PointColumns& seen) {
  seen.count = from.count();
  if (seen.count == 0) return;
  seen.stride = padded(seen.count);
  seen.functions.resize(basis.size() * seen.stride);
  seen.colours.assign(3 * seen.stride, 0.0f);
  basis.evaluate_columns(from.direction, seen.functions.data(), seen.stride);
  for (std::size_t i = 0; i < seen.count; ++i) {
    const std::array<float, 3> dark = light(i);
    for (std::size_t c = 0; c < 3; ++c)
      seen.colours[c * seen.stride + i] = from.colour[i][c] - dark[c];
  }
}

/// out += what is between blocks.
/// @param of_block  [blocks][out.size()]
void add_between(std::span<const float> of_block, const BlockBlend& blend, std::span<float> out) {
  for (std::size_t i = 0; i < blend.count; ++i) {
    const auto from = of_block.subspan(blend.block[i] * out.size(), out.size());
    for (std::size_t k = 0; k < out.size(); ++k) out[k] += blend.weight[i] * from[k];
  }
}

/// min |c - G a|^2 + sum_k penalty_k (a_k - m_k)^2, a_0 free: in the dual form, M x M.
class PointSystem {
 public:
  /// @param inverse_root  [K] of the penalties; [0] is not used
  explicit PointSystem(std::span<const float> inverse_root)
      : root_(inverse_root), model_(inverse_root.size()), change_(inverse_root.size()) {}

  /// @param seen  kept by reference; its functions are scaled by the roots
  void factorise(PointColumns& seen) {
    seen_ = &seen;
    const std::size_t m = seen.count, width = seen.stride;
    for (std::size_t k = 1; k < root_.size(); ++k)
      for (std::size_t i = 0; i < width; ++i) seen.functions[k * width + i] *= root_[k];
    square_.assign(width * width, 0.0f);
    add_square(root_.size() - 1, scaled(), width, square_.data());
    factor_.resize(packed_size(m));
    for (std::size_t j = 0; j < m; ++j) {
      float* column = factor_.data() + packed_column(m, j);
      for (std::size_t i = j; i < m; ++i) column[i - j] = square_[i * width + j];
      column[0] += 1;
    }
    cholesky_factorise(factor_.data(), m, 1.0f);
  }

  /// @param coefficients  [K][3] m before, a after
  void solve(float* coefficients) {
    const std::size_t m = seen_->count, width = seen_->stride, functions = root_.size() - 1;
    for (std::size_t k = 0; k < functions; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        model_[k].c[c] = -coefficients[3 * (k + 1) + c] / root_[k + 1];
    residual_.assign(4 * width, 1.0f);  // the last channel is of ones
    std::copy(seen_->colours.begin(), seen_->colours.end(), residual_.begin());
    if (functions > 0)
      add_products(functions, model_[0].c.data(), 4, 4, scaled(), width, width, residual_.data());
    solved_.resize(m);
    for (std::size_t i = 0; i < m; ++i)
      for (std::size_t c = 0; c < 4; ++c) solved_[i].c[c] = residual_[c * width + i];
    cholesky_solve(factor_.data(), m, solved_.data());
    Lanes<float> sum;
    for (const auto& x : solved_)
      for (std::size_t c = 0; c < 4; ++c) sum.c[c] += x.c[c];
    for (std::size_t c = 0; c < 3; ++c) coefficients[c] = sum.c[c] / sum.c[3];
    for (auto& x : solved_)
      for (std::size_t c = 0; c < 3; ++c) x.c[c] -= coefficients[c] * x.c[3];
    row_products(functions, scaled(), width, m, solved_.data(), change_.data());
    for (std::size_t k = 0; k < functions; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        coefficients[3 * (k + 1) + c] += root_[k + 1] * change_[k].c[c];
  }

 private:
  const float* scaled() const {
    return seen_->functions.data() + seen_->stride;
  }  // [K - 1][stride]

  std::span<const float> root_;
  const PointColumns* seen_ = nullptr;
  std::vector<float> square_, factor_;        // 1 + S S^T: its products; packed
  std::vector<float> residual_;               // [4][stride]
  std::vector<Lanes<float>> solved_;          // [M]
  std::vector<Lanes<float>> model_, change_;  // [K - 1] over the roots
};

}  // namespace

template <class Each>
void HierarchicalFit::for_points(double from, double to, const Progress& progress,
                                 const Each& each) const {
  const BlockTree& tree = prior_.tree();
  const std::size_t blocks = tree.blocks(0);
  parallel_ranges(
      blocks, 1, threads_,
      [&](std::size_t begin, std::size_t end) {
        PointColumns seen;
        SeenRoom room;
        for (std::size_t b = begin; b < end; ++b)
          for (std::size_t p = tree.first(0, b); p < tree.first(0, b + 1); ++p) {
            const SeenPoint point = observations_.of(p, room);
            const auto light_of = [&](std::size_t i) -> std::array<float, 3> {
              if (light_.empty()) return environment_(p, point.direction[i]);
              const float* light = &light_[3 * (observations_.first(p) + i)];
              return {light[0], light[1], light[2]};
            };
            read_columns(point, light_of, basis_, seen);
            if (seen.count > 0) each(b, p, seen);
          }
      },
      [&](std::size_t done) {
        if (progress) progress("fit", from + (to - from) * double(done) / double(blocks));
      });
}

HierarchicalFit::HierarchicalFit(const PointwiseObservations& observations,
                                 std::span<const Voxel> positions, const FitSettings& settings,
                                 const EnvironmentPrior& environment, const Progress& progress)
    : observations_(observations),
      positions_(positions),
      environment_(environment),
      light_(observations.kept() ? environment.along(observations, settings.threads)
                                 : std::vector<float>{}),
      threads_(settings.threads),
      basis_(settings.basis),
      prior_(positions, settings.hierarchy.block_log2, basis_.size()) {
  for_points(0, 0.5, progress,
             [&](std::size_t b, std::size_t, PointColumns& seen) { prior_.add(b, seen); });
  prior_.sum_up(threads_);
}

std::vector<std::vector<float>> HierarchicalFit::solve_blocks(
    std::span<const HierarchySettings> tried) const {
  std::vector<std::vector<float>> blocks;
  for (const HierarchySettings& h : tried)
    blocks.push_back(prior_.solve(h.strength, penalties(basis_, kPenalty, h.growth), threads_));
  return blocks;
}

void HierarchicalFit::solve_points(std::span<const HierarchySettings> tried,
                                   std::span<const std::vector<float>> blocks, const Body& body,
                                   const Progress& progress) const {
  std::vector<float> inverse_root;
  for (const double p : penalties(basis_, tried[0].point_penalty, tried[0].point_growth))
    inverse_root.push_back(static_cast<float>(1 / std::sqrt(p)));
  inverse_root[0] = 0;
  const std::size_t size = 3 * basis_.size();
  for_points(0.5, 1, progress, [&](std::size_t, std::size_t p, PointColumns& seen) {
    const BlockBlend around = prior_.tree().around(positions_[p]);
    PointSystem system(inverse_root);
    system.factorise(seen);
    std::vector<float> solutions(tried.size() * size, 0.0f);
    for (std::size_t t = 0; t < tried.size(); ++t) {
      float* solution = solutions.data() + t * size;
      add_between(blocks[t], around, std::span(solution, size));
      system.solve(solution);
    }
    body(p, solutions);
  });
}

FittedRows fit_hierarchical(const PointwiseObservations& observations,
                            std::span<const Voxel> positions, const MirrorPoints& points,
                            const FitSettings& settings, std::size_t of_piece,
                            const Progress& progress) {
  std::optional<Environment> light;
  if (settings.environment.degree > 0) light = fit_environment(observations, points, settings);
  const EnvironmentPrior environment(light, points, settings.directions);
  HierarchicalFit fit(observations, positions, settings, environment, progress);
  const auto tried = std::span(&settings.hierarchy, 1);
  const auto blocks = fit.solve_blocks(tried);
  fit.forget_sums();
  const std::size_t size = 3 * fit.basis().size();
  FittedRows coefficients(positions.size(), size, of_piece);
  if (light) environment.project(observations, fit.basis(), settings.threads, coefficients);
  const auto norms = fit.basis().norms();
  fit.solve_points(
      tried, blocks,
      [&](std::size_t p, std::span<const float> a) {
        float* of_point = coefficients.of(p);
        for (std::size_t i = 0; i < size; ++i)
          of_point[i] = (of_point[i] + a[i]) / static_cast<float>(norms[i / 3]);
      },
      progress);
  return coefficients;
}

}  // namespace slf
