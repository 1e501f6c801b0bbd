// SPDX-License-Identifier: Apache-2.0
// One photograph of a capture, its mask in the alpha channel.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "capture/image_cache.h"
#include "capture/image_formats.h"
#include "capture/image_reduction.h"
#include "capture/object_mask.h"
#include "capture/upright.h"
#include "slf/capture.h"

namespace slf {

namespace {

InputError other_size(const std::string& name, std::uint32_t width, std::uint32_t height,
                      const Camera& camera) {
  return {Errc::kInvalidInput, name + ": image of " + std::to_string(width) + " x " +
                                   std::to_string(height) + " pixels, calibrated as " +
                                   std::to_string(camera.width) + " x " +
                                   std::to_string(camera.height)};
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

Result<Image, InputError> load(const Capture& capture, std::size_t i) {
  const Camera& camera = capture.cameras[i];
  const int reduction = capture.reduction.empty() ? 0 : capture.reduction[i];
  const auto fits = [&](const Image& x) {
    return x.width == camera.width && x.height == camera.height;
  };
  if (!capture.images.empty()) {
    const Image& given = capture.images[i];
    Image image = reduced(given, reduction);
    if (fits(image)) return without_opaque_alpha(std::move(image));
    return other_size(camera.name, static_cast<std::uint32_t>(given.width),
                      static_cast<std::uint32_t>(given.height), camera);
  }
  const int orientation = capture.orientation.empty() ? 1 : capture.orientation[i];
  ImageSize size;
  // Pixels are put together as they are seen: a side may be no multiple of 2^reduction.
  SLF_TRY(Image image,
          read_image_reduced(capture.image_files[i], orientation == 1 ? reduction : 0, size));
  if (orientation != 1) image = reduced(upright(std::move(image), orientation), reduction);
  if (!fits(image))
    return other_size(capture.image_files[i].string(), size.width, size.height, camera);
  image = without_opaque_alpha(std::move(image));
  if (i >= capture.mask_files.size() || capture.mask_files[i].empty()) return image;
  SLF_TRY(Image whole, read_image(capture.mask_files[i]));
  flatten_mask(whole);
  size = {static_cast<std::uint32_t>(whole.width), static_cast<std::uint32_t>(whole.height)};
  const Image mask = reduced_mask(std::move(whole), reduction);
  if (!fits(mask))
    return other_size(capture.mask_files[i].string(), size.width, size.height, camera);
  return with_mask(image, mask);
}

/// Display values times the photograph's gains.
Image with_gains(Image image, const Capture& capture, std::size_t camera) {
  if (camera >= capture.gains.size()) return image;
  std::array<std::array<std::uint8_t, 256>, 3> table{};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t v = 0; v < 256; ++v)
      table[k][v] = static_cast<std::uint8_t>(
          std::lround(std::clamp(double(v) * double(capture.gains[camera][k]), 0.0, 255.0)));
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.data.size(); i += channels)
    for (std::size_t k = 0; k < 3; ++k) image.data[i + k] = table[k][image.data[i + k]];
  return image;
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
  if (!capture.cache) {
    SLF_TRY(Image image, load(capture, i));
    return with_gains(std::move(image), capture, i);
  }
  if (const auto kept = capture.cache->find(camera)) return with_gains(*kept, capture, i);
  SLF_TRY(Image image, load(capture, i));
  capture.cache->keep(camera, std::make_shared<const Image>(image));
  return with_gains(std::move(image), capture, i);
}

}  // namespace slf
