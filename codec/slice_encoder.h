// Mirror of codec/slice_decoder.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/base_encoder.h"
#include "codec/coded_unit.h"
#include "codec/scene_layout.h"
#include "codec/slice_lead.h"

namespace slf {

/// The integers of one slice.
struct SliceInput {
  std::span<const std::uint64_t> morton;  ///< on the grid
  std::span<const Voxel> positions;
  std::span<std::int32_t> components;  ///< [P][3 R]; used up: holds quantised coefficients after
  std::span<const std::array<std::uint16_t, 2>> normals;
};

/// A slice on its way. Steps are called in the order of the members below.
class SliceEncoder {
 public:
  /// @param slice  its slice_id; layout.first_slice is the first of those laid out
  /// @param lead   of slices that share states, else nullptr
  SliceEncoder(const SliceCoding& coding, const SceneLayout& layout, std::size_t slice,
               const SliceInput& input, SliceLead* lead);

  /// @param base   its geometry is coded; nullptr where slices are apart
  /// @errors kUnsupported: no Draco in this build.
  Result<Done, InputError> encode_geometry(const EncodedBase* base);
  void encode_normals();
  /// Components to coefficients, down to the cells, whose values go to the input of the base.
  /// @errors kInvalidArgument: a component too large to transform.
  Result<Done, InputError> transform(std::span<std::int32_t> base_input, int threads);
  /// @param base  all of it is coded; nullptr where slices are apart
  /// @errors those of textures
  Result<Done, InputError> encode_components(const EncodedBase* base, int threads);
  void encode_digest();

  /// In the order of a slice's units.
  std::vector<CodedUnit> take_units() { return std::move(units_); }

 private:
  std::uint32_t slice_id() const { return static_cast<std::uint32_t>(slice_); }
  bool leads() const { return lead_ != nullptr && slice_ == 0; }
  bool follows() const { return lead_ != nullptr && slice_ != 0; }
  void add(UnitType type, std::uint32_t range, std::uint32_t group,
           std::span<const std::uint8_t> body);
  void encode_octree(OccupancyStates states);
  Result<Done, InputError> encode_texture(int threads);
  Quantised quantise(const EncodedBase* base, int threads);
  void encode_coefficients(const EncodedBase* base, const Quantised& quantised);

  const SliceCoding* coding_;
  const SceneLayout* layout_;
  std::size_t slice_;
  SliceInput input_;
  SliceLead* lead_;
  RahtTree tree_;
  std::vector<std::uint32_t> first_;   // [rows + 1] every row is a point
  SliceCells cells_;                   // where there is a base
  std::vector<std::int32_t> decoded_;  // components as a decoder gets them
  std::vector<CodedUnit> units_;
};

}  // namespace slf
