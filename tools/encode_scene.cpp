// SPDX-License-Identifier: Apache-2.0
// slf encode of a scene that is coded in parts: with a plan, or making one.
#include <array>
#include <filesystem>

#include "tools/interrupt.h"
#include "tools/output.h"
#include "tools/scene_options.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

std::string cost_text(const SceneCost& cost) {
  return text("points        %s in %zu slices\n", grouped(cost.points).c_str(), cost.slices) +
         text("cameras       %zu\n", cost.cameras) +
         text("memory        %.0f MiB at the most for a slice, %.0f while points are sorted\n",
              double(cost.memory) / (1 << 20), double(cost.planning) / (1 << 20)) +
         text("disk          %.0f MiB for the work, and depth maps\n",
              double(cost.disk) / (1 << 20));
}

/// One process, from a capture to a part or to a file.
class SceneRun {
 public:
  SceneRun(const EncodeOptions& given, const SceneOptions& scene)
      : given_(given), scene_(scene), line_(given.common.quiet) {}

  Outcome run() {
    SLF_TRY(const ScenePart part, part_of(scene_.part));
    SLF_CHECK(check());
    SLF_TRY(log_, SceneLog::open(scene_.log, line_));
    directory_ = scene_.work.empty() ? given_.output + ".work" : scene_.work;
    work_ = scene_work(scene_, directory_, given_.common.threads, *log_);
    const DeferInterrupts defer;
    SLF_CHECK(prepare());
    const SceneCost cost = cost_of(plan_);
    log_->write(text("%s points, %zu slices, %zu cameras", grouped(cost.points).c_str(),
                     cost.slices, cost.cameras));
    if (scene_.dry_run) return tell(cost);
    SLF_TRY(auto stream, from(given_.capture,
                              encode_part(input_.capture, plan_, part, work_, log_->progress())));
    if (scene_.part.empty()) {
      SLF_TRY(
          auto merged,
          from(given_.output, merge_parts(std::array{PartStream{given_.output, std::move(stream)}},
                                          false, given_.common.threads)));
      stream = std::move(merged.stream);
    }
    line_.clear();
    SLF_CHECK(save(given_.output, stream.data(), stream.size()));
    log_->write(text("%s bytes", grouped(stream.size()).c_str()));
    clean();
    return report(cost, stream.size());
  }

 private:
  Outcome check() const {
    if (given_.output == "-")
      return Failure{kUsage, "encode: a scene in parts is written to a file, not to -"};
    SLF_CHECK(check_output(given_.output, "encode", std::array{".slf"}));
    if (!scene_.part.empty() && scene_.plan.empty())
      return Failure{kUsage, "encode: --part needs --plan (slf plan)"};
    if (!scene_.plan.empty()) SLF_CHECK(check_left_to_plan());
    if (!scene_.plan.empty() && scene_.work.empty())
      return Failure{kUsage, "encode: --plan needs --work, the directory of slf plan"};
    return Done{};
  }

  Outcome check_left_to_plan() const {
    std::string name = given_.given.empty() ? "" : given_.given.front().first;
    if (!given_.split.empty()) name = "split";
    if (given_.up_given) name = "up";
    if (!given_.metadata.empty()) name = "metadata";
    if (!given_.notes.empty()) name = "notes";
    if (!given_.crs.empty()) name = "crs";
    if (name.empty()) return Done{};
    return Failure{kUsage, "encode: --" + name + " is in the plan: give it to slf plan"};
  }

  /// The plan, and as much of the capture as is needed for it.
  Outcome prepare() {
    if (scene_.plan.empty()) {
      SLF_TRY(input_, load_input(given_, line_));
      return make_plan();
    }
    SLF_TRY(plan_, from(scene_.plan, read_plan(std::filesystem::path(scene_.plan))));
    CaptureOptions options;
    options.points = given_.points;
    options.images = given_.images;
    options.world = given_.world;
    if (const auto& c = given_.crop; !c.empty())
      options.crop = WorldBox{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}};
    options.cloud = !has_points(plan_, work_);
    SLF_TRY(input_.capture, from(given_.capture, load_capture(given_.capture, options)));
    return Done{};
  }

  Outcome make_plan() {
    Metadata metadata = input_.metadata;
    SLF_TRY(const EncoderSettings settings, resolved(given_));
    metadata.insert(metadata.end(), settings.metadata.begin(), settings.metadata.end());
    auto plan =
        plan_scene(input_.capture, input_.cameras, given_.given, metadata, work_, log_->progress());
    if (!plan) clean();
    SLF_TRY(plan_, from(given_.capture, std::move(plan)));
    input_.capture.cloud = {};
    log_->write(quality_text(plan_));
    return Done{};
  }

  Outcome tell(const SceneCost& cost) {
    line_.clear();
    clean();
    if (given_.common.json) return print(cost_json(cost));
    std::fputs(cost_text(cost).c_str(), stdout);
    if (cost.seconds > 0)
      std::printf("time          some %.1f minutes for the slices, in one process here\n",
                  cost.seconds / 60);
    return Done{};
  }

  Outcome report(const SceneCost& cost, std::size_t bytes) {
    if (given_.common.json) {
      auto json = cost_json(cost);
      json["bytes"] = bytes;
      json["seconds"] = watch_.lap();
      json["peak_memory_mib"] = peak_memory_mib();
      return print(json);
    }
    if (given_.common.quiet) return Done{};
    std::fputs(cost_text(cost).c_str(), stderr);
    std::fprintf(stderr, "seconds       %.1f\npeak memory   %.0f MiB\nfile          %s bytes\n",
                 watch_.lap(), peak_memory_mib(), grouped(bytes).c_str());
    return Done{};
  }

  /// A directory that nobody asked for.
  void clean() const {
    std::error_code ignored;
    if (scene_.work.empty()) std::filesystem::remove_all(directory_, ignored);
  }

  const EncodeOptions& given_;
  const SceneOptions& scene_;
  ProgressLine line_;
  std::unique_ptr<SceneLog> log_;
  std::string directory_;
  SceneWork work_;
  CaptureInput input_;
  ScenePlan plan_;
  Stopwatch watch_;
};

}  // namespace

Outcome encode_scene(const EncodeOptions& given, const SceneOptions& scene) {
  return SceneRun(given, scene).run();
}

}  // namespace slf::tools
