// SPDX-License-Identifier: Apache-2.0
// slf truncate: a file with less in it, its units kept or left out as they are.
#include <array>
#include <memory>

#include "slf/frame_inputs.h"
#include "slf/frames.h"
#include "slf/truncate.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/stream_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct TruncateOptions {
  std::string input, output;
  PartOptions part;
  LimitOptions limits;
  CommonOptions common;
};

/// --frames, of a stream of several; all of it without.
Result<std::vector<std::uint8_t>, Failure> cut(const TruncateOptions& given,
                                               const StreamFile& stream,
                                               const DecodeOptions& options) {
  const std::string name = input_name(given.input);
  FrameRange range{0, UINT32_MAX};
  if (!given.part.frames.empty()) {
    SLF_TRY(range, from("--frames", parse_frame_range(given.part.frames)));
    if (range.last >= stream.frames) return no_such_frame(name, range.last, stream.frames);
  }
  if (stream.frames > 1 && options.region)
    return Failure{kUsage, name +
                               ": a region of frames is not cut out: each is predicted from all "
                               "of the one before (--region)"};
  auto kept = stream.frames == 1 ? truncate(stream.bytes, options)
                                 : truncate_frames(stream.bytes, range.first, range.last, options);
  if (!kept) return decode_failure(given.input, kept.error(), stream, options);
  return *std::move(kept);
}

Outcome run_truncate(const TruncateOptions& given) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "truncate: --json and --output - both want standard output"};
  SLF_CHECK(check_output(given.output, "truncate", std::array{".slf"}));
  SLF_TRY(const StreamFile stream, read_stream(given.input, given.limits, given.common));
  const DecodeOptions options = decode_options(stream.info, given.part, given.limits, given.common);
  SLF_TRY(const auto kept, cut(given, stream, options));
  SLF_CHECK(save(given.output, kept.data(), kept.size()));
  SLF_TRY(const StreamInfo left,
          from(output_name(given.output), read_info(kept, given.limits.limits)));
  if (given.common.json)
    return print(nlohmann::ordered_json{{"bytes_before", stream.bytes.size()},
                                        {"bytes", kept.size()},
                                        {"partial", is_partial(left)}});
  if (!given.common.quiet)
    std::fprintf(stderr, "%s of %s bytes\n", grouped(kept.size()).c_str(),
                 grouped(stream.bytes.size()).c_str());
  return Done{};
}

}  // namespace

void add_truncate(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand(
      "truncate",
      "Leave out levels, groups, layers, slices or the end of a file, without coding it again");
  auto o = std::make_shared<TruncateOptions>();
  verb->add_option("FILE", o->input, "The .slf file; - is standard input")
      ->type_name("")
      ->required();
  verb->add_option("-o,--output", o->output, "The smaller .slf file; - is standard output")
      ->type_name("FILE")
      ->required();
  add_part(*verb, o->part);
  verb->get_option("--levels")->description("Octree levels to keep; 0 is all");
  verb->get_option("--groups")->description("Plane groups to keep; 0 is all");
  verb->get_option("--layers")->description("Quality layers to keep; 0 is all");
  verb->get_option("--max-bytes")
      ->description("Bytes of the new file at most: units are dropped from the end; 0 is any");
  verb->get_option("--region")
      ->description(
          "Keep only slices that meet a box: X0,Y0,Z0,X1,Y1,Z1, two corners in world units");
  verb->add_option(
          "--frames", o->part.frames,
          "Frames to keep of a file of several, A and B included. Where A is predicted, the frames "
          "of its group before it are kept, too: it needs them")
      ->type_name("A:B");
  add_limits(*verb, o->limits);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o] { run = [o] { return run_truncate(*o); }; });
}

}  // namespace slf::tools
