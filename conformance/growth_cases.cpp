// SPDX-License-Identifier: Apache-2.0
// What later versions add, as a decoder of this version meets it: units, features, elements of the
// sequence header, minor versions. Spec 7.1.1, 7.1.2, 7.2.1.
#include "conformance/cases.h"
#include "conformance/edit_frames.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

constexpr auto type_of_number(int number) { return static_cast<UnitType>(number); }

/// An identifier that the registry keeps for examples, and some bytes.
const Bytes kPrivate = {'E', 'X', 'A', 'M', 1, 2, 3};

/// The beginning of a stream of format 0.6.
const Bytes kDraft = {0x8B, 'S',  'L',  'F',  0x0D, 0x0A, 0x1A, 0x0A, 0x01, 0x0A, 0x00, 0x06,
                      0x00, 0x06, 0x00, 0x01, 0x42, 0x0E, 0x12, 0x80, 0x81, 0xBA, 0xF9, 0xCB};

/// Three slices, two groups, an index.
Bytes indexed_scene() {
  CodingParameters p = with_steps(3, 24);
  p.group = {0, 1, 1};
  p.base_levels = 2;
  p.max_slice_points = 60;
  return *pack(field(sphere(4), 4, 3), p);
}

/// Behind the sequence header the word of features and bytes of a later version.
Bytes with_features(const Bytes& stream, std::uint32_t features, std::size_t extension_bytes) {
  return edited(stream, [&](UnitList& units) {
    for (int shift = 24; shift >= 0; shift -= 8)
      units[0].payload.push_back(static_cast<std::uint8_t>(features >> shift));
    units[0].payload.insert(units[0].payload.end(), extension_bytes, 0xC3);
  });
}

/// One more unit, before the last one but `behind`.
Bytes with_unit(const Bytes& stream, UnitType type, const Bytes& payload, std::size_t behind = 0) {
  return edited(stream, [&](UnitList& units) {
    units.insert(units.end() - 1 - static_cast<std::ptrdiff_t>(behind), {type, payload});
  });
}

/// One function a run: the sequence unit is longer than 127 bytes.
Bytes long_sequence() {
  CodingParameters p = with_steps(64, 8);
  for (std::uint32_t k = 0; k < 64; ++k) p.step[k] = {8 + k, 9 + k, 10 + k};
  return packed_bare(field(lattice(2, 3, 2), 2, 64), p);
}

/// Two frames of a later version than 1.0: an extended header, and units to skip in both of them.
Bytes frames_of_later_version() {
  CodingParameters p = with_steps(1, 40);
  p.geometry_level_ends = p.coefficient_level_ends = {2, 4};
  FrameWriter writer(p);
  writer.add(field(lattice(3, 4, 5), 4, 1, 500));
  writer.add(field(lattice(3, 4, 5), 4, 1, 600), {});
  const auto grown = [&](std::size_t frame) {
    return edited_frame(writer.frames()[frame], [&](UnitList& units) {
      if (frame == 0) units[0].payload.insert(units[0].payload.end(), {0, 0, 0, 0, 0xFF});
      units.insert(units.end() - 2, {type_of_number(100), kPrivate});
      units.insert(units.end() - 1, {type_of_number(200), kPrivate});
    });
  };
  return joined({of_version(grown(0), kVersionMajor, 1), grown(1)});
}

}  // namespace

std::vector<Case> growth_cases() {
  const Bytes scene = indexed_scene(), bare = base_stream(false);
  std::vector<Case> cases;
  const auto add = [&](const char* id, const char* purpose, const char* clause, Bytes stream) {
    cases.push_back(case_of_stream(id, purpose, {clause}, std::move(stream)));
  };
  add("later-minor", "the greatest minor version", "7.1.2", of_version(scene, kVersionMajor, 255));
  cases.back().levels = {2};
  add("version-of-a-long-sequence", "a sequence unit whose length takes two bytes", "7.1.2",
      long_sequence());
  add("features-of-none", "a word of features of which none is in use", "7.2.1",
      with_features(bare, 0, 0));
  add("feature-without-frames", "contexts by the reference, in a light field that does not move",
      "7.2.1", of_version(with_features(bare, kReferenceContexts, 0), kVersionMajor, 1));
  add("header-extended", "a header with elements of a later version", "7.2.1",
      with_features(bare, 0, 300));
  add("header-extended-most", "a header with 2^16 bytes of a later version", "7.2.1",
      with_features(bare, 0, 1 << 16));
  add("unit-of-a-later-version", "a type of the text that may be skipped, among the slices",
      "7.1.1", with_unit(bare, type_of_number(64), Bytes(300, 0x3C), 3));
  add("unit-private", "a type of an application that may be skipped", "7.1.1",
      with_unit(bare, type_of_number(192), kPrivate));
  add("frames-of-a-later-version", "a later minor version, an extended header and units to skip",
      "7.1.1", frames_of_later_version());
  cases.back().frames = 2;
  return cases;
}

std::vector<RefusedCase> refused_growth() {
  const Bytes bare = base_stream(false);
  std::vector<RefusedCase> cases;
  const auto add = [&](const std::string& id, const char* purpose, const char* clause,
                       Bytes stream) {
    cases.push_back({id, purpose, {clause}, std::move(stream)});
  };
  add("version-major", "a newer major version", "7.1.2", of_version(bare, kVersionMajor + 1, 0));
  add("version-of-drafts", "a stream of draft 0.6, whose length stood where the major version does",
      "7.1.2", kDraft);
  add("truncated-in-version", "ends inside the version", "7.1.2",
      Bytes(bare.begin(), bare.begin() + 10));
  for (const int type : {0, 29, 63})
    add("unit-to-be-understood-" + std::to_string(type), "a type of a later version", "7.1.1",
        with_unit(bare, type_of_number(type), {1, 2, 3}, 2));
  add("unit-private-to-be-understood", "a type of an application", "7.1.1",
      with_unit(bare, type_of_number(128), kPrivate));
  add("unit-of-an-experiment", "a type of an experiment that must be understood", "7.1.1",
      with_unit(bare, type_of_number(160), {}));
  add("feature-first", "the first feature", "7.2.1", with_features(bare, 1u << 31, 0));
  add("feature-last", "the last feature, with elements of its own", "7.2.1",
      with_features(bare, 1, 9));
  add("features-shorter", "a byte behind the header where features take four", "7.2.1",
      edited(bare, [](UnitList& units) { units[0].payload.push_back(0); }));
  add("extension-longer", "more than 2^16 bytes of a later version", "7.2.1",
      with_features(bare, 0, (1 << 16) + 1));
  return cases;
}

}  // namespace slf::conformance
