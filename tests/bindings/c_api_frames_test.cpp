// SPDX-License-Identifier: Apache-2.0
// Frames through the C interface against the C++ one, and what a caller can do wrong.
#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "c_api_objects.h"
#include "slf/frames.h"

namespace slf::c_api_frames_test {
namespace {

using test::Bytes;
using test::name_of;
using test::stream_of;

/// Releases at the end of a test.
struct Frames {
  explicit Frames(const slf_options* options = nullptr, const slf_allocator* allocator = nullptr) {
    EXPECT_EQ(slf_open_frames(options, allocator, &handle, &error), SLF_OK) << error.message;
  }
  ~Frames() { slf_release_frames(handle); }
  Frames(const Frames&) = delete;
  Frames& operator=(const Frames&) = delete;

  void push(const Bytes& bytes, std::size_t piece) {
    for (std::size_t at = 0; at < bytes.size(); at += piece)
      ASSERT_EQ(
          slf_frames_push(handle, bytes.data() + at, std::min(piece, bytes.size() - at), &error),
          SLF_OK)
          << error.message;
  }
  slf_frame info(std::size_t place) {
    slf_frame out{};
    out.size = sizeof out;
    EXPECT_EQ(slf_frames_get(handle, place, &out, &error), SLF_OK);
    return out;
  }

  slf_error error = SLF_ERROR_INIT;
  slf_frames* handle = nullptr;
};

void expect_same(slf_field* field, const LightField& expected) {
  slf_shape shape{};
  shape.size = sizeof shape;
  ASSERT_EQ(slf_get_shape(field, &shape, nullptr), SLF_OK);
  ASSERT_EQ(shape.points, expected.num_points());
  EXPECT_EQ(shape.partial, expected.partial);
  std::vector<std::int32_t> components(expected.components.size());
  std::vector<std::uint32_t> positions(3 * expected.num_points());
  ASSERT_EQ(slf_read_components(field, 0, shape.points, components.data(), 0, nullptr), SLF_OK);
  ASSERT_EQ(slf_read_positions(field, 0, shape.points, positions.data(), 0, nullptr), SLF_OK);
  EXPECT_EQ(components, expected.components);
  for (std::size_t p = 0; p < expected.num_points(); ++p)
    for (std::size_t k = 0; k < 3; ++k)
      ASSERT_EQ(positions[3 * p + k], static_cast<std::uint32_t>(expected.positions[p][k]));
}

void expect_decodes(Frames& frames, std::size_t place, FrameDecoder& whole) {
  slf_field* field = nullptr;
  ASSERT_EQ(slf_frames_decode(frames.handle, place, &field, &frames.error), SLF_OK)
      << place << frames.error.message;
  const auto expected = whole.decode(place);
  ASSERT_TRUE(expected);
  expect_same(field, *expected);
  slf_release_field(field);
}

class CApiFrames : public testing::TestWithParam<const char*> {};

TEST_P(CApiFrames, DecodeAsTheLibraryDoesWhateverThePieces) {
  const Bytes bytes = stream_of(GetParam());
  for (const std::size_t piece : {std::size_t{13}, std::size_t{4096}, bytes.size()})
    for (const std::uint32_t levels : {0u, 2u}) {
      slf_options options = SLF_OPTIONS_INIT;
      options.levels = levels;
      DecodeOptions same;
      same.levels = static_cast<int>(levels);
      auto whole = FrameDecoder::open(bytes, same);
      ASSERT_TRUE(whole);
      Frames frames(&options);
      frames.push(bytes, piece);
      ASSERT_EQ(slf_frames_finish(frames.handle, &frames.error), SLF_OK) << frames.error.message;
      const std::size_t count = slf_frames_count(frames.handle);
      ASSERT_EQ(count, whole->frames().size());
      for (std::size_t t = 0; t < count; ++t) {
        const slf_frame told = frames.info(t);
        const FrameInfo& info = whole->frames()[t];
        EXPECT_EQ(told.number, info.number);
        EXPECT_EQ(told.time, info.time);
        EXPECT_EQ(told.offset, info.offset);
        EXPECT_EQ(told.bytes, info.bytes);
        EXPECT_EQ(told.predicted, info.predicted);
        EXPECT_EQ(told.lost, 0u);
        expect_decodes(frames, t, *whole);
      }
      expect_decodes(frames, count / 2, *whole);  // and back
    }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_12, CApiFrames,
                         testing::Values("frames-affine", "frames-empty", "frames-groups",
                                         "frames-lattice", "frames-moved", "frames-normals", "frames-transform"),
                         name_of);

TEST(CApiFrames, AFieldThatDoesNotMoveIsPulledBeforeItIsCounted) {
  const Bytes bytes = stream_of("scene-shared");
  Frames frames;
  slf_frame none{};
  none.size = sizeof none;
  EXPECT_EQ(slf_frames_get(frames.handle, 0, &none, nullptr), SLF_INVALID_ARGUMENT);
  frames.push(Bytes(bytes.begin(), bytes.end() - 1), 64);
  EXPECT_EQ(slf_frames_count(frames.handle), 0u);
  const slf_frame early = frames.info(0);
  EXPECT_EQ(early.arriving, 1u);
  EXPECT_LT(early.bytes, bytes.size());
  for (const std::uint32_t levels : {0u, 2u}) {
    slf_options options = SLF_OPTIONS_INIT;
    options.levels = levels;
    ASSERT_EQ(slf_frames_set_options(frames.handle, &options, &frames.error), SLF_OK);
    slf_field* field = nullptr;
    ASSERT_EQ(slf_frames_decode(frames.handle, 0, &field, &frames.error), SLF_OK);
    DecodeOptions same;
    same.levels = static_cast<int>(levels);
    same.max_bytes = early.bytes;
    expect_same(field, *decode(bytes, same));
    slf_release_field(field);
  }
  frames.push({bytes.back()}, 1);
  EXPECT_EQ(slf_frames_count(frames.handle), 1u);
  EXPECT_EQ(frames.info(0).arriving, 0u);
  EXPECT_EQ(slf_frames_finish(frames.handle, &frames.error), SLF_OK);
  slf_options refused = SLF_OPTIONS_INIT;
  refused.max_bytes = 9;
  EXPECT_EQ(slf_frames_set_options(frames.handle, &refused, nullptr), SLF_INVALID_ARGUMENT);
  EXPECT_EQ(slf_frames_set_options(nullptr, nullptr, nullptr), SLF_INVALID_ARGUMENT);
}

TEST(CApiFrames, TheFirstBytesOfAGroupSayWhatAStreamDoes) {
  const Bytes bytes = stream_of("frames-groups");
  Frames frames;
  frames.push(bytes, 1000);
  const void* first = nullptr;
  std::size_t size = 0;
  ASSERT_EQ(slf_frames_get_bytes(frames.handle, 0, &first, &size, &frames.error), SLF_OK);
  ASSERT_EQ(size, frames.info(0).bytes);
  EXPECT_EQ(std::memcmp(first, bytes.data(), size), 0);
  slf_stream* stream = nullptr;
  ASSERT_EQ(slf_open(first, size, nullptr, &stream, &frames.error), SLF_OK) << frames.error.message;
  slf_info info{};
  info.size = sizeof info;
  ASSERT_EQ(slf_get_info(stream, &info, nullptr), SLF_OK);
  EXPECT_GT(info.points, 0u);
  slf_release_stream(stream);
}

TEST(CApiFrames, DamageIsNamedAndCostsNoLaterGroup) {
  Bytes bytes = stream_of("frames-groups");
  auto whole = FrameDecoder::open(bytes);
  ASSERT_TRUE(whole);
  std::size_t later = 1;
  while (whole->frames()[later].predicted) ++later;
  ASSERT_GT(later, 1u);
  bytes[static_cast<std::size_t>(whole->frames()[1].offset) + 1] ^= 4;
  Frames frames;
  frames.push(bytes, 77);
  ASSERT_EQ(slf_frames_finish(frames.handle, nullptr), SLF_OK);
  EXPECT_EQ(frames.info(1).lost, 1u);
  slf_field* field = nullptr;
  EXPECT_NE(slf_frames_decode(frames.handle, 1, &field, &frames.error), SLF_OK);
  EXPECT_EQ(field, nullptr);
  EXPECT_STRNE(frames.error.element, "");
  EXPECT_GE(frames.error.bit_offset / 8, whole->frames()[1].offset);
  EXPECT_LT(frames.error.bit_offset / 8, whole->frames()[1].offset + whole->frames()[1].bytes);
  ASSERT_EQ(slf_frames_decode(frames.handle, 2, &field, &frames.error), SLF_OK)
      << frames.error.message;
  expect_same(field, *whole->decode(later));
  slf_release_field(field);
}

TEST(CApiFrames, DroppedGroupsAreReadAgainBehindASeek) {
  const Bytes bytes = stream_of("frames-groups");
  auto whole = FrameDecoder::open(bytes);
  Frames frames;
  frames.push(bytes, bytes.size());
  const std::size_t last = slf_frames_count(frames.handle) - 1;
  EXPECT_EQ(slf_frames_held_bytes(frames.handle), bytes.size());
  ASSERT_EQ(slf_frames_drop_before(frames.handle, last, nullptr), SLF_OK);
  EXPECT_LT(slf_frames_held_bytes(frames.handle), bytes.size());
  slf_field* field = nullptr;
  const void* gone = &bytes;
  std::size_t size = 0;
  EXPECT_EQ(slf_frames_decode(frames.handle, 0, &field, nullptr), SLF_READ_FAILED);
  EXPECT_EQ(slf_frames_get_bytes(frames.handle, 0, &gone, &size, nullptr), SLF_READ_FAILED);
  EXPECT_EQ(gone, nullptr);
  expect_decodes(frames, last, *whole);
  ASSERT_EQ(slf_frames_seek(frames.handle, 0, nullptr), SLF_OK);
  frames.push(bytes, bytes.size());
  expect_decodes(frames, 0, *whole);
  EXPECT_EQ(slf_frames_count(frames.handle), last + 1);
}

TEST(CApiFrames, ArgumentsThatAreWrongAreNamed) {
  Frames frames;
  frames.push(stream_of("frames-affine"), 500);
  slf_frames* none = nullptr;
  slf_field* field = nullptr;
  slf_frame info{};
  info.size = sizeof info;
  const auto expect_invalid = [&](slf_code code, const char* argument) {
    EXPECT_EQ(code, SLF_INVALID_ARGUMENT);
    EXPECT_STREQ(frames.error.element, argument);
  };
  slf_options options = SLF_OPTIONS_INIT;
  options.max_bytes = 10;
  expect_invalid(slf_open_frames(&options, nullptr, &none, &frames.error), "max_bytes");
  expect_invalid(slf_open_frames(nullptr, nullptr, nullptr, &frames.error), "frames");
  slf_allocator half{sizeof(slf_allocator), 0, nullptr, nullptr, nullptr};
  half.deallocate = [](void*, void*, std::size_t) {};
  expect_invalid(slf_open_frames(nullptr, &half, &none, &frames.error), "allocator");
  expect_invalid(slf_frames_push(nullptr, "", 1, &frames.error), "frames");
  expect_invalid(slf_frames_push(frames.handle, nullptr, 1, &frames.error), "bytes");
  const std::size_t count = slf_frames_count(frames.handle);
  expect_invalid(slf_frames_get(frames.handle, count, &info, &frames.error), "place");
  expect_invalid(slf_frames_get(frames.handle, 0, nullptr, &frames.error), "frame");
  expect_invalid(slf_frames_decode(frames.handle, count, &field, &frames.error), "place");
  expect_invalid(slf_frames_decode(frames.handle, 0, nullptr, &frames.error), "field");
  expect_invalid(slf_frames_drop_before(frames.handle, count, &frames.error), "place");
  expect_invalid(slf_frames_seek(frames.handle, 1, &frames.error), "place");  // predicted
  expect_invalid(slf_frames_seek(frames.handle, count, &frames.error), "place");
  EXPECT_EQ(slf_frames_count(nullptr), 0u);
  EXPECT_EQ(slf_frames_held_bytes(nullptr), 0u);
  EXPECT_EQ(slf_frames_push(frames.handle, nullptr, 0, nullptr), SLF_OK);
  ASSERT_EQ(slf_frames_finish(frames.handle, nullptr), SLF_OK);
  expect_invalid(slf_frames_push(frames.handle, "a", 1, &frames.error), "finish");
  slf_release_frames(nullptr);
}

TEST(CApiFrames, HandlesComeFromTheCallersAllocatorAndGoBack) {
  struct Held {
    std::size_t blocks = 0, made = 0;
  } held;
  slf_allocator allocator{sizeof(slf_allocator), 0, &held, nullptr, nullptr};
  allocator.allocate = [](void* user, std::size_t bytes) {
    ++static_cast<Held*>(user)->blocks;
    ++static_cast<Held*>(user)->made;
    return std::malloc(bytes);
  };
  allocator.deallocate = [](void* user, void* block, std::size_t) {
    --static_cast<Held*>(user)->blocks;
    std::free(block);
  };
  slf_field* field = nullptr;
  {
    Frames frames(nullptr, &allocator);
    frames.push(stream_of("frames-affine"), 500);
    ASSERT_EQ(slf_frames_decode(frames.handle, 0, &field, nullptr), SLF_OK);
  }
  EXPECT_EQ(held.blocks, 1u);  // the field outlives its frames
  EXPECT_EQ(held.made, 2u);
  slf_release_field(field);
  EXPECT_EQ(held.blocks, 0u);
}

}  // namespace
}  // namespace slf::c_api_frames_test
