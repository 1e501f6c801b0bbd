// Mirror of codec/slice_decoder.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/coefficient_decoder.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "slf/encoder.h"

namespace slf {

/// A cube of the octree with few enough points, and its points in the sorted light field.
struct SliceCut {
  SliceHeader header;
  std::size_t begin = 0, end = 0;
};

/// Cuts sorted, distinct codes into cubes: the smallest that holds all, or, where it holds more
/// than max_points, its children's.
std::vector<SliceCut> cut_slices(std::span<const std::uint64_t> morton, int grid_bits,
                                 std::uint32_t max_points);

/// The integers of one slice.
struct SliceInput {
  std::span<const std::uint64_t> morton;  ///< on the grid
  std::span<const Voxel> positions;
  std::span<std::int32_t> components;  ///< [P][3 R]; used up: holds quantised coefficients after
  std::span<const std::array<std::uint16_t, 2>> normals;
};

/// What all slices share.
struct SliceCoding {
  const SequenceParameterSet& set;
  PlaneGroups groups;                ///< places of components
  std::vector<std::uint32_t> steps;  ///< [3 R]
  bool digest = true;
  TextureSettings texture;
  double rdo = 0;  ///< CodingParameters
};

/// A unit ready to be written.
struct CodedUnit {
  UnitType type{};
  std::vector<std::uint8_t> payload;
};

/// The units of a slice in stream order.
/// @errors kInvalidArgument: a component too large to transform. kUnsupported: no Draco in this
/// build.
Result<std::vector<CodedUnit>, InputError> encode_slice(const SliceCut& cut, SliceInput input,
                                                        const SliceCoding& coding, int threads);

}  // namespace slf
