// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/block_prior.h"

#include <utility>

#include "encoder/fit/fit_cholesky.h"
#include "encoder/fit/lane_products.h"
#include "slf/parallel.h"

namespace slf {

BlockPrior::BlockPrior(std::span<const Voxel> positions, int block_log2, std::size_t functions)
    : tree_(positions, block_log2), functions_(functions), width_(padded(functions + 3)) {
  for (std::size_t level = 0; level < tree_.levels(); ++level) {
    const std::size_t blocks = tree_.blocks(level);
    sums_.push_back(
        {std::vector<float>(blocks * width_ * width_, 0.0f), std::vector<double>(blocks, 0.0)});
  }
}

void BlockPrior::add(std::size_t b, const PointColumns& seen) {
  std::vector<float> rows(seen.count * width_, 0.0f), mean(width_);
  const auto take = [&](const float* column, std::size_t k) {
    for (std::size_t m = 0; m < seen.count; ++m) rows[m * width_ + k] = column[m];
  };
  for (std::size_t k = 0; k < functions_; ++k) take(&seen.functions[k * seen.stride], k);
  for (std::size_t c = 0; c < 3; ++c) take(&seen.colours[c * seen.stride], functions_ + c);
  centre_rows(seen.count, rows.data(), width_, mean.data());
  add_square(seen.count, rows.data(), width_, matrix_of(0, b));
  sums_.front().observations[b] += static_cast<double>(seen.count);
}

void BlockPrior::sum_up(int threads) {
  for (std::size_t level = 1; level < sums_.size(); ++level)
    parallel_ranges(tree_.blocks(level), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        for (std::size_t child = tree_.first(level, b); child < tree_.first(level, b + 1);
             ++child) {
          const float* from = matrix_of(level - 1, child);
          float* to = matrix_of(level, b);
          for (std::size_t i = 0; i < width_ * width_; ++i) to[i] += from[i];
          sums_[level].observations[b] += sums_[level - 1].observations[child];
        }
    });
}

/// What the level above says of a block; 0 where there is none.
BlockPrior::Solution BlockPrior::from_above(std::size_t level, std::size_t b,
                                            std::span<const Solution> above) const {
  Solution mean(3 * functions_, 0.0);
  if (level + 1 == tree_.levels()) return mean;
  const BlockBlend blend = tree_.above(level, b);
  for (std::size_t i = 0; i < blend.count; ++i)
    for (std::size_t k = 0; k < mean.size(); ++k)
      mean[k] += double{blend.weight[i]} * above[blend.block[i]][k];
  return mean;
}

/// Element 0 is 0.
/// @param penalty  [K] in full
BlockPrior::Solution BlockPrior::solve_block(std::size_t level, std::size_t b, Solution above,
                                             std::span<const double> penalty) const {
  const std::size_t n = functions_ - 1;
  if (sums_[level].observations[b] == 0 || n == 0) return above;
  const float* matrix = sums_[level].matrix.data() + b * width_ * width_;
  std::vector<Lanes<double>> residual(n);
  std::vector<double> factor(packed_size(n));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t c = 0; c < 3; ++c)
      residual[j].c[c] = double{matrix[(functions_ + c) * width_ + j + 1]};
  for (std::size_t j = 0; j < n; ++j) {
    double* column = factor.data() + packed_column(n, j);
    for (std::size_t i = j; i < n; ++i) {
      const double a = column[i - j] = double{matrix[(i + 1) * width_ + j + 1]};
      for (std::size_t c = 0; c < 3; ++c) {
        residual[i].c[c] -= a * above[3 * (j + 1) + c];
        if (i > j) residual[j].c[c] -= a * above[3 * (i + 1) + c];
      }
    }
    column[0] += penalty[j + 1];
  }
  cholesky_factorise(factor.data(), n, 1e-12);
  cholesky_solve(factor.data(), n, residual.data());
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t c = 0; c < 3; ++c) above[3 * (j + 1) + c] += residual[j].c[c];
  return above;
}

std::vector<float> BlockPrior::solve(double strength, std::span<const double> penalty,
                                     int threads) const {
  std::vector<Solution> above;  // of the level above
  for (std::size_t level = tree_.levels(); level-- > 0;) {
    std::vector<Solution> here(tree_.blocks(level));
    parallel_ranges(here.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        std::vector<double> full(penalty.begin(), penalty.end());
        for (double& p : full) p *= strength * sums_[level].observations[b];
        here[b] = solve_block(level, b, from_above(level, b, above), full);
      }
    });
    above = std::move(here);
  }
  std::vector<float> solution;
  solution.reserve(above.size() * functions_ * 3);
  for (const Solution& x : above)
    for (const double value : x) solution.push_back(static_cast<float>(value));
  return solution;
}

}  // namespace slf
