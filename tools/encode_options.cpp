// SPDX-License-Identifier: Apache-2.0
#include "tools/encode_options.h"

#include <algorithm>
#include <array>

#include "slf/notes.h"
#include "tools/choices.h"
#include "tools/notes_input.h"
#include "tools/setting_options.h"

namespace slf::tools {
namespace {

/// Metadata are 2^20 bytes at most (spec 7.8), and other keys are among them.

void add_input_options(CLI::App& verb, EncodeOptions& o, const char* file) {
  verb.add_option("CAPTURE", o.capture,
                  "Directory with cameras.json, a COLMAP model or transforms.json; or one of those "
                  "files; or a coloured cloud alone (docs/captures.md)")
      ->type_name("")
      ->required();
  verb.add_option("-o,--output", o.output,
                  std::string("The ") + file + " file; - is standard output")
      ->type_name("FILE")
      ->required();
  add_points(verb, o.points, o.world);
  verb.add_option("--images", o.images,
                  "Folder of the photographs, where they are not where the capture says: by name, "
                  "with or without folders. Of frames a folder of theirs in it, as frame_0001, or "
                  "DIR/%04d by their numbers")
      ->type_name("DIR");
  verb.add_option("--crop", o.crop,
                  "Only points (of a mesh: faces; splats by their centres) in a box: "
                  "X0,Y0,Z0,X1,Y1,Z1, two corners in world "
                  "units")
      ->delimiter(',')
      ->expected(6)
      ->check(range(-1e300, 1e300));
  verb.add_option("--crs", o.crs,
                  "Coordinate reference system, as the well-known text of a .prj file, kept as "
                  "metadata. None: the .prj beside the cloud, where there is one")
      ->type_name("FILE");
  verb.add_option(
      "--split", o.split,
      "Input images: dense, intermediate, sparse, all, or a name of the capture's. None: "
      "dense where the capture names splits, else all but every fourth");
  add_up_choice(verb, o.up)
      ->type_name("NAME")
      ->each([&o](const std::string&) { o.up_given = true; })
      ->default_str("the capture's");
}

void add_common_options(CLI::App& verb, EncodeOptions& o) {
  verb.add_option("--metadata", o.metadata, "KEY=VALUE to store in the file; may be repeated")
      ->type_name("KEY=VALUE")
      ->expected(1, -1);
  verb.add_option("--notes", o.notes,
                  "Points with text and guided tours (JSON, docs/notes.md), checked and kept as "
                  "metadata: viewers show them")
      ->type_name("FILE");
  add_threads(verb, o.common);
  add_quiet(verb, o.common);
  add_json(verb, o.common);
}

/// Keys that the encoder writes: a second value of one would make the file say two things.
bool is_written_by_encoder(const std::string& key) {
  constexpr std::array kOwn = {"encoder",
                               "source",
                               "split",
                               "crs",
                               "preset",
                               "cameras",
                               "observations",
                               "merged_points",
                               "q",
                               "grid",
                               "densified",
                               "voxel_pixels",
                               "functions",
                               "surfels",
                               "cross_validation",
                               "kernel",
                               "cameras_dropped",
                               "cameras_gain_corrected",
                               "picture_pull",
                               "exposure",
                               "poses",
                               "quality_loss_held_out"};
  if (key.starts_with("surface_") || key.starts_with("refine_") || key.starts_with("plenoptic"))
    return true;
  std::string option = key;
  std::replace(option.begin(), option.end(), '_', '-');
  const auto& settings = encoder_settings();
  return std::find(kOwn.begin(), kOwn.end(), key) != kOwn.end() ||
         std::any_of(settings.begin(), settings.end(),
                     [&](const SettingInfo& setting) { return setting.name == option; });
}

Outcome resolve_metadata(const EncodeOptions& given, Metadata& metadata) {
  for (const std::string& pair : given.metadata) {
    const std::size_t equals = pair.find('=');
    if (equals == 0 || equals == std::string::npos)
      return Failure{kUsage,
                     std::string(given.verb) + ": --metadata " + pair + " is not KEY=VALUE"};
    const std::string key = pair.substr(0, equals);
    if (key == kNotesKey)
      return Failure{kUsage, std::string(given.verb) +
                                 ": --metadata notes: --notes FILE checks and keeps them"};
    if (is_written_by_encoder(key))
      return Failure{kUsage, std::string(given.verb) + ": --metadata " + key +
                                 ": the encoder writes this key itself"};
    for (const auto& [other, value] : metadata)
      if (other == key)
        return Failure{kUsage, std::string(given.verb) + ": --metadata " + key + " is given twice"};
    metadata.emplace_back(key, pair.substr(equals + 1));
  }
  if (given.notes.empty()) return Done{};
  SLF_TRY(std::string notes, read_notes(given.notes));
  SLF_CHECK(check_notes_of_file(std::string(given.verb) + ": --notes", given.notes, notes));
  metadata.emplace_back(kNotesKey, std::move(notes));
  return Done{};
}

}  // namespace

void add_encode_options(CLI::App& verb, EncodeOptions& o) {
  add_input_options(verb, o, ".slf");
  add_settings(verb, o.given, [](const SettingInfo&) { return true; });
  add_common_options(verb, o);
}

void add_igc_options(CLI::App& verb, EncodeOptions& o) {
  add_input_options(verb, o, ".igc");
  add_settings(verb, o.given, [](const SettingInfo& setting) {
    return setting.group != "Coding" && !setting.group.starts_with("Texture") &&
           setting.name != "check-cameras" && setting.name != "match-exposure" &&
           setting.name != "refine-cameras" && setting.name != "metres-per-unit";
  });
  add_common_options(verb, o);
}

Result<EncoderSettings, Failure> resolved(const EncodeOptions& given) {
  auto settings = settings_from(given.given);
  if (!settings) return Failure{kUsage, std::string(given.verb) + ": " + settings.error().message};
  SLF_CHECK(resolve_metadata(given, settings->metadata));
  settings->threads = given.common.threads;
  return *std::move(settings);
}

}  // namespace slf::tools
