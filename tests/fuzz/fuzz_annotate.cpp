// SPDX-License-Identifier: Apache-2.0
// What annotate makes of a stream that decodes, decodes: to the same, and says what it was to say.
#include <cstdlib>
#include <string>

#include "slf/annotate.h"
#include "slf/decoder.h"
#include "tests/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto stream = slf::fuzz::with_sound_crcs_of_frames({data + 2, size - 2});
  slf::Annotations annotations;
  if (data[0] & 1) annotations.metadata.push_back({"title", std::string(data[1], 'x')});
  if (data[0] & 2) annotations.metadata.push_back({"source", std::nullopt});
  if (data[0] & 4) annotations.metres_per_unit = data[1] / 100.0;
  slf::DecodeOptions options;
  options.limits = slf::fuzz::small_limits();
  const auto annotated = slf::annotate(stream, annotations, options.limits);
  if (!annotated) return 0;
  slf::fuzz::accept(true);
  const auto before = slf::decode(stream, options);
  if (!before) return 0;
  const auto after = slf::decode(*annotated);  // a title may be what small limits have no room for
  if (!after || after->positions != before->positions || after->components != before->components ||
      after->normals.octahedral != before->normals.octahedral)
    std::abort();
  if (annotations.metres_per_unit && after->header.metres_per_unit != *annotations.metres_per_unit)
    std::abort();
  return 0;
}
