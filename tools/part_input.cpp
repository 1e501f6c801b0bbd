// SPDX-License-Identifier: Apache-2.0
#include "tools/part_input.h"

#include <filesystem>
#include <fstream>
#include <ios>
#include <span>

#include "slf/part_decoder.h"

namespace slf::tools {
namespace {

/// A file that is read in places, by one thread.
class FileReader {
 public:
  explicit FileReader(const std::string& file) {
    file_.rdbuf()->pubsetbuf(nullptr, 0);  // or more is read than was asked for
    file_.open(file, std::ios::binary | std::ios::ate);
  }

  /// nullopt: it cannot be read.
  std::optional<std::uint64_t> bytes() {
    const std::streamoff end = file_ ? std::streamoff{file_.tellg()} : -1;
    return end < 0 ? std::nullopt : std::optional(static_cast<std::uint64_t>(end));
  }

  bool read(std::uint64_t offset, std::span<std::uint8_t> to) {
    Stopwatch watch;
    file_.seekg(static_cast<std::streamoff>(offset));
    file_.read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(to.size()));
    seconds_ += watch.lap();
    return file_.good();
  }

  double seconds() const { return seconds_; }  ///< spent in read()

 private:
  std::ifstream file_;
  double seconds_ = 0;
};

bool asks_for_part(const PartOptions& part) {
  return part.levels > 0 || part.groups > 0 || part.layers > 0 || part.max_bytes > 0 ||
         !part.region.empty();
}

/// Opening a pipe would take from it what cannot be read again.
bool is_regular(const std::string& file) {
  std::error_code ignored;
  return file != "-" && std::filesystem::is_regular_file(file, ignored);
}

}  // namespace

std::optional<DecodedFile> decode_part_alone(const std::string& file, const PartOptions& part,
                                             const LimitOptions& given,
                                             const CommonOptions& common) {
  if (!asks_for_part(part) || part.frame > 0 || !is_regular(file)) return std::nullopt;
  FileReader reader(file);
  const auto bytes = reader.bytes();
  if (!bytes) return std::nullopt;
  const StreamSource source{*bytes,
                            [&](std::uint64_t offset, auto to) { return reader.read(offset, to); }};
  auto beginning = read_beginning(source, given.limits);
  if (!beginning || !*beginning) return std::nullopt;
  StreamInfo& info = (*beginning)->info;
  auto metadata = read_metadata(source, **beginning, given.limits);
  if (!metadata) return std::nullopt;
  info.metadata = *std::move(metadata);
  if (given.strict && is_partial(info)) return std::nullopt;
  const double before = reader.seconds();
  Stopwatch watch;
  auto field = decode_part(source, **beginning, decode_options(info, part, given, common));
  const double seconds = watch.lap() - (reader.seconds() - before);
  if (!field || !*field || !check_whole(file, info, given, common)) return std::nullopt;
  return DecodedFile{**std::move(field), *bytes, seconds, info.metadata};
}

}  // namespace slf::tools
