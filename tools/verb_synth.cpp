// SPDX-License-Identifier: Apache-2.0
// slf synth: a capture of an analytic scene.
#include <unistd.h>

#include <array>
#include <filesystem>
#include <memory>

#include "tools/interrupt.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/progress.h"
#include "tools/synth/moving.h"
#include "tools/synth/moving_scene.h"
#include "tools/synth/plenoptic.h"
#include "tools/synth/synth.h"
#include "tools/text.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct SynthOptions {
  synth::SynthSettings settings;
  std::string output, size = "256x256";
  bool list = false;
  int plenoptic = 0;  ///< views; 0: a capture
  int frames = 0;     ///< 0: 8, of a scene that moves
  int bits = 0;       ///< of clouds that move
  double camera_turn = 0;
  int circles = 0, per_circle = 0;  ///< 0: what the scene has
  CommonOptions common;
};

/// Images are written by several threads, each through a temporary file. Called between images.
void leave_if_interrupted(const std::filesystem::path& directory) {
  if (!interrupt_pending()) return;
  const std::string mark = ".tmp" + std::to_string(getpid()) + "-";  // as write_file names them
  std::error_code ignored;
  std::vector<std::filesystem::path> parts;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory, ignored))
    if (entry.path().filename().string().find(mark) != std::string::npos)
      parts.push_back(entry.path());
  for (const auto& part : parts) std::filesystem::remove(part, ignored);
  exit_cancelled();
}

/// One PLY in place of a capture.
Outcome run_plenoptic(const SynthOptions& given) {
  SLF_CHECK(check_output(given.output, "synth", std::array{".ply"}));
  const synth::PlenopticScene scene{given.settings.scene, given.plenoptic, given.settings.points,
                                    static_cast<std::uint32_t>(given.settings.disturb.seed),
                                    given.common.threads};
  ProgressLine line(given.common.quiet);
  const DeferInterrupts defer;
  return from(given.output, synth::synthesise_plenoptic(scene, given.output, line.callback()));
}

/// What a progress function does besides drawing: it leaves when it was interrupted.
Progress leaving_if_interrupted(const std::filesystem::path& directory, ProgressLine& line) {
  return [directory, draw = line.callback()](const char* stage, double fraction) {
    leave_if_interrupted(directory);
    if (draw) draw(stage, fraction);
  };
}

/// A scene that moves: a directory with an entry for every frame.
Outcome run_moving(const SynthOptions& given, synth::MovingSettings settings) {
  const synth::SynthSettings& s = given.settings;
  if (s.mesh || s.disturb.any() || s.exposure_drift > 0 || s.houses != 0 || s.cameras != 0)
    return Failure{kUsage, "synth: " + s.scene +
                               " moves: it has no --mesh, --noise, --hull, --exposure-drift, "
                               "--houses, --cameras"};
  settings.scene = s.scene;
  if (given.frames != 0) settings.frames = given.frames;
  settings.threads = given.common.threads;
  settings.force = s.force;
  settings.bits = given.bits;
  settings.views = given.plenoptic;
  settings.points = s.points;
  settings.circles = given.circles;
  settings.per_circle = given.per_circle;
  settings.supersampling = s.supersampling;
  settings.camera_turn = given.camera_turn;
  ProgressLine line(given.common.quiet);
  const DeferInterrupts defer;
  return from(given.output, synth::synthesise_moving(settings, given.output,
                                                     leaving_if_interrupted(given.output, line)));
}

Outcome run_synth(const SynthOptions& given) {
  if (given.list) {
    return print(std::string(
        "can      textured, specular cylinder under 4 lights, as the paper's Can\n"
        "die      specular, slightly transparent die under 3 lights, as the paper's Die\n"
        "vase     glazed solid of revolution\n"
        "terrace  streets of houses, 1 to 10000 (--houses, --cameras, --seed): windows, "
        "wet stones and metal that mirror sky and street\n"
        "\n"
        "Scenes that move (--frames): captures\n"
        "turn     the can turns about two axes under standing lamps, 4 degrees a frame\n"
        "twist    a tube with three lobes twists and bends\n"
        "walk     a figure of ten parts walks in a circle\n"
        "appear   a ball is there from the third frame on, beside a can that turns\n"
        "and clouds on one grid of --bits, to compare codecs with\n"
        "still, noise   the can; with up to 0.3 voxel along its normals, anew in every frame\n"
        "rot1, rot4     the can turns by 1, 4 degrees a frame about two axes\n"
        "tube2, tube8   the tube's ends turn by 2, 8 degrees a frame against each other\n"));
  }
  if (given.settings.scene.empty())
    return Failure{kUsage, "synth: SCENE is missing (see slf synth --list)"};
  if (given.output.empty()) return Failure{kUsage, "synth: --output is missing"};
  const bool moves = synth::make_moving_scene(given.settings.scene).has_value();
  if (given.plenoptic == 0 || moves) SLF_CHECK(check_directory(given.output));
  synth::SynthSettings settings = given.settings;
  synth::MovingSettings moving;
  if (!parse_size(given.size, settings.width, settings.height))
    return Failure{kUsage, "synth: --size " + given.size + " is not WxH"};
  moving.width = settings.width;
  moving.height = settings.height;
  if (moves) return run_moving(given, moving);
  if (given.frames != 0 || given.bits != 0 || given.camera_turn != 0)
    return Failure{kUsage, "synth: " + settings.scene +
                               " does not move: --frames, --bits and --camera-turn are of " +
                               synth::moving_scene_names()};
  if (given.plenoptic > 0) return run_plenoptic(given);
  if (given.circles != 0) settings.circles = given.circles;
  if (given.per_circle != 0) settings.per_circle = given.per_circle;
  settings.threads = given.common.threads;
  ProgressLine line(given.common.quiet);
  const DeferInterrupts defer;
  return from(given.output, synth::synthesise(settings, given.output,
                                              leaving_if_interrupted(given.output, line)));
}

void add_disturbances(CLI::App& verb, synth::DisturbSettings& d) {
  verb.add_option("--noise", d.noise,
                  "Move points along their normals by Gaussian noise, standard deviation in point "
                  "spacings; the true cloud becomes exact.ply")
      ->capture_default_str()
      ->check(range(0, 10));
  verb.add_option("--noise-scale", d.noise_scale,
                  "Over so many spacings the noise is the same; 0: each point by itself")
      ->capture_default_str()
      ->check(range(0, 1000));
  verb.add_option("--hull", d.hull,
                  "Push points outwards by 0 to so many spacings, slowly varying, as a visual hull")
      ->capture_default_str()
      ->check(range(0, 20));
  verb.add_option("--seed", d.seed,
                  "Seed of --noise, --hull, --exposure-drift, --plenoptic and the terrace")
      ->capture_default_str()
      ->check(whole_range(0, 0xffffffff));
}

void add_motions(CLI::App& verb, SynthOptions& o) {
  verb.add_option("--frames", o.frames,
                  "Frames of a scene that moves: captures DIR/frame_0001 or clouds "
                  "DIR/frame_0001.ply and so on (8)")
      ->check(whole_range(1, 9999));
  verb.add_option("--bits", o.bits, "Bits of the grid of clouds that move (8)")
      ->check(whole_range(5, 12));
  verb.add_option("--camera-turn", o.camera_turn,
                  "Degrees that all cameras of a capture that moves go on by in a frame (0: they "
                  "stand still)")
      ->check(range(-180, 180));
}

}  // namespace

void add_synth(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand(
      "synth", "Write a capture of an analytic scene (--list), or of one that moves");
  auto o = std::make_shared<SynthOptions>();
  synth::SynthSettings& s = o->settings;
  verb->add_option("SCENE", s.scene, "Scene (see --list)")->type_name("");
  verb->add_option(
          "-o,--output", o->output,
          "Directory to write the capture into: new, empty, or an earlier synthetic capture; with "
          "--plenoptic the PLY file")
      ->type_name("DIR");
  verb->add_option("--size", o->size, "Pixels of an image, WxH, 8x8 to 4096x4096")
      ->type_name("WxH")
      ->capture_default_str();
  verb->add_option(
          "--points", s.points,
          "About so many points, 100 to 10000000, of the terrace to 100000000; 0: the scene's "
          "own density")
      ->capture_default_str()
      ->check(whole_range(0, 100'000'000));
  verb->add_option("--houses", s.houses, "Houses of the terrace (12)")
      ->check(whole_range(1, 10'000));
  verb->add_option(
          "--cameras", s.cameras,
          "Photographs of the terrace, half of them from the street, half from above; every "
          "eighth is for evaluation (120)")
      ->check(whole_range(2, 10'000));
  verb->add_option("--circles", o->circles,
                   "Circles of cameras; not of the terrace (11; 3 of scenes that move)")
      ->check(whole_range(1, 99));
  verb->add_option("--per-circle", o->per_circle, "Cameras on a circle (50; 8 of scenes that move)")
      ->check(whole_range(1, 360));
  verb->add_option("--supersampling", s.supersampling, "Rays per pixel and axis")
      ->capture_default_str()
      ->check(whole_range(1, 8));
  add_motions(*verb, *o);
  add_disturbances(*verb, s.disturb);
  verb->add_option("--exposure-drift", s.exposure_drift,
                   "Exposure of photographs differs by up to this share, each channel's by half as "
                   "much again; not of the terrace")
      ->capture_default_str()
      ->check(range(0, 0.5));
  verb->add_flag("--mesh", s.mesh, "Write mesh.obj too (can, vase), for --points of encode");
  verb->add_option(
          "--plenoptic", o->plenoptic,
          "Write one PLY whose points have the colours of so many views, a quarter of the "
          "voxels of the surface, in place of a capture (can, die, vase); of clouds that move "
          "one for each frame: docs/plenoptic.md")
      ->type_name("VIEWS")
      ->check(whole_range(2, 254));
  verb->add_flag("--force", s.force, "Write into a directory that holds something else");
  verb->add_flag("--list", o->list, "List the scenes");
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  verb->callback([&run, o] { run = [o] { return run_synth(*o); }; });
}

}  // namespace slf::tools
