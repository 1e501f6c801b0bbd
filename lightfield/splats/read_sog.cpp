// SPDX-License-Identifier: Apache-2.0
// SOG 2 (PlayCanvas): a text, and pictures in WebP in which a pixel is a splat; bundled in a zip,
// or beside each other in a folder. Numbers in brackets are clauses of its description,
// developer.playcanvas.com/user-manual/gaussian-splatting/formats/sog.
#include <array>
#include <cmath>
#include <functional>

#include "capture/importer.h"
#include "capture/json_numbers.h"
#include "lightfield/splats/gaussian_readers.h"
#include "lightfield/splats/webp_adapter.h"
#include "lightfield/splats/zip_bundle.h"
#include "slf/capture.h"

namespace slf {
namespace {

using Bytes = std::vector<std::uint8_t>;
using ReadFile = std::function<Result<Bytes, InputError>(const JsonView& file)>;
using Codebook = std::array<float, 256>;

// WebP has at most 16,383 pixels along a side; splats take some 13 bytes each, and never so few.
constexpr std::size_t kMostSplats = std::size_t{1} << 26, kSplatsPerByte = 16;
constexpr std::size_t kSmallFile = 4096;  // splats that any file may say
constexpr std::size_t kPaletteColumns = 64, kMostPalette = std::size_t{1} << 16;

struct Palette {
  int degree = 0;
  std::size_t count = 0;
  Codebook values{};
  RgbaPicture vectors, labels;  // [count / 64][64 functions]; [splats]
};

/// A picture as its file has it.
struct Packed {
  JsonView file;
  Bytes bytes;
};

class SogReader {
 public:
  SogReader(const JsonView& meta, ReadFile read) : meta_(meta), read_(std::move(read)) {}

  Result<GaussianFile, InputError> read(const std::string& name) {
    SLF_CHECK(read_header());
    SLF_TRY(const Packed packed_low, packed("means", 0));
    SLF_TRY(const Packed packed_high, packed("means", 1));
    SLF_TRY(const Packed packed_sizes, packed("scales", 0));
    SLF_TRY(const Packed packed_turns, packed("quats", 0));
    SLF_TRY(const Packed packed_colours, packed("sh0", 0));
    SLF_CHECK(read_count());
    SLF_TRY(const RgbaPicture low, picture(packed_low));
    SLF_TRY(const RgbaPicture high, picture(packed_high));
    SLF_TRY(const RgbaPicture sizes, picture(packed_sizes));
    SLF_TRY(const RgbaPicture turns, picture(packed_turns));
    SLF_TRY(const RgbaPicture colours, picture(packed_colours));
    SLF_CHECK(read_palette());
    GaussianCollector collector(palette_.degree, UpAxis::kMinusY, count_);
    std::vector<float> harmonics(3 * std::size_t(palette_.degree + 1) *
                                 std::size_t(palette_.degree + 1));
    for (std::size_t p = 0; p < count_; ++p) {
      RawGaussian splat;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = 4 * p + k;
        splat.position[k] = place(k, low.pixels[at], high.pixels[at]);
        splat.log_deviations[k] = sizes_[sizes.pixels[at]];
        harmonics[k] = colours_[colours.pixels[at]];
      }
      splat.rotation = turn(&turns.pixels[4 * p]);
      splat.logit = logit_of_byte(colours.pixels[4 * p + 3]);
      add_harmonics(p, harmonics);
      collector.add(splat, harmonics);
    }
    return std::move(collector).take(name, "SOG 2");
  }

 private:
  /// [2]
  Result<Done, InputError> read_header() {
    const auto version = meta_.find("version");
    if (!version)
      return InputError{
          Errc::kUnsupported,
          meta_.error("SOG 1 is not read: splat-transform makes SOG 2 of it").message};
    SLF_TRY(const double number, version->number());
    if (number != 2)
      return InputError{Errc::kUnsupported, version->error("only SOG 2 is read").message};
    SLF_TRY(const JsonView means, meta_.at("means"));
    SLF_TRY(const JsonView least, means.at("mins"));
    SLF_TRY(least_, json_vector<3>(least));
    SLF_TRY(const JsonView greatest, means.at("maxs"));
    SLF_TRY(most_, json_vector<3>(greatest));
    SLF_TRY(sizes_, codebook("scales"));
    SLF_TRY(colours_, codebook("sh0"));
    return Done{};
  }

  /// After the files that splats are in, before anything is unpacked.
  Result<Done, InputError> read_count() {
    SLF_TRY(const JsonView count, meta_.at("count"));
    SLF_TRY(const double splats, count.number());
    const auto most =
        static_cast<double>(std::min(kMostSplats, kSmallFile + kSplatsPerByte * bytes_));
    if (!(splats >= 1 && splats <= most) || splats != std::floor(splats))
      return count.error("as many splats as the files have room for are expected");
    count_ = static_cast<std::size_t>(splats);
    return Done{};
  }

  /// [3.2, 3.4, 3.5] Values that a byte stands for; those of a shorter list are zeros behind it.
  Result<Codebook, InputError> codebook(const char* key) const {
    SLF_TRY(const JsonView of, meta_.at(key));
    SLF_TRY(const JsonView list, of.at("codebook"));
    SLF_TRY(const JsonItems items, list.items());
    if (items.empty() || items.size() > 256) return list.error("1 to 256 numbers are expected");
    Codebook values{};
    for (std::size_t i = 0; i < items.size(); ++i) {
      SLF_TRY(const double value, items[i].number());
      values[i] = static_cast<float>(value);
    }
    return values;
  }

  Result<Packed, InputError> packed(const char* key, std::size_t i) {
    SLF_TRY(const JsonView of, meta_.at(key));
    SLF_TRY(const JsonView files, of.at("files"));
    SLF_TRY(const JsonItems items, files.items());
    if (i >= items.size()) return files.error("a file is missing");
    SLF_TRY(Bytes bytes, read_(items[i]));
    bytes_ += bytes.size();
    return Packed{items[i], std::move(bytes)};
  }

  static Result<RgbaPicture, InputError> decoded(const Packed& packed, std::size_t most) {
    auto picture = decode_webp(packed.bytes, most);
    if (!picture)
      return packed.file.error("not a WebP picture, damaged, or of more pixels than it needs");
    return *std::move(picture);
  }

  /// [1.1] A picture of which the pixels are splats, at most some rows and columns more.
  Result<RgbaPicture, InputError> picture(const Packed& packed) const {
    SLF_TRY(auto picture, decoded(packed, 2 * count_ + (std::size_t{1} << 16)));
    if (picture.width * picture.height < count_)
      return packed.file.error("a picture of fewer pixels than there are splats");
    return picture;
  }

  /// [3.5]
  Result<Done, InputError> read_palette() {
    const auto shn = meta_.find("shN");
    if (!shn) return Done{};
    SLF_TRY(const JsonView bands, shn->at("bands"));
    SLF_TRY(const double degree, bands.number());
    if (degree != 1 && degree != 2 && degree != 3) return bands.error("1, 2 or 3 is expected");
    SLF_TRY(const JsonView count, shn->at("count"));
    SLF_TRY(const double vectors, count.number());
    if (!(vectors >= 1 && vectors <= double(kMostPalette)) || vectors != std::floor(vectors))
      return count.error("1 to 65536 vectors are expected");
    palette_.degree = static_cast<int>(degree);
    palette_.count = static_cast<std::size_t>(vectors);
    SLF_TRY(palette_.values, codebook("shN"));
    SLF_TRY(const Packed rows, packed("shN", 0));
    SLF_TRY(palette_.vectors, decoded(rows, (kMostPalette + kPaletteColumns) * functions()));
    if (palette_.vectors.width != kPaletteColumns * functions() ||
        palette_.vectors.height * kPaletteColumns < palette_.count)
      return rows.file.error("64 vectors a row, and as many rows as they take, are expected");
    SLF_TRY(const Packed labels, packed("shN", 1));
    SLF_TRY(palette_.labels, picture(labels));
    return Done{};
  }

  std::size_t functions() const {
    return std::size_t(palette_.degree + 1) * std::size_t(palette_.degree + 1) - 1;
  }

  /// [3.1] 16 bits between bounds, of sign(x) log(1 + |x|).
  float place(std::size_t axis, std::uint8_t low, std::uint8_t high) const {
    const double share = double(low | high << 8) / 65535;
    const double log = least_[axis] + (most_[axis] - least_[axis]) * share;
    return static_cast<float>(std::copysign(std::expm1(std::abs(log)), log));
  }

  /// [3.3] The last byte says which of w, x, y, z is the largest, the others are of sqrt(1/2).
  static std::array<float, 4> turn(const std::uint8_t* pixel) {
    std::array<float, 4> q{};
    if (pixel[3] < 252) return q;
    const std::size_t largest = pixel[3] - 252;
    float square = 0;
    for (std::size_t k = 0, from = 0; k < 4; ++k) {
      if (k == largest) continue;
      q[k] = (static_cast<float>(pixel[from++]) / 127.5f - 1) * std::sqrt(0.5f);
      square += q[k] * q[k];
    }
    q[largest] = std::sqrt(std::max(0.0f, 1 - square));
    return q;
  }

  /// [3.5] Beyond degree 0. A label of no vector stands for none.
  void add_harmonics(std::size_t p, std::vector<float>& harmonics) const {
    if (palette_.degree == 0) return;
    const std::uint8_t* label = &palette_.labels.pixels[4 * p];
    const std::size_t vector = static_cast<std::size_t>(label[0] | label[1] << 8);
    for (std::size_t i = 0; i < functions(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        harmonics[3 * (i + 1) + k] =
            vector < palette_.count
                ? palette_.values[palette_.vectors.pixels[4 * (vector * functions() + i) + k]]
                : 0;
  }

  const JsonView& meta_;
  ReadFile read_;
  std::size_t bytes_ = 0;  // of the files that were read
  std::size_t count_ = 0;
  std::array<double, 3> least_{}, most_{};
  Codebook sizes_{}, colours_{};
  Palette palette_;
};

Result<GaussianFile, InputError> read_bundle(const std::string& name, FileBytes bytes) {
  const auto bundle = ZipBundle::open(bytes);
  if (!bundle) return InputError{Errc::kInvalidInput, name + ": SOG: a damaged zip"};
  const std::string meta = bundle->find("meta.json");
  const auto text = bundle->read(meta, kMaxJsonBytes);
  if (!text) return InputError{Errc::kInvalidInput, name + ": SOG: no meta.json, or damaged"};
  const std::string folder = meta.substr(0, meta.size() - std::string("meta.json").size());
  SLF_TRY(const JsonValue document, parse_json(name + ": " + meta, *text));
  const JsonView view(document, name + ": " + meta);
  const auto read = [&](const JsonView& file) -> Result<Bytes, InputError> {
    SLF_TRY(const std::string picture, file.string());
    auto found = bundle->read(folder + picture, std::size_t{1} << 30);
    if (!found) return file.error("no such file in the bundle, or damaged");
    return *std::move(found);
  };
  return SogReader(view, read).read(name);
}

}  // namespace

Result<GaussianFile, InputError> read_sog(const std::string& name, FileBytes bytes,
                                          const std::filesystem::path& folder) {
  if (!has_webp()) return refuse_sog(name);
  if (bytes[0] == 'P') return read_bundle(name, bytes);
  SLF_TRY(const JsonValue document, parse_json(name, bytes));
  const JsonView view(document, name);
  const auto read = [&](const JsonView& file) -> Result<Bytes, InputError> {
    if (folder.empty()) return file.error("pictures beside the text need its folder");
    SLF_TRY(const std::string picture, file.string());
    SLF_TRY(const auto path, path_inside(folder, picture, file.error("file").message));
    return read_file(path);
  };
  return SogReader(view, read).read(name);
}

}  // namespace slf
