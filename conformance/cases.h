// SPDX-License-Identifier: Apache-2.0
// The light fields behind the golden streams. Everything is made from integers and fixed seeds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slf/decoder.h"
#include "slf/encoder.h"

namespace slf::conformance {

/// A stream that must decode to what its manifest says.
struct Case {
  std::string id, purpose;
  std::vector<std::string> clauses;
  LightField field;
  CodingParameters parameters;
  std::vector<int> levels, groups;  ///< reduced decodes to pin as well
  std::size_t keep_units = 0;       ///< > 0: the stream is cut after so many units
  bool unknown_unit = false;        ///< a unit of type 99 is inserted
  std::vector<VoxelBox> regions{};  ///< decodes of parts of space to pin as well
  bool slice_by_slice = false;      ///< units of slice 0 come first, then those of slice 1, ...
  std::optional<DecodeOptions>
      truncated{};  ///< the stream is cut to these levels, groups, layers, region
  std::vector<std::uint8_t> stream{};    ///< not empty: this one, whatever the field
  std::vector<DecodeOptions> decodes{};  ///< to pin as well
  std::vector<int> layers{};             ///< reduced decodes to pin as well
  std::size_t frames = 1;                ///< of the stream: each decode is pinned of all of them
};

/// A light field and how it is coded, decoded whole.
inline Case case_of(std::string id, std::string purpose, std::vector<std::string> clauses,
                    LightField field, CodingParameters parameters = {}) {
  return {std::move(id),
          std::move(purpose),
          std::move(clauses),
          std::move(field),
          std::move(parameters),
          {},
          {}};
}

/// A stream that was made otherwise.
inline Case case_of_stream(std::string id, std::string purpose, std::vector<std::string> clauses,
                           std::vector<std::uint8_t> stream) {
  Case c = case_of(std::move(id), std::move(purpose), std::move(clauses), {});
  c.stream = std::move(stream);
  return c;
}

std::vector<Case> valid_cases();
std::vector<Case> component_cases();        ///< among them: what values there are
std::vector<Case> header_cases();           ///< among them: slices, normals, what headers say
std::vector<Case> scene_cases();            ///< among them
std::vector<Case> apart_cases();            ///< among them
std::vector<Case> small_cases();            ///< among them
std::vector<Case> edited_cases();           ///< among them: units that no encoder writes
std::vector<Case> transform_cases();        ///< among them: matrices that no encoder writes
std::vector<Case> layer_cases();            ///< among them
std::vector<Case> attribute_cases();        ///< among them
std::vector<Case> texture_cases();          ///< among them: planes as pictures
std::vector<Case> frame_cases();            ///< among them: light fields that move
std::vector<Case> frame_context_cases();    ///< among them
std::vector<Case> empty_frame_cases();      ///< among them
std::vector<Case> frame_attribute_cases();  ///< among them
std::vector<Case> moved_frame_cases();      ///< among them: points that move one by one
std::vector<Case> limit_cases();            ///< among them: limits that are hard to come to
std::vector<Case> ordinary_cases();         ///< among them: what small streams do not show
std::vector<Case> growth_cases();           ///< among them: what later versions add
std::vector<Case> level_cases();            ///< among them

/// A stream that must be refused, with the error this project's decoder gives. Empty where it takes
/// a component that this build lacks.
struct RefusedCase {
  std::string id, purpose;
  std::vector<std::string> clauses;
  std::vector<std::uint8_t> stream;
  std::optional<std::size_t> frame{};  ///< which cannot be decoded
};
std::vector<RefusedCase> refused_cases();
std::vector<RefusedCase> refused_scenes();        ///< among them
std::vector<RefusedCase> refused_units();         ///< among them
std::vector<RefusedCase> refused_growth();        ///< among them
std::vector<RefusedCase> refused_levels();        ///< among them
std::vector<RefusedCase> refused_layers();        ///< among them
std::vector<RefusedCase> refused_apart();         ///< among them
std::vector<RefusedCase> refused_textures();      ///< among them
std::vector<RefusedCase> refused_transforms();    ///< among them
std::vector<RefusedCase> refused_first_frames();  ///< among them
std::vector<RefusedCase> refused_alone();         ///< among them: one rule each, and no second
std::vector<RefusedCase> refused_empty_frames();  ///< among them
/// Streams of frames of which those before one may be decoded, and that one is refused.
std::vector<RefusedCase> refused_frames();
std::vector<RefusedCase> refused_behind_empty();  ///< among them
RefusedCase refused_frame_rate();                 ///< among them
std::vector<RefusedCase> refused_moves();         ///< among them

}  // namespace slf::conformance
