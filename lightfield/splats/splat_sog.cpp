// SPDX-License-Identifier: Apache-2.0
// SOG 2 (PlayCanvas): pictures in lossless WebP in which a pixel is a splat, and a text that says
// what their bytes stand for, in a zip. Numbers in brackets are clauses of its description, see
// sog_codes.h.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lightfield/splats/sog_codes.h"
#include "lightfield/splats/splat_writers.h"
#include "lightfield/splats/stored_zip.h"
#include "lightfield/splats/webp_adapter.h"

namespace slf {
namespace {

using SogPixel = std::array<std::uint8_t, 4>;
using SogJson = nlohmann::ordered_json;

constexpr std::size_t kMostSogSplats = std::size_t{1} << 26;
constexpr std::size_t kVectorsInRow = 64;

/// Files of a bundle. The first error is kept.
class SogPictures {
 public:
  explicit SogPictures(std::size_t splats) {
    const auto side = static_cast<std::size_t>(std::ceil(std::sqrt(double(splats)) / 4)) * 4;
    width_ = side;
    height_ = (splats + 4 * side - 1) / (4 * side) * 4;
  }

  /// [1.1] A pixel for each splat.
  template <class PixelOf>
  void add(const std::string& name, const SogCodes& codes, const PixelOf& pixel_of) {
    RgbaPicture picture{width_, height_, std::vector<std::uint8_t>(4 * width_ * height_)};
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const SogPixel pixel = pixel_of(std::size_t{codes.order[i]});
      std::copy(pixel.begin(), pixel.end(), &picture.pixels[4 * i]);
    }
    add(name, picture);
  }

  void add(const std::string& name, const RgbaPicture& picture) {
    auto bytes = encode_webp(picture);
    whole_ = whole_ && bytes.has_value();
    if (bytes) files_.push_back({name, *std::move(bytes)});
  }

  Result<std::vector<NamedBytes>, InputError> take() && {
    if (!whole_) return InputError{Errc::kInvalidInput, "SOG: a picture is not coded as WebP"};
    return std::move(files_);
  }

 private:
  std::size_t width_ = 0, height_ = 0;
  bool whole_ = true;
  std::vector<NamedBytes> files_;
};

void add_splats(const SogCodes& codes, SogPictures& to) {
  const auto place = [&](std::size_t p, int shift) {
    SogPixel pixel{0, 0, 0, 255};
    for (std::size_t k = 0; k < 3; ++k)
      pixel[k] = static_cast<std::uint8_t>(codes.places.codes[p][k] >> shift);
    return pixel;
  };
  const auto three = [](const ByteCodebook& book, std::size_t p, std::uint8_t last) {
    return SogPixel{book.bytes[3 * p], book.bytes[3 * p + 1], book.bytes[3 * p + 2], last};
  };
  to.add("means_l.webp", codes, [&](std::size_t p) { return place(p, 0); });
  to.add("means_u.webp", codes, [&](std::size_t p) { return place(p, 8); });
  to.add("quats.webp", codes, [&](std::size_t p) { return codes.turns[p]; });
  to.add("scales.webp", codes, [&](std::size_t p) { return three(codes.sizes, p, 255); });
  to.add("sh0.webp", codes,
         [&](std::size_t p) { return three(codes.colours, p, codes.opacities[p]); });
}

/// [3.5] 64 vectors in a row of the picture, a pixel for each function.
void add_vectors(const SogCodes& codes, SogPictures& to) {
  const std::size_t width = kVectorsInRow * codes.functions();
  const std::size_t height = (codes.vectors() + kVectorsInRow - 1) / kVectorsInRow;
  RgbaPicture picture{width, height, std::vector<std::uint8_t>(4 * width * height)};
  for (std::size_t i = 0; i < codes.vectors() * codes.functions(); ++i) {
    std::copy_n(&codes.harmonics.bytes[3 * i], 3, &picture.pixels[4 * i]);
    picture.pixels[4 * i + 3] = 255;
  }
  to.add("shN_centroids.webp", picture);
  to.add("shN_labels.webp", codes, [&](std::size_t p) {
    return SogPixel{static_cast<std::uint8_t>(codes.labels[p]),
                    static_cast<std::uint8_t>(codes.labels[p] >> 8), 0, 255};
  });
}

/// As doubles that are nearest to their decimals, which then are written short.
std::vector<double> decimals(const ByteCodebook& book) {
  std::vector<double> out;
  for (const float value : book.values)
    out.push_back(std::round(double{value} * kSogDigits) / kSogDigits);
  return out;
}

/// [2]
NamedBytes sog_text(const SogCodes& codes) {
  SogJson meta{
      {"version", 2},
      {"asset", {{"generator", "slf"}}},
      {"count", codes.size()},
      {"means",
       {{"mins", codes.places.least},
        {"maxs", codes.places.most},
        {"files", {"means_l.webp", "means_u.webp"}}}},
      {"scales", {{"codebook", decimals(codes.sizes)}, {"files", SogJson::array({"scales.webp"})}}},
      {"quats", {{"files", SogJson::array({"quats.webp"})}}},
      {"sh0", {{"codebook", decimals(codes.colours)}, {"files", SogJson::array({"sh0.webp"})}}}};
  if (codes.degree > 0)
    meta["shN"] = SogJson{{"count", codes.vectors()},
                          {"bands", codes.degree},
                          {"codebook", decimals(codes.harmonics)},
                          {"files", {"shN_centroids.webp", "shN_labels.webp"}}};
  const std::string text = meta.dump();
  return {"meta.json", {text.begin(), text.end()}};
}

/// Are places finer than the distance of points? They are coarsest far from coordinate 0.
bool resolves(const SogPlaces& places, double step) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double farthest = std::max(std::abs(places.least[k]), std::abs(places.most[k]));
    if ((places.most[k] - places.least[k]) / 65535 * std::exp(farthest) > step) return false;
  }
  return true;
}

}  // namespace

Result<Bytes, InputError> write_sog(const SplatRows& splats, int threads) {
  if (!has_webp())
    return InputError{Errc::kUnsupported,
                      "SOG is pictures in WebP, which this build does not write (SLF_WEBP)"};
  if (splats.size() < 1 || splats.size() > kMostSogSplats)
    return InputError{Errc::kInvalidInput, "SOG is written of 1 to 67108864 splats, and here are " +
                                               std::to_string(splats.size())};
  const SogCodes codes = sog_codes(splats, threads);
  if (splats.step() > 0 && !resolves(codes.places, splats.step()))
    return InputError{Errc::kInvalidInput,
                      "SOG has 16 bits for a coordinate, which do not tell its points apart"};
  SogPictures pictures(codes.size());
  add_splats(codes, pictures);
  if (codes.degree > 0) add_vectors(codes, pictures);
  SLF_TRY(auto files, std::move(pictures).take());
  files.insert(files.begin(), sog_text(codes));
  return stored_zip(files);
}

SplatCloud rounded_to_sog(SplatCloud splats, int threads) {
  const SogCodes codes = sog_codes(DiscRows(splats), threads);
  const std::size_t row = 3 * splats.num_harmonics();
  for (std::size_t p = 0; p < splats.size(); ++p) {
    for (std::size_t k = 0; k < 3; ++k) {
      splats.positions[p][k] = codes.places.coordinate(p, k);
      splats.harmonics[p * row + k] = codes.colours.of(3 * p + k);
    }
    splats.deviations[p] = std::exp(codes.sizes.of(3 * p));
    for (std::size_t i = 3; i < row; ++i)
      splats.harmonics[p * row + i] =
          codes.harmonics.of(std::size_t{codes.labels[p]} * (row - 3) + i - 3);
  }
  return splats;
}

}  // namespace slf
