#include "fit/block_prior.h"

#include "fit/fit_cholesky.h"
#include "fit/lane_products.h"
#include "geometry/morton.h"
#include "slf/parallel.h"

namespace slf {

BlockPrior::BlockPrior(std::span<const Voxel> positions, int block_log2, std::size_t functions)
    : functions_(functions), width_(padded(functions + 3)) {
  std::vector<std::uint64_t> codes;  // of the level at hand
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const std::uint64_t code = morton(positions[p]) >> (3 * block_log2);
    if (!codes.empty() && codes.back() == code) continue;
    if (codes.empty()) first_.emplace_back();
    codes.push_back(code);
    first_.back().push_back(p);
  }
  first_.back().push_back(positions.size());
  while (codes.size() > 1) {  // up to the block that holds all
    std::vector<std::uint64_t> above;
    std::vector<std::size_t> first;
    for (std::size_t b = 0; b < codes.size(); ++b) {
      if (!above.empty() && above.back() == codes[b] >> 3) continue;
      above.push_back(codes[b] >> 3);
      first.push_back(b);
    }
    first.push_back(codes.size());
    first_.push_back(std::move(first));
    codes = std::move(above);
  }
  for (const auto& first : first_) {
    sums_.emplace_back(first.size() - 1);
    for (Sums& sums : sums_.back()) sums.matrix.assign(width_ * width_, 0);
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
  Sums& sums = sums_.front()[b];
  add_square(seen.count, rows.data(), width_, sums.matrix.data());
  sums.observations += static_cast<double>(seen.count);
}

void BlockPrior::sum_up(int threads) {
  for (std::size_t level = 1; level < sums_.size(); ++level)
    parallel_ranges(sums_[level].size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        for (std::size_t child = first_[level][b]; child < first_[level][b + 1]; ++child) {
          const Sums& from = sums_[level - 1][child];
          Sums& to = sums_[level][b];
          for (std::size_t i = 0; i < to.matrix.size(); ++i) to.matrix[i] += from.matrix[i];
          to.observations += from.observations;
        }
    });
}

/// [K][3] of a block; element 0 is 0.
/// @param above  the same of the block above it
/// @param penalty  [K] in full
std::vector<double> BlockPrior::solve_block(const Sums& sums, std::span<const double> above,
                                            std::span<const double> penalty) const {
  std::vector<double> solution(above.begin(), above.end());
  const std::size_t n = functions_ - 1;
  if (sums.observations == 0 || n == 0) return solution;
  std::vector<Lanes<double>> residual(n);
  std::vector<double> factor(packed_size(n));
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t c = 0; c < 3; ++c)
      residual[j].c[c] = double{sums.matrix[(functions_ + c) * width_ + j + 1]};
  for (std::size_t j = 0; j < n; ++j) {
    double* column = factor.data() + packed_column(n, j);
    for (std::size_t i = j; i < n; ++i) {
      const double a = column[i - j] = double{sums.matrix[(i + 1) * width_ + j + 1]};
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
    for (std::size_t c = 0; c < 3; ++c) solution[3 * (j + 1) + c] += residual[j].c[c];
  return solution;
}

std::vector<float> BlockPrior::solve(double strength, std::span<const double> penalty,
                                     int threads) const {
  using Solution = std::vector<double>;                           // [K][3]
  std::vector<Solution> above(1, Solution(3 * functions_, 0.0));  // of the level above
  std::vector<std::size_t> parent(sums_.back().size(), 0);
  for (std::size_t level = sums_.size(); level-- > 0;) {
    std::vector<Solution> here(sums_[level].size());
    parallel_ranges(here.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        std::vector<double> full(penalty.begin(), penalty.end());
        for (double& p : full) p *= strength * sums_[level][b].observations;
        here[b] = solve_block(sums_[level][b], above[parent[b]], full);
      }
    });
    if (level > 0) {
      parent.assign(sums_[level - 1].size(), 0);
      for (std::size_t b = 0; b < here.size(); ++b)
        for (std::size_t c = first_[level][b]; c < first_[level][b + 1]; ++c) parent[c] = b;
    }
    above = std::move(here);
  }
  std::vector<float> solution;
  solution.reserve(above.size() * functions_ * 3);
  for (const Solution& x : above)
    for (const double value : x) solution.push_back(static_cast<float>(value));
  return solution;
}

}  // namespace slf
