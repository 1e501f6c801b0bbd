// SPDX-License-Identifier: Apache-2.0
// Frames in time: what is decoded is what was coded, from any frame on. Spec 7.13, 8.12.
#include <cstdlib>
#include <limits>

#include "codec/decoder/frame_chain.h"
#include "frames_support.h"

namespace slf::frames_test {
namespace {

using namespace test;

class FramesThatMove : public testing::TestWithParam<Moves> {};

TEST_P(FramesThatMove, StepOfOneIsLosslessUpToRounding) {
  const auto fields = fields_of(GetParam(), 4);
  const Bytes stream = joined(coded_frames(fields, frame_parameters(1)));
  FrameDecoder decoder = opened(stream);
  ASSERT_EQ(decoder.frames().size(), fields.size());
  for (std::size_t t = 0; t < fields.size(); ++t) {
    const LightField out = decoded_frame(decoder, t);
    ASSERT_EQ(out.positions, fields[t].positions);
    EXPECT_FALSE(out.partial);
    int largest = 0;
    for (std::size_t i = 0; i < out.components.size(); ++i)
      largest = std::max(largest, std::abs(out.components[i] - fields[t].components[i]));
    EXPECT_LE(largest, 4) << t;
  }
}

TEST_P(FramesThatMove, PredictedOnesAreSmallerUnlessByChance) {
  const auto frames = coded_frames(fields_of(GetParam(), 2), frame_parameters(8));
  EXPECT_TRUE(GetParam() == Moves::kChance || frames[1].size() < frames[0].size());
}

TEST_P(FramesThatMove, AnyFrameAloneIsAsInOrder) {
  const Bytes stream = joined(coded_frames(fields_of(GetParam(), 5), frame_parameters(12), 3));
  FrameDecoder in_order = opened(stream), anywhere = opened(stream);
  std::vector<LightField> fields;
  for (std::size_t t = 0; t < 5; ++t) fields.push_back(decoded_frame(in_order, t));
  for (const std::size_t t : {4u, 1u, 2u, 2u, 0u, 3u, 4u}) {
    FrameDecoder fresh = opened(stream);
    expect_same(decoded_frame(fresh, t), fields[t]);
    expect_same(decoded_frame(anywhere, t), fields[t]);
  }
}

TEST_P(FramesThatMove, FewerLevelsAreThoseWithWholeReferencesToo) {
  for (const std::uint32_t step : {1u, 30u}) {
    const Bytes stream = joined(coded_frames(fields_of(GetParam(), 4), frame_parameters(step)));
    const auto units = *split_frames(stream);
    for (int levels = 1; levels <= kFrameBits; ++levels) {
      DecodeOptions options;
      options.levels = levels;
      FrameDecoder coarse = opened(stream, options);
      for (std::size_t t = 0; t < units.size(); ++t) {
        FrameChain chain;  // of frames that are whole, up to the last
        for (std::size_t before = 0; before < t; ++before)
          ASSERT_TRUE(chain.decode(stream, units[before], {}));
        const auto field = chain.decode(stream, units[t], options);
        ASSERT_TRUE(field);
        SCOPED_TRACE(std::to_string(levels) + " levels, frame " + std::to_string(t));
        expect_same(decoded_frame(coarse, t), *field);
        if (t == 0) expect_same(*field, *decode(stream, options));
      }
    }
  }
}

TEST_P(FramesThatMove, FewerGroupsAreThoseOfTheWhole) {
  const Bytes stream = joined(coded_frames(fields_of(GetParam(), 4), frame_parameters(20)));
  FrameDecoder whole = opened(stream);
  for (std::size_t t = 0; t < 4; ++t) {
    const LightField all = decoded_frame(whole, t);
    for (int groups = 1; groups <= 3; ++groups) {
      DecodeOptions options;
      options.groups = groups;
      FrameDecoder some = opened(stream, options);
      const LightField field = decoded_frame(some, t);
      const std::size_t kept = groups == 1 ? 1 : groups == 2 ? 3 : 4;
      ASSERT_EQ(field.header.num_components(), static_cast<int>(kept));
      ASSERT_EQ(field.positions, all.positions);
      for (std::size_t p = 0; p < field.num_points(); ++p)
        for (std::size_t j = 0; j < 3 * kept; ++j)
          ASSERT_EQ(field.components[p * 3 * kept + j],
                    all.components[p * 3 * kFrameFunctions + j]);
    }
  }
}

TEST_P(FramesThatMove, NeitherBytesNorIntegersDependOnThreads) {
  const auto fields = fields_of(GetParam(), 3);
  CodingParameters p = frame_parameters(12);
  p.rdo = 0.3;
  const Bytes one = joined(coded_frames(fields, p));
  p.threads = 4;
  EXPECT_EQ(joined(coded_frames(fields, p)), one);
  DecodeOptions options;
  options.threads = 4;
  FrameDecoder alone = opened(one), several = opened(one, options);
  for (std::size_t t = 0; t < 3; ++t)
    expect_same(decoded_frame(several, t), decoded_frame(alone, t));
}

TEST_P(FramesThatMove, RegionIsCutFromTheWhole) {
  const Bytes stream = joined(coded_frames(fields_of(GetParam(), 3), frame_parameters(12)));
  DecodeOptions options;
  options.region = VoxelBox{{0, 0, 0}, {31, 40, 50}};
  FrameDecoder whole = opened(stream), part = opened(stream, options);
  for (std::size_t t = 0; t < 3; ++t) {
    const LightField all = decoded_frame(whole, t), some = decoded_frame(part, t);
    std::vector<Voxel> inside;
    for (const Voxel& v : all.positions)
      if (v[0] <= 31 && v[1] <= 40 && v[2] <= 50) inside.push_back(v);
    EXPECT_EQ(some.positions, inside);
    EXPECT_TRUE(some.partial);
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_12, FramesThatMove,
                         testing::Values(Moves::kNothing, Moves::kShift, Moves::kTurn, Moves::kBend,
                                         Moves::kChance, Moves::kAppears),
                         [](const auto& how) { return name_of(how.param); });

TEST(Spec_7_13_Frames, AreListedByGroups) {
  const auto frames = coded_frames(fields_of(Moves::kShift, 5), frame_parameters(30), 2);
  const Bytes stream = joined(frames);
  const auto listed = list_frames(stream);
  ASSERT_TRUE(listed);
  ASSERT_EQ(listed->size(), 5u);
  std::uint64_t offset = 0;
  for (std::size_t t = 0; t < 5; ++t) {
    const FrameInfo& info = (*listed)[t];
    EXPECT_EQ(info.number, t);
    EXPECT_EQ(info.time, 0.5 + static_cast<double>(t) / 30);
    EXPECT_EQ(info.predicted, t % 2 == 1);
    EXPECT_EQ(info.offset, offset);
    EXPECT_EQ(info.bytes, frames[t].size());
    offset += info.bytes;
  }
}

TEST(Spec_7_13_Frames, FirstIsWhatADecoderOfOneLightFieldHas) {
  const auto frames = coded_frames(fields_of(Moves::kShift, 3), frame_parameters(12));
  const LightField first = *opened(frames[0]).decode(0);
  for (const Bytes& stream : {frames[0], joined(frames)}) {
    const auto field = decode(stream);
    ASSERT_TRUE(field) << to_string(field.error());
    expect_same(*field, first);
    const auto info = read_info(stream);
    ASSERT_TRUE(info);
    EXPECT_EQ(info->num_points, first.num_points());
    EXPECT_TRUE(info->complete);
  }
}

TEST(Spec_7_13_Frames, OneThatDoesNotMoveIsOne) {
  const LightField field = frame_of(Moves::kNothing, 0);
  CodingParameters p = frame_parameters(12);
  p.base_levels = 2;
  p.max_slice_points = 500;
  const Bytes stream = *pack(field, p);
  FrameDecoder decoder = opened(stream);
  ASSERT_EQ(decoder.frames().size(), 1u);
  EXPECT_EQ(decoder.frames()[0].bytes, stream.size());
  expect_same(decoded_frame(decoder, 0), *decode(stream));
  const auto beyond = decoder.decode(1);
  ASSERT_FALSE(beyond);
  EXPECT_EQ(beyond.error().code, Errc::kInvalidArgument);
}

TEST(Spec_8_12_Frames, FramesMayHaveOnePoint) {
  std::vector<LightField> fields;
  for (const Voxel& v : {Voxel{5, 5, 5}, Voxel{5, 5, 6}, Voxel{63, 0, 63}})
    fields.push_back(make_field({v}, kFrameBits, 2));
  fields.push_back(frame_of(Moves::kNothing, 0, 2));
  fields.push_back(fields[0]);
  const Bytes stream = joined(coded_frames(fields, frame_parameters(1, 2)));
  FrameDecoder decoder = opened(stream);
  for (std::size_t t = 0; t < fields.size(); ++t) {
    const LightField out = decoded_frame(decoder, t);
    EXPECT_EQ(out.positions, fields[t].positions);
    if (fields[t].num_points() == 1) {
      EXPECT_EQ(out.components, fields[t].components);
    }
  }
}

TEST(Spec_8_12_Frames, WithNormalsDigestsAndTransforms) {
  for (const auto transform : {TransformMode::kNone, TransformMode::kFunctions}) {
    auto fields = fields_of(Moves::kTurn, 3, 12);
    for (LightField& field : fields) field = with_normals(std::move(field));
    CodingParameters p = frame_parameters(4, 12);
    p.transform = transform;
    const Bytes stream = joined(coded_frames(fields, p));
    FrameDecoder decoder = opened(stream);
    for (std::size_t t = 0; t < 3; ++t) {
      const LightField out = decoded_frame(decoder, t);
      EXPECT_EQ(out.positions, fields[t].positions);
      EXPECT_EQ(out.normals.octahedral, fields[t].normals.octahedral);
    }
  }
}

TEST(Spec_8_12_Frames, FramesMayHaveGeometryAlone) {
  const auto fields = fields_of(Moves::kBend, 3, 0);
  const Bytes stream = joined(coded_frames(fields, frame_parameters(1, 0)));
  FrameDecoder decoder = opened(stream);
  for (std::size_t t = 0; t < 3; ++t)
    EXPECT_EQ(decoded_frame(decoder, t).positions, fields[t].positions);
  for (int levels = 1; levels < kFrameBits; ++levels) {
    DecodeOptions options;
    options.levels = levels;
    FrameDecoder coarse = opened(stream, options);
    for (std::size_t t = 0; t < 3; ++t) {
      std::vector<Voxel> cells;
      for (const Voxel& v : fields[t].positions) {
        const int below = kFrameBits - levels;
        cells.push_back({v[0] >> below, v[1] >> below, v[2] >> below});
      }
      EXPECT_EQ(decoded_frame(coarse, t).positions, sorted_distinct(cells));
    }
  }
}

TEST(Spec_8_12_Frames, GroupsOfZerosLeaveStatesToThoseThatAreNot) {
  auto fields = fields_of(Moves::kShift, 4);
  for (const std::size_t t : {0u, 1u, 3u})
    for (std::size_t i = 0; i < fields[t].components.size(); ++i)
      if (i % 12 >= 3) fields[t].components[i] = 0;
  const Bytes stream = joined(coded_frames(fields, frame_parameters(1)));
  FrameDecoder decoder = opened(stream);
  for (std::size_t t = 0; t < 4; ++t) {
    const LightField out = decoded_frame(decoder, t);
    int largest = 0;
    for (std::size_t i = 0; i < out.components.size(); ++i)
      largest = std::max(largest, std::abs(out.components[i] - fields[t].components[i]));
    EXPECT_LE(largest, 4) << t;
  }
}

class FrameRefusals : public testing::Test {
 protected:
  /// The message of what is added behind a first frame.
  static std::string message(const CodingParameters& parameters, const LightField& first,
                             const LightField& second, double time = 1) {
    FrameEncoder encoder(parameters);
    const auto one = encoder.add(first, 0);
    if (!one) return one.error().message;
    const auto two = encoder.add(second, time);
    if (two) return "";
    EXPECT_EQ(two.error().code, Errc::kInvalidArgument);
    EXPECT_TRUE(encoder.add(first, 2)) << "what was refused is forgotten";
    return two.error().message;
  }

  const LightField field_ = frame_of(Moves::kNothing, 0);
  const CodingParameters parameters_ = frame_parameters(12);
};

TEST_F(FrameRefusals, NameTimesThatDoNotAscend) {
  for (const double time : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()})
    EXPECT_THAT(message(parameters_, field_, field_, time), testing::HasSubstr("time"));
}

TEST_F(FrameRefusals, NameWhatIsNotThatOfTheFirst) {
  LightField other = field_;
  other.header.grid.bits = 7;
  other.header.grid.step = 2;
  CodingParameters p = parameters_;
  p.geometry_level_ends = p.coefficient_level_ends = {};
  EXPECT_THAT(message(p, field_, other), testing::HasSubstr("grid"));
  EXPECT_NE(message(parameters_, field_, with_normals(field_)), "");
}

TEST_F(FrameRefusals, NameLayersAndCodersThatFramesDoNotHave) {
  CodingParameters p = parameters_;
  p.quality_layers = 2;
  EXPECT_THAT(message(p, field_, field_), testing::HasSubstr("quality layer"));
  p = parameters_;
  p.group_layers = {1, 2, 1};
  EXPECT_THAT(message(p, field_, field_), testing::HasSubstr("quality layer"));
  p = parameters_;
  p.coefficients = CoefficientCoder::kIndependent;
  EXPECT_THAT(message(p, field_, field_), testing::HasSubstr("coders"));
}

TEST_F(FrameRefusals, TwoPointsInOneVoxelLeaveTheStreamAsItWas) {
  LightField twice = field_;
  twice.positions[1] = twice.positions[0];
  EXPECT_THAT(message(parameters_, field_, twice), testing::HasSubstr("positions"));
}

}  // namespace
}  // namespace slf::frames_test
