// SPDX-License-Identifier: Apache-2.0
// The adapter of libjpeg-turbo. Errors arrive by longjmp: each function that calls setjmp has only
// trivial locals; what owns memory lives in its caller.
#include <cstddef>
#include <cstdio>
// jpeglib.h needs the two above.
#include <jerror.h>
#include <jpeglib.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "capture/image_formats.h"
#include "capture/jpeg_errors.h"

namespace slf {

namespace {

// One block of 64 pixels takes a bit at the least in Huffman coding; the rest is reserve.
constexpr std::uint64_t kMaxPixelsPerByte = 4096;

// A progressive photograph has some 10 scans. Each takes a pass over all blocks, however few bytes
// it has.
constexpr int kMaxScans = 200;

// libjpeg fills what is missing with grey and warns; that is no photograph.
void on_message(j_common_ptr info, int level) {
  if (level >= 0) return;  // trace
  const int code = info->err->msg_code;
  if (code != JWRN_JPEG_EOF && code != JWRN_HIT_MARKER && code != JWRN_HUFF_BAD_CODE) return;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  if (!errors->damaged) info->err->format_message(info, errors->text);
  errors->damaged = true;
}

// Called now and then while scans are read.
void on_progress(j_common_ptr info) {
  if (reinterpret_cast<j_decompress_ptr>(info)->input_scan_number <= kMaxScans) return;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  std::snprintf(errors->text, sizeof errors->text, "more than %d scans", kMaxScans);
  std::longjmp(errors->jump, 1);
}

struct JpegReader {
  JpegReader() {
    std::memset(&info, 0, sizeof info);
    info.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = on_jpeg_error;
    errors.base.emit_message = on_message;
  }
  ~JpegReader() { jpeg_destroy_decompress(&info); }  // harmless before create
  JpegReader(const JpegReader&) = delete;
  JpegReader& operator=(const JpegReader&) = delete;

  jpeg_decompress_struct info;
  JpegErrors errors;
  jpeg_progress_mgr progress{};
};

bool read_jpeg_header(JpegReader& reader, Bytes file) {
  if (setjmp(reader.errors.jump) != 0) return false;
  jpeg_create_decompress(&reader.info);
  jpeg_mem_src(&reader.info, file.data(), file.size());
  reader.progress.progress_monitor = on_progress;
  reader.info.progress = &reader.progress;
  jpeg_read_header(&reader.info, TRUE);
  return true;
}

/// The size of the output is known then.
bool prepare(JpegReader& reader, int reduction) {
  if (setjmp(reader.errors.jump) != 0) return false;
  reader.info.out_color_space = JCS_RGB;
  reader.info.dct_method = JDCT_ISLOW;  // the accurate one, the same on every machine
  reader.info.scale_num = 1;
  reader.info.scale_denom = 1u << reduction;
  jpeg_calc_output_dimensions(&reader.info);
  return true;
}

bool read_jpeg_rows(JpegReader& reader, std::uint8_t* data, std::size_t stride) {
  if (setjmp(reader.errors.jump) != 0) return false;
  jpeg_start_decompress(&reader.info);
  while (reader.info.output_scanline < reader.info.output_height) {
    JSAMPROW row = data + reader.info.output_scanline * stride;
    jpeg_read_scanlines(&reader.info, &row, 1);
  }
  jpeg_finish_decompress(&reader.info);
  return true;
}

}  // namespace

Result<Image, InputError> decode_jpeg(const std::string& name, Bytes file, int reduction,
                                      ImageSize& size) {
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": " + cause};
  };
  JpegReader reader;
  const auto damaged = [&] { return invalid(std::string("damaged JPEG: ") + reader.errors.text); };
  if (!read_jpeg_header(reader, file)) return damaged();

  size = {reader.info.image_width, reader.info.image_height};
  if (const auto problem = image_size_problem(size)) return invalid(*problem);
  if (std::uint64_t{size.width} * size.height / kMaxPixelsPerByte > file.size())
    return invalid("damaged JPEG: larger than its bytes can hold");
  const auto space = reader.info.jpeg_color_space;
  if (space != JCS_GRAYSCALE && space != JCS_YCbCr && space != JCS_RGB)
    return invalid(
        "JPEG that is neither grey nor RGB (CMYK?): convert it (mogrify -colorspace sRGB)");

  if (!prepare(reader, reduction)) return damaged();
  Image image;
  image.width = static_cast<int>(reader.info.output_width);
  image.height = static_cast<int>(reader.info.output_height);
  image.channels = 3;
  const std::size_t stride = std::size_t{3} * reader.info.output_width;
  image.data.resize(stride * reader.info.output_height);
  if (!read_jpeg_rows(reader, image.data.data(), stride) || reader.errors.damaged) return damaged();
  return image;
}

}  // namespace slf
