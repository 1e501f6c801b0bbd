// SPDX-License-Identifier: Apache-2.0
// Light fields coded as pictures; skips, by name, of tests that need a video library.
#pragma once

#include <gtest/gtest.h>

#include "attributes/video/encoder/hevc_encoder.h"
#include "attributes/video/hevc_decoder.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "tests/codec/field_support.h"

#define SKIP_WITHOUT_HEVC() \
  if (const char* lacking = slf::test::lacks()) GTEST_SKIP() << lacking

namespace slf::test {

/// What this build needs for pictures and does not have, or null.
inline const char* lacks() {
  const auto blank = [](std::size_t) { return blank_picture(64, 64, 8, ChromaFormat::k400); };
  if (!encode_hevc(1, blank, {})) return "built without x265 (SLF_X265)";
  const auto none = decode_hevc({}, {64, 64, 8, ChromaFormat::k400, 1}, [](auto, const auto&) {});
  if (!none && none.error().code == Errc::kUnsupported) return "built without libde265 (SLF_HEVC)";
  return nullptr;
}

inline CodingParameters texture_coding(int functions, std::uint32_t step, int bits, bool lossless) {
  CodingParameters parameters;
  parameters.coefficients = CoefficientCoder::kTexture;
  parameters.step.assign(static_cast<std::size_t>(functions), {step, step, step});
  parameters.texture.bits = bits;
  parameters.texture.lossless = lossless;
  parameters.texture.preset = "superfast";
  return parameters;
}

inline std::vector<std::uint8_t> packed(const LightField& field,
                                        const CodingParameters& parameters) {
  auto stream = pack(field, parameters);
  EXPECT_TRUE(stream) << (stream ? "" : stream.error().message);
  return stream ? *stream : std::vector<std::uint8_t>{};
}

}  // namespace slf::test
