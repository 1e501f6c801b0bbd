// SPDX-License-Identifier: Apache-2.0
#include "capture/check_photographs.h"

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "capture/image_formats.h"
#include "capture/object_mask.h"

namespace slf {

namespace {

constexpr std::size_t kLookedAt = 6;         // photographs, for their masks
constexpr std::size_t kProjected = 4096;     // points
constexpr double kNothing = 0.02;            // of the points: the masks leave nothing
constexpr double kFew = 0.2, kMostly = 0.5;  // of the points; of the pixels that are the object

std::string size_text(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

/// Turned by 90 degrees, EXIF 5 .. 8, and as the calibration has it then.
bool fits_turned(const ImageHeader& header, const Camera& camera) {
  return header.orientation >= 5 && static_cast<int>(header.size.height) == camera.width &&
         static_cast<int>(header.size.width) == camera.height;
}

Result<ImageHeader, InputError> header_of_photograph(const std::filesystem::path& file) {
  std::error_code error;  // a pipe would be waited for
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    return InputError{Errc::kInvalidInput, file.string() + ": is not a regular file"};
  return read_image_header(file);
}

bool fits(const ImageHeader& header, const Camera& camera) {
  return static_cast<int>(header.size.width) == camera.width &&
         static_cast<int>(header.size.height) == camera.height;
}

InputError other_size_than(const Camera& camera, const std::filesystem::path& file,
                           const ImageHeader& header) {
  return {Errc::kInvalidInput,
          file.string() + ": image of " +
              size_text(static_cast<int>(header.size.width), static_cast<int>(header.size.height)) +
              " pixels, calibrated as " + size_text(camera.width, camera.height)};
}

/// Sizes tell which way a photograph was calibrated, unless turning it keeps them.
bool may_be_turned(const ImageHeader& header) {
  if (header.orientation == 1) return false;
  return header.orientation <= 4 || header.size.width == header.size.height;
}

/// Photographs with something to be told of them, and the first of these.
struct Noticed {
  std::size_t count = 0;
  std::string first;

  void add(bool is, const std::filesystem::path& file) {
    if (is && count++ == 0) first = file.filename().string();
  }
};

/// @param what  they have
void warn_of(const Noticed& noticed, const char* what, Capture& capture) {
  if (noticed.count == 0) return;
  capture.warnings.push_back(std::to_string(noticed.count) + " of " +
                             std::to_string(capture.cameras.size()) + " photographs (" +
                             (noticed.count > 1 ? "the first is " : "") + noticed.first + ") " +
                             (noticed.count > 1 ? "have " : "has ") + what);
}

struct Shares {
  std::size_t points = 0, left = 0;  // in view; of these where the object is
  std::size_t pixels = 0, object = 0;
};

void add_shares(const Capture& capture, std::size_t camera, const Image& image, Shares& sum) {
  if (image.channels != 4) return;
  const auto alpha = [&](std::size_t pixel) { return image.data[4 * pixel + 3]; };
  const std::size_t pixels = image.data.size() / 4;
  for (std::size_t i = 0; i < pixels; ++i) sum.object += shows_object(alpha(i));
  sum.pixels += pixels;
  const auto& cloud = capture.cloud.positions;
  const std::size_t stride = std::max<std::size_t>(cloud.size() / kProjected, 1);
  for (std::size_t p = 0; p < cloud.size(); p += stride) {
    const Vec3 point{double{cloud[p][0]}, double{cloud[p][1]}, double{cloud[p][2]}};
    const auto at = capture.cameras[camera].project(point);
    if (!at ||
        !((*at)[0] >= 0 && (*at)[1] >= 0 && (*at)[0] < image.width && (*at)[1] < image.height))
      continue;
    ++sum.points;
    sum.left += shows_object(
        alpha(static_cast<std::size_t>((*at)[1]) * static_cast<std::size_t>(image.width) +
              static_cast<std::size_t>((*at)[0])));
  }
}

/// Cameras with a mask or with alpha.
Result<std::vector<std::size_t>, InputError> masked_cameras(const Capture& capture) {
  std::vector<std::size_t> masked;
  for (std::size_t i = 0; i < capture.cameras.size(); ++i) {
    bool has = i < capture.mask_files.size() && !capture.mask_files[i].empty();
    if (!has) {
      SLF_TRY(const ImageHeader header, read_image_header(capture.image_files[i]));
      has = header.alpha;
    }
    if (has) masked.push_back(i);
  }
  return masked;
}

}  // namespace

Result<Done, InputError> check_photographs(Capture& capture) {
  Noticed ambiguous, coloured;
  bool turned = false;
  std::vector<int> orientation(capture.cameras.size(), 1), either_way = orientation;
  for (std::size_t i = 0; i < capture.cameras.size(); ++i) {
    const Camera& camera = capture.cameras[i];
    const auto& file = capture.image_files[i];
    SLF_TRY(const ImageHeader header, header_of_photograph(file));
    if (!fits(header, camera)) {
      if (!fits_turned(header, camera)) return other_size_than(camera, file, header);
      orientation[i] = header.orientation;
      turned = true;
    } else if (may_be_turned(header)) {
      ambiguous.add(true, file);
      either_way[i] = header.orientation;
    }
    coloured.add(header.other_colour, file);
    if (capture.mask_files.empty() || capture.mask_files[i].empty()) continue;
    SLF_TRY(const ImageHeader mask, header_of_photograph(capture.mask_files[i]));
    if (!fits(mask, camera)) return other_size_than(camera, capture.mask_files[i], mask);
  }
  if (turned) {
    // Whoever calibrated turned photographs did so with all of them.
    for (std::size_t i = 0; i < orientation.size(); ++i)
      orientation[i] = std::max(orientation[i], either_way[i]);
    capture.orientation = std::move(orientation);
    ambiguous = {};
  }
  warn_of(ambiguous,
          "an EXIF orientation, which is ignored: a calibration of upright pictures (OpenCV, "
          "ffmpeg, browsers) does not fit them; store them upright (exiftran -a, mogrify "
          "-auto-orient)",
          capture);
  warn_of(coloured,
          "a colour profile or gamma other than sRGB's, which is ignored: convert them, or "
          "their colours are shown as if they were sRGB",
          capture);
  return Done{};
}

Result<Done, InputError> check_masks(Capture& capture) {
  SLF_TRY(const auto masked, masked_cameras(capture));
  Shares sum;
  const std::size_t chosen = std::min(masked.size(), kLookedAt);
  for (std::size_t c = 0; c < chosen; ++c) {
    const std::size_t camera = masked[c * masked.size() / chosen];
    SLF_TRY(const Image image, load_image(capture, static_cast<int>(camera)));
    add_shares(capture, camera, image, sum);
  }
  if (sum.points == 0) return Done{};
  const double left = static_cast<double>(sum.left) / static_cast<double>(sum.points);
  const double object = static_cast<double>(sum.object) / static_cast<double>(sum.pixels);
  if (left >= kNothing && !(left < kFew && object > kMostly)) return Done{};
  char text[200];
  std::snprintf(text, sizeof text,
                "masks or alpha leave %.1f %% of the points in view (%zu photographs looked at): "
                "are they inverted? 128 and more is the object",
                100 * left, chosen);
  capture.warnings.emplace_back(text);
  return Done{};
}

}  // namespace slf
