// SPDX-License-Identifier: Apache-2.0
// A .slf file as input of a verb: read, judged by the limits that the caller sets, and what is
// missing of it said.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "slf/decoder.h"
#include "tools/failure.h"
#include "tools/options.h"

namespace slf::tools {

/// --max-memory, --max-points, --max-work and --strict: the same in every verb that reads a .slf.
struct LimitOptions {
  DecodeLimits limits;
  bool strict = false;
};
void add_limits(CLI::App& verb, LimitOptions& options);

/// Is the list of the units of a file kept? It takes more than the units where they are short.
enum class UnitList : std::uint8_t { kNone, kKept };

/// A stream whose headers were read and, by --strict, found whole.
struct StreamFile {
  std::vector<std::uint8_t> bytes;
  StreamInfo info;         ///< of the first frame; its units only with UnitList::kKept
  std::size_t frames = 1;  ///< warned of where there are several
};

/// A place beyond the last one.
Failure no_such_frame(const std::string& name, std::size_t frame, std::size_t count);

/// Warns of what is missing, unless quiet. "-" is standard input.
Result<StreamFile, Failure> read_stream(const std::string& file, const LimitOptions& given,
                                        const CommonOptions& common,
                                        UnitList units = UnitList::kNone);

/// Bytes of any file, as far as the limits allow.
Result<std::vector<std::uint8_t>, Failure> read_input(const std::string& file,
                                                      const LimitOptions& given);
/// The same for bytes that were read.
Result<StreamFile, Failure> open_stream(const std::string& file, std::vector<std::uint8_t> bytes,
                                        const LimitOptions& given, const CommonOptions& common,
                                        UnitList units = UnitList::kNone);

/// Is the file not all that was coded: cut short, or cut by `slf truncate`?
bool is_partial(const StreamInfo& info);

/// Warns of what is missing, unless quiet; by --strict that is a failure.
Outcome check_whole(const std::string& file, const StreamInfo& info, const LimitOptions& given,
                    const CommonOptions& common);

/// Every unit of every frame, of which read_stream() looks at the first: a verb that passes a file
/// on without decoding it passes no damage on.
Outcome check_frames(const std::string& file, const StreamFile& stream, const LimitOptions& given);

/// For the library.
DecodeOptions decode_options(const StreamInfo& info, const PartOptions& part,
                             const LimitOptions& given, const CommonOptions& common);

/// A limit is named with what the file would take, every other error as it is.
Failure decode_failure(const std::string& file, const Error& error, const StreamFile& stream,
                       const DecodeOptions& options);

struct DecodedFile {
  LightField field;
  std::uint64_t bytes = 0;  ///< of the file, whatever was read of it
  double seconds = 0;       ///< of decoding alone
  Metadata metadata = {};
  std::vector<std::uint8_t> stream = {};  ///< of a plenoptic cloud that was read whole
};
/// Decodes a file. A part of a regular file reads no more of it than it needs (tools/part_input.h).
Result<DecodedFile, Failure> decode_file(const std::string& file, const PartOptions& part,
                                         const LimitOptions& given, const CommonOptions& common);

/// A failure for verbs that need view maps, where the file holds geometry alone, or integer planes
/// without a meaning; and where its grid is none that floats hold.
Outcome require_view_maps(const LightField& field, const std::string& file);

}  // namespace slf::tools
