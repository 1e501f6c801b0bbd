// SPDX-License-Identifier: Apache-2.0
// Mirror of codec/decoder/slice_decoder.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/encoder/base_encoder.h"
#include "codec/encoder/coded_unit.h"
#include "codec/encoder/scene_layout.h"
#include "codec/states_of_slice0.h"

namespace slf {

/// The integers of one slice.
struct SliceInput {
  std::span<const std::uint64_t> morton;  ///< on the grid
  std::span<const Voxel> positions;
  std::span<std::int32_t> components;  ///< [P][3 R]; used up: holds quantised coefficients after
  std::span<const std::array<std::uint16_t, 2>> normals;
};

/// What the steps of a slice read. They change its components alone.
struct SliceToEncode {
  const SliceCoding& coding;
  const SceneLayout& layout;
  std::span<const UnitSlot> slots;  ///< of a slice
  std::size_t slice;  ///< its slice_id; layout.first_slice is the first of those laid out
  SliceInput input;
  StatesOfSlice0* lead;  ///< of slices that share states, else nullptr

  std::uint32_t slice_id() const { return static_cast<std::uint32_t>(slice); }
  bool leads() const { return lead != nullptr && slice == 0; }
  bool follows() const { return lead != nullptr && slice != 0; }
};

/// The transform of a slice, with which its coefficients are coded.
struct SliceTree {
  RahtTree tree;
  std::vector<std::uint32_t> first;  ///< [rows + 1] every row is a point
  SliceCells cells;                  ///< where there is a base
};

using CodedUnits = std::vector<CodedUnit>;

/// The units of geometry and normals.
/// @param base   its geometry is coded; nullptr where slices are apart
/// @errors kUnsupported: no Draco in this build.
Result<CodedUnits, InputError> encode_slice_geometry(const SliceToEncode& slice,
                                                     const EncodedBase* base);

/// Components to coefficients, down to the cells, whose values go to the input of the base.
/// @errors kInvalidArgument: a component too large to transform.
Result<SliceTree, InputError> transform_slice(const SliceToEncode& slice,
                                              std::span<std::int32_t> base_input, int threads);

/// The units of coefficients and refinements, and the digest.
/// @param base  all of it is coded; nullptr where slices are apart
/// @errors those of textures
Result<CodedUnits, InputError> encode_slice_values(const SliceToEncode& slice, SliceTree tree,
                                                   const EncodedBase* base, int threads);

/// 8.11, of a slice whose planes are pictures: its components become what a decoder gets, where
/// coding.digest asks for it. In slice_texture_encoder.cpp.
/// @errors kInvalidArgument: values too large; an atlas larger than 8192. kUnsupported: x265, or
///         libde265 for the digest, is not part of this build.
Result<CodedUnits, InputError> encode_slice_texture(const SliceToEncode& slice, int threads);

}  // namespace slf
