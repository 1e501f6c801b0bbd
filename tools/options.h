// SPDX-License-Identifier: Apache-2.0
// Options that several verbs share, and checks of values: every number has a stated range.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "slf/points_world.h"

namespace slf::tools {

/// A number from low to high, both included. NaN and infinities are outside every range.
CLI::Validator range(double low, double high);
CLI::Validator whole_range(std::int64_t low, std::int64_t high);
/// Bytes within the same: a whole number, with K, M, G or T for powers of 1024 where wanted. What
/// is given becomes plain digits.
CLI::Validator byte_range(std::int64_t low, std::int64_t high);

/// -j, --quiet and --json.
struct CommonOptions {
  int threads = 0;
  bool quiet = false;
  bool json = false;
};
void add_threads(CLI::App& verb, CommonOptions& options);
void add_quiet(CLI::App& verb, CommonOptions& options);
void add_json(CLI::App& verb, CommonOptions& options);

/// --points and --points-world.
void add_points(CLI::App& verb, std::string& points, std::optional<WorldChange>& world);

/// --levels, --groups, --layers, --max-bytes and --region: which part of a stream is decoded.
class FrameSource;

struct PartOptions {
  int levels = 0;
  int groups = 0;
  int layers = 0;
  std::uint64_t max_bytes = 0;
  std::vector<double> region;           ///< two corners in world units, or nothing
  int frame = -1;                       ///< place among the frames; -1: the first, and only
  std::string frames;                   ///< "A:B": several of them, one after the other
  std::shared_ptr<FrameSource> source;  ///< where they come from, so that each is decoded once
  bool means_only = false;  ///< what is not needed for them is left out; no option of its own
};
void add_part(CLI::App& verb, PartOptions& options);
/// --frame, of verbs that show one.
void add_frame(CLI::App& verb, PartOptions& options);
/// --frame and --frames.
void add_frames_to_show(CLI::App& verb, PartOptions& options);

/// Wall time for reports.
class Stopwatch {
 public:
  /// Seconds since the last lap, or since construction.
  double lap();

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// "800x600". @return false where it is not two whole numbers of 1 .. 16384.
bool parse_size(const std::string& text, int& width, int& height);

}  // namespace slf::tools
