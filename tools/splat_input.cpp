// SPDX-License-Identifier: Apache-2.0
#include "tools/splat_input.h"

#include "tools/text.h"

namespace slf::tools {

bool is_splat_file(const std::string& file) {
  return looks_like_gaussians(std::filesystem::path(file));
}

Result<GaussianFile, Failure> read_splat_file(const std::string& verb, const std::string& file,
                                              const PartOptions& part, const LimitOptions& given,
                                              const CommonOptions& common) {
  if (part.levels > 0 || part.groups > 0 || part.layers > 0 || part.max_bytes > 0 ||
      !part.region.empty() || part.frame >= 0)
    return Failure{kUsage, verb + ": " + file + " holds splats, of which no part can be asked for"};
  SLF_TRY(const auto bytes, read_input(file, given));
  const auto folder = std::filesystem::path(file).parent_path();
  SLF_TRY(GaussianFile splats,
          from(file, parse_gaussians(file, bytes, folder.empty() ? "." : folder)));
  if (splats.left_out > 0)
    warn(file + ": " + grouped(splats.left_out) +
             " splats are left out: a position, size or colour is no number, or beyond its range",
         common.quiet);
  if (splats.mended > 0)
    warn(file + ": " + grouped(splats.mended) +
             " splats have a value beyond its range, which is the nearest within it now",
         common.quiet);
  return splats;
}

}  // namespace slf::tools
