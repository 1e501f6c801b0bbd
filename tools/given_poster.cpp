// SPDX-License-Identifier: Apache-2.0
#include "tools/given_poster.h"

#include <algorithm>

#include "slf/capture.h"
#include "slf/jpeg.h"
#include "slf/picture_sides.h"
#include "tools/page_template.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

// It shows for a second or two, at the size of a screen.
constexpr std::uint32_t kMostPosterSide = 4096;
constexpr std::uint64_t kMostPosterBytes = std::uint64_t{8} << 20;

}  // namespace

Result<std::string, Failure> given_poster(const std::string& file) {
  const auto bytes = read_file(file, kMostPosterBytes);
  if (!bytes && bytes.error().code == Errc::kLimitExceeded)
    return Failure{kLimitExceeded, file + ": larger than the " + grouped(kMostPosterBytes) +
                                       " bytes that a poster may have"};
  if (!bytes) return failure_of(bytes.error(), file);
  SLF_TRY(const PictureSides sides, from(file, picture_sides(file)));
  if (std::max(sides.width, sides.height) > kMostPosterSide)
    return Failure{kLimitExceeded, file + ": " + grouped(sides.width) + " x " +
                                       grouped(sides.height) + " pixels, more than the " +
                                       grouped(kMostPosterSide) + " a side that a poster may have"};
  SLF_TRY(const Image image, from(file, read_image(file)));
  if (bytes->front() == 'P') {
    SLF_TRY(const auto jpeg, from(file, encode_jpeg(image, kPosterQuality)));
    return "data:image/jpeg;base64," + base64(jpeg.data(), jpeg.size());
  }
  const char* type = bytes->front() == 0xff ? "jpeg" : "png";  // what read_image takes
  return std::string("data:image/") + type + ";base64," + base64(bytes->data(), bytes->size());
}

}  // namespace slf::tools
