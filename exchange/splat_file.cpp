#include "exchange/splat_writers.h"

namespace slf {

SplatCloud as_stored(SplatCloud splats, SplatFormat format) {
  return format == SplatFormat::kSpz ? rounded_to_spz(std::move(splats)) : splats;
}

Result<std::vector<std::uint8_t>, InputError> splat_file(const SplatCloud& splats,
                                                         SplatFormat format) {
  switch (format) {
    case SplatFormat::kPly:
      return write_splat_ply(splats);
    case SplatFormat::kGlb:
      return write_splat_glb(splats);
    case SplatFormat::kSpz:
      return write_spz(splats);
  }
  return InputError{Errc::kInvalidArgument, "no such format of splats"};
}

}  // namespace slf
