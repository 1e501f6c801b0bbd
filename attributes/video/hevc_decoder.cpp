// SPDX-License-Identifier: Apache-2.0
#include "attributes/video/hevc_decoder.h"

#if SLF_WITH_HEVC
#include <libde265/de265.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <memory>
#endif

namespace slf {

#if SLF_WITH_HEVC
namespace {

const Error kDamaged{Errc::kOutOfRange, "hevc_slice_data", 0};

struct FreeDecoder {
  void operator()(de265_decoder_context* decoder) const { de265_free_decoder(decoder); }
};
using Decoder = std::unique_ptr<de265_decoder_context, FreeDecoder>;

/// libde265 leaves the samples of missing blocks as the allocator gave them. Zero is repeatable,
/// and shows nothing of this process.
int zeroed_buffer(de265_decoder_context*, de265_image_spec* spec, de265_image* image, void*) {
  static_assert(alignof(std::max_align_t) >= 16);  // spec->alignment, which calloc has to give
  constexpr std::size_t kReadBeyond = 16;          // bytes that vector loads may touch past the end
  for (int plane = 0; plane < 3; ++plane) de265_set_image_plane(image, plane, nullptr, 0, nullptr);
  const de265_chroma chroma = de265_get_chroma_format(image);
  for (int plane = 0; plane < (chroma == de265_chroma_mono ? 1 : 3); ++plane) {
    const int shift = plane > 0 && chroma == de265_chroma_420 ? 1 : 0;
    const int stride = ((spec->width >> shift) + spec->alignment - 1) & -spec->alignment;
    const std::size_t bytes = de265_get_bits_per_pixel(image, plane) > 8 ? 2 : 1;
    void* samples = std::calloc(
        static_cast<std::size_t>(stride) * bytes * static_cast<std::size_t>(spec->height >> shift) +
            kReadBeyond,
        1);
    if (samples == nullptr) return 0;
    const int row_bytes = stride * static_cast<int>(bytes);
    de265_set_image_plane(image, plane, samples, row_bytes, samples);
  }
  return 1;
}

/// Where a stream has SAO, libde265 decodes into pictures that its own functions allocate and that
/// a decoder's do not reach: those become these. Freed as before, by free() of the planes.
void zero_internal_buffers() {
  static const bool done = [] {
    const auto* functions = de265_get_default_image_allocation_functions();
    const_cast<de265_image_allocation*>(functions)->get_buffer = zeroed_buffer;  // not const there
    return true;
  }();
  static_cast<void>(done);
}

void free_buffer(de265_decoder_context*, de265_image* image, void*) {
  for (int plane = 0; plane < 3; ++plane) std::free(de265_get_image_plane_user_data(image, plane));
}

Decoder new_decoder() {
  zero_internal_buffers();
  Decoder decoder(de265_new_decoder());
  de265_image_allocation allocation{zeroed_buffer, free_buffer};
  if (decoder) de265_set_image_allocation_functions(decoder.get(), &allocation, nullptr);
  return decoder;
}

/// A plane of libde265: rows of one or two bytes per sample.
Result<Done> copy_plane(const de265_image* image, int plane, Picture& picture) {
  const int width = plane_size(picture.width, picture.chroma, plane);
  const int height = plane_size(picture.height, picture.chroma, plane);
  int stride = 0;
  const std::uint8_t* row = de265_get_image_plane(image, plane, &stride);
  if (row == nullptr || de265_get_image_width(image, plane) != width ||
      de265_get_image_height(image, plane) != height ||
      de265_get_bits_per_pixel(image, plane) != picture.bits)
    return kDamaged;
  const auto columns = static_cast<std::size_t>(width);
  std::uint16_t* to = picture.planes[static_cast<std::size_t>(plane)].data();
  for (int y = 0; y < height; ++y, row += stride, to += columns) {
    if (picture.bits > 8)
      std::memcpy(to, row, columns * sizeof *to);
    else
      for (std::size_t x = 0; x < columns; ++x) to[x] = row[x];
  }
  return Done{};
}

/// Hands out what has been decoded so far.
Result<Done> take_pictures(de265_decoder_context* decoder, const HevcFormat& expected,
                           std::size_t& taken,
                           const std::function<void(std::size_t, const Picture&)>& sink) {
  while (const de265_image* image = de265_peek_next_picture(decoder)) {
    if (taken == expected.pictures) return Error{Errc::kOutOfRange, "hevc_pictures", 0};
    if (static_cast<int>(de265_get_chroma_format(image)) != static_cast<int>(expected.chroma))
      return kDamaged;
    Picture picture =
        blank_picture(expected.width, expected.height, expected.bits, expected.chroma);
    for (int plane = 0; plane < num_planes(expected.chroma); ++plane)
      SLF_CHECK(copy_plane(image, plane, picture));
    sink(taken++, picture);
    de265_release_next_picture(decoder);
  }
  return Done{};
}

/// Decodes what was pushed. Any complaint of libde265 counts as damage: streams without damage
/// give none, and what it conceals is not what was encoded.
Result<Done> decode_pushed(de265_decoder_context* decoder, const HevcFormat& expected,
                           std::size_t& taken,
                           const std::function<void(std::size_t, const Picture&)>& sink) {
  constexpr int kMostIdle = 8;  // a turn decodes a unit or yields a picture, but for a few
  int idle = 0;
  for (int more = 1; more != 0 && idle < kMostIdle;) {
    const std::size_t before = taken;
    const int pending = de265_get_number_of_NAL_units_pending(decoder);
    const de265_error error = de265_decode(decoder, &more);
    if (de265_get_warning(decoder) != DE265_OK) return kDamaged;
    SLF_CHECK(take_pictures(decoder, expected, taken, sink));
    if (error == DE265_ERROR_WAITING_FOR_INPUT_DATA) return Done{};
    if (error != DE265_OK && error != DE265_ERROR_IMAGE_BUFFER_FULL) return kDamaged;
    const bool moved = taken > before || de265_get_number_of_NAL_units_pending(decoder) < pending;
    idle = moved ? 0 : idle + 1;
  }
  return Done{};
}

}  // namespace

Result<Done> decode_hevc(std::span<const std::uint8_t> stream, const HevcFormat& expected,
                         const std::function<void(std::size_t, const Picture&)>& sink) {
  SLF_TRY(const auto units, split_hevc(stream, expected));
  const Decoder decoder = new_decoder();
  if (!decoder) return Error{Errc::kUnsupported, "hevc_decoder", 0};
  std::size_t taken = 0;
  for (const auto& unit : units) {
    if (de265_push_NAL(decoder.get(), unit.data(), static_cast<int>(unit.size()), 0, nullptr) !=
        DE265_OK)
      return kDamaged;
    SLF_CHECK(decode_pushed(decoder.get(), expected, taken, sink));
  }
  if (de265_flush_data(decoder.get()) != DE265_OK) return kDamaged;
  SLF_CHECK(decode_pushed(decoder.get(), expected, taken, sink));
  if (taken < expected.pictures) return Error{Errc::kTruncated, "hevc_pictures", 0};
  return Done{};
}
#else
Result<Done> decode_hevc(std::span<const std::uint8_t>, const HevcFormat&,
                         const std::function<void(std::size_t, const Picture&)>&) {
  return Error{Errc::kUnsupported, "hevc_decoder", 0};
}
#endif

}  // namespace slf
