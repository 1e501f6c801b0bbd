// SPDX-License-Identifier: Apache-2.0
// Errors of libjpeg arrive by longjmp: the function that calls setjmp has only trivial locals.
#include <cstddef>
#include <cstdio>
// jpeglib.h needs the two above.
#include <jpeglib.h>

#include <csetjmp>
#include <cstdlib>
#include <cstring>

#include "capture/jpeg_errors.h"
#include "slf/jpeg.h"

namespace slf {
namespace {

constexpr int kMostPixels = 16384;  // per side

struct JpegWriter {
  JpegWriter() {
    std::memset(&info, 0, sizeof info);
    info.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = on_jpeg_error;
  }
  ~JpegWriter() {
    jpeg_destroy_compress(&info);  // harmless before create
    std::free(data);
  }
  JpegWriter(const JpegWriter&) = delete;
  JpegWriter& operator=(const JpegWriter&) = delete;

  jpeg_compress_struct info;
  JpegErrors errors;
  unsigned char* data = nullptr;  // libjpeg's malloc
  unsigned long size = 0;
};

bool write_rows(JpegWriter& writer, const Image& image, int quality) {
  if (setjmp(writer.errors.jump) != 0) return false;
  jpeg_create_compress(&writer.info);
  jpeg_mem_dest(&writer.info, &writer.data, &writer.size);
  writer.info.image_width = static_cast<JDIMENSION>(image.width);
  writer.info.image_height = static_cast<JDIMENSION>(image.height);
  writer.info.input_components = 3;
  writer.info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&writer.info);
  jpeg_set_quality(&writer.info, quality, TRUE);
  writer.info.optimize_coding = TRUE;
  writer.info.dct_method = JDCT_ISLOW;  // the same on every machine
  jpeg_start_compress(&writer.info, TRUE);
  while (writer.info.next_scanline < writer.info.image_height) {
    // libjpeg reads the row only.
    auto* row = const_cast<JSAMPLE*>(
        image.data.data() + std::size_t{3} * writer.info.next_scanline * writer.info.image_width);
    jpeg_write_scanlines(&writer.info, &row, 1);
  }
  jpeg_finish_compress(&writer.info);
  return true;
}

}  // namespace

Result<std::vector<std::uint8_t>, InputError> encode_jpeg(const Image& image, int quality) {
  const bool sized = image.width >= 1 && image.height >= 1 && image.width <= kMostPixels &&
                     image.height <= kMostPixels;
  if (!sized || image.channels != 3 ||
      image.data.size() != std::size_t{3} * std::size_t(image.width) * std::size_t(image.height))
    return InputError{Errc::kInvalidArgument, "image is not RGB of 1 to 16384 pixels a side"};
  if (quality < 1 || quality > 100)
    return InputError{Errc::kInvalidArgument, "JPEG quality is not 1 to 100"};
  JpegWriter writer;
  if (!write_rows(writer, image, quality))
    return InputError{Errc::kUnwritable, std::string("JPEG: ") + writer.errors.text};
  return std::vector<std::uint8_t>(writer.data, writer.data + writer.size);
}

}  // namespace slf
