// Coefficients of one plane group, a vector per node: is it all zero, then every value. Each
// decision is predicted from the vectors around it. Written once for decoder and encoder. Spec
// 8.7.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <utility>
#include <vector>

#include "attributes/coefficient_layout.h"
#include "attributes/coefficient_magnitude_model.h"
#include "attributes/coefficient_neighbours.h"
#include "attributes/coefficient_sign_model.h"
#include "attributes/states_in_use.h"
#include "bitstream/huge_pages.h"
#include "bitstream/prefetch.h"
#include "entropy/log_class.h"
#include "entropy/mixed_bit.h"

namespace slf {

/// What the decisions of a group leave to those of its next unit: a value, so that several slices
/// may start from the same.
struct VectorStates {
  /// functions: of the group.
  explicit VectorStates(std::size_t functions)
      : activity(3 * functions, functions > 1 ? kFirstActivity : 0) {}

  static constexpr std::int32_t kFirstActivity = 16;
  static constexpr std::uint32_t kTopSplit = 44;

  std::vector<std::int32_t> activity;  ///< [planes] running mean of min(magnitude, 7), in 1/4096
  MixedBit<4, kTopSplit + 1> node{{48 * 16, 45 * 24, 625 * 3, 125 * 3 * 4}};
  MixedBit<4, 32> rest{{32 * 48, 1024, 24 * 5 * 12, 32 * 5 * 16}};
  MixedBit<5, 34> any{{25 * 48, 48 * 17, 400, 56 * 24, 48 * 24}};
  CoefficientMagnitudeModel magnitude;
  CoefficientSignModel sign;
};

class VectorCoefficients {
 public:
  using States = VectorStates;

  /// functions: the group's, ascending.
  VectorCoefficients(std::vector<std::uint16_t> functions, std::size_t num_points)
      : functions_(std::move(functions)),
        width_(3 * functions_.size()),
        sum_(num_points),
        vector_of_(num_points),
        vectors_(width_),
        parents_(width_),
        beside_(width_),
        rest_((functions_.size() + kRun - 1) / kRun),
        runs_(num_points) {}

  /// Codes rows order[begin .. end). `lower`: the group before this one, or nullptr.
  /// Returns false where the decoder met a value no encoder writes.
  template <class Coder>
  bool code(Coder& coder, const CoefficientRows& rows, const CoefficientNeighbours& neighbours,
            const VectorCoefficients* lower, std::size_t begin, std::size_t end) {
    states_.begin(functions_.size());
    if constexpr (!Coder::kDecodes) find_rows(rows);
    for (std::size_t i = begin; i < end; ++i) {
      if constexpr (Coder::kDecodes)
        if (coder.exhausted()) return false;
      const std::uint32_t row = rows.tree.order[i];
      const Around around = around_of(neighbours.rows, i);
      const std::uint32_t below = lower != nullptr ? log_class(lower->sum_[i], 15) : 0;
      const bool any = !Coder::kDecodes && any_in_row_[row] != 0;
      if (!code_node(coder, around, below, any)) continue;
      rows.set_nonzero(row);
      if (!code_vector(coder, around, i, rows.row(row))) return false;
    }
    return true;
  }

  const std::vector<std::uint16_t>& functions() const { return functions_; }
  StatesInUse<VectorStates>& states() { return states_; }

  /// Keeps for place `here` what `base` keeps for its place `there`; here is not coded. Spec 8.2.1.
  void adopt(const VectorCoefficients& base, std::uint32_t there, std::uint32_t here) {
    if (base.vector_of_[there] == 0) return;
    const std::int16_t* vector = base.kept_vector(there);
    std::copy(vector, vector + width_, &vectors_[add_vector()]);
    vector_of_[here] = static_cast<std::uint32_t>(vectors_.size() / width_ - 1);
    sum_[here] = base.sum_[there];
    runs_[here] = base.runs_[there];
  }

 private:
  static constexpr std::size_t kParents = 3;  // parent, its parent, and that one's
  static constexpr std::size_t kAround = 7;   // and the faces towards lower x, y, z; the previous
  static constexpr std::uint32_t kTopSplit = VectorStates::kTopSplit;
  static constexpr std::size_t kRun = 4;          // functions
  static constexpr std::int32_t kLargest = 4095;  // magnitudes are kept for contexts up to this

  /// The rows around one, by place, 0 where there is none, and what their magnitudes say of its
  /// own.
  struct Around {
    std::array<std::uint32_t, kAround> row{};
    std::array<std::uint32_t, kAround> weight{};  // 8 fractional bits; 0 also for a zero vector
    bool any_beside = false;
    std::uint32_t same_axis = 0;      // nearest of the parents whose split is along the same axis
    std::uint32_t split = kTopSplit;  // at most
    std::uint32_t axis = 2;           // 0 .. 2, of the split
    std::uint32_t scale_class = 0;
  };

  /// Of the values of a vector so far.
  struct Progress {
    std::uint32_t sum = 0;       // of magnitudes
    std::uint64_t activity = 0;  // of their planes
    std::uint32_t recent = 0;    // functions of the run that are not zero
  };

  using Rows = std::vector<CoefficientNeighbours::Row>;

  Around around_of(const Rows& rows, std::size_t i) const {
    const CoefficientNeighbours::Row& row = rows[i];
    Around around;
    around.scale_class = log_class(row.scale >> 5, 23);
    if (i == 0) return around;
    around.split = std::min<std::uint32_t>(row.split, kTopSplit);
    around.axis = row.split % 3u;
    std::uint32_t up = row.parent;
    for (std::size_t k = 0; k < kParents; ++k) {
      around.row[k] = up;
      if (up != 0 && around.same_axis == 0 && rows[up].split % 3u == around.axis)
        around.same_axis = up;
      up = rows[up].parent;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) around.row[kParents + axis] = row.faces[axis];
    if (rows[i - 1].split == row.split) around.row[kAround - 1] = static_cast<std::uint32_t>(i - 1);
    set_weights(rows, row.scale, around);
    return around;
  }

  /// A difference between means is as likely large here as there; coefficients are differences
  /// times scale.
  void set_weights(const Rows& rows, std::uint32_t scale, Around& around) const {
    constexpr std::array<std::uint32_t, kAround> kShares = {2, 2, 1, 3, 3, 3, 1};
    constexpr std::uint32_t kParentShares = 5;
    constexpr std::uint32_t kMostWeight = 32767;  // times 7 * kLargest stays below 2^31
    std::uint32_t shares_beside = 0;
    for (std::size_t k = kParents; k < kAround; ++k)
      if (around.row[k] != 0) shares_beside += kShares[k];
    around.any_beside = shares_beside > 0;
    for (std::size_t k = 0; k < kAround; ++k) {
      if (sum_[around.row[k]] == 0) continue;  // the sum of place 0 stays 0
      prefetch(kept_vector(around.row[k]));
      const std::uint32_t shares = k < kParents ? kParentShares : shares_beside;
      around.weight[k] =
          std::min(kShares[k] * scale * 256 / (rows[around.row[k]].scale * shares), kMostWeight);
    }
  }

  /// Which rows have a vector, for the encoder: asked for in the order of memory.
  void find_rows(const CoefficientRows& rows) {
    if (!any_in_row_.empty()) return;
    any_in_row_.resize(sum_.size());
    for (std::size_t row = 0; row < any_in_row_.size(); ++row)
      any_in_row_[row] = has_any(rows.row(row), functions_);
  }

  template <class Coder>
  bool code_node(Coder& coder, const Around& around, std::uint32_t below, bool any) {
    std::uint32_t parents = 0, beside = 0;
    std::array<std::uint32_t, kAround> size;
    for (std::size_t k = 0; k < kAround; ++k) {
      const std::uint32_t sum = sum_[around.row[k]];
      (k < kParents ? parents : beside) +=
          around.weight[k] * std::min<std::uint32_t>(sum, kLargest);
      size[k] = std::min<std::uint32_t>(sum, 4);
    }
    const std::uint32_t expected = (parents + (around.any_beside ? beside : parents)) / 2;
    const std::array<std::uint32_t, 4> contexts = {
        log_class(expected >> 4, 47) * 16 + below, around.split * 24 + around.scale_class,
        (((size[0] * 5 + size[1]) * 5 + size[2]) * 5 + size[6]) * 3 + around.axis,
        (((size[3] * 5 + size[4]) * 5 + size[5]) * 3 + around.axis) * 4 + std::min(below, 3u)};
    return states_->node.code(coder, contexts, around.split, any) != 0;
  }

  template <class Coder>
  bool code_vector(Coder& coder, const Around& around, std::size_t i, std::int32_t* values) {
    prefetch(values + 3u * functions_.front());
    expect(around);
    const std::size_t place = add_vector();
    Progress progress;
    std::size_t last = 0;  // function that is not zero
    std::size_t end =
        functions_.size();  // behind the last function that is not zero: the encoder's
    if constexpr (!Coder::kDecodes)
      while (end > 1 && is_zero(values + 3u * functions_[end - 1])) --end;
    expect_rest();
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      if (f > 0 && f % kRun == 0 && progress.sum > 0 &&
          !code_rest(coder, around, f, progress, end > f)) {
        leave(3 * f);
        break;
      }
      if (!code_function(coder, around, f, values + 3u * functions_[f], &vectors_[place], progress))
        return false;
      if (!is_zero_kept(&vectors_[place] + 3 * f)) last = f;
    }
    if (i == 0) return true;  // the mean of all says nothing of differences
    vector_of_[i] = static_cast<std::uint32_t>(place / width_);
    sum_[i] = static_cast<std::uint16_t>(std::min(progress.sum, 65535u));
    runs_[i] = static_cast<std::uint8_t>(std::min<std::size_t>((last + kRun) / kRun, 255));
    return true;
  }

  /// Place of one more, of zeros, in vectors_. There is room for all, on pages that are not there
  /// until they are used: vectors never move.
  std::size_t add_vector() {
    const std::size_t place = vectors_.size();
    if (place == width_) {
      vectors_.reserve((sum_.size() + 1) * width_);
      advise_huge_pages(vectors_.data(), vectors_.capacity() * sizeof(std::int16_t));
    }
    vectors_.resize(place + width_);
    return place;
  }

  static bool is_zero(const std::int32_t* values) {
    return (values[0] | values[1] | values[2]) == 0;
  }

  static bool is_zero_kept(const std::int16_t* values) {
    return (values[0] | values[1] | values[2]) == 0;
  }

  /// The planes from j on are zero in this vector.
  void leave(std::size_t j) {
    for (; j < width_; ++j) states_->activity[j] -= (states_->activity[j] + 63) >> 6;
  }

  /// What is expected of the functions of every run and those behind it.
  void expect_rest() {
    std::uint32_t sum = 0;
    for (std::size_t run = rest_.size(); run-- > 0;) {
      for (std::size_t j = 3 * kRun * run; j < std::min(3 * kRun * (run + 1), width_); ++j)
        sum += std::min((parents_[j] + beside_[j]) / 2 +
                            (static_cast<std::uint32_t>(states_->activity[j]) >> 5),
                        1u << 18);
      rest_[run] = sum;
    }
  }

  /// Has the vector a value other than 0 from function f on?
  template <class Coder>
  bool code_rest(Coder& coder, const Around& around, std::size_t f, Progress& progress, bool any) {
    const auto run = static_cast<std::uint32_t>(std::min<std::size_t>(f / kRun, 31));
    const auto ahead = [&](std::size_t k) {  // how far on a vector around goes
      const std::uint32_t there = runs_[around.row[k]];
      return there <= run ? 0u : std::min(there - run, 3u);
    };
    const std::uint32_t size = log_class(rest_[f / kRun] >> 4, 47);
    const std::array<std::uint32_t, 4> contexts = {
        run * 48 + size, (((ahead(0) * 4 + ahead(3)) * 4 + ahead(4)) * 4 + ahead(5)) * 4 + ahead(6),
        (log_class(progress.sum, 23) * 5 + progress.recent) * 12 + size / 4,
        (run * 5 + progress.recent) * 16 + ahead(0) * 4 + ahead(6)};
    progress.recent = 0;
    return states_->rest.code(coder, contexts, run, any) != 0;
  }

  /// Expected magnitudes of all planes at once: most vectors around are zero.
  void expect(const Around& around) {
    std::fill(parents_.begin(), parents_.end(), 0u);
    std::fill(beside_.begin(), beside_.end(), 0u);
    for (std::size_t k = 0; k < kAround; ++k) {
      if (around.weight[k] == 0) continue;
      const std::int16_t* vector = kept_vector(around.row[k]);
      std::uint32_t* sums = k < kParents ? parents_.data() : beside_.data();
      for (std::size_t j = 0; j < width_; ++j)
        sums[j] += around.weight[k] * static_cast<std::uint32_t>(std::abs(int{vector[j]}));
    }
    if (!around.any_beside) beside_ = parents_;
  }

  template <class Coder>
  bool code_function(Coder& coder, const Around& around, std::size_t f, std::int32_t* values,
                     std::int16_t* own, Progress& progress) {
    MagnitudeEvidence evidence{};
    evidence.split = std::min(around.split, 24u);
    evidence.scale_class = around.scale_class;
    evidence.functions_before = functions_before(f, own);
    const bool known = progress.sum == 0 && f + 1 == functions_.size();  // the vector is not zero
    if (functions_.size() > 1 && !known &&
        !code_any(coder, around, f, evidence.functions_before, progress,
                  !Coder::kDecodes && (values[0] | values[1] | values[2]) != 0)) {
      for (std::uint32_t c = 0; c < 3; ++c) {
        std::int32_t& activity = states_->activity[3 * f + c];
        progress.activity += static_cast<std::uint32_t>(activity);
        activity -= (activity + 63) >> 6;
      }
      return true;
    }
    ++progress.recent;
    SignEvidence signs = signs_around(around, f, own);
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::size_t j = 3 * f + c;
      const auto activity = static_cast<std::uint32_t>(states_->activity[j]);
      evidence.channel = signs.channel = c;
      evidence.parents = parents_[j];
      evidence.beside = beside_[j];
      evidence.expected[c] = (parents_[j] + beside_[j]) / 2 + (activity >> 5);
      evidence.vector_ratio = log_class(
          (std::uint64_t{progress.sum} * 64 + 16) * activity / (progress.activity + 256), 47);
      evidence.first = progress.sum == 0;
      const bool nonzero =  // the function's vector is not all zero
          c == 2 && (evidence.magnitude[0] | evidence.magnitude[1]) == 0;
      const std::uint32_t magnitude = states_->magnitude.code(
          coder, evidence, nonzero,
          Coder::kDecodes ? 0 : static_cast<std::uint32_t>(std::abs(values[c])));
      if (magnitude == CoefficientMagnitudeModel::kDamaged) return false;
      const auto kept =
          static_cast<std::int32_t>(std::min(magnitude, static_cast<std::uint32_t>(kLargest)));
      evidence.magnitude[c] = static_cast<std::uint32_t>(kept);
      progress.sum += static_cast<std::uint32_t>(kept);
      progress.activity += activity;
      if (functions_.size() > 1)
        states_->activity[j] += (std::min(kept, 7) * 4096 - states_->activity[j]) >> 6;
      if (magnitude == 0) continue;
      const bool negative = states_->sign.code(coder, signs, !Coder::kDecodes && values[c] < 0);
      const auto size = static_cast<std::int32_t>(magnitude);
      if (Coder::kDecodes) values[c] = negative ? -size : size;
      own[j] = static_cast<std::int16_t>(negative ? -kept : kept);
    }
    return true;
  }

  /// Has a function of the vector a value other than 0?
  template <class Coder>
  bool code_any(Coder& coder, const Around& around, std::size_t f, std::uint32_t before,
                const Progress& progress, bool any) {
    const std::size_t j = 3 * f;
    const std::uint32_t up = parents_[j] + parents_[j + 1] + parents_[j + 2];
    const std::uint32_t side = beside_[j] + beside_[j + 1] + beside_[j + 2];
    const auto activity = static_cast<std::uint32_t>(
        states_->activity[j] + states_->activity[j + 1] + states_->activity[j + 2]);
    const std::uint32_t size = log_class(((up + side) / 2 + (activity >> 5)) >> 4, 47);
    const std::uint32_t ratio = log_class(
        (std::uint64_t{progress.sum} * 64 + 16) * activity / (progress.activity + 256), 55);
    const std::uint32_t act = log_class(activity >> 2, 47);
    const std::array<std::uint32_t, 5> contexts = {
        std::min(around.split, 24u) * 48 + act, size * 17 + before,
        log_class(up >> 4, 39) / 2 * 20 + log_class(side >> 4, 39) / 2, ratio * 24 + size / 2,
        act * 24 + around.scale_class};
    return states_->any.code(coder, contexts, before + (progress.sum == 0 ? 17 : 0), any) != 0;
  }

  /// Sizes of channel 0 of the two functions before.
  static std::uint32_t functions_before(std::size_t f, const std::int16_t* own) {
    const auto size = [&](std::size_t function, int most) {
      return static_cast<std::uint32_t>(std::min(std::abs(int{own[3 * function]}), most));
    };
    if (f == 0) return 16;
    return size(f - 1, 3) + 4 * (f == 1 ? 3 : size(f - 2, 2));
  }

  SignEvidence signs_around(const Around& around, std::size_t f, const std::int16_t* own) const {
    const auto at = [&](std::uint32_t row) { return kept_vector(row) + 3 * f; };
    return {own + 3 * f,
            at(around.row[0]),
            at(around.row[1]),
            at(around.same_axis),
            {at(around.row[3]), at(around.row[4]), at(around.row[5])},
            at(around.row[6]),
            around.axis,
            0};
  }

  const std::int16_t* kept_vector(std::uint32_t row) const {
    return &vectors_[vector_of_[row] * width_];
  }

  std::vector<std::uint16_t> functions_;
  std::size_t width_;                     // planes of the group
  std::vector<std::uint16_t> sum_;        // [P] of magnitudes, by place, 65535 for more
  std::vector<std::uint32_t> vector_of_;  // [P] by place: which of vectors_, 0: all zero
  std::vector<std::int16_t> vectors_;     // [..][width] values within +-kLargest; the first is zero
  // [width] expected magnitudes, 8 fractional bits: what is above the row, and beside it, implies.
  std::vector<std::uint32_t> parents_, beside_;
  std::vector<std::uint32_t> rest_;  // [runs] the same, of a run and those behind it
  std::vector<std::uint8_t> runs_;   // [P] runs of a row's vector up to its last value, at most 255
  std::vector<std::uint8_t> any_in_row_;  // [P] the encoder's
  StatesInUse<VectorStates> states_;
};

}  // namespace slf
