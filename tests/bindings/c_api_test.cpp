// SPDX-License-Identifier: Apache-2.0
// The C interface against the C++ one, and everything a caller can do wrong.
#include "slf/slf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "c_api_objects.h"
#include "slf/decoder.h"

namespace slf::c_api_test {
namespace {

using test::Bytes;
using test::Field;
using test::name_of;
using test::Stream;
using test::stream_of;

void expect_same(const Field& field, const LightField& expected, const std::string& what) {
  ASSERT_EQ(field.code, SLF_OK) << what << ": " << field.error.message;
  ASSERT_EQ(field.shape.points, expected.num_points()) << what;
  EXPECT_EQ(field.shape.partial, expected.partial) << what;
  EXPECT_EQ(field.components(), expected.components) << what;
  const auto positions = field.positions();
  for (std::size_t p = 0; p < expected.num_points(); ++p)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(positions[3 * p + k], static_cast<std::uint32_t>(expected.positions[p][k])) << what;
}

/// What a caller may ask of a stream, and the same in C++.
struct Asked {
  std::string name;
  slf_options options;
  DecodeOptions same;
};

std::vector<Asked> everything_of(int levels, int groups, int layers) {
  std::vector<Asked> all;
  const auto add = [&](std::string name, auto set) {
    Asked asked{std::move(name), SLF_OPTIONS_INIT, {}};
    set(asked);
    asked.options.levels = static_cast<std::uint32_t>(asked.same.levels);
    asked.options.groups = static_cast<std::uint32_t>(asked.same.groups);
    asked.options.layers = static_cast<std::uint32_t>(asked.same.layers);
    if (asked.same.region) {
      asked.options.has_region = 1;
      for (std::size_t k = 0; k < 3; ++k) {
        asked.options.region_low[k] = asked.same.region->low[k];
        asked.options.region_high[k] = asked.same.region->high[k];
      }
    }
    all.push_back(asked);
  };
  add("whole", [](Asked&) {});
  for (int n = 1; n <= levels; ++n)
    add("levels " + std::to_string(n), [n](Asked& a) { a.same.levels = n; });
  for (int n = 1; n <= groups; ++n)
    add("groups " + std::to_string(n), [n](Asked& a) { a.same.groups = n; });
  for (int n = 1; n <= layers; ++n)
    add("layers " + std::to_string(n), [n](Asked& a) { a.same.layers = n; });
  const int half = 1 << (levels - 1);
  add("region", [half](Asked& a) { a.same.region = VoxelBox{{0, 0, 0}, {half, half, half}}; });
  add("all three", [half, levels, groups](Asked& a) {
    a.same.region = VoxelBox{{half / 2, 0, 0}, {half, half, 2 * half - 1}};
    a.same.levels = std::max(1, levels - 1);
    a.same.groups = groups > 0 ? 1 : 0;
  });
  return all;
}

class CApiStreams : public testing::TestWithParam<const char*> {};

TEST_P(CApiStreams, DecodesAsTheLibraryDoesFromMemoryAndInParts) {
  const Bytes bytes = stream_of(GetParam());
  const auto info = read_info(bytes);
  ASSERT_TRUE(info);
  std::vector<slf_range> reads;
  const Stream memory(bytes), parts(bytes, reads);
  slf_info told{};
  told.size = sizeof told;
  ASSERT_EQ(slf_get_info(memory.handle, &told, nullptr), SLF_OK);
  const int layers = info->layers.empty() ? 0 : *std::ranges::max_element(info->layers);
  EXPECT_EQ(told.layers, static_cast<std::uint32_t>(layers));
  for (const Asked& asked : everything_of(info->header.grid.bits, info->num_groups, layers)) {
    const auto expected = decode(bytes, asked.same);
    ASSERT_TRUE(expected) << asked.name;
    expect_same(Field(memory.handle, &asked.options), *expected, asked.name + ", in memory");
    expect_same(Field(parts.handle, &asked.options), *expected, asked.name + ", in parts");
  }
}

TEST_P(CApiStreams, ReadsWhatItSaysItWill) {
  const Bytes bytes = stream_of(GetParam());
  std::vector<slf_range> reads;
  const Stream stream(bytes, reads);
  for (std::uint32_t levels = 0; levels < 2; ++levels) {
    slf_options options = SLF_OPTIONS_INIT;
    options.levels = levels;
    std::size_t count = 0;
    ASSERT_EQ(slf_get_ranges(stream.handle, &options, nullptr, 0, &count, nullptr), SLF_OK);
    std::vector<slf_range> ranges(count);
    ASSERT_EQ(slf_get_ranges(stream.handle, &options, ranges.data(), count, &count, nullptr),
              SLF_OK);
    reads.clear();
    ASSERT_EQ(Field(stream.handle, &options).code, SLF_OK);
    ASSERT_EQ(reads.size(), ranges.size());
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(reads[i].offset, ranges[i].offset);
      EXPECT_EQ(reads[i].bytes, ranges[i].bytes);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_9, CApiStreams,
                         testing::Values("scene-shared", "scene-slice-by-slice", "sphere-dense",
                                         "harmonics", "prediction", "no-index-no-digest", "slices",
                                         "cut-region", "normals", "scene-alone", "layers-by-group"),
                         name_of);

TEST(CApi, RowsGoWhereTheStrideSays) {
  const Stream stream(stream_of("harmonics"));
  const Field field(stream.handle, nullptr);
  const auto packed = field.components();
  const std::size_t row = field.shape.components * 3, wide = row + 5;
  ASSERT_GT(field.shape.points, 4u);
  std::vector<std::int32_t> out(3 * wide, -7);
  ASSERT_EQ(slf_read_components(field.handle, 1, 3, out.data(), wide * 4, nullptr), SLF_OK);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < wide; ++j)
      EXPECT_EQ(out[i * wide + j], j < row ? packed[(i + 1) * row + j] : -7);
}

TEST(CApi, ErrorsNameElementUnitAndPlace) {
  Bytes bytes = stream_of("two-points");
  bytes[30] ^= 1;
  slf_error error = SLF_ERROR_INIT;
  slf_stream* stream = nullptr;
  EXPECT_EQ(slf_open(bytes.data(), bytes.size(), nullptr, &stream, &error), SLF_CHECKSUM);
  EXPECT_EQ(stream, nullptr);
  EXPECT_STREQ(error.element, "unit_crc");
  EXPECT_STREQ(error.unit, "index");
  EXPECT_EQ(error.bit_offset, 304u);
  EXPECT_STREQ(error.message, "SLF_CHECKSUM: unit_crc in the index unit, bit 304");
  slf_error small{};
  small.size = 8;  // up to the code
  EXPECT_EQ(slf_open(bytes.data(), bytes.size(), nullptr, &stream, &small), SLF_CHECKSUM);
  EXPECT_EQ(small.code, SLF_CHECKSUM);
  EXPECT_STREQ(small.message, "");
  for (slf_code code = 0; code <= SLF_INTERNAL; ++code)
    EXPECT_STRNE(slf_code_name(code), "SLF_UNKNOWN");
  EXPECT_STREQ(slf_code_name(99), "SLF_UNKNOWN");
  EXPECT_STREQ(slf_code_name(-1), "SLF_UNKNOWN");
}

TEST(CApi, ErrorsAreThoseOfTheLibrary) {
  for (const std::string id : {"step-zero", "geometry-shorter", "points-one-more", "index-box",
                               "metadata-garbage", "bytes-after-end"}) {
    const Bytes bytes = stream_of(id, "refused");
    const auto decoded = decode(bytes);
    ASSERT_FALSE(decoded) << id;
    slf_error error = SLF_ERROR_INIT;
    slf_stream* stream = nullptr;
    if (slf_open(bytes.data(), bytes.size(), nullptr, &stream, &error) == SLF_OK) {
      const Field field(stream, nullptr);
      EXPECT_NE(field.code, SLF_OK) << id;
      error = field.error;
    }
    slf_release_stream(stream);
    EXPECT_EQ(std::string(error.message),
              slf_code_name(error.code) + (": " + where(decoded.error())));
    EXPECT_STREQ(error.unit, decoded.error().unit);
    EXPECT_EQ(error.bit_offset, decoded.error().bit_offset);
  }
}

TEST(CApi, WrongArgumentsAreRefusedByName) {
  const Stream stream(stream_of("vector"));  // planes without a meaning
  const Field field(stream.handle, nullptr);
  slf_error error = SLF_ERROR_INIT;
  std::vector<float> floats(100000);
  std::uint32_t voxel[3];
  EXPECT_EQ(slf_decode(stream.handle, nullptr, nullptr, &error), SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(error.element, "field");
  EXPECT_EQ(slf_read_positions(field.handle, field.shape.points, 1, voxel, 0, &error),
            SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(error.element, "first");
  EXPECT_EQ(slf_read_positions(field.handle, ~std::uint64_t{0}, 2, voxel, 0, &error),
            SLF_INVALID_ARGUMENT);
  EXPECT_EQ(slf_read_positions(field.handle, 0, 1, voxel, 8, &error), SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(error.element, "stride");
  EXPECT_EQ(slf_read_positions(field.handle, 0, 1, nullptr, 0, &error), SLF_INVALID_ARGUMENT);
  EXPECT_EQ(slf_read_weights(field.handle, 0, 1, floats.data(), 0, &error), SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(error.element, "weights");
  EXPECT_EQ(slf_read_mirror_normals(field.handle, 0, 1, floats.data(), 0, &error),
            SLF_INVALID_ARGUMENT);
  EXPECT_EQ(slf_read_function_cube(field.handle, 9, floats.data(), floats.size(), &error),
            SLF_INVALID_ARGUMENT);
  slf_options options = SLF_OPTIONS_INIT;
  options.levels = 22;
  const Field none(stream.handle, &options);
  EXPECT_EQ(none.code, SLF_INVALID_ARGUMENT);
  EXPECT_STREQ(none.error.element, "levels");
  EXPECT_EQ(none.handle, nullptr);
  slf_release_stream(nullptr);
  slf_release_field(nullptr);
}

TEST(CApi, MetadataThatIsNotThereIsNull) {
  const Stream stream(stream_of("two-points"));
  const char *key = "left", *value = "left";
  EXPECT_EQ(slf_get_metadata(stream.handle, 999, &key, &value, nullptr), SLF_INVALID_ARGUMENT);
  EXPECT_EQ(key, nullptr);
  EXPECT_EQ(value, nullptr);
}

TEST(CApi, LimitsAndThePreflightHold) {
  const Stream stream(stream_of("harmonics"));
  slf_estimate estimate{sizeof(slf_estimate), 0, 0, 0, 0, 0};
  ASSERT_EQ(slf_preflight(stream.handle, nullptr, &estimate, nullptr), SLF_OK);
  const Field field(stream.handle, nullptr);
  EXPECT_EQ(estimate.points, field.shape.points);
  EXPECT_EQ(estimate.components, field.shape.components);
  EXPECT_GE(estimate.memory_bytes, estimate.field_bytes);
  EXPECT_EQ(estimate.memory_bytes, decode_cost(stream.held)->memory_most);
  slf_options options = SLF_OPTIONS_INIT;
  options.max_memory_bytes = estimate.memory_bytes;
  EXPECT_EQ(Field(stream.handle, &options).code, SLF_OK);
  options.max_memory_bytes = estimate.memory_bytes - 1;
  EXPECT_EQ(Field(stream.handle, &options).code, SLF_LIMIT_EXCEEDED);
  options = SLF_OPTIONS_INIT;
  options.max_points = field.shape.points - 1;
  EXPECT_EQ(Field(stream.handle, &options).code, SLF_LIMIT_EXCEEDED);
}

TEST(CApi, ProgressRisesAndCanEndADecodeAtEveryCall) {
  const Stream stream(stream_of("scene-shared"));
  struct Told {
    std::vector<double> fractions;
    std::size_t most = ~std::size_t{0};
  } told;
  slf_options options = SLF_OPTIONS_INIT;
  options.user = &told;
  options.progress = [](void* user, double fraction) {
    auto& t = *static_cast<Told*>(user);
    t.fractions.push_back(fraction);
    return t.fractions.size() > t.most ? 1 : 0;
  };
  ASSERT_EQ(Field(stream.handle, &options).code, SLF_OK);
  ASSERT_GT(told.fractions.size(), 3u);
  EXPECT_TRUE(std::is_sorted(told.fractions.begin(), told.fractions.end()));
  EXPECT_GE(told.fractions.front(), 0);
  EXPECT_LE(told.fractions.back(), 1);
  const std::size_t calls = told.fractions.size();
  for (const int threads : {1, 3})
    for (std::size_t most = 0; most < calls; ++most) {
      told = {{}, most};
      options.threads = threads;
      const Field field(stream.handle, &options);
      EXPECT_EQ(field.code, SLF_CANCELLED) << most;
      EXPECT_EQ(field.handle, nullptr);
    }
}

TEST(CApi, AReaderThatFailsIsNamed) {
  std::vector<slf_range> reads;
  Stream stream(stream_of("scene-shared"), reads);
  stream.fails = true;
  slf_info info{};
  info.size = sizeof info;
  ASSERT_EQ(slf_get_info(stream.handle, &info, nullptr), SLF_OK);
  const Field field(stream.handle, nullptr);
  EXPECT_EQ(field.code, info.bytes > (1 << 16) ? SLF_READ_FAILED : SLF_OK);
  slf_reader reader{sizeof(slf_reader), 0, 100, nullptr,
                    [](void*, std::uint64_t, void*, std::size_t) { return 1; }};
  slf_stream* none = nullptr;
  slf_error error = SLF_ERROR_INIT;
  EXPECT_EQ(slf_open_reader(&reader, nullptr, &none, &error), SLF_READ_FAILED);
  EXPECT_EQ(none, nullptr);
}

TEST(CApi, VersionsAreThoseOfTheHeader) {
  EXPECT_EQ(slf_api_version(), SLF_API_VERSION_MAJOR << 16 | SLF_API_VERSION_MINOR);
  EXPECT_EQ(slf_format_version(), 65539u);
  EXPECT_STRNE(slf_version(), "unknown");
  EXPECT_EQ(slf_has_feature(99), 0);
}

}  // namespace
}  // namespace slf::c_api_test
