// SPDX-License-Identifier: Apache-2.0
// Coefficients of one plane group, a vector per node: is it all zero, then every value. Each
// decision is predicted from the vectors around it. Written once for decoder and encoder. Spec
// 8.7.2. A finer layer is coded alike, without the decisions that the layers before answer: 8.7.7.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "attributes/coefficient_layout.h"
#include "attributes/kept_vectors.h"
#include "attributes/known_values.h"
#include "attributes/states_in_use.h"
#include "attributes/vector_expectation.h"
#include "attributes/vector_states.h"
#include "attributes/vector_surroundings.h"
#include "base/multiversion.h"
#include "base/prefetch.h"
#include "entropy/log_class.h"

namespace slf {

class VectorCoefficients {
 public:
  /// functions: the group's, ascending. refines: units hold one bit more of values that are there.
  VectorCoefficients(std::vector<std::uint16_t> functions, std::size_t num_points,
                     bool refines = false)
      : functions_(std::move(functions)),
        known_(refines),
        width_(3 * functions_.size()),
        kept_(width_, num_points),
        expected_(width_) {}

  /// Codes rows order[begin .. end). `lower`: the group before this one, or nullptr.
  /// A refinement replaces the decoder's values, those of the layers before, by 2 v or 2 v +- 1;
  /// the encoder gives the values after. Returns false where the decoder met a value no encoder
  /// writes.
  template <class Coder>
  SLF_OWN_CALL bool code(Coder& coder, const CoefficientRows& rows,
                         const CoefficientNeighbours& neighbours, const VectorCoefficients* lower,
                         std::size_t begin, std::size_t end) {
    states_.begin(functions_.size());
    if (reference_.is_known()) states_->add_reference();
    if constexpr (!Coder::kDecodes) find_rows(rows);
    for (std::size_t i = begin; i < end; ++i) {
      if constexpr (Coder::kDecodes)
        if (coder.exhausted()) return false;
      const std::uint32_t row = rows.tree.order[i];
      const Around around = around_of(neighbours.rows, kept_, i);
      there_ = reference_.row(row, neighbours.rows[i].split);
      const std::uint32_t below =
          lower != nullptr
              ? log_class(lower->kept_.sum(static_cast<std::uint32_t>(i)), Node::Expected::kMost<1>)
              : 0;
      const bool any = !Coder::kDecodes && any_in_row_[row] != 0;
      if (known_.refines() && i + kRowsAhead < end)
        prefetch(rows.row(rows.tree.order[i + kRowsAhead]) + 3u * functions_.front());
      const std::size_t known = known_.end<Coder>(rows.row(row), functions_);
      if (known == 0 && !code_node(coder, around, below, any)) continue;
      rows.set_nonzero(row);
      if (!code_vector(coder, around, known, i, rows.row(row))) return false;
    }
    return true;
  }

  const std::vector<std::uint16_t>& functions() const { return functions_; }
  StatesInUse<VectorStates>& states() { return states_; }
  /// Before a unit of a frame that is predicted.
  void predict_from(const GroupReference& reference) { reference_ = reference; }

  /// Keeps for place `here` what `base` keeps for its place `there`; here is not coded. Spec 8.7.2.
  void adopt(const VectorCoefficients& base, std::uint32_t there, std::uint32_t here) {
    kept_.adopt(base.kept_, there, here);
  }

 private:
  using Node = VectorStates::Node;
  using Rest = VectorStates::Rest;
  using Any = VectorStates::Any;
  static constexpr std::size_t kRun = VectorExpectation::kRun;
  static constexpr std::size_t kRowsAhead = 8;  // asked for before they are needed
  static constexpr std::int32_t kLargest = KeptVectors::kLargest;

  /// What the values of a vector so far add up to.
  struct Progress {
    std::uint32_t sum = 0;       // of magnitudes
    std::uint64_t activity = 0;  // of their planes
    std::uint32_t recent = 0;    // functions of the run that are not zero
  };

  /// Which rows have a vector, for the encoder: asked for in the order of memory.
  void find_rows(const CoefficientRows& rows) {
    if (!any_in_row_.empty()) return;
    any_in_row_.resize(rows.tree.size());
    for (std::size_t row = 0; row < any_in_row_.size(); ++row)
      any_in_row_[row] = has_any(rows.row(row), functions_);
  }

  template <class Coder>
  SLF_OWN_CALL bool code_node(Coder& coder, const Around& around, std::uint32_t below, bool any) {
    std::uint32_t parents = 0, beside = 0;
    std::array<std::uint32_t, Around::kRows> size;
    for (std::size_t k = 0; k < Around::kRows; ++k) {
      const std::uint32_t sum = kept_.sum(around.row[k]);
      (k < Around::kParents ? parents : beside) +=
          around.weight[k] * std::min<std::uint32_t>(sum, kLargest);
      size[k] = std::min<std::uint32_t>(sum, Node::Above::kMost<0>);
    }
    const std::uint32_t expected = (parents + (around.any_beside ? beside : parents)) / 2;
    const std::uint32_t size_class = log_class(expected >> 4, Node::Expected::kMost<0>);
    const std::array<std::uint32_t, 3> contexts = {
        Node::Expected::index(size_class, below),
        Node::Above::index(size[0], size[1], size[2], size[6], around.axis),
        Node::Beside::index(size[3], size[4], size[5], around.axis,
                            std::min(below, Node::Beside::kMost<4>))};
    if (!there_.is_known()) return states_->node.code(coder, contexts, around.split, any) != 0;
    ContextBit& there = states_->reference->node[there_.node(functions_, size_class)];
    return states_->node.code(coder, states_->node.with(contexts, there), 0, around.split, any) !=
           0;
  }

  template <class Coder>
  SLF_OWN_CALL bool code_vector(Coder& coder, const Around& around, std::size_t known,
                                std::size_t i, std::int32_t* values) {
    prefetch(values + 3u * functions_.front());
    std::int16_t* const own = kept_.add();
    const VectorsAround vectors = vectors_around(around, kept_);
    expected_.expect(around, vectors, states_->activity);
    Progress progress;
    std::size_t last = 0;  // function that is not zero
    std::size_t end =
        functions_.size();  // behind the last function that is not zero: the encoder's
    if constexpr (!Coder::kDecodes)
      while (end > 1 && is_zero(values + 3u * functions_[end - 1])) --end;
    for (std::size_t f = 0; f < functions_.size(); ++f) {
      if (f > 0 && f % kRun == 0 && f >= known && progress.sum > 0 &&
          !code_rest(coder, around, f, progress, end > f)) {
        leave(3 * f);
        break;
      }
      if (f % kRun == 0) progress.recent = 0;
      if (!code_function(coder, around, vectors, f, values + 3u * functions_[f], own, progress))
        return false;
      if (!is_zero_kept(own + 3 * f)) last = f;
    }
    if (i == 0) return true;  // the mean of all says nothing of differences
    kept_.keep(i, progress.sum, (last + kRun) / kRun);
    return true;
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

  /// Has the vector a value other than 0 from function f on?
  template <class Coder>
  bool code_rest(Coder& coder, const Around& around, std::size_t f, const Progress& progress,
                 bool any) {
    const auto run = std::min(static_cast<std::uint32_t>(f / kRun), Rest::Run::kMost<0>);
    const auto ahead = [&](std::size_t k) {  // how far on a vector around goes
      const std::uint32_t there = kept_.runs(around.row[k]);
      return there <= run ? 0u : std::min(there - run, Rest::Run::kMost<2>);
    };
    const std::uint32_t size = log_class(expected_.rest(f / kRun) >> 4, Rest::Expected::kMost<1>);
    const std::array<std::uint32_t, 3> contexts = {
        Rest::Expected::index(run, size),
        Rest::Before::index(log_class(progress.sum, Rest::Before::kMost<0>), progress.recent,
                            size / 4),
        Rest::Run::index(run, progress.recent, ahead(0), ahead(6))};
    return states_->rest.code(coder, contexts, run, any) != 0;
  }

  template <class Coder>
  bool code_function(Coder& coder, const Around& around, const VectorsAround& vectors,
                     std::size_t f, std::int32_t* values, std::int16_t* own, Progress& progress) {
    MagnitudeEvidence evidence{};
    evidence.functions_before = functions_before(f, own);
    const std::int32_t* const before = known_.of(values);
    const bool known =  // the vector is not zero
        (progress.sum == 0 && f + 1 == functions_.size()) || KnownValues::any<Coder>(before);
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
    SignEvidence signs = signs_around(around.axis, vectors, f, own);
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::size_t j = 3 * f + c;
      const auto activity = static_cast<std::uint32_t>(states_->activity[j]);
      evidence.channel = signs.channel = c;
      evidence.expected[c] = expected_.both(j) + (activity >> 5);
      evidence.vector_ratio = log_class(
          (std::uint64_t{progress.sum} * 64 + 16) * activity / (progress.activity + 256), 47);
      evidence.first = progress.sum == 0;
      if (there_.is_known())
        evidence.there = &states_->reference->more[there_.magnitude(
            3u * functions_[f] + c, log_class(evidence.expected[c] >> 4, 47))];
      const bool nonzero =  // the function's vector is not all zero
          c == 2 && (evidence.magnitude[0] | evidence.magnitude[1]) == 0;
      const std::int32_t by_layers = KnownValues::value<Coder>(before[c]);
      const std::uint32_t magnitude =
          code_magnitude(coder, evidence, nonzero, by_layers, values[c]);
      if (magnitude == CoefficientMagnitudeModel::kDamaged) return false;
      const auto kept =
          static_cast<std::int32_t>(std::min(magnitude, static_cast<std::uint32_t>(kLargest)));
      evidence.magnitude[c] = static_cast<std::uint32_t>(kept);
      progress.sum += static_cast<std::uint32_t>(kept);
      progress.activity += activity;
      if (functions_.size() > 1)
        states_->activity[j] += (std::min(kept, 7) * 4096 - states_->activity[j]) >> 6;
      if (magnitude == 0) continue;
      const bool negative =
          by_layers != 0 ? by_layers < 0
                         : states_->sign.code(coder, signs, !Coder::kDecodes && values[c] < 0);
      const std::int32_t factor = 1 - 2 * negative;  // no branch: signs are hard to foresee
      if (Coder::kDecodes) values[c] = factor * static_cast<std::int32_t>(magnitude);
      own[j] = static_cast<std::int16_t>(factor * kept);
    }
    return true;
  }

  /// nonzero: the value is known to be. known: what it is by the layers before
  template <class Coder>
  std::uint32_t code_magnitude(Coder& coder, const MagnitudeEvidence& evidence, bool nonzero,
                               std::int32_t known, std::int32_t value) {
    const auto whole = static_cast<std::uint32_t>(Coder::kDecodes ? 0 : std::abs(value));
    if (!known_.refines()) return states_->magnitude.code(coder, evidence, nonzero, whole);
    if (std::abs(known) >= kRefinedLimit) return CoefficientMagnitudeModel::kDamaged;
    return states_->magnitude.refine(coder, evidence, nonzero,
                                     static_cast<std::uint32_t>(std::abs(known)), whole);
  }

  /// Has a function of the vector a value other than 0?
  template <class Coder>
  bool code_any(Coder& coder, const Around& around, std::size_t f, std::uint32_t before,
                const Progress& progress, bool any) {
    const std::size_t j = 3 * f;
    const std::uint32_t up =
        expected_.parents(j) + expected_.parents(j + 1) + expected_.parents(j + 2);
    const std::uint32_t side =
        expected_.beside(j) + expected_.beside(j + 1) + expected_.beside(j + 2);
    const auto activity = static_cast<std::uint32_t>(
        states_->activity[j] + states_->activity[j + 1] + states_->activity[j + 2]);
    const std::uint32_t size =
        log_class(((up + side) / 2 + (activity >> 5)) >> 4, 2 * Any::Ratio::kMost<1> + 1);
    const std::uint32_t ratio =
        log_class((std::uint64_t{progress.sum} * 64 + 16) * activity / (progress.activity + 256),
                  Any::Ratio::kMost<0>);
    const std::uint32_t act = log_class(activity >> 2, Any::Scale::kMost<0>);
    const std::array<std::uint32_t, 3> contexts = {
        Any::Sides::index(log_class(up >> 4, 39) / 2, log_class(side >> 4, 39) / 2),
        Any::Ratio::index(ratio, size / 2), Any::Scale::index(act, around.scale_class)};
    const std::uint32_t set = Any::Set::index(progress.sum == 0, before);
    return states_->any.code(coder, contexts, set, any) != 0;
  }

  static SignEvidence signs_around(std::uint32_t axis, const VectorsAround& vectors, std::size_t f,
                                   const std::int16_t* own) {
    const auto at = [f](const std::int16_t* vector) { return vector + 3 * f; };
    const auto& of = vectors.of;
    return {
        at(own),   at(of[0]), at(of[1]), at(vectors.same_axis), {at(of[3]), at(of[4]), at(of[5])},
        at(of[6]), axis,      0};
  }

  std::vector<std::uint16_t> functions_;
  KnownValues known_;
  std::size_t width_;  // planes of the group
  KeptVectors kept_;
  VectorExpectation expected_;
  std::vector<std::uint8_t> any_in_row_;  // [P] the encoder's
  StatesInUse<VectorStates> states_;
  GroupReference reference_;
  ReferenceRow there_;  // of the row at work
};

}  // namespace slf
