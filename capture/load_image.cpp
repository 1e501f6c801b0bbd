// One photograph of a capture, its mask in the alpha channel.
#include <algorithm>
#include <string>
#include <utility>

#include "slf/capture.h"

namespace slf {

namespace {

Result<Image, InputError> of_size(Image image, const std::string& name, const Camera& camera) {
  if (image.width == camera.width && image.height == camera.height) return image;
  return InputError{Errc::kInvalidInput,
                    name + ": image of " + std::to_string(image.width) + " x " +
                        std::to_string(image.height) + " pixels, calibrated as " +
                        std::to_string(camera.width) + " x " + std::to_string(camera.height)};
}

Result<Image, InputError> read_of_size(const std::filesystem::path& file, const Camera& camera) {
  SLF_TRY(Image image, read_image(file));
  return of_size(std::move(image), file.string(), camera);
}

// Alpha where both say so; masks are grey, so any of their colour channels will do.
Image with_mask(const Image& image, const Image& mask) {
  Image merged{image.width, image.height, 4, {}};
  const std::size_t pixels = image.data.size() / static_cast<std::size_t>(image.channels);
  merged.data.resize(pixels * 4);
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto* from = &image.data[i * static_cast<std::size_t>(image.channels)];
    std::copy(from, from + 3, &merged.data[i * 4]);
    const std::uint8_t alpha = image.channels == 4 ? from[3] : 255;
    merged.data[i * 4 + 3] =
        std::min(alpha, mask.data[i * static_cast<std::size_t>(mask.channels)]);
  }
  return merged;
}

}  // namespace

Result<Image, InputError> load_image(const Capture& capture, int camera) {
  const auto i = static_cast<std::size_t>(camera);
  const std::size_t images =
      capture.images.empty() ? capture.image_files.size() : capture.images.size();
  if (camera < 0 || i >= capture.cameras.size() || i >= images)
    return InputError{Errc::kInvalidArgument, "camera " + std::to_string(camera) +
                                                  ": the capture has " +
                                                  std::to_string(capture.cameras.size())};
  if (!capture.images.empty())
    return of_size(capture.images[i], capture.cameras[i].name, capture.cameras[i]);
  SLF_TRY(Image image, read_of_size(capture.image_files[i], capture.cameras[i]));
  if (i >= capture.mask_files.size() || capture.mask_files[i].empty()) return image;
  SLF_TRY(const Image mask, read_of_size(capture.mask_files[i], capture.cameras[i]));
  return with_mask(image, mask);
}

}  // namespace slf
