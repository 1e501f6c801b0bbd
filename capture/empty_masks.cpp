// SPDX-License-Identifier: Apache-2.0
// Photographs whose mask or alpha leaves nothing of them.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/image_formats.h"
#include "capture/object_mask.h"
#include "slf/capture.h"
#include "slf/parallel.h"

namespace slf {

namespace {

/// Any of the samples, each `stride` after the one before.
bool any_object(const Image& image, std::size_t first, std::size_t stride) {
  for (std::size_t i = first; i < image.data.size(); i += stride)
    if (shows_object(image.data[i])) return true;
  return false;
}

bool is_masked(const Capture& capture, std::size_t camera) {
  if (!capture.images.empty()) return capture.images[camera].channels == 4;
  if (camera < capture.mask_files.size() && !capture.mask_files[camera].empty()) return true;
  const auto header = read_image_header(capture.image_files[camera]);
  return header && header->alpha;
}

bool shows_nothing(const Capture& capture, int camera) {
  if (!is_masked(capture, static_cast<std::size_t>(camera))) return false;
  const auto image = load_image(capture, camera);
  return image && image->channels == 4 && !any_object(*image, 3, 4);
}

}  // namespace

std::vector<int> cameras_without_object(const Capture& capture, std::span<const int> cameras,
                                        int threads) {
  std::vector<std::uint8_t> empty(cameras.size(), 0);
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) empty[i] = shows_nothing(capture, cameras[i]);
  });
  std::vector<int> out;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    if (empty[i]) out.push_back(cameras[i]);
  return out;
}

}  // namespace slf
