// SPDX-License-Identifier: Apache-2.0
// Writes the golden streams and their manifests: slf_conformance_generate DIRECTORY
//
// The same bytes for every compiler and optimisation level; conformance/compilers.sh proves it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "base/sha256.h"
#include "bitstream/bit_writer.h"
#include "bitstream/index.h"
#include "bitstream/units.h"
#include "conformance/cases.h"
#include "slf/decoder.h"
#include "slf/frames.h"
#include "slf/given_planes.h"
#include "slf/truncate.h"

namespace slf::conformance {
namespace {

namespace fs = std::filesystem;

std::string sha256(std::span<const std::uint8_t> bytes) {
  Sha256 sha;
  sha.update(bytes);
  std::string text;
  char hex[3];
  for (const std::uint8_t byte : sha.finish()) {
    std::snprintf(hex, sizeof hex, "%02x", byte);
    text += hex;
  }
  return text;
}

template <class Integer>
std::string sha256_of(
    const std::vector<Integer>& values) {  // little-endian hosts only, as the goldens
  return sha256(
      {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(Integer)});
}

std::string quoted(const std::string& s) { return '"' + s + '"'; }

std::string list(const std::vector<std::string>& items) {
  std::string text = "[";
  for (std::size_t i = 0; i < items.size(); ++i) text += (i ? ", " : "") + quoted(items[i]);
  return text + "]";
}

/// sps_version_major, sps_version_minor: as the stream says, where it is long enough and begins
/// with a sequence.
std::string version_of(std::span<const std::uint8_t> stream) {
  const std::size_t at = kSignature.size();
  if (stream.size() < at + 3 || stream[at] != static_cast<std::uint8_t>(UnitType::kSequence))
    return "1.0";
  return std::to_string(stream[at + 1]) + "." + std::to_string(stream[at + 2]);
}

std::string description(const std::string& id, const std::vector<std::string>& clauses,
                        const std::string& purpose, std::span<const std::uint8_t> stream) {
  return "{\n  \"id\": " + quoted(id) + ",\n  \"format_version\": " + quoted(version_of(stream)) +
         ",\n  \"clauses\": " + list(clauses) + ",\n  \"purpose\": " + quoted(purpose) +
         ",\n  \"stream\": {\"file\": \"stream.slf\", \"bytes\": " + std::to_string(stream.size()) +
         ", \"sha256\": " + quoted(sha256(stream)) + "},\n";
}

std::string region_text(const VoxelBox& box) {
  std::string text = ", \"region\": [";
  for (std::size_t i = 0; i < 6; ++i)
    text += (i ? ", " : "") + std::to_string(i < 3 ? box.low[i] : box.high[i - 3]);
  return text + "]";
}

/// frame: of a stream of several
std::string expectation(const LightField& field, const DecodeOptions& options,
                        std::optional<std::size_t> frame) {
  std::string text = (frame ? "    {\"frame\": " + std::to_string(*frame) + ", " : "    {") +
                     "\"levels\": " + std::to_string(options.levels) +
                     ", \"groups\": " + std::to_string(options.groups) +
                     (options.layers > 0 ? ", \"layers\": " + std::to_string(options.layers) : "") +
                     (options.region ? region_text(*options.region) : "") +
                     ", \"partial\": " + (field.partial ? "true" : "false") +
                     ", \"points\": " + std::to_string(field.num_points()) +
                     ", \"functions\": " + std::to_string(field.header.num_functions) +
                     ", \"components\": " + std::to_string(field.header.num_components()) +
                     ",\n     \"positions_sha256\": " + quoted(sha256_of(field.positions)) +
                     ",\n     \"components_sha256\": " + quoted(sha256_of(field.components));
  if (!field.header.transforms.empty())
    text += ",\n     \"planes_sha256\": " + quoted(sha256_of(given_planes(field)));
  if (field.normals.bits > 0)
    text += ",\n     \"normals_sha256\": " + quoted(sha256_of(field.normals.octahedral));
  return text + "}";
}

struct EditableUnit {
  UnitType type;
  std::vector<std::uint8_t> payload;
  std::uint32_t slice;  ///< 0: also of no slice
};

/// The place of a unit where slices come one after the other.
std::uint32_t slice_of(const Unit& unit, const SequenceParameterSet& set) {
  if (unit.type == UnitType::kEnd || unit.type == UnitType::kMetadata) return ~0u;
  if (!has_ids(unit.type)) return 0;
  const SliceUnitHeader ids = *read_ids(unit, set);
  return ids.of_base() ? 0 : ids.slice_id;
}

/// Sound lengths, CRCs and unit count; no index may be among them.
std::vector<std::uint8_t> rewritten(const std::vector<EditableUnit>& units) {
  std::vector<std::uint8_t> out(kSignature.begin(), kSignature.end());
  for (std::size_t i = 0; i < units.size(); ++i) {
    BitWriter end;
    end.ue(i);
    append_unit(out, units[i].type,
                units[i].type == UnitType::kEnd ? end.take() : units[i].payload);
  }
  return out;
}

/// Another order of units.
std::vector<std::uint8_t> sorted(const std::vector<std::uint8_t>& stream, const Case& c) {
  if (!c.slice_by_slice) return stream;
  const Units split = *split_units(stream);
  const SequenceParameterSet set = *parse_sequence_parameter_set(split.units[0].payload);
  std::vector<EditableUnit> units;
  for (const Unit& unit : split.units)
    units.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}, slice_of(unit, set)});
  std::stable_sort(units.begin(), units.end(),
                   [](const auto& a, const auto& b) { return a.slice < b.slice; });
  return rewritten(units);
}

/// Cuts after some units, or slips in one of an unknown type before the last.
std::vector<std::uint8_t> altered(const std::vector<std::uint8_t>& stream, const Case& c) {
  if (c.keep_units == 0 && !c.unknown_unit) return stream;
  const Units units = *split_units(stream);
  std::vector<std::uint8_t> out(kSignature.begin(), kSignature.end());
  for (std::size_t i = 0; i < units.units.size() && (c.keep_units == 0 || i < c.keep_units); ++i) {
    const Unit& unit = units.units[i];
    if (unit.type == UnitType::kEnd) {
      const std::vector<std::uint8_t> payload = {1, 2, 3};
      append_unit(out, static_cast<UnitType>(99), payload);
      BitWriter end;
      end.ue(units.units.size());
      append_unit(out, UnitType::kEnd, end.take());
    } else {
      append_unit(out, unit.type, unit.payload);
    }
  }
  return out;
}

void write(const fs::path& directory, const std::vector<std::uint8_t>& stream,
           const std::string& manifest) {
  fs::create_directories(directory);
  std::ofstream(directory / "stream.slf", std::ios::binary)
      .write(reinterpret_cast<const char*>(stream.data()),
             static_cast<std::streamsize>(stream.size()));
  std::ofstream(directory / "case.json", std::ios::binary) << manifest;
}

/// Names, on standard output, a case that needs a component this build lacks.
bool leave_out(const char* part, const std::string& id, bool lacks_component) {
  if (lacks_component) std::printf("left out: %s/%s\n", part, id.c_str());
  return lacks_component;
}

/// The stream of a case; nothing where it needs a component this build lacks.
std::optional<std::vector<std::uint8_t>> stream_of(const Case& c) {
  if (!c.stream.empty()) return c.stream;
  const auto packed = pack(c.field, c.parameters);
  if (!packed) {
    std::fprintf(stderr, "%s: %s\n", c.id.c_str(), packed.error().message.c_str());
    if (packed.error().code != Errc::kUnsupported) std::exit(1);
    return std::nullopt;
  }
  auto stream = altered(sorted(*packed, c), c);
  return c.truncated ? *truncate(stream, *c.truncated) : stream;
}

Result<LightField> decode_frame(std::span<const std::uint8_t> stream, std::size_t frame,
                                const DecodeOptions& options = {}) {
  if (frame == 0) return decode(stream, options);
  SLF_TRY(FrameDecoder decoder, FrameDecoder::open(stream, options));
  return decoder.decode(frame);
}

bool write_case(const fs::path& root, const Case& c) {
  const auto made = stream_of(c);
  if (!made) return leave_out("streams", c.id, true);
  const std::vector<std::uint8_t>& stream = *made;
  std::string text = description(c.id, c.clauses, c.purpose, stream) + "  \"expect\": [\n";
  std::vector<DecodeOptions> decodes(1);
  const auto add = [&](int levels, int groups, std::optional<VoxelBox> region, int layers = 0) {
    decodes.emplace_back();
    decodes.back().layers = layers;
    decodes.back().levels = levels;
    decodes.back().groups = groups;
    decodes.back().region = region;
  };
  for (const int levels : c.levels) add(levels, 0, {});
  for (const int groups : c.groups) add(0, groups, {});
  for (const VoxelBox& region : c.regions) {
    add(0, 0, region);
    for (const int levels : c.levels) add(levels, 0, region);
  }
  decodes.insert(decodes.end(), c.decodes.begin(), c.decodes.end());
  for (const int layers : c.layers) {
    add(0, 0, {}, layers);
    for (const int levels : c.levels) add(levels, 0, {}, layers);
  }
  for (std::size_t i = 0; i < decodes.size() * c.frames; ++i) {
    const DecodeOptions& options = decodes[i / c.frames];
    const auto field = decode_frame(stream, i % c.frames, options);
    if (!field) {
      std::fprintf(stderr, "%s: %s\n", c.id.c_str(), to_string(field.error()).c_str());
      return false;
    }
    text += (i ? ",\n" : "") +
            expectation(*field, options, c.frames > 1 ? std::optional(i % c.frames) : std::nullopt);
  }
  text +=
      "\n  ],\n  \"digest_of\": \"positions: int32 little-endian x, y, z; components: int32 "
      "[points][components][3]; "
      "planes: int32 [points][functions][3]; normals: uint16 pairs; decoded order\",\n  "
      "\"source\": {\"made_by\": "
      "\"conformance/generate.cpp\", \"licence\": \"CC0-1.0\"}\n}\n";
  write(root / "streams" / c.id, stream, text);
  return true;
}

/// A stream that is refused for something else than before may have lost its purpose.
void tell_other_refusal(const fs::path& before, const std::string& text) {
  std::ifstream file(before);
  std::string line;
  while (std::getline(file, line))
    if (line.find("\"refuse\"") != std::string::npos && text.find(line) == std::string::npos)
      std::fprintf(stderr, "%s: was%s\n", before.parent_path().filename().c_str(), line.c_str());
}

bool write_refused(const fs::path& root, const RefusedCase& c) {
  const char* const part = c.frame ? "refused_frames" : "refused";
  if (c.stream.empty()) return leave_out(part, c.id, true);
  const auto field = decode_frame(c.stream, c.frame.value_or(0));
  const auto info = read_info(c.stream);  // what decode() does not look at
  if (field && (info || c.frame)) {
    std::fprintf(stderr, "%s: was not refused\n", c.id.c_str());
    return false;
  }
  const Error& error = field ? info.error() : field.error();
  const std::string frame = c.frame ? "\"frame\": " + std::to_string(*c.frame) + ", " : "";
  const std::string text = description(c.id, c.clauses, c.purpose, c.stream) + "  \"refuse\": {" +
                           frame + "\"by\": " + quoted(field ? "info" : "decode") +
                           ", \"code\": " + quoted(to_string(error.code)) +
                           ", \"element\": " + quoted(error.element) +
                           ", \"unit\": " + quoted(error.unit) + "}\n}\n";
  tell_other_refusal(root / part / c.id / "case.json", text);
  write(root / part / c.id, c.stream, text);
  return true;
}

}  // namespace
}  // namespace slf::conformance

int main(int argc, char** argv) {
  const std::string directory = argc == 2 ? argv[1] : "";
  if (directory.empty() || directory[0] == '-') {
    const bool asked = directory == "--help";
    std::fprintf(asked ? stdout : stderr, "usage: slf_conformance_generate DIRECTORY\n");
    return asked ? 0 : 2;
  }
  bool good = true;
  for (const auto& c : slf::conformance::valid_cases())
    good = slf::conformance::write_case(directory, c) && good;
  for (const auto& c : slf::conformance::refused_cases())
    good = slf::conformance::write_refused(directory, c) && good;
  for (const auto& c : slf::conformance::refused_frames())
    good = slf::conformance::write_refused(directory, c) && good;
  return good ? 0 : 1;
}
