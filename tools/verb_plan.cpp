// SPDX-License-Identifier: Apache-2.0
// slf plan: what the parts of a scene share.
#include <array>
#include <memory>

#include "slf/frame_inputs.h"
#include "tools/interrupt.h"
#include "tools/output.h"
#include "tools/scene_options.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct PlanOptions {
  EncodeOptions encode;
  SceneOptions scene;
};

Outcome run_plan(const PlanOptions& o) {
  const EncodeOptions& given = o.encode;
  if (o.scene.work.empty()) return Failure{kUsage, "plan: --work DIR is missing"};
  SLF_CHECK(check_output(given.output, "plan", std::array{".json"}));
  if (holds_frames(given.capture))
    return Failure{kUsage, "plan: " + given.capture +
                               " holds frames in time, whose parts need no plan (slf encode "
                               "--part)"};
  SLF_TRY(const EncoderSettings settings, resolved(given));
  ProgressLine line(given.common.quiet);
  SLF_TRY(const auto log, SceneLog::open(o.scene.log, line));
  const SceneWork work = scene_work(o.scene, o.scene.work, given.common.threads, *log);
  SLF_TRY(CaptureInput input, load_input(given, line));
  input.metadata.insert(input.metadata.end(), settings.metadata.begin(), settings.metadata.end());
  const DeferInterrupts defer;
  SLF_TRY(const ScenePlan plan,
          from(given.capture, plan_scene(input.capture, input.cameras, given.given, input.metadata,
                                         work, log->progress())));
  line.clear();
  SLF_CHECK(save(given.output, write_plan(plan)));
  const SceneCost cost = cost_of(plan);
  log->write(text("plan: %s points, %zu slices", grouped(cost.points).c_str(), cost.slices));
  log->write(quality_text(plan));
  if (given.common.json) return print(cost_json(cost));
  if (!given.common.quiet)
    std::fprintf(stderr, "%s points in %zu slices, %.0f MiB for one\n%s\n",
                 grouped(cost.points).c_str(), cost.slices, double(cost.memory) / (1 << 20),
                 quality_text(plan).c_str());
  return Done{};
}

}  // namespace

void add_plan(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand("plan", "What the parts of a large scene share, as JSON");
  auto o = std::make_shared<PlanOptions>();
  o->encode.verb = "plan";
  add_encode_options(*verb, o->encode);
  add_work(*verb, o->scene);
  verb->get_option("--output")->description("The plan; - is standard output");
  verb->get_option("--work")->description(
      "Directory for the points and depth maps, made where it is missing; parts share it");
  verb->callback([&run, o] { run = [o] { return run_plan(*o); }; });
}

}  // namespace slf::tools
