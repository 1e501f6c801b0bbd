// SPDX-License-Identifier: Apache-2.0
#include "tools/encode_splats.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "slf/crop_gaussians.h"
#include "slf/encode_gaussians.h"
#include "slf/settings.h"
#include "tools/output.h"
#include "tools/splat_input.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

constexpr std::uint64_t kMostInput = std::uint64_t{1} << 32;

/// What splats have no use for. A setting that changes nothing would be a promise not kept.
Outcome check_given(const EncodeOptions& given) {
  const auto refused = [&](const std::string& option) {
    return Failure{kUsage, "encode: --" + option + " is for photographs and clouds, and " +
                               given.capture + " holds splats"};
  };
  if (!given.points.empty()) return refused("points");
  if (given.world) return refused("points-world");
  if (!given.images.empty()) return refused("images");
  if (!given.split.empty()) return refused("split");
  const auto& settings = encoder_settings();
  for (const auto& pair : given.given)
    if (std::any_of(settings.begin(), settings.end(), [&](const SettingInfo& setting) {
          return setting.name == pair.first && setting.splats != SettingInfo::kAnySplats;
        }))
      return refused(pair.first);
  return Done{};
}

/// Leaves out what is not wanted; else says what perhaps is not.
Outcome crop_or_warn(const EncodeOptions& given, const std::string& file, Gaussians& splats) {
  if (const auto& c = given.crop; !c.empty())
    return from(file, crop(splats, WorldBox{{c[0], c[1], c[2]}, {c[3], c[4], c[5]}}));
  const std::string far = far_splats_warning(splats);
  if (!far.empty()) warn(file + ": " + far, given.common.quiet);
  return Done{};
}

}  // namespace

Result<GaussianFile, Failure> wanted_splats(const EncodeOptions& given, const std::string& name) {
  LimitOptions limits;  // as of any file that is encoded: 16 million splats of degree 3
  limits.limits.max_stream_bytes = limits.limits.max_memory = kMostInput;
  SLF_TRY(GaussianFile file, read_splat_file("encode", name, {}, limits, given.common));
  SLF_CHECK(crop_or_warn(given, name, file.gaussians));
  if (given.up_given) file.gaussians.up = given.up;
  return file;
}

Outcome encode_splats(const EncodeOptions& given, EncoderSettings settings) {
  SLF_CHECK(check_given(given));
  Stopwatch watch;
  SLF_TRY(GaussianFile file, wanted_splats(given, given.capture));
  const double load = watch.lap();
  const int degree = file.gaussians.degree;
  settings.metadata.insert(settings.metadata.begin(), {"source", file.format});
  if (!given.crs.empty()) {
    SLF_TRY(std::string crs, from(given.crs, read_crs(given.crs)));
    settings.metadata.emplace_back("crs", std::move(crs));
  }
  SLF_TRY(const EncodedGaussians coded,
          from(given.capture, encode_gaussians(std::move(file.gaussians), settings)));
  const double code = watch.lap();
  std::vector<std::string> warnings;
  if (!coded.warning.empty()) warnings.push_back(coded.warning);
  warn(warnings, given.common.quiet);
  SLF_CHECK(save(given.output, coded.stream.data(), coded.stream.size()));
  const double each = static_cast<double>(coded.stream.size()) / static_cast<double>(coded.splats);
  if (given.common.json)
    return print(nlohmann::ordered_json{
        {"bytes", coded.stream.size()},
        {"input_format", file.format},
        {"splats", coded.splats},
        {"left_out", file.left_out + coded.left_out},
        {"mended", file.mended},
        {"degree", degree},
        {"q", coded.q},
        {"grid", {{"bits", coded.grid.bits}, {"step", coded.grid.step}}},
        {"bytes_per_splat", each},
        {"seconds", {{"load", load}, {"code", code}, {"total", load + code}}},
        {"peak_memory_mib", peak_memory_mib()},
        {"warnings", warnings}});
  if (given.common.quiet) return Done{};
  std::fprintf(stderr,
               "splats        %s of degree %d (%s that no pixel shows left out)\n"
               "quality       Q %.4g; grid of %d bits, voxels of %.4g\n"
               "seconds       load %.2f, code %.2f\n"
               "file          %s bytes, %.1f a splat\n",
               grouped(coded.splats).c_str(), degree, grouped(coded.left_out).c_str(), coded.q,
               coded.grid.bits, coded.grid.step, load, code, grouped(coded.stream.size()).c_str(),
               each);
  return Done{};
}

}  // namespace slf::tools
