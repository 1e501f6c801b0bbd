// SPDX-License-Identifier: Apache-2.0
// Source: ppm(5) and pgm(5) of Netpbm.
#include "capture/netpbm.h"

namespace slf {
namespace {

constexpr std::uint32_t kMostSample = 65535;

bool is_blank(std::uint8_t c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

/// Words of a header, in which # begins a comment.
class NetpbmReader {
 public:
  explicit NetpbmReader(Bytes file) : file_(file) {}

  /// A decimal number up to kMostSample; nothing else.
  std::optional<std::uint32_t> number() {
    while (at_ < file_.size() && (is_blank(file_[at_]) || file_[at_] == '#'))
      if (file_[at_++] == '#')
        while (at_ < file_.size() && file_[at_] != '\n' && file_[at_] != '\r') ++at_;
    std::uint32_t value = 0;
    const std::size_t first = at_;
    for (; at_ < file_.size() && file_[at_] >= '0' && file_[at_] <= '9'; ++at_) {
      value = 10 * value + (file_[at_] - '0');
      if (value > kMostSample) return std::nullopt;
    }
    if (at_ == first) return std::nullopt;
    return value;
  }
  /// The one blank between a header and its samples.
  bool blank() { return at_ < file_.size() && is_blank(file_[at_++]); }
  /// `bytes` of a sample, big endian.
  std::optional<std::uint32_t> sample(std::size_t bytes) {
    if (file_.size() - at_ < bytes) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < bytes; ++i) value = value << 8 | file_[at_++];
    return value;
  }
  std::size_t left() const { return file_.size() - at_; }

 private:
  Bytes file_;
  std::size_t at_ = 2;  // behind "P6"
};

struct NetpbmHeader {
  ImageSize size;
  std::uint32_t largest = 0;
};

std::optional<NetpbmHeader> netpbm_header(NetpbmReader& reader) {
  const auto width = reader.number(), height = reader.number(), largest = reader.number();
  if (!width || !height || !largest || *largest == 0) return std::nullopt;
  return NetpbmHeader{{*width, *height}, *largest};
}

}  // namespace

bool is_netpbm(Bytes file) {
  return file.size() >= 3 && file[0] == 'P' &&
         (file[1] == '2' || file[1] == '3' || file[1] == '5' || file[1] == '6') &&
         (is_blank(file[2]) || file[2] == '#');
}

std::optional<ImageSize> netpbm_size(Bytes start) {
  if (!is_netpbm(start)) return std::nullopt;
  NetpbmReader reader(start);
  const auto header = netpbm_header(reader);
  if (!header) return std::nullopt;
  return header->size;
}

Result<Image, InputError> decode_netpbm(const std::string& name, Bytes file) {
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": " + cause};
  };
  NetpbmReader reader(file);
  const auto header = netpbm_header(reader);
  if (!header) return invalid("PPM without a sound header");
  if (const auto problem = image_size_problem(header->size)) return invalid(*problem);
  const bool text = file[1] == '2' || file[1] == '3', grey = file[1] == '2' || file[1] == '5';
  const std::size_t bytes = header->largest > 255 ? 2 : 1, channels = grey ? 1 : 3;
  const std::size_t pixels = std::size_t{header->size.width} * header->size.height;
  const bool sound = reader.blank();
  // A digit and a blank for each sample of text, but for the last.
  if (!sound || pixels * channels * (text ? 2 : bytes) > reader.left() + (text ? 1 : 0))
    return invalid("PPM is cut off");
  Image image{static_cast<int>(header->size.width), static_cast<int>(header->size.height), 3, {}};
  image.data.reserve(3 * pixels);
  for (std::size_t i = 0; i < pixels * channels; ++i) {
    const auto sample = text ? reader.number() : reader.sample(bytes);
    if (!sample || *sample > header->largest)
      return invalid("PPM has a sample that is missing or above " +
                     std::to_string(header->largest));
    const auto byte =
        static_cast<std::uint8_t>((*sample * 255 + header->largest / 2) / header->largest);
    image.data.insert(image.data.end(), grey ? 3 : 1, byte);
  }
  return image;
}

}  // namespace slf
