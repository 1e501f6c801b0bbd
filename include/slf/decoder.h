// SPDX-License-Identifier: Apache-2.0
// Decoding: bytes to the integer light field. Links without the encoder (target slf::decoder).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slf/error.h"
#include "slf/limits.h"
#include "slf/types.h"

namespace slf {

/// Where the time went, by stage; of all threads together.
struct DecodeSeconds {
  double geometry = 0;      ///< units, occupancy, positions, what is derived from them
  double coefficients = 0;  ///< components, normals, the check of the digests
};

/// Voxels of the whole grid from low to high, both included.
struct VoxelBox {
  Voxel low{0, 0, 0}, high{0, 0, 0};
};

struct DecodeOptions {
  DecodeLimits limits;
  int levels = 0;  ///< octree levels to keep, 1 .. grid bits; 0: all. Fewer give a coarser grid,
                   ///< each node with the mean of its points
  int groups = 0;  ///< plane groups to decode, 1 .. number of groups; 0: all. Others count as zero
  bool means_only = false;  ///< only the groups that mean_colours() needs: the result is good for
                            ///< mean colours alone. It does not set `partial`
  int layers = 0;  ///< quality layers to decode, 1 .. those of the group that has most; 0: all.
                   ///< Values that are not refined to the end stand for what they may be
  std::uint64_t max_bytes = 0;       ///< use only units that end within the first max_bytes; 0: all
  std::optional<VoxelBox> region;    ///< only points whose voxel, of the levels asked for, meets it
  int threads = 1;                   ///< 0: all cores. The result does not depend on it
  DecodeSeconds* seconds = nullptr;  ///< filled where given
  /// Called before every unit, by one thread at a time, which need not be the caller's: 0 .. 1 of
  /// the bytes to decode. False ends the decode with kCancelled.
  std::function<bool(double fraction)> progress = {};
};

/// Decodes one SLF sequence held in memory. Of a stream of frames it is the first one:
/// slf/frames.h has all.
///
/// @param stream  the whole sequence; not kept after the call.
/// @return the light field, bit exact on every platform. A stream cut at a unit boundary gives a
///         light field marked partial; any other damage gives nothing.
/// @errors kNotSlf, kTruncated, kChecksum, kOutOfRange, kReserved: damaged or foreign.
///         kUnsupported: another version of the format, unknown profile. kLimitExceeded: larger
///         than the limits, by its headers. kInvalidArgument: levels, groups or layers beyond what
///         it has. kCancelled.
/// @throws std::bad_alloc only. Thread-safe: no shared state. O(P * K) time and memory.
/// Source: spec clause 8.
Result<LightField> decode(std::span<const std::uint8_t> stream, const DecodeOptions& options = {});

/// One unit, as `slf info` lists it.
struct UnitInfo {
  std::string type;          ///< "sequence", "geometry", ...
  std::uint64_t offset = 0;  ///< of its first byte in the stream
  std::uint64_t bytes = 0;   ///< with its header and CRC
  int slice = -1, group = -1, level_first = -1, level_last = -1;  ///< -1: does not apply
  int layer = -1;               ///< 0: coefficients, 1 .. 3: refinements
  bool base = false;            ///< geometry and coefficients of all slices together
  std::vector<int> prediction;  ///< coefficients: of each level, 0 .. 3; empty: the stream has none
};

/// A transform across planes (spec 8.7.5).
struct TransformInfo {
  int first_group = 0, last_group = 0;
  int functions = 0, coded_functions = 0;  ///< in whose planes components stand
  bool joint = false;                      ///< over channels and functions at once
  bool colour = false;                     ///< else: has a matrix of its own for the channels
};

/// A run of cells of the base.
struct SliceInfo {
  std::uint64_t cells = 0, points = 0;  ///< 1 cell where there is no base
  std::uint64_t bytes = 0;              ///< of its units
  std::optional<VoxelBox> box;          ///< voxels of its cells, where the index has boxes
};

/// What was left out of a stream on purpose (slf truncate).
struct CutInfo {
  int levels = 0, groups = 0, layers = 0;  ///< that are left; groups, layers 0: all
  bool slices = false;                     ///< slices were left out
};

struct StreamInfo {
  int version_major = 0, version_minor = 0, profile = 0, level = 0;
  LightFieldHeader header;
  std::uint64_t num_points = 0;  ///< as the slices unit says
  std::uint64_t num_slices = 0;
  int base_levels = 0;  ///< the coarsest levels, coded once for all slices; 0: one slice
  SliceStart slice_start = SliceStart::kBase;  ///< of several slices
  std::vector<SliceInfo> slices;
  std::optional<CutInfo> cut;
  int num_groups = 0;
  std::vector<int> group;  ///< [K]
  std::vector<std::array<std::uint32_t, 3>>
      step;                 ///< [K][3] quantiser steps, integer component units
  std::vector<int> layers;  ///< [groups] 1 .. 4
  std::vector<TransformInfo> transforms;
  std::string geometry_coder;     ///< "octree" or "draco"
  std::string coefficient_coder;  ///< "vector", "independent" or "texture"
  int texture_bits = 0;           ///< of a sample; 0: no texture
  bool prediction = false;        ///< levels may be predicted (8.7.6)
  int normal_bits = 0;            ///< of a coordinate of coded normals; 0: none
  Metadata metadata;
  std::vector<UnitInfo> units;
  bool complete = false;  ///< the end unit is there
};

/// Reads headers and walks the units without decoding geometry or coefficients. Errors as decode.
Result<StreamInfo> read_info(std::span<const std::uint8_t> stream, const DecodeLimits& limits = {});

/// What decode() takes, as headers tell: before any of it is allocated.
struct DecodeCost {
  /// Bytes at a time, the light field included, the stream itself not. Of scenes like those of
  /// docs/decisions/009 within 10 %; a hostile stream may need up to memory_most.
  std::uint64_t memory = 0;
  std::uint64_t memory_most = 0;  ///< what no stream with these headers exceeds
  std::uint64_t work = 0;         ///< steps as DecodeLimits::max_work counts them, at most
};

/// Cost of decoding the requested levels, groups, layers and bytes with options.threads threads;
/// fewer are used if limits.max_memory has no room for their slices. A region counts as the whole:
/// what it meets is known when the base is decoded. Thread-safe. O(units).
/// @errors as decode; of the limits those of the stream's own length and of planes alone
Result<DecodeCost> decode_cost(std::span<const std::uint8_t> stream,
                               const DecodeOptions& options = {});

}  // namespace slf
