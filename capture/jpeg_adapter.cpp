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
// it has: so many pixels of all scans together are 16 scans of the largest picture, half a second.
constexpr std::uint64_t kMaxScans = 200, kMaxPixelsOfScans = std::uint64_t{1} << 32;

std::uint64_t most_scans(ImageSize size) {
  return std::min(kMaxScans, kMaxPixelsOfScans / (std::uint64_t{size.width} * size.height));
}

// By the markers alone, as libjpeg finds them: bytes between segments are passed over.
std::uint64_t scans_of(Bytes file) {
  constexpr std::uint8_t kEnd = 0xD9, kScan = 0xDA;
  std::uint64_t scans = 0;
  auto at = file.begin() + 2;
  while ((at = std::find(at, file.end(), 0xFF)) != file.end()) {
    while (at != file.end() && *at == 0xFF) ++at;
    if (file.end() - at < 3 || *at == kEnd) break;
    const std::uint8_t marker = *at;
    const bool alone = marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD8);  // 0: a byte of data
    scans += marker == kScan;
    const std::ptrdiff_t length = alone ? 0 : at[1] << 8 | at[2];
    at += std::min<std::ptrdiff_t>(1 + length, file.end() - at);
  }
  return scans;
}

// libjpeg fills what is missing with grey and warns; that is no photograph.
void on_message(j_common_ptr info, int level) {
  if (level >= 0) return;  // trace
  const int code = info->err->msg_code;
  if (code != JWRN_JPEG_EOF && code != JWRN_HIT_MARKER && code != JWRN_HUFF_BAD_CODE) return;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  if (!errors->damaged) info->err->format_message(info, errors->text);
  errors->damaged = true;
}

// Called now and then while scans are read: whatever they were counted before.
void on_progress(j_common_ptr info) {
  const auto* reader = reinterpret_cast<j_decompress_ptr>(info);
  const std::uint64_t most = most_scans({reader->image_width, reader->image_height});
  if (static_cast<std::uint64_t>(reader->input_scan_number) <= most) return;
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  std::snprintf(errors->text, sizeof errors->text, "more than %d scans", static_cast<int>(most));
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
  if (const std::uint64_t most = most_scans(size); scans_of(file) > most)
    return invalid("JPEG of more than " + std::to_string(most) + " scans of " +
                   std::to_string(size.width) + " x " + std::to_string(size.height) + " pixels");
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
