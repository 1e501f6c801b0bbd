// SPDX-License-Identifier: Apache-2.0
// AVI 1.0 (Microsoft, "AVI RIFF File Reference"): a header, pictures as chunks, an index of them.
#include "tools/film.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include "slf/jpeg.h"
#include "tools/output.h"

namespace slf::tools {
namespace {

constexpr std::uint32_t kHasIndex = 0x10, kKeyFrame = 0x10;  // flags
constexpr std::uint32_t kAnyQuality = 0xFFFFFFFF;
constexpr std::uint64_t kAround = 32;  // bytes beside a picture, in its chunk and in the index

class RiffWriter {
 public:
  void four(std::string_view code) { bytes_.insert(bytes_.end(), code.begin(), code.end()); }
  void u16(std::uint32_t v) {
    for (int shift = 0; shift < 16; shift += 8)
      bytes_.push_back(static_cast<std::uint8_t>(v >> shift));
  }
  void u32(std::uint32_t v) {
    u16(v & 0xFFFF);
    u16(v >> 16);
  }
  template <class... V>
  void all(V... v) {
    (u32(static_cast<std::uint32_t>(v)), ...);
  }
  /// Begins a chunk, or a list of such, whose length end() fills in.
  std::size_t begin(std::string_view code, std::string_view list = {}) {
    four(code);
    u32(0);
    const std::size_t at = bytes_.size();
    four(list);
    return at;
  }
  void end(std::size_t at) {
    const std::size_t size = bytes_.size() - at;
    for (std::size_t i = 0; i < 4; ++i)
      bytes_[at - 4 + i] = static_cast<std::uint8_t>(size >> (8 * i));
    if (size % 2 != 0) bytes_.push_back(0);
  }
  void append(const std::vector<std::uint8_t>& data) {
    bytes_.insert(bytes_.end(), data.begin(), data.end());
  }
  std::size_t size() const { return bytes_.size(); }
  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
};

struct Shape {
  int width, height;
  std::uint32_t frames, largest, rate;  // bytes of a picture; thousandths of a picture a second
};

void write_header(RiffWriter& out, const Shape& shape) {
  const std::size_t header = out.begin("LIST", "hdrl");
  const std::size_t main = out.begin("avih");
  const auto microseconds = static_cast<std::uint32_t>(std::lround(1e9 / shape.rate));
  out.all(microseconds, 0, 0, kHasIndex, shape.frames, 0, 1, shape.largest, shape.width,
          shape.height, 0, 0, 0, 0);
  out.end(main);
  const std::size_t stream = out.begin("LIST", "strl");
  const std::size_t head = out.begin("strh");
  out.four("vids");
  out.four("MJPG");
  out.all(0, 0, 0, 1000, shape.rate, 0, shape.frames, shape.largest, kAnyQuality, 0);
  for (const int v : {0, 0, shape.width, shape.height}) out.u16(static_cast<std::uint32_t>(v));
  out.end(head);
  const std::size_t format = out.begin("strf");  // BITMAPINFOHEADER
  out.all(40, shape.width, shape.height);
  out.u16(1);
  out.u16(24);
  out.four("MJPG");
  out.all(std::int64_t{3} * shape.width * shape.height, 0, 0, 0, 0);
  out.end(format);
  out.end(stream);
  out.end(header);
}

}  // namespace

bool Film::is_named(const std::string& file) { return small_extension(file) == ".avi"; }

Outcome Film::add(const Image& image) {
  if (!pictures_.empty() && (image.width != width_ || image.height != height_))
    return Failure{kUsage, "film: a picture is " + std::to_string(image.width) + " x " +
                               std::to_string(image.height) + ", the first " +
                               std::to_string(width_) + " x " + std::to_string(height_)};
  SLF_TRY(auto picture, from("film", encode_jpeg(image, kJpegQuality)));
  if (bytes_ + picture.size() + kAround > kMostBytes)
    return Failure{kUsage,
                   "film: it has more than 1 GiB; show fewer frames or take a smaller --size"};
  bytes_ += picture.size() + kAround;
  width_ = image.width;
  height_ = image.height;
  pictures_.push_back(std::move(picture));
  return Done{};
}

bool Film::has_room(const FilmTiming& timing) const {
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < pictures_.size() && bytes <= kMostBytes; ++i)
    bytes += timing.shown[i] * (pictures_[i].size() + kAround);
  return bytes <= kMostBytes;
}

std::vector<std::uint8_t> Film::avi(const FilmTiming& timing) const {
  Shape shape{
      width_, height_, std::accumulate(timing.shown.begin(), timing.shown.end(), 0U), 0,
      static_cast<std::uint32_t>(std::lround(1000 * std::clamp(timing.rate, 0.001, 1000.0)))};
  for (const auto& picture : pictures_)
    shape.largest = std::max(shape.largest, static_cast<std::uint32_t>(picture.size()));
  RiffWriter out;
  const std::size_t file = out.begin("RIFF", "AVI ");
  write_header(out, shape);
  const std::size_t movie = out.begin("LIST", "movi");
  struct Place {
    std::size_t at, bytes;  // from "movi" on
  };
  std::vector<Place> places;
  for (std::size_t i = 0; i < pictures_.size(); ++i)
    for (std::uint32_t again = 0; again < timing.shown[i]; ++again) {
      places.push_back({out.size() - movie, pictures_[i].size()});
      const std::size_t chunk = out.begin("00dc");
      out.append(pictures_[i]);
      out.end(chunk);
    }
  out.end(movie);
  const std::size_t index = out.begin("idx1");
  for (const Place& place : places) {
    out.four("00dc");
    out.all(kKeyFrame, place.at, place.bytes);
  }
  out.end(index);
  out.end(file);
  return out.take();
}

}  // namespace slf::tools
