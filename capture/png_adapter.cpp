// SPDX-License-Identifier: Apache-2.0
// The adapter of libpng. libpng reports errors by longjmp: each function that calls setjmp has only
// trivial locals and calls nothing of C++; what owns memory lives in its caller.
#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>

#include "capture/image_formats.h"

namespace slf {

namespace {

// Deflate cannot expand further (zlib, "Technical Details"): a larger image is not in so few bytes.
constexpr std::uint64_t kMaxDeflateRatio = 1032;

struct Messages {
  char text[128] = "";
};

struct Source {
  const std::uint8_t* data = nullptr;
  std::size_t left = 0;
};

[[noreturn]] void on_png_error(png_structp png, png_const_charp message) {
  auto* messages = static_cast<Messages*>(png_get_error_ptr(png));
  std::strncpy(messages->text, message, sizeof messages->text - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, std::size_t size) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (size > source->left) png_error(png, "the file ends too early");
  std::memcpy(to, source->data, size);
  source->data += size;
  source->left -= size;
}

void on_write(png_structp png, png_bytep from, std::size_t size) {
  auto* out = static_cast<std::vector<std::uint8_t>*>(png_get_io_ptr(png));
  bool grown = true;
  try {  // no exception may cross libpng
    out->insert(out->end(), from, from + size);
  } catch (...) {
    grown = false;
  }
  if (!grown) png_error(png, "out of memory");
}

struct PngReader {
  PngReader()
      : png(png_create_read_struct(PNG_LIBPNG_VER_STRING, &messages, on_png_error, on_warning)) {
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  Messages messages;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

struct PngWriter {
  PngWriter()
      : png(png_create_write_struct(PNG_LIBPNG_VER_STRING, &messages, on_png_error, on_warning)) {
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  Messages messages;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

bool read_png_header(PngReader& reader, Source& source) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_user_limits(reader.png, kMaxImageSide, kMaxImageSide);
  png_set_chunk_malloc_max(reader.png, 16u << 20);
  png_set_read_fn(reader.png, &source, on_read);
  png_read_info(reader.png, reader.info);
  return true;
}

// Everything becomes 8-bit RGB or RGBA.
bool set_conversions(PngReader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_expand(reader.png);    // palette to RGB, grey to 8 bits, tRNS to alpha
  png_set_scale_16(reader.png);  // rounded, not cut
  png_set_gray_to_rgb(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  return true;
}

bool read_png_rows(PngReader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

bool write_png(PngWriter& writer, const Image& image, png_bytepp rows,
               std::vector<std::uint8_t>& out) {
  if (setjmp(png_jmpbuf(writer.png)) != 0) return false;
  png_set_write_fn(writer.png, &out, on_write, nullptr);
  png_set_IHDR(writer.png, writer.info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8,
               image.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB,
               PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

std::vector<png_bytep> row_pointers(std::uint8_t* data, const Image& image) {
  const auto stride =
      static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.channels);
  std::vector<png_bytep> rows(static_cast<std::size_t>(image.height));
  for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = data + y * stride;
  return rows;
}

}  // namespace

Result<Image, InputError> decode_png(const std::string& name, Bytes file) {
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": " + cause};
  };
  PngReader reader;
  if (reader.info == nullptr) return invalid("libpng cannot be started");
  Source source{file.data(), file.size()};
  const auto damaged = [&] { return invalid(std::string("damaged PNG: ") + reader.messages.text); };
  if (!read_png_header(reader, source)) return damaged();

  const ImageSize size{png_get_image_width(reader.png, reader.info),
                       png_get_image_height(reader.png, reader.info)};
  if (const auto problem = image_size_problem(size)) return invalid(*problem);
  const std::uint64_t coded_bytes =
      std::uint64_t{png_get_rowbytes(reader.png, reader.info)} * size.height;
  if (coded_bytes / kMaxDeflateRatio > file.size())
    return invalid("damaged PNG: larger than its bytes can hold");

  if (!set_conversions(reader)) return damaged();
  Image image;
  image.width = static_cast<int>(size.width);
  image.height = static_cast<int>(size.height);
  image.channels = png_get_channels(reader.png, reader.info);
  const std::uint64_t stride = std::uint64_t{size.width} * static_cast<unsigned>(image.channels);
  if ((image.channels != 3 && image.channels != 4) ||
      png_get_rowbytes(reader.png, reader.info) != stride)
    return invalid("PNG of an unexpected layout");
  image.data.resize(stride * size.height);
  auto rows = row_pointers(image.data.data(), image);
  if (!read_png_rows(reader, rows.data())) return damaged();
  return image;
}

Result<std::vector<std::uint8_t>, InputError> encode_png(const std::string& name,
                                                         const Image& image) {
  PngWriter writer;
  std::vector<std::uint8_t> out;
  // libpng takes rows to write without const, and does not change them.
  auto rows = row_pointers(const_cast<std::uint8_t*>(image.data.data()), image);
  if (writer.info == nullptr || !write_png(writer, image, rows.data(), out))
    return InputError{Errc::kUnwritable, name + ": libpng: " + writer.messages.text};
  return out;
}

}  // namespace slf
