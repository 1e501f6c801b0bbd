// SPDX-License-Identifier: Apache-2.0
// PLY as 3-D Gaussian splatting (Kerbl et al. 2023) writes it: scales as logarithms, opacity as a
// logit, quaternions w first, harmonics channel by channel.
#include <string>

#include "lightfield/splats/splat_writers.h"

namespace slf {
namespace {

std::string header(const SplatRows& splats) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(splats.size()) + "\n";
  const auto add = [&text](const std::string& name) { text += "property float " + name + "\n"; };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"})
    add(name);
  for (std::size_t i = 0; i < 3 * (functions_of(splats.degree()) - 1); ++i)
    add("f_rest_" + std::to_string(i));
  for (const char* name :
       {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    add(name);
  return text + "end_header\n";
}

}  // namespace

Bytes write_splat_ply(const SplatRows& splats) {
  const std::string head = header(splats);
  const std::size_t count = functions_of(splats.degree());
  Bytes out(head.begin(), head.end());
  out.reserve(head.size() + splats.size() * 4 * (14 + 3 * count));
  for (std::size_t p = 0; p < splats.size(); ++p) {
    for (const float x : splats.position(p)) put(out, x);
    for (const float n : splats.normal(p)) put(out, n);
    const float* harmonics = splats.harmonics(p);
    for (std::size_t c = 0; c < 3; ++c) put(out, harmonics[c]);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 1; k < count; ++k) put(out, harmonics[3 * k + c]);
    put(out, splats.logit(p));
    for (const float size : splats.log_deviations(p)) put(out, size);
    for (const float q : splats.rotation(p)) put(out, q);
  }
  return out;
}

}  // namespace slf
