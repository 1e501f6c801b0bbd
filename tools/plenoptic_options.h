// SPDX-License-Identifier: Apache-2.0
// slf encode and slf eval of plenoptic clouds: a PLY with the colours of N views.
#pragma once

#include <string>
#include <vector>

#include "slf/plenoptic.h"
#include "tools/encode_options.h"
#include "tools/stream_input.h"

namespace slf::tools {

struct PlenopticVerbOptions {
  std::string as = "auto", views;
  std::vector<int> hold_out;

  bool given() const { return as != "auto" || !views.empty() || !hold_out.empty(); }
};

/// --as, --views, --hold-out.
void add_plenoptic(CLI::App& verb, PlenopticVerbOptions& options);

/// Whether the capture is such a cloud, and is to be coded as one.
bool is_plenoptic_input(const EncodeOptions& given, const PlenopticVerbOptions& plenoptic);

/// By its options.
Result<PlenopticSettings, Failure> plenoptic_settings(const EncodeOptions& given,
                                                      const PlenopticVerbOptions& plenoptic);

/// slf encode, of such a cloud.
/// @param memory  bytes that it may take; 0: any
Outcome encode_plenoptic_file(const EncodeOptions& given, const PlenopticVerbOptions& plenoptic,
                              std::uint64_t memory);

/// What slf eval prints of such a file against the cloud it was made of.
struct PlenopticEval {
  std::string input, cloud;
  LimitOptions limits;
  CommonOptions common;
};
Outcome eval_plenoptic_file(const PlenopticEval& given);

/// Bits per point of geometry, of colours (coefficients, transforms, corrections), of the file.
struct PlenopticBits {
  double geometry = 0, colour = 0, file = 0;
};
PlenopticBits plenoptic_bits(const StreamInfo& info, std::uint64_t bytes);

}  // namespace slf::tools
