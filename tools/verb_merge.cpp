// SPDX-License-Identifier: Apache-2.0
// slf merge: parts of a scene, or of frames, to one file.
#include <array>
#include <memory>

#include "slf/decoder.h"
#include "slf/frames.h"
#include "slf/join_frames.h"
#include "tools/output.h"
#include "tools/scene_options.h"
#include "tools/stream_input.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct MergeOptions {
  std::vector<std::string> parts;
  std::string output;
  bool allow_missing = false, append = false;
  LimitOptions limits;  ///< of decoding what was merged
  bool has_limits = false;
  std::uint64_t max_memory = DecodeLimits::kNone;  ///< of parts and lists, where it was given
  CommonOptions common;
};

DecodeLimits memory_limit(const MergeOptions& given) {
  DecodeLimits limits = DecodeLimits::none();
  limits.max_memory = given.max_memory;
  return limits;
}

/// A unit with a sound checksum can hold what does not decode. Not looked at where that takes more
/// memory than a decoder gives it unasked; beyond a limit that was given it is refused.
Outcome check_decodes(const MergeOptions& given, const std::vector<PartStream>& parts,
                      const MergedScene& merged) {
  DecodeOptions options;
  options.limits = given.limits.limits;
  options.threads = given.common.threads;
  const auto decoded = decode(merged.stream, options);
  if (decoded) return Done{};
  if (decoded.error().code == Errc::kLimitExceeded) {
    if (given.has_limits) return failure_of(decoded.error(), "merge");
    warn("merge: too large to look whether all of it decodes", given.common.quiet);
    return Done{};
  }
  for (const PartStream& part : parts)
    if (const auto alone = decode(part.bytes, options); !alone)
      return failure_of(alone.error(), part.name);
  return failure_of(decoded.error(), "merge");
}

Outcome check_frames_of(const std::string& name, std::span<const std::uint8_t> stream,
                        const DecodeOptions& options) {
  SLF_TRY(FrameDecoder decoder, from(name, FrameDecoder::open(stream, options)));
  for (std::size_t f = 0; f < decoder.frames().size(); ++f)
    if (const auto field = decoder.decode(f); !field) return failure_of(field.error(), name);
  return Done{};
}

/// Every frame: damage that no checksum shows is in one of them. The part that has it is named.
Outcome check_frames_decode(const MergeOptions& given, const std::vector<PartStream>& parts,
                            std::span<const std::uint8_t> stream) {
  DecodeOptions options;
  options.limits = given.limits.limits;
  options.threads = given.common.threads;
  const Outcome all = check_frames_of("merge", stream, options);
  if (all) return Done{};
  for (const PartStream& part : parts) SLF_CHECK(check_frames_of(part.name, part.bytes, options));
  return all;
}

/// What a file says of its views.
Result<Metadata, Failure> views_of(const PartStream& part) {
  SLF_TRY(StreamInfo info, from(part.name, read_info(part.bytes)));
  std::erase_if(info.metadata,
                [](const auto& pair) { return !pair.first.starts_with("plenoptic"); });
  return std::move(info.metadata);
}

/// Metadata of the first part are those of all, and name the views of a cloud.
Outcome check_same_views(const std::vector<PartStream>& parts) {
  SLF_TRY(const Metadata first, views_of(parts.front()));
  for (const PartStream& part : parts) {
    SLF_TRY(const Metadata own, views_of(part));
    if (!own.empty() && own != first)
      return Failure{kInputInvalid, part.name +
                                        ": properties or positions of its views are not those of " +
                                        parts.front().name};
  }
  return Done{};
}

Outcome merge_frames(const MergeOptions& given, const std::vector<PartStream>& parts) {
  if (given.allow_missing)
    return Failure{kUsage, "merge: --allow-missing is of scenes: frames follow each other"};
  SLF_CHECK(check_same_views(parts));
  const JoinOrder order = given.append ? JoinOrder::kAsGiven : JoinOrder::kByNumber;
  SLF_TRY(const auto stream, from("merge", join_frames(parts, order, memory_limit(given))));
  SLF_CHECK(check_frames_decode(given, parts, stream));
  SLF_CHECK(save(given.output, stream.data(), stream.size()));
  SLF_TRY(const auto frames, from("merge", list_frames(stream, memory_limit(given))));
  if (given.common.json)
    return print(nlohmann::ordered_json{{"bytes", stream.size()}, {"frames", frames.size()}});
  if (!given.common.quiet)
    std::fprintf(stderr, "%s bytes, %s frames: %u to %u\n", grouped(stream.size()).c_str(),
                 grouped(frames.size()).c_str(), frames.front().number, frames.back().number);
  return Done{};
}

/// All parts together within the limit.
Result<std::vector<PartStream>, Failure> read_parts(const MergeOptions& given) {
  std::vector<PartStream> parts;
  LimitOptions left;
  left.limits.max_memory = given.max_memory;
  for (const std::string& name : given.parts) {
    SLF_TRY(auto bytes, read_input(name, left));
    if (left.limits.max_memory != DecodeLimits::kNone) left.limits.max_memory -= bytes.size();
    parts.push_back({name, std::move(bytes)});
  }
  return parts;
}

Outcome run_merge(const MergeOptions& given) {
  if (given.common.json && given.output == "-")
    return Failure{kUsage, "merge: --json and --output - both want standard output"};
  SLF_CHECK(check_output(given.output, "merge", std::array{".slf"}));
  SLF_TRY(const std::vector<PartStream> parts, read_parts(given));
  if (is_of_frames(parts.front().bytes)) return merge_frames(given, parts);
  if (given.append)
    return Failure{
        kUsage, "merge: --append is of frames, and " + parts.front().name + " is one light field"};
  SLF_TRY(const MergedScene merged,
          from("merge",
               merge_parts(parts, given.allow_missing, given.common.threads, memory_limit(given))));
  SLF_CHECK(check_decodes(given, parts, merged));
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
  add_limits(*verb, o->limits);
  verb->get_option("--max-memory")
      ->description("Bytes of all parts, of lists of their units, and of decoding what they make")
      ->default_str("none, of decoding 1G");
  verb->remove_option(verb->get_option("--strict"));  // parts are partial
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  add_json(*verb, o->common);
  verb->callback([&run, o, verb] {
    for (const char* limit :
         {"--max-memory", "--max-points", "--max-values-per-byte", "--max-work"})
      o->has_limits = o->has_limits || verb->count(limit) > 0;
    if (verb->count("--max-memory") > 0) o->max_memory = o->limits.limits.max_memory;
    run = [o] { return run_merge(*o); };
  });
}

}  // namespace slf::tools
