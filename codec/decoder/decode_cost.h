// SPDX-License-Identifier: Apache-2.0
// What a decode will take, from headers alone: bytes at a time, and steps. Spec 9.
#pragma once

#include <cstdint>
#include <vector>

#include "codec/decoder/request.h"
#include "slf/decoder.h"

namespace slf {

/// All that decides what a decode takes.
struct DecodeShape {
  static constexpr double kUnknown = -1;

  std::vector<std::uint64_t> slices;  ///< points of each
  std::uint64_t units = 0;            ///< of all types, and entries of indices
  std::uint64_t cells = 0;            ///< of the base; 0: none
  std::uint64_t planes = 0;           ///< 3 R, of the groups that are decoded
  std::uint64_t groups = 0;
  std::uint64_t layers = 1;                                 ///< of a group, at most
  std::uint64_t levels = 0, base_levels = 0;                ///< of the grid, of the base
  std::uint64_t geometry_units = 1, coefficient_units = 1;  ///< of a slice
  double coefficient_bits = kUnknown;                       ///< of a point, in all units
  bool base_alone = false;                                  ///< no slice is opened
  bool vector = true;                                       ///< coefficients: contexts keep vectors
  bool prediction = false, draco = false, texture = false, normals = false;
  bool shared_states = false;
  bool ahead = false;               ///< of slice 0 more levels are decoded than are kept
  bool kept = false;                ///< a frame of several: what the next is predicted from stays
  bool reference_contexts = false;  ///< of predicted frames, by what the reference has
  const FrameReference* reference = nullptr;  ///< of a frame that is predicted
};

/// What a decode takes on so many threads.
struct CostOnThreads : DecodeCost {
  int threads = 1;  ///< as in DecodeOptions
};

/// On as many threads as were asked for, or fewer where max_memory has no room for their slices; at
/// least one, whatever that takes.
CostOnThreads cost_of(const DecodeShape& shape, const DecodeOptions& options);

/// That of what was asked for, which may be less than the whole.
DecodeShape shape_of(const Request& request);

/// Are so many rows, of the base and of slices, within what the caller allows of so many bytes?
/// @errors kLimitExceeded: max_values_per_byte
Result<Done> check_values(const Request& request, std::uint64_t rows);

/// What the slices say they hold, before any of it is decoded; where a region is asked for, what
/// the base takes, which tells the slices.
/// @errors kLimitExceeded, with the limit as element.
Result<CostOnThreads> check_limits(const Request& request, const DecodeOptions& options);

/// The same of the slices that will be opened. chosen: [slices]
Result<CostOnThreads> check_limits_of_slices(const Request& request, const DecodeOptions& options,
                                             const std::vector<std::uint8_t>& chosen);

}  // namespace slf
