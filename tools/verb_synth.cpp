// slf synth: a capture of an analytic scene.
#include <unistd.h>

#include <array>
#include <filesystem>
#include <memory>

#include "tools/interrupt.h"
#include "tools/options.h"
#include "tools/output.h"
#include "tools/progress.h"
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
  CommonOptions common;
};

/// Images are written by several threads, each through a temporary file. Called between images.
void leave_if_interrupted(const std::filesystem::path& directory) {
  if (!interrupt_pending()) return;
  const std::string mark = ".tmp" + std::to_string(getpid()) + "-";  // as write_file names them
  std::error_code ignored;
  for (const auto& part : {directory, directory / "images"})
    for (const auto& entry : std::filesystem::directory_iterator(part, ignored))
      if (entry.path().filename().string().find(mark) != std::string::npos)
        std::filesystem::remove(entry.path(), ignored);
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

Outcome run_synth(const SynthOptions& given) {
  if (given.list) {
    return print(std::string(
        "can      textured, specular cylinder under 4 lights, as the paper's Can\n"
        "die      specular, slightly transparent die under 3 lights, as the paper's Die\n"
        "vase     glazed solid of revolution\n"
        "terrace  streets of houses, 1 to 10000 (--houses, --cameras, --seed): windows, "
        "wet stones and metal that mirror sky and street\n"));
  }
  if (given.settings.scene.empty())
    return Failure{kUsage, "synth: SCENE is missing (see slf synth --list)"};
  if (given.output.empty()) return Failure{kUsage, "synth: --output is missing"};
  if (given.plenoptic > 0) return run_plenoptic(given);
  synth::SynthSettings settings = given.settings;
  if (!parse_size(given.size, settings.width, settings.height))
    return Failure{kUsage, "synth: --size " + given.size + " is not WxH"};
  settings.threads = given.common.threads;
  const std::filesystem::path directory = given.output;
  ProgressLine line(given.common.quiet);
  const Progress draw = line.callback();
  const DeferInterrupts defer;
  return from(given.output,
              synth::synthesise(settings, directory, [&](const char* stage, double fraction) {
                leave_if_interrupted(directory);
                if (draw) draw(stage, fraction);
              }));
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
  verb.add_option("--seed", d.seed, "Of --noise, --hull, --plenoptic and the terrace")
      ->capture_default_str();
}

}  // namespace

void add_synth(CLI::App& program, Run& run) {
  auto* verb = program.add_subcommand(
      "synth", "Write a capture of an analytic scene: can, die, vase, terrace");
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
  verb->add_option("--circles", s.circles, "Circles of cameras; not of the terrace")
      ->capture_default_str()
      ->check(whole_range(1, 99));
  verb->add_option("--per-circle", s.per_circle, "Cameras on a circle")
      ->capture_default_str()
      ->check(whole_range(1, 360));
  verb->add_option("--supersampling", s.supersampling, "Rays per pixel and axis")
      ->capture_default_str()
      ->check(whole_range(1, 8));
  add_disturbances(*verb, s.disturb);
  verb->add_flag("--mesh", s.mesh, "Write mesh.obj too (can, vase), for --points of encode");
  verb->add_option("--plenoptic", o->plenoptic,
                   "Write one PLY whose points have the colours of so many views, a quarter of the "
                   "voxels of the surface, in place of a capture (can, die, vase): "
                   "docs/plenoptic.md")
      ->type_name("VIEWS")
      ->check(whole_range(2, 254));
  verb->add_flag("--force", s.force, "Write into a directory that holds something else");
  verb->add_flag("--list", o->list, "List the scenes");
  add_threads(*verb, o->common);
  add_quiet(*verb, o->common);
  verb->callback([&run, o] { run = [o] { return run_synth(*o); }; });
}

}  // namespace slf::tools
