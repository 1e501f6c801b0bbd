// SPDX-License-Identifier: Apache-2.0
#include "tools/scene_options.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <ctime>

#include "tools/interrupt.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

constexpr double kSecondsOfLine = 60;

/// "2026-11-23 10:15:00", UTC.
std::string now() {
  const std::time_t seconds = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &parts);
  return text;
}

}  // namespace

void add_work(CLI::App& verb, SceneOptions& o) {
  verb.add_option("--memory", o.memory,
                  "Code the scene slice by slice within so many bytes (K, M and G are 2^10, 2^20, "
                  "2^30): at least 256M. Of a plenoptic cloud: the degree of view maps that it has "
                  "room for")
      ->type_name("BYTES")
      ->transform(byte_range(std::int64_t{1} << 28, std::int64_t{1} << 50));
  verb.add_option("--work", o.work,
                  "Directory for points, depth maps and slices that are done; parts may share it. "
                  "None: FILE.work, removed at the end. Without parts: for what a training needs "
                  "to go on")
      ->type_name("DIR");
  verb.add_option("--log", o.log, "File that a line is added to for every slice, and every minute")
      ->type_name("FILE");
}

void add_scene(CLI::App& verb, SceneOptions& o) {
  const std::string group = "Large scenes (docs/scenes.md)";
  add_work(verb, o);
  verb.add_option("--plan", o.plan, "What all parts share, from slf plan, in place of settings")
      ->type_name("FILE");
  verb.add_option(
          "--part", o.part,
          "Code part I of N of the plan, or of the groups of frames: 1/4 .. 4/4, for slf merge")
      ->type_name("I/N");
  verb.add_flag("--resume", o.resume, "Go on where an earlier run with the same --work was ended");
  verb.add_flag("--dry-run", o.dry_run,
                "Say points, slices, memory, disk and time that it would take, and stop; of frames "
                "which there are, their points and their grid");
  for (const char* name :
       {"--memory", "--work", "--log", "--plan", "--part", "--resume", "--dry-run"})
    verb.get_option(name)->group(group);
}

Result<ScenePart, Failure> part_of(const std::string& text) {
  ScenePart part;
  if (text.empty()) return part;
  const Failure wrong{kUsage, "encode: --part " + text + " is not I/N, 1/N to N/N, N up to 4096"};
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, part.index);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != '/') return wrong;
  const auto second = std::from_chars(first.ptr + 1, end, part.count);
  if (second.ec != std::errc() || second.ptr != end) return wrong;
  if (part.count < 1 || part.count > kMostParts || part.index < 1 || part.index > part.count)
    return wrong;
  --part.index;
  return part;
}

Result<std::unique_ptr<SceneLog>, Failure> SceneLog::open(const std::string& file,
                                                          ProgressLine& line) {
  std::unique_ptr<SceneLog> log(new SceneLog(line.callback()));
  if (file.empty()) return log;
  log->file_ = std::fopen(file.c_str(), "ae");
  if (log->file_ == nullptr) return Failure{kWriteFailed, file + ": " + std::strerror(errno)};
  return log;
}

SceneLog::~SceneLog() {
  if (file_ != nullptr) std::fclose(file_);
}

void SceneLog::write(const std::string& text) {
  last_ = std::chrono::steady_clock::now();
  if (file_ == nullptr) return;
  std::fprintf(file_, "%s %s\n", now().c_str(), text.c_str());
  std::fflush(file_);
}

Progress SceneLog::progress() {
  return [this](const char* stage, double fraction) {
    if (interrupt_pending()) {
      write("interrupted");
      exit_cancelled();
    }
    if (draw_) draw_(stage, fraction);
    const auto time = std::chrono::steady_clock::now();
    if (std::chrono::duration<double>(time - last_).count() < kSecondsOfLine) return;
    write(text("%s %.0f %%", stage, 100 * fraction));
  };
}

nlohmann::ordered_json cost_json(const SceneCost& cost) {
  return {{"points", cost.points},
          {"slices", cost.slices},
          {"cameras", cost.cameras},
          {"memory", cost.memory},
          {"planning_memory", cost.planning},
          {"disk", cost.disk},
          {"estimated_seconds", cost.seconds > 0 ? nlohmann::ordered_json(cost.seconds) : nullptr}};
}

SceneWork scene_work(const SceneOptions& options, const std::string& directory, int threads,
                     SceneLog& log) {
  SceneWork work;
  work.directory = directory;
  if (options.memory > 0) work.memory = options.memory;
  work.resume = options.resume;
  work.threads = threads;
  work.log = [&log](const std::string& line) { log.write(line); };
  return work;
}

std::string quality_text(const ScenePlan& plan) {
  std::string q;
  for (const auto& [name, value] : plan.settings)
    if (name == "quality") q = value;
  return "Q " + q + ", " + reason_of(plan.step);
}

}  // namespace slf::tools
