// Files of Gaussian splats of every format; an SPZ is taken out of its gzip first, so that the
// fuzzer reaches what is in it. What is kept must be finite.
#include <cmath>
#include <cstdlib>

#include "bitstream/deflate.h"
#include "fuzz/fuzz.h"
#include "slf/gaussian_files.h"

namespace {

bool is_finite(const slf::Gaussians& g) {
  for (std::size_t p = 0; p < g.size(); ++p)
    for (std::size_t k = 0; k < 3; ++k)
      if (!std::isfinite(g.positions[p][k]) || !std::isfinite(g.log_deviations[p][k]) ||
          !std::isfinite(g.rotations[p][k + 1]) || !std::isfinite(g.logits[p]))
        return false;
  for (const float h : g.harmonics)
    if (!std::isfinite(h)) return false;
  return g.harmonics.size() == 3 * g.num_harmonics() * g.size();
}

void read(const std::vector<std::uint8_t>& file) {
  (void)slf::looks_like_gaussians(file, file.size());
  const auto read = slf::parse_gaussians("fuzz", file);
  if (read && !is_finite(read->gaussians)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> file(data, data + size);
  const bool spz = size >= 8 && data[0] == 'N' && data[1] == 'G' && data[4] < 4;
  if (spz) file = slf::gzip(file);
  const bool glb = size >= 12 && data[0] == 'g' && data[1] == 'l';
  for (std::size_t i = 0; glb && i < 4; ++i)  // the length is made right
    file[8 + i] = static_cast<std::uint8_t>(size >> (8 * i));
  read(file);
  return 0;
}
