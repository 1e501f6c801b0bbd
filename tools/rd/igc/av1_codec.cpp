// SPDX-License-Identifier: Apache-2.0
#include "tools/rd/igc/av1_codec.h"

#if SLF_WITH_AV1
#include <aom/aom_decoder.h>
#include <aom/aom_encoder.h>
#include <aom/aomcx.h>
#include <aom/aomdx.h>

#include <algorithm>
#include <memory>
#include <string>
#endif

namespace slf {

#if SLF_WITH_AV1
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kUnitLengthBytes = 4;
constexpr unsigned kLag = 48;  // pictures looked ahead; the most that libaom takes

const Error kDamaged{Errc::kOutOfRange, "av1_temporal_unit", 0};

InputError invalid(const std::string& what) {
  return {Errc::kInvalidArgument, "AV1 encoding: " + what};
}

struct DestroyCodec {
  void operator()(aom_codec_ctx_t* codec) const {
    aom_codec_destroy(codec);
    delete codec;
  }
};
using Codec = std::unique_ptr<aom_codec_ctx_t, DestroyCodec>;

struct FreeImage {
  void operator()(aom_image_t* image) const { aom_img_free(image); }
};
using AomImage = std::unique_ptr<aom_image_t, FreeImage>;

aom_img_fmt_t image_format(const Picture& p) {
  const int base = p.chroma == ChromaFormat::k444 ? AOM_IMG_FMT_I444 : AOM_IMG_FMT_I420;
  return static_cast<aom_img_fmt_t>(p.bits > 8 ? base | AOM_IMG_FMT_HIGHBITDEPTH : base);
}

/// libaom's own picture; grey ones get chroma planes in the middle of the range.
AomImage to_aom(const Picture& p) {
  constexpr unsigned kAlignment = 32;
  AomImage image(aom_img_alloc(nullptr, image_format(p), static_cast<unsigned>(p.width),
                               static_cast<unsigned>(p.height), kAlignment));
  if (!image) return image;
  image->monochrome = p.chroma == ChromaFormat::k400;
  for (int plane = 0; plane < 3; ++plane) {
    const int width = aom_img_plane_width(image.get(), plane);
    const int height = aom_img_plane_height(image.get(), plane);
    const auto i = static_cast<std::size_t>(plane);
    for (int y = 0; y < height; ++y) {
      std::uint8_t* row =
          image->planes[plane] + static_cast<std::ptrdiff_t>(image->stride[plane]) * y;
      for (int x = 0; x < width; ++x) {
        const std::uint16_t sample =
            i < p.planes.size()
                ? p.planes[i][static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                              static_cast<std::size_t>(x)]
                : static_cast<std::uint16_t>(1 << (p.bits - 1));
        if (p.bits > 8)
          reinterpret_cast<std::uint16_t*>(row)[x] = sample;
        else
          row[x] = static_cast<std::uint8_t>(sample);
      }
    }
  }
  return image;
}

aom_codec_enc_cfg_t configuration(const Picture& first, const Av1Settings& settings) {
  aom_codec_enc_cfg_t cfg{};
  aom_codec_enc_config_default(aom_codec_av1_cx(), &cfg, AOM_USAGE_GOOD_QUALITY);
  cfg.g_w = static_cast<unsigned>(first.width);
  cfg.g_h = static_cast<unsigned>(first.height);
  cfg.g_threads = 1;
  cfg.g_profile = first.bits == 12 ? 2 : first.chroma == ChromaFormat::k444 ? 1 : 0;
  cfg.g_bit_depth = static_cast<aom_bit_depth_t>(first.bits);
  cfg.g_input_bit_depth = static_cast<unsigned>(first.bits);
  cfg.monochrome = first.chroma == ChromaFormat::k400;
  cfg.g_timebase = {1, 25};
  cfg.rc_end_usage = AOM_Q;
  cfg.g_lag_in_frames = settings.intra_only ? 0 : kLag;
  cfg.kf_mode = settings.intra_only ? AOM_KF_AUTO : AOM_KF_DISABLED;
  if (settings.intra_only) cfg.kf_min_dist = cfg.kf_max_dist = 0;
  return cfg;
}

Codec open_encoder(const Picture& first, const Av1Settings& settings) {
  const aom_codec_enc_cfg_t cfg = configuration(first, settings);
  auto context = std::make_unique<aom_codec_ctx_t>();
  if (aom_codec_enc_init(context.get(), aom_codec_av1_cx(), &cfg,
                         first.bits > 8 ? AOM_CODEC_USE_HIGHBITDEPTH : 0) != AOM_CODEC_OK)
    return nullptr;
  Codec codec(context.release());
  if (aom_codec_control(codec.get(), AOME_SET_CPUUSED, settings.cpu_used) != AOM_CODEC_OK ||
      aom_codec_control(codec.get(), AOME_SET_CQ_LEVEL, settings.cq_level) != AOM_CODEC_OK ||
      aom_codec_control(codec.get(), AV1E_SET_COLOR_RANGE, AOM_CR_FULL_RANGE) != AOM_CODEC_OK)
    return nullptr;
  return codec;
}

/// Appends what is ready. @return temporal units appended
std::size_t take_packets(aom_codec_ctx_t* codec, std::vector<std::uint8_t>& stream) {
  std::size_t taken = 0;
  aom_codec_iter_t iterator = nullptr;
  while (const aom_codec_cx_pkt_t* packet = aom_codec_get_cx_data(codec, &iterator)) {
    if (packet->kind != AOM_CODEC_CX_FRAME_PKT) continue;
    const auto size = static_cast<std::uint32_t>(packet->data.frame.sz);
    for (int byte = 0; byte < static_cast<int>(kUnitLengthBytes); ++byte)
      stream.push_back(static_cast<std::uint8_t>(size >> 8 * byte));
    const auto* data = static_cast<const std::uint8_t*>(packet->data.frame.buf);
    stream.insert(stream.end(), data, data + size);
    ++taken;
  }
  return taken;
}

/// One OBU of a temporal unit. AV1 specification clause 5.3.
struct Obu {
  int type = 0;
  Bytes payload;
};

Result<Obu> next_obu(Bytes& rest) {
  const std::uint8_t header = rest[0];
  std::size_t at = (header & 4) != 0 ? 2 : 1;  // obu_extension_flag
  if ((header & 2) == 0) return kDamaged;      // obu_has_size_field: always, in this stream
  std::uint64_t size = 0;
  for (int i = 0;; ++i, ++at) {  // leb128( )
    if (i == 8 || at >= rest.size()) return kDamaged;
    size |= static_cast<std::uint64_t>(rest[at] & 127) << 7 * i;
    if ((rest[at] & 128) == 0) break;
  }
  ++at;
  if (size > rest.size() - at) return kDamaged;
  const Obu obu{header >> 3 & 15, rest.subspan(at, static_cast<std::size_t>(size))};
  rest = rest.subspan(at + obu.payload.size());
  return obu;
}

/// What all temporal units share.
struct UnitChecks {
  Bytes sequence_header;  ///< the first; later ones repeat it
  std::size_t frames = 0;
};

constexpr int kObuSequenceHeader = 1, kObuFrameHeader = 3, kObuFrame = 6;

Result<Done> check_unit(Bytes unit, const VideoFormat& expected, UnitChecks& checks) {
  if (checks.sequence_header.empty()) {
    aom_codec_stream_info_t info{};
    if (aom_codec_peek_stream_info(aom_codec_av1_dx(), unit.data(), unit.size(), &info) !=
            AOM_CODEC_OK ||
        info.w != static_cast<unsigned>(expected.width) ||
        info.h != static_cast<unsigned>(expected.height))
      return Error{Errc::kOutOfRange, "av1_sequence_header", 0};
  }
  while (!unit.empty()) {
    SLF_TRY(const Obu obu, next_obu(unit));
    if (obu.type == kObuSequenceHeader) {
      if (checks.sequence_header.empty()) checks.sequence_header = obu.payload;
      if (!std::ranges::equal(obu.payload, checks.sequence_header))
        return Error{Errc::kOutOfRange, "av1_sequence_header", 0};
    }
    checks.frames += obu.type == kObuFrameHeader || obu.type == kObuFrame;
  }
  if (checks.sequence_header.empty()) return Error{Errc::kOutOfRange, "av1_sequence_header", 0};
  if (checks.frames > 2 * expected.pictures) return Error{Errc::kOutOfRange, "av1_frames", 0};
  return Done{};
}

Result<std::vector<Bytes>> split_av1(Bytes stream, const VideoFormat& expected) {
  if (!is_sound(expected)) return Error{Errc::kOutOfRange, "av1_format", 0};
  std::vector<Bytes> units;
  UnitChecks checks;
  while (!stream.empty()) {
    if (stream.size() < kUnitLengthBytes) return Error{Errc::kTruncated, "av1_length", 0};
    std::uint32_t size = 0;
    for (std::size_t i = 0; i < kUnitLengthBytes; ++i) size |= std::uint32_t{stream[i]} << 8 * i;
    stream = stream.subspan(kUnitLengthBytes);
    if (size == 0) return Error{Errc::kOutOfRange, "av1_length", 0};
    if (size > stream.size()) return Error{Errc::kTruncated, "av1_temporal_unit", 0};
    SLF_CHECK(check_unit(stream.first(size), expected, checks));
    units.push_back(stream.first(size));
    stream = stream.subspan(size);
  }
  if (units.size() < expected.pictures) return Error{Errc::kTruncated, "av1_pictures", 0};
  if (units.size() > expected.pictures) return Error{Errc::kOutOfRange, "av1_pictures", 0};
  return units;
}

Result<Picture> from_aom(const aom_image_t& image, const VideoFormat& expected) {
  Picture p = blank_picture(expected.width, expected.height, expected.bits, expected.chroma);
  const bool grey = expected.chroma == ChromaFormat::k400;
  const auto format = static_cast<aom_img_fmt_t>(image.fmt & ~AOM_IMG_FMT_HIGHBITDEPTH);
  if (image.d_w != static_cast<unsigned>(p.width) || image.d_h != static_cast<unsigned>(p.height) ||
      image.bit_depth != static_cast<unsigned>(p.bits) || (image.monochrome != 0) != grey ||
      format != (image_format(p) & ~AOM_IMG_FMT_HIGHBITDEPTH))
    return Error{Errc::kOutOfRange, "av1_picture", 0};
  const bool wide = (image.fmt & AOM_IMG_FMT_HIGHBITDEPTH) != 0;
  for (std::size_t plane = 0; plane < p.planes.size(); ++plane) {
    const int width = plane_size(p.width, p.chroma, static_cast<int>(plane));
    const int height = plane_size(p.height, p.chroma, static_cast<int>(plane));
    std::uint16_t* to = p.planes[plane].data();
    const std::uint8_t* row = image.planes[plane];
    for (int y = 0; y < height; ++y, row += image.stride[plane], to += width)
      for (int x = 0; x < width; ++x)
        to[x] = wide ? reinterpret_cast<const std::uint16_t*>(row)[x] : row[x];
  }
  return p;
}

}  // namespace

Result<std::vector<std::uint8_t>, InputError> encode_av1(
    std::size_t pictures, const std::function<Picture(std::size_t)>& source,
    const Av1Settings& settings) {
  if (settings.cq_level < 0 || settings.cq_level > 63) return invalid("quality level: 0 to 63");
  if (settings.cpu_used < 0 || settings.cpu_used > 8) return invalid("speed: 0 to 8");
  if (pictures == 0) return invalid("no pictures");
  const InputError failed{Errc::kLimitExceeded, "AV1 encoding: libaom failed"};
  std::vector<std::uint8_t> stream;
  Codec codec;
  VideoFormat format;
  for (std::size_t i = 0; i < pictures; ++i) {
    const Picture picture = source(i);
    const VideoFormat now{picture.width, picture.height, picture.bits, picture.chroma, pictures};
    if (i == 0) format = now;
    SLF_CHECK(check_picture(picture, format));
    if (!codec) codec = open_encoder(picture, settings);
    const AomImage image = to_aom(picture);
    if (!codec || !image ||
        aom_codec_encode(codec.get(), image.get(), static_cast<aom_codec_pts_t>(i), 1, 0) !=
            AOM_CODEC_OK)
      return failed;
    take_packets(codec.get(), stream);
  }
  do
    if (aom_codec_encode(codec.get(), nullptr, -1, 1, 0) != AOM_CODEC_OK) return failed;
  while (take_packets(codec.get(), stream) > 0);
  return stream;
}

Result<Done> decode_av1(std::span<const std::uint8_t> stream, const VideoFormat& expected,
                        const std::function<void(std::size_t, const Picture&)>& sink) {
  SLF_TRY(const auto units, split_av1(stream, expected));
  auto context = std::make_unique<aom_codec_ctx_t>();
  const aom_codec_dec_cfg_t cfg{1, 0, 0, 1};  // one thread; size from the stream; 8 bit as bytes
  if (aom_codec_dec_init(context.get(), aom_codec_av1_dx(), &cfg, 0) != AOM_CODEC_OK)
    return Error{Errc::kUnsupported, "av1_decoder", 0};
  const Codec codec(context.release());
  std::size_t taken = 0;
  for (const Bytes unit : units) {
    if (aom_codec_decode(codec.get(), unit.data(), unit.size(), nullptr) != AOM_CODEC_OK)
      return kDamaged;
    aom_codec_iter_t iterator = nullptr;
    while (const aom_image_t* image = aom_codec_get_frame(codec.get(), &iterator)) {
      if (taken == expected.pictures) return Error{Errc::kOutOfRange, "av1_pictures", 0};
      SLF_TRY(const Picture picture, from_aom(*image, expected));
      sink(taken++, picture);
    }
  }
  if (taken < expected.pictures) return Error{Errc::kTruncated, "av1_pictures", 0};
  return Done{};
}
#else
Result<std::vector<std::uint8_t>, InputError> encode_av1(std::size_t,
                                                         const std::function<Picture(std::size_t)>&,
                                                         const Av1Settings&) {
  return InputError{Errc::kUnsupported, "AV1 encoding: libaom is not part of this build (SLF_AV1)"};
}

Result<Done> decode_av1(std::span<const std::uint8_t>, const VideoFormat&,
                        const std::function<void(std::size_t, const Picture&)>&) {
  return Error{Errc::kUnsupported, "av1_decoder", 0};
}
#endif

}  // namespace slf
