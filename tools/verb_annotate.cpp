// SPDX-License-Identifier: Apache-2.0
// slf annotate: notes and scale of a file that is there, without coding it again.
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "slf/annotate.h"
#include "slf/notes.h"
#include "tools/notes_input.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/stream_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct AnnotateOptions {
  std::string input, notes, output;
  std::optional<double> metres;
  LimitOptions limits;
  CommonOptions common;
};

Result<Annotations, Failure> annotations_of(const AnnotateOptions& given) {
  Annotations made;
  if (given.metres && !(*given.metres == 0 || (*given.metres >= 1e-12 && *given.metres <= 1e12)))
    return Failure{kUsage, "annotate: --metres-per-unit: 0, or 1e-12 to 1e12"};
  made.metres_per_unit = given.metres;
  if (given.notes.empty() && !made.metres_per_unit)
    return Failure{kUsage, "annotate: nothing to write: NOTES or --metres-per-unit"};
  if (given.notes == "none") made.metadata.emplace_back(kNotesKey, std::nullopt);
  if (given.notes.empty() || given.notes == "none") return made;
  if (given.notes == "-" && given.input == "-")
    return Failure{kUsage, "annotate: FILE and NOTES both want standard input"};
  SLF_TRY(std::string notes, read_notes(given.notes));
  SLF_CHECK(check_notes_of_file("annotate: NOTES", given.notes, notes));
  made.metadata.emplace_back(kNotesKey, std::move(notes));
  return made;
}

Outcome run_annotate(const AnnotateOptions& given) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "annotate: --json and --output - both want standard output"};
  SLF_CHECK(check_output(given.output, "annotate", std::array{".slf"}));
  SLF_TRY(const Annotations annotations, annotations_of(given));
  SLF_TRY(const StreamFile stream, read_stream(given.input, given.limits, given.common));
  SLF_CHECK(check_frames(given.input, stream, given.limits));
  SLF_TRY(const AnnotatedPieces annotated,
          from(input_name(given.input),
               annotate_in_pieces(stream.bytes, annotations, given.limits.limits)));
  std::vector<std::span<const std::byte>> pieces;
  for (const auto& piece : annotated.pieces) pieces.push_back(std::as_bytes(piece));
  SLF_CHECK(save(given.output, pieces));
  if (given.common.json)
    return print(nlohmann::ordered_json{{"bytes_before", stream.bytes.size()},
                                        {"bytes", annotated.bytes()}});
  if (!given.common.quiet)
    std::fprintf(stderr, "%s bytes, %s before\n", grouped(annotated.bytes()).c_str(),
                 grouped(stream.bytes.size()).c_str());
  return Done{};
}

}  // namespace

void add_annotate(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand(
      "annotate", "Write notes or the scale into a file that is there, without coding it again");
  auto o = std::make_shared<AnnotateOptions>();
  verb->add_option("FILE", o->input, "The .slf file; - is standard input")
      ->type_name("")
      ->required();
  verb->add_option("NOTES", o->notes,
                   "Points with text and guided tours (JSON, docs/notes.md), in place of those of "
                   "the file; none: it has none then; without it they stay")
      ->type_name("");
  verb->add_option("-o,--output", o->output, "The .slf file to write; - is standard output")
      ->type_name("FILE")
      ->required();
  verb->add_option("--metres-per-unit", o->metres,
                   "Metres in a unit of the world, for a bar of scale and lengths; 0: not known")
      ->type_name("M");
  add_limits(*verb, o->limits);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o] { run = [o] { return run_annotate(*o); }; });
}

}  // namespace slf::tools
