// SPDX-License-Identifier: Apache-2.0
// What slf plan, slf encode and slf merge are told of scenes that are coded in parts.
#pragma once

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "slf/scene.h"
#include "tools/capture_input.h"
#include "tools/encode_options.h"
#include "tools/progress.h"

namespace slf::tools {

struct SceneOptions {
  std::uint64_t memory = 0;  ///< bytes; 0: not given
  std::string work, plan, log;
  std::string part;  ///< "i/n", from 1
  bool resume = false, dry_run = false;

  /// A scene is coded in slices, each with what is near to it. --work and --resume alone are of a
  /// training.
  bool in_parts() const {
    return memory > 0 || !plan.empty() || !part.empty() || !log.empty() || dry_run;
  }
};

/// --memory, --work, --log.
void add_work(CLI::App& verb, SceneOptions& options);

/// Those of encode: also --plan, --part, --resume, --dry-run.
void add_scene(CLI::App& verb, SceneOptions& options);

/// The part that --part names; the only part where there is none.
/// @errors kUsage
Result<ScenePart, Failure> part_of(const std::string& text);

/// A log in a file, a line at a time, and progress that ends at an interrupt.
class SceneLog {
 public:
  /// @errors kWriteFailed
  static Result<std::unique_ptr<SceneLog>, Failure> open(const std::string& file,
                                                         ProgressLine& line);
  ~SceneLog();
  SceneLog(const SceneLog&) = delete;
  SceneLog& operator=(const SceneLog&) = delete;

  void write(const std::string& text);
  /// Draws, writes a line a minute, and leaves the program where it is interrupted.
  Progress progress();

 private:
  explicit SceneLog(Progress draw) : draw_(std::move(draw)) {}

  Progress draw_;
  std::FILE* file_ = nullptr;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now(), last_ = began_;
};

SceneWork scene_work(const SceneOptions& options, const std::string& directory, int threads,
                     SceneLog& log);

nlohmann::ordered_json cost_json(const SceneCost& cost);

/// slf encode, of a scene.
Outcome encode_scene(const EncodeOptions& given, const SceneOptions& scene);

/// The step of all slices, and where it came from.
std::string quality_text(const ScenePlan& plan);

}  // namespace slf::tools
