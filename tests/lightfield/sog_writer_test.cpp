// SPDX-License-Identifier: Apache-2.0
// SOG and SPZ 4 as they are written: read again within what they keep.
#include <gmock/gmock.h>

#include <numbers>
#include <numeric>

#include "gaussian_support.h"
#include "lightfield/splats/sog_codebook.h"
#include "lightfield/splats/sog_palette.h"
#include "lightfield/splats/stored_zip.h"
#include "lightfield/splats/zip_bundle.h"
#include "splats_support.h"

namespace slf::sog_writer_test {
namespace {

using test::random_gaussians;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;
using Bytes = std::vector<std::uint8_t>;

TEST(SogWriter, ACodebookKeepsFewNumbersAndIsNearManyOfThem) {
  const ByteCodebook few = byte_codebook({3, -1, 3, 0.5f, -1}, 256);
  for (std::size_t i = 0; const float x : {3.0f, -1.0f, 3.0f, 0.5f, -1.0f})
    EXPECT_EQ(few.of(i++), x);
  std::vector<float> numbers{-50, 70};  // far from the others
  for (int i = 0; i < 5000; ++i) numbers.push_back(std::sin(0.7f * float(i)));
  const ByteCodebook many = byte_codebook(numbers, 256);
  EXPECT_TRUE(std::is_sorted(many.values.begin(), many.values.end()));
  EXPECT_EQ(many.of(0), -50);
  EXPECT_EQ(many.of(1), 70);
  double squares = 0;
  for (std::size_t i = 2; i < numbers.size(); ++i) {
    const float error = std::abs(many.of(i) - numbers[i]);
    for (const float level : many.values) EXPECT_LE(error, std::abs(level - numbers[i]));
    squares += double{error} * double{error};
  }
  // Half of the levels go by how many numbers there are: 128 cells, of which the widest is that at
  // 0, where a sine has 1/pi of its values in a unit.
  const double widest = std::numbers::pi / 128;
  EXPECT_LT(squares / 5000, widest * widest / 12);
}

/// Rows about some centres, far apart.
VectorRows clouds(std::size_t centres, std::size_t each) {
  VectorRows rows{16, {}};
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (std::size_t i = 0; i < centres * each; ++i)
    for (std::size_t d = 0; d < 16; ++d)
      rows.numbers.push_back(10 * std::sin(float(1 + i % centres * (d + 3))) +
                             0.01f * uniform(random));
  return rows;
}

TEST(SogWriter, APaletteFindsCloudsAndHasNoVectorThatNobodyUses) {
  const VectorRows rows = clouds(40, 25);
  const VectorPalette palette = vector_palette(rows, 40, 1);
  ASSERT_EQ(palette.vectors.size(), 40u);
  std::vector<std::size_t> used(40);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ++used.at(palette.labels[i]);
    for (std::size_t d = 0; d < 16; ++d)
      EXPECT_NEAR(palette.vectors[palette.labels[i]][d], rows[i][d], 0.02);
  }
  EXPECT_THAT(used, Each(25u));
  EXPECT_EQ(vector_palette(rows, 5000, 1).vectors.size(), 1000u);  // no more than there are rows
  const VectorRows equal{8, std::vector<float>(8 * 100, 0.1f)};
  EXPECT_EQ(vector_palette(equal, 64, 1).vectors.size(), 1u);
}

TEST(SogWriter, APaletteIsTheSameForAnyNumberOfThreads) {
  const VectorRows rows = clouds(700, 3);
  const VectorPalette one = vector_palette(rows, 300, 1), eight = vector_palette(rows, 300, 8);
  EXPECT_EQ(one.labels, eight.labels);
  EXPECT_EQ(one.vectors.numbers, eight.vectors.numbers);
}

#if SLF_WITH_WEBP
GaussianFile read_again(const Bytes& bytes) {
  EXPECT_TRUE(looks_like_gaussians(bytes, bytes.size()));
  auto file = parse_gaussians("x", bytes);
  EXPECT_TRUE(file) << file.error().message;
  return file ? *std::move(file) : GaussianFile{};
}

/// Which splat of `before` each of `after` is: the nearest.
std::vector<std::size_t> matched(const Gaussians& before, const Gaussians& after) {
  std::vector<std::size_t> out;
  for (const auto& at : after.positions) {
    const auto distance = [&](std::size_t p) {
      double sum = 0;
      for (std::size_t k = 0; k < 3; ++k)
        sum += std::pow(double{at[k]} - double{before.positions[p][k]}, 2);
      return sum;
    };
    std::vector<double> all(before.size());
    for (std::size_t p = 0; p < all.size(); ++p) all[p] = distance(p);
    out.push_back(std::size_t(std::min_element(all.begin(), all.end()) - all.begin()));
  }
  return out;
}

// Coordinates up to 1 in 65535ths of a logarithm's range of 1.4, doubled at 1; turns in 255ths of
// sqrt(2); opacity in 255ths. Six hundred sizes and colours over a range of 3 share 256 values.
// Harmonics of 64 or fewer splats have a vector each.
TEST(SogWriter, SplatsOfEveryDegreeAreReadAgainWithinWhatItKeeps) {
  for (int degree = 0; degree <= 3; ++degree) {
    const Gaussians before = random_gaussians(60, degree);
    const GaussianFile file = read_again(*gaussian_file(before, SplatFormat::kSog));
    const Gaussians& after = file.gaussians;
    EXPECT_EQ(file.format, "SOG 2");
    EXPECT_EQ(file.left_out + file.mended, 0u);
    EXPECT_EQ(after.degree, degree);
    ASSERT_EQ(after.size(), 60u);
    const auto from = matched(before, after);
    std::vector<std::size_t> sorted = from, all(60);
    std::sort(sorted.begin(), sorted.end());
    std::iota(all.begin(), all.end(), std::size_t{0});
    EXPECT_EQ(sorted, all);
    const std::size_t row = 3 * before.num_harmonics();
    for (std::size_t i = 0; i < 60; ++i) {
      const std::size_t p = from[i];
      EXPECT_THAT(after.positions[i], Pointwise(FloatNear(2.2e-5f), before.positions[p]));
      EXPECT_THAT(after.log_deviations[i], Pointwise(FloatNear(0.006f), before.log_deviations[p]));
      EXPECT_NEAR(1 / (1 + std::exp(-after.logits[i])), 1 / (1 + std::exp(-before.logits[p])),
                  0.002);
      const auto &a = after.rotations[i], &b = before.rotations[p];
      EXPECT_GT(std::abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]), 0.9999f);
      for (std::size_t k = 0; k < row; ++k)
        EXPECT_NEAR(after.harmonics[i * row + k], before.harmonics[p * row + k],
                    k < 3 ? 0.006f : 0.02f)
            << degree << ' ' << k;
    }
  }
}

TEST(SogWriter, OneSplatIsWrittenAndNoneIsRefused) {
  const Gaussians before = random_gaussians(1, 2);
  const Gaussians after = read_again(*gaussian_file(before, SplatFormat::kSog)).gaussians;
  ASSERT_EQ(after.size(), 1u);
  EXPECT_THAT(after.positions[0], Pointwise(FloatNear(1e-6f), before.positions[0]));
  EXPECT_THAT(after.log_deviations[0], Pointwise(FloatNear(1e-5f), before.log_deviations[0]));
  EXPECT_THAT(after.harmonics, Pointwise(FloatNear(1e-5f), before.harmonics));
  EXPECT_EQ(gaussian_file({}, SplatFormat::kSog).error().code, Errc::kInvalidInput);
  EXPECT_EQ(splat_file({}, SplatFormat::kSog).error().code, Errc::kInvalidInput);
}

TEST(SogWriter, TheFileIsTheSameForAnyNumberOfThreads) {
  const Gaussians splats = random_gaussians(3000, 3);
  EXPECT_EQ(*gaussian_file(splats, SplatFormat::kSog, 1),
            *gaussian_file(splats, SplatFormat::kSog, 8));
}

TEST(SogWriter, ValuesAtTheirBoundsStayNumbers) {
  Gaussians splats = random_gaussians(5, 1);
  splats.logits = {-32, 32, 0, -90, 90};
  splats.positions[0] = {1e30f, -1e30f, 0};
  splats.rotations[1] = {1, 0, 0, 0};
  splats.rotations[2] = {0, 0, -1, 0};
  splats.log_deviations[3] = {-40, 40, 0};
  const GaussianFile file = read_again(*gaussian_file(splats, SplatFormat::kSog));
  EXPECT_EQ(file.left_out + file.mended, 0u);
  EXPECT_EQ(file.gaussians.size(), 5u);
}

TEST(SogWriter, DiscsAreReadAgainAsTheyAreSaidToBeStored) {
  const ViewMaps maps(test::harmonic_ball(Directions::kWorld));
  const auto discs = make_splats(maps, {.degree = 2, .axes = SplatAxes::kYDown});
  const SplatCloud stored = as_stored(*discs, SplatFormat::kSog);
  const Gaussians after = read_again(*splat_file(*discs, SplatFormat::kSog)).gaussians;
  const Gaussians told = gaussians_of(stored, UpAxis::kMinusY);
  ASSERT_EQ(after.size(), told.size());
  const auto from = matched(told, after);
  for (std::size_t i = 0; i < after.size(); ++i) {
    EXPECT_EQ(after.positions[i], told.positions[from[i]]);
    for (std::size_t k = 0; k < 27; ++k)
      EXPECT_EQ(after.harmonics[27 * i + k], told.harmonics[27 * from[i] + k]);
  }
}

TEST(SogWriter, PointsThatSixteenBitsDoNotTellApartAreRefused) {
  const ViewMaps maps(test::harmonic_ball(Directions::kWorld));
  SplatCloud discs = *make_splats(maps, {});
  discs.step = 1e-9;
  EXPECT_THAT(splat_file(discs, SplatFormat::kSog).error().message, HasSubstr("16 bits"));
}

TEST(SogWriter, AZipIsReadByAnotherLibrary) {
  const Bytes zip = *stored_zip({{"a", {1, 2, 3}}, {"b/c.bin", {}}, {"last", Bytes(70000, 9)}});
  const auto bundle = ZipBundle::open(zip);
  ASSERT_TRUE(bundle);
  EXPECT_THAT(*bundle->read("a", 10), ElementsAre(1, 2, 3));
  EXPECT_THAT(*bundle->read("b/c.bin", 10), ElementsAre());
  EXPECT_EQ(bundle->read("last", 70000)->size(), 70000u);
  EXPECT_EQ(bundle->find("c.bin"), "b/c.bin");
}
#else
TEST(SogWriter, SogIsRefusedByNameWithoutWebp) {
  const auto file = gaussian_file(random_gaussians(3, 1), SplatFormat::kSog);
  EXPECT_EQ(file.error().code, Errc::kUnsupported);
  EXPECT_THAT(file.error().message, HasSubstr("WebP"));
}
#endif

#if SLF_WITH_ZSTD
TEST(SogWriter, Spz4HoldsWhatSpz3HoldsAndDegreeFour) {
  for (int degree = 0; degree <= 3; ++degree) {
    const Gaussians splats = random_gaussians(70, degree);
    const auto three = parse_gaussians("x", *gaussian_file(splats, SplatFormat::kSpz3));
    const auto four = parse_gaussians("x", *gaussian_file(splats, SplatFormat::kSpz4));
    ASSERT_TRUE(four) << four.error().message;
    EXPECT_EQ(four->format, "SPZ 4");
    EXPECT_EQ(four->gaussians.positions, three->gaussians.positions);
    EXPECT_EQ(four->gaussians.log_deviations, three->gaussians.log_deviations);
    EXPECT_EQ(four->gaussians.rotations, three->gaussians.rotations);
    EXPECT_EQ(four->gaussians.logits, three->gaussians.logits);
    EXPECT_EQ(four->gaussians.harmonics, three->gaussians.harmonics);
  }
  const auto whole =
      parse_gaussians("x", *gaussian_file(random_gaussians(9, 4), SplatFormat::kSpz4));
  EXPECT_EQ(whole->gaussians.degree, 4);
}
#else
TEST(SogWriter, Spz4IsRefusedByNameWithoutZstd) {
  const auto file = gaussian_file(random_gaussians(3, 1), SplatFormat::kSpz4);
  EXPECT_EQ(file.error().code, Errc::kUnsupported);
  EXPECT_THAT(file.error().message, HasSubstr("zstd"));
}
#endif

}  // namespace
}  // namespace slf::sog_writer_test
