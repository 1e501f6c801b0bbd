// SPDX-License-Identifier: Apache-2.0
// Files of Gaussian splats of every format. An SPZ comes without its gzip, a ksplat (behind "KS")
// without the zeros of its headers, so that the fuzzer reaches what is in them. What is kept must
// be finite.
#include <cmath>
#include <cstdlib>

#include "bitstream/encoder/deflate.h"
#include "slf/gaussian_files.h"
#include "tests/fuzz/fuzz.h"

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
  slf::fuzz::accept(read);
}

/// 48 bytes of either header, then the rest.
std::vector<std::uint8_t> with_long_headers(std::vector<std::uint8_t> file) {
  constexpr std::size_t kMain = 4096, kSection = 1024, kShort = 48;
  file.insert(file.begin() + kShort, kMain - kShort, 0);
  file.insert(file.begin() + kMain + kShort, kSection - kShort, 0);
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> file(data, data + size);
  const bool spz = size >= 8 && data[0] == 'N' && data[1] == 'G' && data[4] < 4;
  if (spz) file = slf::gzip(file);
  const bool glb = size >= 12 && data[0] == 'g' && data[1] == 'l';
  for (std::size_t i = 0; glb && i < 4; ++i)  // the length is made right
    file[8 + i] = static_cast<std::uint8_t>(size >> (8 * i));
  if (size >= 98 && data[0] == 'K' && data[1] == 'S')
    file = with_long_headers({data + 2, data + size});
  read(file);
  return 0;
}
