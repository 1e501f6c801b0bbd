#include "fit/block_prior.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "base/signed_index.h"
#include "geometry/morton.h"
#include "slf/parallel.h"

namespace slf {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Columns = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

}  // namespace

BlockPrior::BlockPrior(std::span<const Voxel> positions, int block_log2, std::size_t functions)
    : functions_(functions) {
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
  const std::size_t unknowns = functions_ - 1;
  for (const auto& first : first_) {
    sums_.emplace_back(first.size() - 1);
    for (Sums& sums : sums_.back()) {
      sums.matrix.assign(unknowns * unknowns, 0);
      sums.right.assign(3 * unknowns, 0);
    }
  }
}

void BlockPrior::add(std::size_t b, const PointRows& rows) {
  if (rows.count == 0) return;
  const Eigen::Map<const Matrix> g(rows.functions.data(), index(rows.count), index(functions_));
  const Eigen::Map<const Columns> c(rows.colours.data(), index(rows.count), 3);
  const Matrix centred = (g.rowwise() - g.colwise().mean()).rightCols(index(functions_ - 1));
  const Columns residual = c.rowwise() - c.colwise().mean();
  Sums& sums = sums_.front()[b];
  Eigen::Map<Matrix> a(sums.matrix.data(), index(functions_ - 1), index(functions_ - 1));
  a.selfadjointView<Eigen::Lower>().rankUpdate(centred.transpose());
  Eigen::Map<Columns> r(sums.right.data(), index(functions_ - 1), 3);
  r.noalias() += centred.transpose() * residual;
  sums.observations += static_cast<double>(rows.count);
}

void BlockPrior::sum_up(int threads) {
  for (std::size_t level = 1; level < sums_.size(); ++level)
    parallel_ranges(sums_[level].size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b)
        for (std::size_t child = first_[level][b]; child < first_[level][b + 1]; ++child) {
          const Sums& from = sums_[level - 1][child];
          Sums& to = sums_[level][b];
          for (std::size_t i = 0; i < to.matrix.size(); ++i) to.matrix[i] += from.matrix[i];
          for (std::size_t i = 0; i < to.right.size(); ++i) to.right[i] += from.right[i];
          to.observations += from.observations;
        }
    });
}

std::vector<float> BlockPrior::solve(double strength, std::span<const double> penalty,
                                     int threads) const {
  const std::size_t unknowns = functions_ - 1;
  using Square = Eigen::MatrixXd;
  using Solution = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  std::vector<Solution> above(1, Solution::Zero(index(unknowns), 3));  // of the level above
  std::vector<std::size_t> parent(sums_.back().size(), 0);
  for (std::size_t level = sums_.size(); level-- > 0;) {
    std::vector<Solution> here(sums_[level].size());
    parallel_ranges(here.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const Sums& sums = sums_[level][b];
        here[b] = above[parent[b]];
        if (sums.observations == 0 || unknowns == 0) continue;
        const Eigen::Map<const Matrix> a(sums.matrix.data(), index(unknowns), index(unknowns));
        const Eigen::Map<const Columns> r(sums.right.data(), index(unknowns), 3);
        Square m = a.cast<double>().selfadjointView<Eigen::Lower>();
        const Solution residual = r.cast<double>() - m * here[b];
        for (std::size_t k = 0; k < unknowns; ++k)
          m(index(k), index(k)) += strength * sums.observations * penalty[k + 1];
        here[b] += m.llt().solve(residual);
      }
    });
    if (level > 0) {
      parent.assign(sums_[level - 1].size(), 0);
      for (std::size_t b = 0; b < here.size(); ++b)
        for (std::size_t c = first_[level][b]; c < first_[level][b + 1]; ++c) parent[c] = b;
    }
    above = std::move(here);
  }
  std::vector<float> solution(above.size() * functions_ * 3, 0);
  for (std::size_t b = 0; b < above.size(); ++b)
    for (std::size_t k = 0; k < unknowns; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        solution[(b * functions_ + k + 1) * 3 + c] =
            static_cast<float>(above[b](index(k), index(c)));
  return solution;
}

}  // namespace slf
