#include "tools/encode_options.h"

#include <bit>
#include <charconv>

#include "tools/choices.h"

namespace slf::tools {
namespace {

std::string shown(double number) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number).ptr};
}

/// An option of the preset: `initial`, what the default preset has, is shown, not set.
template <class T>
CLI::Option* add(CLI::App& verb, const char* name, std::optional<T>& target, double initial,
                 const std::string& description, const CLI::Validator& check) {
  return verb.add_option(name, target, description)->default_str(shown(initial))->check(check);
}

void add_input_options(CLI::App& verb, EncodeOptions& o, const char* file) {
  verb.add_option("CAPTURE", o.capture,
                  "Directory with cameras.json, a COLMAP model or transforms.json; or one of those "
                  "files; or a coloured .ply alone (docs/captures.md)")
      ->type_name("")
      ->required();
  verb.add_option("-o,--output", o.output,
                  std::string("The ") + file + " file; - is standard output")
      ->type_name("FILE")
      ->required();
  verb.add_option("--points", o.points,
                  "Cloud (PLY) or mesh (PLY with faces, OBJ, GLB) in place of the capture's own")
      ->type_name("FILE");
  verb.add_option(
      "--split", o.split,
      "Input images: dense, intermediate, sparse, all, or a name of the capture's. None: "
      "dense where the capture names splits, else all but every fourth");
  add_up_choice(verb, o.up)
      ->type_name("NAME")
      ->each([&o](const std::string&) { o.up_given = true; })
      ->default_str("the capture's");
  verb.add_flag("--linear", o.linear,
                "Fit in linear light (sRGB decoded); default: display values");
}

void add_observe_options(CLI::App& verb, EncodeOptions& o, const EncoderSettings& initial) {
  const ObserveSettings& s = initial.observe;
  add(verb, "--delta", o.delta, s.delta_degrees,
      "A view is valid up to 90 - delta degrees from the normal; degrees", range(0, 90))
      ->group("Observation (paper III-A)");
  add(verb, "--occlusion-resolution", o.occlusion_resolution, s.occlusion_resolution,
      "Depth buffer pixels per image pixel", range(0.05, 8))
      ->group("Observation (paper III-A)");
  add(verb, "--depth-tolerance", o.depth_tolerance, s.depth_tolerance,
      "Hidden if deeper than the depth buffer by more, in point spacings; 0: strict",
      range(0, 1000))
      ->group("Observation (paper III-A)");
}

void add_hierarchy_options(CLI::App& verb, EncodeOptions& o, const FitSettings& fit) {
  const HierarchySettings& s = fit.hierarchy;
  const auto group = [](CLI::Option* option) {
    return option->group("Hierarchical fit (--fit hierarchical)");
  };
  group(add_basis_choice(verb, o.basis)->each([&o](const std::string&) {
    o.basis_given = true;
  }))->default_str("harmonics");
  group(add_frame_choice(verb, o.frame)->each([&o](const std::string&) {
    o.frame_given = true;
  }))->default_str("auto");
  group(add_cross_validate_choice(verb, o.cross_validate)->each([&o](const std::string&) {
    o.cross_validate_given = true;
  }));
  group(add(verb, "--degree", o.degree, fit.basis.degree, "Degree of the harmonics",
            whole_range(0, 10)));
  group(add(verb, "--block-log2", o.block_log2, s.block_log2,
            "Side of the finest blocks, 2^n spacings of points", whole_range(0, 21)));
  group(add(verb, "--block-strength", o.block_strength, s.strength,
            "Pull of a block towards the one above, per observation", range(1e-6, 1e6)));
  group(add(verb, "--block-growth", o.block_growth, s.growth,
            "Growth of its penalties with a function's fineness", range(1, 10)));
  group(add(verb, "--point-penalty", o.point_penalty, s.point_penalty,
            "Pull of a point towards its block", range(1e-6, 1e9)));
  group(add(verb, "--point-growth", o.point_growth, s.point_growth, "Growth of its penalties",
            range(1, 10)));
  group(add(verb, "--environment-degree", o.environment_degree, fit.environment.degree,
            "Degree of the light about the object that its surface reflects; 0: none",
            whole_range(0, 16)));
  const CLI::Validator radius(
      [](std::string& given) {
        return range(0, 0)(given).empty() ? std::string() : range(2, 1e6)(given);
      },
      "0 or 2 to 1e6");
  group(add(verb, "--environment-radius", o.environment_radius, fit.environment.radius,
            "Where that light is, in halves of the object's longest side; 0: by cross-validation",
            radius));
}

void add_fit_options(CLI::App& verb, EncodeOptions& o, const EncoderSettings& initial) {
  const FitSettings& s = initial.fit;
  const auto fit = [](CLI::Option* option) { option->group("View maps (paper II)"); };
  fit(add_fit_choice(verb, o.fit)->each([&o](const std::string&) { o.fit_given = true; }));
  fit(add_fit_to_choice(verb, o.fit_to_pictures)->each([&o](const std::string&) {
    o.fit_to_given = true;
  }));
  fit(add(verb, "--order", o.order, FitSettings{}.basis.order, "Order of the B-spline wavelets",
          whole_range(1, 4)));
  auto* functions =
      add(verb, "--functions", o.functions, FitSettings{}.basis.num_functions(),
          "N, functions per view map: a power of two; s0 = s1 or s1 + 1", whole_range(1, 4096));
  fit(functions);
  auto* scales = verb.add_option("--scales", o.scales,
                                 "s0,s1 apart: 2^s0 functions of azimuth times 2^s1 of elevation")
                     ->delimiter(',')
                     ->expected(2)
                     ->check(whole_range(0, 6))
                     ->excludes(functions);
  fit(scales);
  fit(add(verb, "--lambda", o.lambda, s.lambda, "Ridge weight", range(0, 1e9)));
  fit(add(verb, "--beta", o.beta, s.beta, "Smoothness weight", range(0, 1e9)));
  fit(add(verb, "--iterations", o.iterations, s.iterations, "T, sweeps of smoothing",
          whole_range(0, 100)));
  fit(add(verb, "--neighbours", o.neighbours, s.neighbours, "Nearest points to smooth over",
          whole_range(1, 64)));
  auto* penalise = verb.add_flag("--penalise-dc", o.penalise_dc,
                                 "lambda and beta hold for the mean too (paper)");
  auto* free = verb.add_flag("--free-dc", o.free_dc, "They leave out the mean (default)")
                   ->excludes(penalise);
  fit(penalise);
  fit(free);
  add_hierarchy_options(verb, o, s);
}

CLI::Option* coding(CLI::Option* option) { return option->group("Coding"); }

void add_grid_options(CLI::App& verb, EncodeOptions& o) {
  const CLI::Validator bits_or_auto(
      [](std::string& given) {
        if (given != "auto") return whole_range(1, 21)(given);
        given = "0";
        return std::string();
      },
      "1 to 21 or auto");
  auto* bits = coding(verb.add_option("--grid-bits", o.grid_bits,
                                      "Voxel grid, bits per axis; auto: a voxel is what the "
                                      "sharpest photographs resolve, or the cloud's own spacing")
                          ->default_str("auto")
                          ->transform(bits_or_auto));
  coding(verb.add_option("--voxel-size", o.voxel_size,
                         "Voxel edge in world units, in place of --grid-bits")
             ->check(range(1e-12, 1e12))
             ->excludes(bits));
  coding(add_densify_choice(verb, o.densify)->each([&o](const std::string&) {
    o.densify_given = true;
  }));
  coding(
      add_refine_choice(verb, o.refine)->each([&o](const std::string&) { o.refine_given = true; }));
  coding(add_geometry_choice(verb, o.geometry)->each([&o](const std::string&) {
    o.geometry_given = true;
  }));
  coding(
      add_colour_choice(verb, o.colour)->each([&o](const std::string&) { o.colour_given = true; }));
  coding(
      verb.add_option("--metadata", o.metadata, "KEY=VALUE to store in the file; may be repeated")
          ->type_name("KEY=VALUE")
          ->expected(1, -1));
}

void add_coding_options(CLI::App& verb, EncodeOptions& o, const EncoderSettings& initial) {
  auto* q = coding(add(verb, "-q,--quality", o.q, initial.q,
                       "Quantiser step Q in grey levels: smaller is better and larger",
                       range(0.05, 4096)));
  auto* bytes =
      coding(verb.add_option("--target-bytes", o.target_bytes,
                             "Find the Q that gives a file of 99 to 100 % of so many bytes")
                 ->check(whole_range(1, 1LL << 40))
                 ->excludes(q));
  coding(verb.add_option("--target-psnr", o.target_psnr,
                         "Find the Q that gives the input images' PSNR, up to 0.05 dB more: of "
                         "pictures, or of points with --fit-to points")
             ->check(range(1, 100))
             ->excludes(q)
             ->excludes(bytes));
  coding(
      add_steps_choice(verb, o.by_norm)->each([&o](const std::string&) { o.steps_given = true; }));
  coding(add_coefficients_choice(verb, o.coefficients)->each([&o](const std::string&) {
    o.coefficients_given = true;
  }));
  coding(add_klt_choice(verb, o.klt)->each([&o](const std::string&) { o.klt_given = true; }));
  coding(add(verb, "--chroma-step", o.chroma_step, initial.chroma_step,
             "Steps of the second and third channel, over those of the first", range(0.1, 10)));
  add_texture_options(verb, o.texture);
  coding(add_predict_choice(verb, o.predict)->each([&o](const std::string&) {
    o.predict_given = true;
  }));
  coding(o.rdo_option = add_rdo(verb, o.rdo));
  coding(add(verb, "--normal-bits", o.normal_bits, initial.normal_bits,
             "Code normals with 4 to 12 bits per coordinate; 0: not", whole_range(0, 12)));
  coding(o.base_levels_option = add_base_levels(verb, o.base_levels));
  coding(o.slice_points_option = add_slice_points(verb, o.slice_points));
}

template <class T, class U>
void replace(U& setting, const std::optional<T>& given) {
  if (given) setting = *given;
}

Failure usage(const EncodeOptions& given, const std::string& what) {
  return {kUsage, std::string(given.verb) + ": " + what};
}

Outcome resolve_basis(const EncodeOptions& given, Basis& basis) {
  if (given.order) basis.order = *given.order;
  if (given.functions) {
    const auto n = static_cast<unsigned>(*given.functions);
    if (!std::has_single_bit(n))
      return usage(given, "--functions " + std::to_string(n) + " is not a power of two");
    const int scales = std::countr_zero(n);
    basis.scales_gamma = scales / 2;
    basis.scales_theta = scales - basis.scales_gamma;
  }
  if (given.scales.size() == 2) {
    basis.scales_theta = given.scales[0];
    basis.scales_gamma = given.scales[1];
  }
  return Done{};
}

/// An option that was given for another fit or basis than the one in force.
Outcome refuse_idle(const EncodeOptions& given, const FitSettings& fit) {
  struct Idle {
    const char* option;
    bool given;
  };
  const auto refuse = [&](std::initializer_list<Idle> options, const char* of) -> Outcome {
    for (const auto& [option, is_given] : options)
      if (is_given) return usage(given, std::string(option) + " is for " + of);
    return Done{};
  };
  if (fit.method == FitMethod::kHierarchical) {
    SLF_CHECK(refuse({{"--lambda", given.lambda.has_value()},
                      {"--beta", given.beta.has_value()},
                      {"--iterations", given.iterations.has_value()},
                      {"--penalise-dc", given.penalise_dc},
                      {"--free-dc", given.free_dc}},
                     "--fit paper"));
  } else {
    SLF_CHECK(refuse({{"--basis harmonics", given.basis == BasisId::kHarmonics},
                      {"--basis auto", given.basis_given && !given.basis},
                      {"--frame auto", given.frame_given && !given.frame},
                      {"--cross-validate", given.cross_validate_given},
                      {"--effort", given.effort.has_value()},
                      {"--block-log2", given.block_log2.has_value()},
                      {"--block-strength", given.block_strength.has_value()},
                      {"--block-growth", given.block_growth.has_value()},
                      {"--point-penalty", given.point_penalty.has_value()},
                      {"--point-growth", given.point_growth.has_value()},
                      {"--environment-degree", given.environment_degree.has_value()},
                      {"--environment-radius", given.environment_radius.has_value()}},
                     "--fit hierarchical"));
  }
  if (given.cross_validate_given && !given.cross_validate)
    SLF_CHECK(refuse({{"--basis auto", given.basis_given && !given.basis},
                      {"--frame auto", given.frame_given && !given.frame}},
                     "--cross-validate on"));
  if (fit.basis.id == BasisId::kBspline)
    return refuse({{"--degree", given.degree.has_value()}}, "--basis harmonics");
  const bool searched = given.basis_given && !given.basis;
  return refuse({{"--functions", given.functions.has_value()},
                 {"--scales", !given.scales.empty()},
                 {"--order", given.order.has_value() && !searched}},
                "--basis bspline");
}

/// What is left to cross-validation where the preset has `of_preset`: nothing that was given.
FitSearch search_of(const EncodeOptions& given, FitMethod method, FitSearch of_preset) {
  const bool asked = (given.basis_given && !given.basis) || (given.frame_given && !given.frame);
  const bool on = given.cross_validate_given ? given.cross_validate : asked || of_preset.any();
  if (method != FitMethod::kHierarchical || !on) return FitSearch::none();
  const bool basis = given.basis_given ? !given.basis : of_preset.basis && !given.degree;
  return {!given.block_strength, !given.block_growth, !given.point_penalty, !given.frame, basis,
          of_preset.points,      of_preset.pictures};
}

/// Each fit has a basis and a frame of its own. Options that only the paper's has choose it.
Outcome resolve_fit(const EncodeOptions& given, EncoderSettings& settings) {
  FitSettings& fit = settings.fit;
  const bool of_paper = !given.basis_given &&
                        (given.functions || !given.scales.empty() || given.order || given.lambda ||
                         given.beta || given.iterations || given.penalise_dc || given.free_dc);
  const FitMethod method = given.fit_given ? given.fit : of_paper ? FitMethod::kPaper : fit.method;
  if (method != fit.method) {
    const FitSettings start =
        method == FitMethod::kHierarchical ? FitSettings::hierarchical() : FitSettings{};
    fit.method = start.method;
    fit.basis = start.basis;
    fit.frame = start.frame;
    fit.pictures = start.pictures;
    settings.search = FitSearch{};
  }
  if (given.basis == BasisId::kBspline && fit.basis.id != BasisId::kBspline) fit.basis = Basis{};
  if (given.basis == BasisId::kHarmonics && fit.basis.id != BasisId::kHarmonics)
    fit.basis = FitSettings::hierarchical().basis;
  if (given.basis_given && !given.basis) fit.basis.id = BasisId::kHarmonics;
  replace(fit.frame, given.frame);
  SLF_CHECK(refuse_idle(given, fit));
  if (given.fit_to_given) {
    if (!given.fit_to_pictures) fit.pictures.rounds = 0;
    if (given.fit_to_pictures && fit.pictures.rounds == 0)
      fit.pictures = FitSettings::hierarchical().pictures;
  }
  settings.search = search_of(given, fit.method, settings.search);
  replace(fit.basis.degree, given.degree);
  replace(fit.hierarchy.block_log2, given.block_log2);
  replace(fit.hierarchy.strength, given.block_strength);
  replace(fit.hierarchy.growth, given.block_growth);
  replace(fit.hierarchy.point_penalty, given.point_penalty);
  replace(fit.hierarchy.point_growth, given.point_growth);
  replace(fit.environment.degree, given.environment_degree);
  replace(fit.environment.radius, given.environment_radius);
  return resolve_basis(given, fit.basis);
}

Outcome resolve_metadata(const EncodeOptions& given, Metadata& metadata) {
  for (const std::string& pair : given.metadata) {
    const std::size_t equals = pair.find('=');
    if (equals == 0 || equals == std::string::npos)
      return usage(given, "--metadata " + pair + " is not KEY=VALUE");
    metadata.emplace_back(pair.substr(0, equals), pair.substr(equals + 1));
  }
  return Done{};
}

/// More slices than one need a base, whatever the preset has.
void resolve_slices(const EncodeOptions& given, EncoderSettings& settings) {
  const auto is_given = [](const CLI::Option* option) {
    return option != nullptr && option->count() > 0;
  };
  if (is_given(given.slice_points_option)) {
    settings.max_slice_points = given.slice_points;
    settings.base_levels = kAutomaticBase;
  }
  if (is_given(given.base_levels_option)) settings.base_levels = given.base_levels;
}

}  // namespace

void add_encode_options(CLI::App& verb, EncodeOptions& o) {
  add_view_map_options(verb, o, ".slf");
  add_check_cameras_choice(verb, o.check_cameras)
      ->each([&o](const std::string&) { o.check_cameras_given = true; })
      ->group("Observation (paper III-A)");
  add_coding_options(verb, o, settings_of(Preset::kDefault));
}

void add_view_map_options(CLI::App& verb, EncodeOptions& o, const char* file) {
  const EncoderSettings initial = settings_of(Preset::kDefault);
  add_input_options(verb, o, file);
  add_preset_choice(verb, o.preset);
  add(verb, "--effort", o.effort, kDefaultEffort,
      "Time for bytes: 1 is quickest, 9 looks furthest (docs/rate.md)", whole_range(1, 9));
  add_grid_options(verb, o);
  add_observe_options(verb, o, initial);
  add_fit_options(verb, o, initial);
  add_threads(verb, o.common);
  add_quiet(verb, o.common);
  add_json(verb, o.common);
}

Result<EncoderSettings, Failure> resolved(const EncodeOptions& given) {
  if (given.effort && given.preset == Preset::kPaper)
    return usage(given, "--effort is for --preset default");
  EncoderSettings s = settings_of(given.preset, given.effort.value_or(kDefaultEffort));
  replace(s.grid_bits, given.grid_bits);
  replace(s.voxel_size, given.voxel_size);
  replace(s.q, given.q);
  replace(s.target_bytes, given.target_bytes);
  replace(s.target_psnr, given.target_psnr);
  replace(s.observe.delta_degrees, given.delta);
  replace(s.observe.occlusion_resolution, given.occlusion_resolution);
  replace(s.observe.depth_tolerance, given.depth_tolerance);
  replace(s.fit.lambda, given.lambda);
  replace(s.fit.beta, given.beta);
  replace(s.fit.iterations, given.iterations);
  replace(s.fit.neighbours, given.neighbours);
  replace(s.normal_bits, given.normal_bits);
  resolve_slices(given, s);
  if (s.normal_bits > 0 && s.normal_bits < 4)
    return usage(given, "--normal-bits " + std::to_string(s.normal_bits) + " is not 0, or 4 to 12");
  if (given.check_cameras_given) s.check_cameras = given.check_cameras;
  SLF_CHECK(resolve_fit(given, s));
  if (given.penalise_dc) s.fit.penalise_dc = true;
  if (given.free_dc) s.fit.penalise_dc = false;
  if (given.linear) s.observe.transfer = Transfer::kLinear;
  if (given.steps_given) s.steps_by_norm = given.by_norm;
  if (given.colour_given) s.colour = given.colour;
  if (given.densify_given) s.densify.mode = given.densify;
  if (given.refine_given) s.refine_geometry = given.refine;
  if (given.geometry_given) s.geometry = given.geometry;
  if (given.coefficients_given) s.coefficients = given.coefficients;
  s.texture = given.texture;
  if (given.predict_given) s.predict = given.predict;
  if (given.rdo_option != nullptr && given.rdo_option->count() > 0) s.rdo = given.rdo;
  if (given.klt_given) s.transform = given.klt;
  replace(s.chroma_step, given.chroma_step);
  SLF_CHECK(resolve_metadata(given, s.metadata));
  s.threads = given.common.threads;
  return s;
}

}  // namespace slf::tools
