// SPDX-License-Identifier: Apache-2.0
// slf merge: parts of a scene, or of frames, to one file.
#include <array>
#include <memory>

#include "slf/decoder.h"
#include "slf/frames.h"
#include "slf/join_frames.h"
#include "tools/output.h"
#include "tools/scene_options.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output;
  bool allow_missing = false, append = false;
  CommonOptions common;
};

/// A unit with a sound checksum can hold what does not decode. Not looked at where that takes more
/// memory than a decoder gives it unasked.
Outcome check_decodes(const std::vector<PartStream>& parts, const MergedScene& merged,
                      const CommonOptions& common) {
  DecodeOptions options;
  options.threads = common.threads;
  const auto decoded = decode(merged.stream, options);
  if (decoded) return Done{};
  if (decoded.error().code == Errc::kLimitExceeded) {
    warn("merge: too large to look whether all of it decodes", common.quiet);
    return Done{};
  }
  for (const PartStream& part : parts)
    if (const auto alone = decode(part.bytes, options); !alone)
      return failure_of(alone.error(), part.name);
  return failure_of(decoded.error(), "merge");
}

/// Every frame: damage that no checksum shows is in one of them.
Outcome check_frames_decode(std::span<const std::uint8_t> stream, const CommonOptions& common) {
  DecodeOptions options;
  options.threads = common.threads;
  SLF_TRY(FrameDecoder decoder, from("merge", FrameDecoder::open(stream, options)));
  for (std::size_t f = 0; f < decoder.frames().size(); ++f)
    if (const auto field = decoder.decode(f); !field) return failure_of(field.error(), "merge");
  return Done{};
}

Outcome merge_frames(const MergeOptions& given, const std::vector<PartStream>& parts) {
  if (given.allow_missing)
    return Failure{kUsage, "merge: --allow-missing is of scenes: frames follow each other"};
  const JoinOrder order = given.append ? JoinOrder::kAsGiven : JoinOrder::kByNumber;
  SLF_TRY(const auto stream, from("merge", join_frames(parts, order)));
  SLF_CHECK(check_frames_decode(stream, given.common));
  SLF_CHECK(save(given.output, stream.data(), stream.size()));
  SLF_TRY(const auto frames, from("merge", list_frames(stream)));
  if (given.common.json)
    return print(nlohmann::ordered_json{{"bytes", stream.size()}, {"frames", frames.size()}});
  if (!given.common.quiet)
    std::fprintf(stderr, "%s bytes, %s frames: %u to %u\n", grouped(stream.size()).c_str(),
                 grouped(frames.size()).c_str(), frames.front().number, frames.back().number);
  return Done{};
}

Outcome run_merge(const MergeOptions& given) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "merge: --json and --output - both want standard output"};
  SLF_CHECK(check_output(given.output, "merge", std::array{".slf"}));
  std::vector<PartStream> parts;
  for (const std::string& name : given.parts) {
    SLF_TRY(auto bytes, from(name, read_file(name)));
    parts.push_back({name, std::move(bytes)});
  }
  if (is_of_frames(parts.front().bytes)) return merge_frames(given, parts);
  if (given.append) return Failure{kUsage, "merge: --append is of frames"};
  SLF_TRY(const MergedScene merged,
          from("merge", merge_parts(parts, given.allow_missing, given.common.threads)));
  SLF_CHECK(check_decodes(parts, merged, given.common));
  SLF_CHECK(save(given.output, merged.stream.data(), merged.stream.size()));
  if (given.common.json)
    return print(nlohmann::ordered_json{{"bytes", merged.stream.size()},
                                        {"missing_slices", merged.missing}});
  if (given.common.quiet) return Done{};
  std::fprintf(stderr, "%s bytes", grouped(merged.stream.size()).c_str());
  if (!merged.missing.empty())
    std::fprintf(stderr, ", %zu slices are missing", merged.missing.size());
  std::fputs("\n", stderr);
  return Done{};
}

}  // namespace

void add_merge(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand("merge",
                                      "Join the parts of a scene, or of frames (slf encode "
                                      "--part), without coding them again; what does not decode "
                                      "is refused");
  auto o = std::make_shared<MergeOptions>();
  verb->add_option("PART", o->parts, "The parts, in any order")->type_name("")->required();
  verb->add_option("-o,--output", o->output, "The .slf file; - is standard output")
      ->type_name("FILE")
      ->required();
  verb->add_flag("--allow-missing", o->allow_missing,
                 "Slices that no part has are left out: the file is partial");
  verb->add_flag("--append", o->append,
                 "Frames: one part after the other as they are given, with new numbers and times");
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o] { run = [o] { return run_merge(*o); }; });
}

}  // namespace slf::tools
