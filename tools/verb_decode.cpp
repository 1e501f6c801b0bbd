// SPDX-License-Identifier: Apache-2.0
// slf decode: points with their mean colour, and on request every integer of the light field.
#include <array>
#include <memory>

#include "slf/plenoptic.h"
#include "slf/view_map.h"
#include "tools/dump.h"
#include "tools/frame_source.h"
#include "tools/interrupt.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/stream_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct DecodeVerbOptions {
  std::string input, output, dump;
  bool planes = false;
  PartOptions part;
  LimitOptions limits;
  CommonOptions common;
};

nlohmann::ordered_json decoded_json(const DecodedFile& decoded, std::uint64_t peak) {
  return {{"bytes", decoded.bytes},
          {"points", decoded.field.num_points()},
          {"functions", decoded.field.header.num_functions},
          {"components", decoded.field.header.num_components()},
          {"grid_bits", decoded.field.header.grid.bits},
          {"partial", decoded.field.partial},
          {"peak_memory", peak},
          {"seconds", decoded.seconds}};
}

/// With the colours of all views, where it has some.
Outcome save_cloud(const DecodeVerbOptions& given, const DecodedFile& decoded) {
  const int threads = given.common.threads;
  if (!is_plenoptic(decoded.metadata))
    return save(given.output, mean_cloud(decoded.field, threads));
  std::vector<std::string> warnings;
  SLF_TRY(const PlenopticCloud cloud,
          from(input_name(given.input), decode_plenoptic(decoded.stream, decoded.field,
                                                         decoded.metadata, &warnings, threads)));
  for (const std::string& warning : warnings)
    warn(input_name(given.input) + ": " + warning, given.common.quiet);
  const DeferInterrupts defer;
  SLF_CHECK(from(output_name(given.output), write_plenoptic(given.output, cloud)));
  return Done{};
}

Outcome run_decode(const DecodeVerbOptions& given) {
  if (given.output.empty() && given.dump.empty())
    return Failure{kUsage, "decode: --output or --dump is missing"};
  if (!given.dump.empty()) SLF_CHECK(check_directory(given.dump));
  if (given.planes && given.dump.empty())
    return Failure{kUsage, "decode: --planes goes with --dump"};
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "decode: --json and --output - both want standard output"};
  if (!given.output.empty()) SLF_CHECK(check_output(given.output, "decode", std::array{".ply"}));
  PartOptions part = given.part;
  part.means_only = given.dump.empty();
  SLF_TRY(const DecodedFile decoded, decode_file(given.input, part, given.limits, given.common));
  const auto peak = static_cast<std::uint64_t>(peak_memory_mib() * (1 << 20));
  if (!given.output.empty()) SLF_CHECK(require_cloud_grid(decoded.field, given.input));
  if (!given.output.empty()) SLF_CHECK(save_cloud(given, decoded));
  if (!given.dump.empty()) SLF_CHECK(dump(decoded.field, given.planes, given.dump));
  if (given.common.json) return print(decoded_json(decoded, peak));
  if (!given.common.quiet)
    std::fprintf(stderr, "%s points, %d functions%s, decoded in %.3f s\n",
                 grouped(decoded.field.num_points()).c_str(), decoded.field.header.num_functions,
                 decoded.field.partial ? ", PARTIAL" : "", decoded.seconds);
  return Done{};
}

}  // namespace

void add_decode(CLI::App& program, Run& run) {
  auto* verb =
      program.add_subcommand("decode", "Decode to a point cloud, or to the coded integers");
  auto o = std::make_shared<DecodeVerbOptions>();
  verb->add_option("FILE", o->input, "The .slf file; - is standard input")
      ->type_name("")
      ->required();
  verb->add_option("-o,--output", o->output,
                   "PLY with positions (world units), normals where coded, and the colour averaged "
                   "over all directions; of a plenoptic cloud the properties that it had, with the "
                   "colour of every view; - is standard output. Without --dump only what these "
                   "need is decoded, and no digest is checked where that is not all")
      ->type_name("FILE");
  verb->add_option(
          "--dump", o->dump,
          "Directory for positions.npy [P,3], components.npy [P,R,3] (int32), octahedral.npy "
          "[P,2] where normals are coded, matrix0.npy and on where functions are coded by others, "
          "and light_field.json (what the integers mean)")
      ->type_name("DIR");
  verb->add_flag(
      "--planes", o->planes,
      "With --dump, planes.npy [P,K,3] too: those given to pack, made of the components");
  add_part(*verb, o->part);
  add_frames_to_show(*verb, o->part);
  add_limits(*verb, o->limits);
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o] {
    run = [o] {
      return for_each_frame("decode", ".ply", o->output, o->part, [&] { return run_decode(*o); });
    };
  });
}

}  // namespace slf::tools
