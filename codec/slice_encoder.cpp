#include "codec/slice_encoder.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "attributes/coefficient_quantiser.h"
#include "attributes/normal_model.h"
#include "attributes/quantiser.h"
#include "attributes/raht_forward.h"
#include "attributes/raht_tree.h"
#include "codec/sequence.h"
#include "codec/slice_decoder.h"
#include "codec/slice_digest.h"
#include "codec/slice_texture_encoder.h"
#include "entropy/range_encoder.h"
#include "geometry/draco_encoder.h"
#include "geometry/morton.h"
#include "geometry/octree_encoder.h"

namespace slf {
namespace {

void cut_cube(std::span<const std::uint64_t> morton, std::size_t begin, std::size_t end, int depth,
              std::uint32_t max_points, std::vector<SliceCut>& cuts) {
  if (begin == end) return;
  if (end - begin > max_points && depth > 0) {
    const int below = 3 * (depth - 1);
    for (std::size_t first = begin; first < end;) {
      const auto next = std::upper_bound(morton.begin() + static_cast<std::ptrdiff_t>(first),
                                         morton.begin() + static_cast<std::ptrdiff_t>(end),
                                         morton[first] | ((std::uint64_t{1} << below) - 1));
      const auto last = static_cast<std::size_t>(next - morton.begin());
      cut_cube(morton, first, last, depth - 1, max_points, cuts);
      first = last;
    }
    return;
  }
  // The smallest cube around these points.
  const int depth_needed =
      (static_cast<int>(std::bit_width(morton[begin] ^ morton[end - 1])) + 2) / 3;
  const Voxel cell = from_morton(morton[begin] >> (3 * depth_needed));
  SliceCut cut{{}, begin, end};
  cut.header.slice_id = static_cast<std::uint32_t>(cuts.size());
  cut.header.slice_num_points_minus1 = static_cast<std::uint32_t>(end - begin - 1);
  cut.header.slice_depth = static_cast<std::uint32_t>(depth_needed);
  for (std::size_t axis = 0; axis < 3; ++axis)
    cut.header.slice_cell[axis] = static_cast<std::uint32_t>(cell[axis]);
  cuts.push_back(cut);
}

std::vector<std::uint8_t> slice_unit_payload(const SliceUnitHeader& header, bool has_range,
                                             bool has_group, const SequenceParameterSet& set,
                                             std::span<const std::uint8_t> body) {
  BitWriter out;
  WriteSyntax write{out};
  slice_unit_header(write, header, has_range, has_group, set);
  out.append(body);
  return out.take();
}

Result<Done, InputError> code_geometry(const SliceCut& cut, const SliceInput& input,
                                       std::span<const std::uint64_t> local,
                                       const SequenceParameterSet& set,
                                       std::vector<CodedUnit>& units) {
  const int depth = static_cast<int>(cut.header.slice_depth);
  std::vector<std::vector<std::uint8_t>> payloads;
  if (set.sps_geometry_coder == 0) {
    std::vector<int> ends;
    for (std::uint32_t r = 0; r <= set.sps_num_geometry_ranges_minus1; ++r)
      ends.push_back(slice_level(range_end(set.sps_geometry_range_end, r, set.grid_bits()),
                                 set.grid_bits(), cut.header.slice_depth));
    payloads = encode_octree(local, depth, ends);
  } else {
    std::vector<Voxel> voxels(input.positions.begin(), input.positions.end());
    for (Voxel& v : voxels)
      for (auto& coordinate : v) coordinate &= (1 << depth) - 1;
    auto draco = encode_draco(voxels);
    if (!draco)
      return InputError{Errc::kUnsupported,
                        "geometry coder draco: Draco failed, or is not part of this build"};
    payloads.push_back(std::move(*draco));
  }
  for (std::uint32_t r = 0; r < payloads.size(); ++r)
    units.push_back({UnitType::kGeometry, slice_unit_payload({cut.header.slice_id, r, 0, {}}, true,
                                                             false, set, payloads[r])});
  return Done{};
}

void code_normals(const SliceCut& cut, const SliceInput& input, const SequenceParameterSet& set,
                  std::vector<CodedUnit>& units) {
  RangeEncoder encoder;
  NormalModel model(static_cast<int>(set.sps_normal_bits));
  for (auto normal : input.normals) model.code(encoder, normal);
  units.push_back({UnitType::kNormals, slice_unit_payload({cut.header.slice_id, 0, 0, {}}, false,
                                                          false, set, encoder.finish())});
}

/// sqrt(P) times the largest component is what the mean of all could reach. Spec 8.8.2.
bool fits_transform(const SliceInput& input) {
  std::int64_t largest = 0;
  for (const std::int32_t value : input.components)
    largest = std::max(largest, std::abs(std::int64_t{value}));
  const auto root = static_cast<std::int64_t>(isqrt(input.morton.size())) + 1;
  return largest < kCoefficientLimit && largest * root < kCoefficientLimit;
}

/// cu_prediction of the levels of a range; those above the slice's cube are 0.
std::vector<std::uint32_t> modes_of_range(const SequenceParameterSet& set, const SliceHeader& slice,
                                          std::uint32_t range,
                                          const std::vector<std::uint8_t>& modes) {
  std::vector<std::uint32_t> coded(set.coefficient_levels(range), 0);
  const std::uint32_t end = range_end(set.sps_coefficient_range_end, range, set.grid_bits());
  for (std::size_t i = 0; i < coded.size(); ++i) {
    const std::size_t level = end - coded.size() + i, above = set.grid_bits() - slice.slice_depth;
    if (level >= above) coded[i] = modes[level - above];
  }
  return coded;
}

/// Returns the components that a decoder will get.
std::vector<std::int32_t> code_components(const SliceCut& cut, const SliceInput& input,
                                          std::span<const std::uint64_t> morton,
                                          const RahtTree& tree, const SliceCoding& coding,
                                          int threads, std::vector<CodedUnit>& units) {
  const SequenceParameterSet& set = coding.set;
  const std::size_t planes = coding.steps.size();
  raht_forward(tree, static_cast<int>(planes), input.components, threads);
  Quantised quantised =
      quantise_coefficients({tree, morton, static_cast<int>(cut.header.slice_depth), coding.groups,
                             coding.steps, set.sps_prediction_flag != 0, coding.rdo},
                            input.components, threads);
  std::vector<std::uint32_t> first(tree.size() + 1);  // every row is a point
  std::iota(first.begin(), first.end(), 0u);
  CoefficientModels models(coding.groups, tree, morton, first, set.sps_coefficient_coder == 0);
  const CoefficientRows rows{tree, input.components, planes};
  std::size_t begin = 0;
  for (std::uint32_t r = 0; r <= set.sps_num_coefficient_ranges_minus1; ++r) {
    const int level = slice_level(range_end(set.sps_coefficient_range_end, r, set.grid_bits()),
                                  set.grid_bits(), cut.header.slice_depth);
    const std::size_t end = order_end(tree, 3 * (static_cast<int>(cut.header.slice_depth) - level));
    for (std::uint32_t g = 0; g < coding.groups.size(); ++g) {
      RangeEncoder encoder;
      models.code(encoder, rows, g, begin, end);
      const SliceUnitHeader header{cut.header.slice_id, r, g,
                                   modes_of_range(set, cut.header, r, quantised.modes[g])};
      units.push_back(
          {UnitType::kCoefficients, slice_unit_payload(header, true, true, set, encoder.finish())});
    }
    begin = end;
  }
  return std::move(quantised.values);
}

}  // namespace

std::vector<SliceCut> cut_slices(std::span<const std::uint64_t> morton, int grid_bits,
                                 std::uint32_t max_points) {
  std::vector<SliceCut> cuts;
  cut_cube(morton, 0, morton.size(), grid_bits, max_points, cuts);
  return cuts;
}

Result<std::vector<CodedUnit>, InputError> encode_slice(const SliceCut& cut, SliceInput input,
                                                        const SliceCoding& coding, int threads) {
  std::vector<CodedUnit> units;
  units.push_back({UnitType::kSlice, write_slice_header(cut.header, coding.set.grid_bits())});
  const std::uint64_t inside = (std::uint64_t{1} << (3 * cut.header.slice_depth)) - 1;
  std::vector<std::uint64_t> local(input.morton.begin(), input.morton.end());
  for (auto& code : local) code &= inside;
  SLF_CHECK(code_geometry(cut, input, local, coding.set, units));
  if (coding.set.sps_normal_bits > 0) code_normals(cut, input, coding.set, units);
  std::vector<std::int32_t> decoded;
  if (coding.set.has_texture()) {
    SLF_TRY(const auto payloads, encode_slice_texture(cut, input, local, coding, threads));
    for (std::uint32_t g = 0; g < payloads.size(); ++g)
      units.push_back(
          {UnitType::kCoefficients, slice_unit_payload({cut.header.slice_id, 0, g, {}}, true, true,
                                                       coding.set, payloads[g])});
  } else if (!coding.steps.empty()) {
    if (!fits_transform(input))
      return InputError{
          Errc::kInvalidArgument,
          "components: the largest, times the root of the number of points, reaches 2^27"};
    decoded = code_components(cut, input, local, build_raht_tree(local), coding, threads, units);
  }
  if (coding.digest) {
    const auto digest = slice_digest(
        input.positions,
        decoded.empty() ? std::span<const std::int32_t>(input.components) : decoded, input.normals);
    units.push_back({UnitType::kDigest, slice_unit_payload({cut.header.slice_id, 0, 0, {}}, false,
                                                           false, coding.set, digest)});
  }
  return units;
}

}  // namespace slf
