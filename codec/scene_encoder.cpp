#include "codec/scene_encoder.h"

#include <algorithm>
#include <functional>
#include <optional>

#include "codec/scene_units.h"
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
        lead_(PartList(coding.set, false).size()) {
    SliceLead* lead = layout.table.shared() ? &lead_ : nullptr;
    for (std::size_t s = 0; s < slices.size(); ++s)
      slices_.emplace_back(coding, layout, s, slices[s], lead);
  }

  Result<std::vector<CodedUnit>, InputError> encode() {
    EncodedBase base = encode_base_geometry(coding_, layout_);  // 8.4
    std::vector<std::int32_t> base_input(
        layout_.base_levels > 0 ? layout_.cells.size() * coding_.planes() : 0);
    SLF_CHECK(for_each_slice([&](SliceEncoder& slice, std::size_t s) -> Step {
      const CloseAtEnd<OccupancyStates> close{lead_.geometry, s == 0};
      SLF_CHECK(slice.encode_geometry(start_of_slices(base)));  // 8.4, 8.5
      slice.encode_normals();                                   // 8.10
      return slice.transform(base_input, slice_threads());
    }));
    encode_base_components(coding_, layout_, std::move(base_input), threads_, base);  // 8.6 - 8.8
    SLF_CHECK(for_each_slice([&](SliceEncoder& slice, std::size_t s) -> Step {
      const CloseAtEnd<CoefficientStates> close{lead_.coefficients, s == 0};
      SLF_CHECK(slice.encode_components(start_of_slices(base), slice_threads()));  // 8.6 - 8.8
      slice.encode_digest();                                                       // 7.9
      return Done{};
    }));
    return in_order(std::move(base.units));
  }

 private:
  using Step = Result<Done, InputError>;

  const EncodedBase* start_of_slices(const EncodedBase& base) const {
    return layout_.table.apart() ? nullptr : &base;
  }

  int slice_threads() const { return slices_.size() > 1 ? 1 : threads_; }

  /// The error, if there is one, is that of the first slice.
  Step for_each_slice(const std::function<Step(SliceEncoder&, std::size_t)>& step) {
    std::vector<std::optional<InputError>> errors(slices_.size());
    parallel_ranges(slices_.size(), 1, threads_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s)
        if (auto done = step(slices_[s], s); !done) errors[s] = done.error();
    });
    for (const auto& error : errors)
      if (error) return *error;
    return Done{};
  }

  /// Spec 7.1. Unit by unit of a slice, all slices.
  std::vector<CodedUnit> in_order(std::vector<CodedUnit> units) {
    std::vector<std::vector<CodedUnit>> of_slice;
    for (SliceEncoder& slice : slices_) of_slice.push_back(slice.take_units());
    for (std::size_t place = 0; place < of_slice.front().size(); ++place)
      for (auto& slice : of_slice) units.push_back(std::move(slice[place]));
    return units;
  }

  const SliceCoding& coding_;
  const SceneLayout& layout_;
  int threads_;
  SliceLead lead_;
  std::vector<SliceEncoder> slices_;
};

}  // namespace

Result<std::vector<CodedUnit>, InputError> encode_scene(const SliceCoding& coding,
                                                        const SceneLayout& layout,
                                                        std::span<const SliceInput> slices,
                                                        int threads) {
  return SceneEncoder(coding, layout, slices, threads).encode();
}

}  // namespace slf
