// Options that several verbs share, and checks of values: every number has a stated range.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "slf/decoder.h"
#include "tools/failure.h"

namespace slf::tools {

/// A number from low to high, both included. NaN and infinities are outside every range.
CLI::Validator range(double low, double high);
CLI::Validator whole_range(std::int64_t low, std::int64_t high);

/// -j, --quiet and --json.
struct CommonOptions {
  int threads = 0;
  bool quiet = false;
  bool json = false;
};
void add_threads(CLI::App& verb, CommonOptions& options);
void add_quiet(CLI::App& verb, CommonOptions& options);
void add_json(CLI::App& verb, CommonOptions& options);

/// --levels, --groups, --max-bytes and --region: which part of a stream is decoded.
struct PartOptions {
  int levels = 0;
  int groups = 0;
  std::uint64_t max_bytes = 0;
  std::vector<double> region;  ///< two corners in world units, or nothing
};
void add_part(CLI::App& verb, PartOptions& options);

/// The same for the library. Of the stream only headers are read, and only for a region.
Result<DecodeOptions, Failure> decode_options(const std::string& file,
                                              const std::vector<std::uint8_t>& stream,
                                              const PartOptions& part);

/// Reads and decodes; "-" is standard input.
struct DecodedFile {
  LightField field;
  std::uint64_t bytes = 0;
  double seconds = 0;  ///< of decoding alone
};
Result<DecodedFile, Failure> decode_file(const std::string& file, const PartOptions& part,
                                         int threads);

/// Wall time for reports.
class Stopwatch {
 public:
  /// Seconds since the last lap, or since construction.
  double lap();

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// A failure for verbs that need view maps, where the file holds integer planes without a meaning.
Outcome require_view_maps(const LightField& field, const std::string& file);

/// "800x600". @return false where it is not two whole numbers of 1 .. 16384.
bool parse_size(const std::string& text, int& width, int& height);

}  // namespace slf::tools
