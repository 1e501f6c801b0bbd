// SPDX-License-Identifier: Apache-2.0
// Images by content, out through write_file.
#include <algorithm>
#include <utility>

#include "capture/image_formats.h"
#include "capture/image_reduction.h"
#include "capture/netpbm.h"
#include "slf/picture_sides.h"

namespace slf {

Result<Image, InputError> read_image(const std::filesystem::path& file) {
  ImageSize ignored;
  return read_image_reduced(file, 0, ignored);
}

Result<PictureSides, InputError> picture_sides(const std::filesystem::path& file) {
  SLF_TRY(const ImageSize size, read_image_size(file));
  return PictureSides{size.width, size.height};
}

Result<Image, InputError> read_image_reduced(const std::filesystem::path& file, int reduction,
                                             ImageSize& size) {
  SLF_TRY(const auto bytes, read_file(file));
  if (is_png(bytes)) {
    SLF_TRY(Image image, decode_png(file.string(), bytes));
    size = {static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height)};
    return reduced(std::move(image), reduction);
  }
  if (is_netpbm(bytes)) {
    SLF_TRY(Image image, decode_netpbm(file.string(), bytes));
    size = {static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height)};
    return reduced(std::move(image), reduction);
  }
  if (!is_jpeg(bytes))
    return InputError{Errc::kInvalidInput, file.string() + ": neither PNG, JPEG nor PPM"};
  const int at_once = std::min(reduction, kMostJpegReduction);
  SLF_TRY(Image image, decode_jpeg(file.string(), bytes, at_once, size));
  return reduced(std::move(image), reduction - at_once);
}

Result<Done, InputError> write_png(const std::filesystem::path& file, const Image& image) {
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidArgument, file.string() + ": " + cause};
  };
  if (image.width < 1 || image.height < 1) return invalid("image without pixels");
  const ImageSize size{static_cast<std::uint32_t>(image.width),
                       static_cast<std::uint32_t>(image.height)};
  if (const auto problem = image_size_problem(size)) return invalid(*problem);
  if (image.channels != 3 && image.channels != 4)
    return invalid("image of neither 3 nor 4 channels");
  const std::uint64_t samples =
      std::uint64_t{size.width} * size.height * static_cast<std::uint64_t>(image.channels);
  if (image.data.size() != samples) return invalid("image data of another size than the image");
  SLF_TRY(const auto bytes, encode_png(file.string(), image));
  return write_file(file, bytes.data(), bytes.size());
}

}  // namespace slf
