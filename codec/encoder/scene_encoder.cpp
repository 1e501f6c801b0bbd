// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/scene_encoder.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>

#include "codec/encoder/assemble.h"
#include "slf/parallel.h"

namespace slf {
namespace {

class SceneEncoder {
 public:
  SceneEncoder(const SliceCoding& coding, const SceneLayout& layout,
               std::span<const SliceInput> slices, int threads)
      : coding_(coding),
        layout_(layout),
        threads_(threads),
        units_(layout_of(coding.set)),
        lead_(slots_of(units_, Owner::kSlice).size()),
        coded_(slices.size()) {
    StatesOfSlice0* lead = layout.table.shared() ? &lead_ : nullptr;
    for (std::size_t s = 0; s < slices.size(); ++s)
      slices_.push_back({coding, layout, slots_of(units_, Owner::kSlice), s, slices[s], lead});
  }

  Result<CodedUnits, InputError> encode() {
    SLF_TRY(EncodedBase base, encode_base_geometry(coding_, layout_));  // 8.4
    const EncodedBase* start = layout_.table.apart() ? nullptr : &base;
    std::vector<std::int32_t> base_input(
        layout_.base_levels > 0 ? layout_.cells.size() * coding_.planes() : 0);
    std::vector<SliceTree> trees(slices_.size());
    SLF_CHECK(for_each_slice([&](const SliceToEncode& slice, std::size_t s) -> Step {
      const CloseAtEnd<OccupancyStates> close{lead_.geometry, s == 0};
      SLF_TRY(coded_[s], encode_slice_geometry(slice, start));                 // 8.4, 8.5, 8.10
      SLF_TRY(trees[s], transform_slice(slice, base_input, slice_threads()));  // 8.6, 8.8
      return Done{};
    }));
    SLF_CHECK(encode_base_components(coding_, layout_, std::move(base_input), threads_,
                                     base));  // 8.6 - 8.8
    SLF_CHECK(for_each_slice([&](const SliceToEncode& slice, std::size_t s) -> Step {
      const CloseAtEnd<CoefficientStates> close{lead_.coefficients, s == 0};
      SLF_TRY(CodedUnits values, encode_slice_values(slice, std::move(trees[s]), start,
                                                     slice_threads()));  // 8.7, 7.9
      std::move(values.begin(), values.end(), std::back_inserter(coded_[s]));
      return Done{};
    }));
    append_slices(std::move(coded_), base.units);  // 7.1
    return std::move(base.units);
  }

 private:
  using Step = Result<Done, InputError>;

  int slice_threads() const { return slices_.size() > 1 ? 1 : threads_; }

  /// The error, if there is one, is that of the first slice.
  Step for_each_slice(const std::function<Step(const SliceToEncode&, std::size_t)>& step) {
    std::vector<std::optional<InputError>> errors(slices_.size());
    parallel_ranges(slices_.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s)
        if (auto done = step(slices_[s], s); !done) errors[s] = done.error();
    });
    for (const auto& error : errors)
      if (error) return *error;
    return Done{};
  }

  const SliceCoding& coding_;
  const SceneLayout& layout_;
  int threads_;
  UnitLayout units_;
  StatesOfSlice0 lead_;
  std::vector<SliceToEncode> slices_;
  std::vector<CodedUnits> coded_;  // [slices]
};

}  // namespace

Result<CodedUnits, InputError> encode_scene(const SliceCoding& coding, const SceneLayout& layout,
                                            std::span<const SliceInput> slices, int threads) {
  return SceneEncoder(coding, layout, slices, threads).encode();
}

}  // namespace slf
