// PLY as 3-D Gaussian splatting (Kerbl et al. 2023) writes it: scales as logarithms, opacity as a
// logit, quaternions w first, harmonics channel by channel.
#include <cmath>
#include <string>

#include "exchange/splat_axes.h"
#include "exchange/splat_writers.h"

namespace slf {
namespace {

std::string header(const SplatCloud& splats) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(splats.size()) + "\n";
  const auto add = [&text](const std::string& name) { text += "property float " + name + "\n"; };
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"})
    add(name);
  for (std::size_t i = 0; i < 3 * (splats.num_harmonics() - 1); ++i)
    add("f_rest_" + std::to_string(i));
  for (const char* name :
       {"opacity", "scale_0", "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    add(name);
  return text + "end_header\n";
}

}  // namespace

Bytes write_splat_ply(const SplatCloud& splats) {
  const std::string head = header(splats);
  const std::size_t count = splats.num_harmonics();
  Bytes out(head.begin(), head.end());
  out.reserve(head.size() + splats.size() * 4 * (14 + 3 * count));
  const float opacity = std::log(kSplatOpacity / (1 - kSplatOpacity));
  for (std::size_t p = 0; p < splats.size(); ++p) {
    for (const float x : splats.positions[p]) put(out, x);
    for (const float n : splats.normals[p]) put(out, n);
    const float* harmonics = &splats.harmonics[p * 3 * count];
    for (std::size_t c = 0; c < 3; ++c) put(out, harmonics[c]);
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 1; k < count; ++k) put(out, harmonics[3 * k + c]);
    put(out, opacity);
    const float across = std::log(splats.deviations[p]);
    put(out, across);
    put(out, across);
    put(out, across + std::log(kSplatFlatness));
    for (const float q : disc_rotation(splats.normals[p])) put(out, q);
  }
  return out;
}

}  // namespace slf
