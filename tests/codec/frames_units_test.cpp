// SPDX-License-Identifier: Apache-2.0
// What frames are made of, and motions that are made to hurt. Spec 7.13.
#include <chrono>

#include "frames_edit.h"

namespace slf::frames_units_test {
namespace {

using namespace test;

TEST(Spec_7_13_Units, ThatPredictedFramesDoNotHaveAreRefused) {
  const auto f = small_frames();
  for (const UnitType type : {UnitType::kSequence, UnitType::kTransform, UnitType::kIndex,
                              UnitType::kMetadata, UnitType::kFrame})
    for (const std::size_t at : {1u, 2u, 4u}) {
      Frame units = split(f[1]);
      units.insert(units.begin() + static_cast<std::ptrdiff_t>(at),
                   {type, type == UnitType::kFrame ? units[0].payload : split(f[0])[0].payload});
      expect_error(joined({f[0], joined_units(units)}), Errc::kOutOfRange, "unit_type",
                   unit_name(type));
    }
}

TEST(Spec_7_13_Units, FillersAndUnknownOnesStandInPredictedFrames) {
  const auto f = small_frames();
  Frame units = split(f[1]);
  for (const UnitType type : {UnitType::kFiller, static_cast<UnitType>(99)})
    units.insert(units.begin() + 2, {type, {1, 2, 3}});
  EXPECT_FALSE(decode_all(joined({f[0], joined_units(units), f[2]})));
}

TEST(Spec_7_13_Units, UnitsBehindTheEndOfAPredictedFrameAreRefused) {
  const auto f = small_frames();
  Frame units = split(f[1]);
  units.push_back({UnitType::kFiller, {}});
  EXPECT_TRUE(decode_all(joined({f[0], joined_units(units)})));
}

TEST(Spec_7_1_Order, FrameUnitIsTheSecondOrThereIsNone) {
  const Bytes still = *pack(small_fields(1)[0], [] {
    CodingParameters p = small_parameters();
    p.index = false;
    p.base_levels = 0;
    return p;
  }());
  const Frame units = split(still);
  const OwnedUnit frame = split(small_frames()[0])[1];
  for (std::size_t at = 2; at < units.size(); ++at) {
    Frame other = units;
    other.insert(other.begin() + static_cast<std::ptrdiff_t>(at), frame);
    expect_error(joined_units(other), Errc::kOutOfRange, "unit_type", "frame");
    EXPECT_FALSE(decode(joined_units(other)));
    EXPECT_FALSE(read_info(joined_units(other)));
  }
  Frame first = units;
  first.insert(first.begin(), frame);
  Bytes bytes(kSignature.begin(), kSignature.end());
  for (const OwnedUnit& unit : first) append_unit(bytes, unit.type, unit.payload);
  EXPECT_TRUE(decode_all(bytes));
  Frame two = units;
  two.insert(two.begin() + 1, 2, frame);
  expect_error(joined_units(two), Errc::kOutOfRange, "unit_type", "frame");
}

TEST(Spec_7_13_Hazards, DamagedFrameUnitIsAnErrorOfOneLightFieldToo) {
  const Bytes stream = small_frames()[0];
  Frame units = split(stream);
  units[1].payload.push_back(7);
  Bytes bytes(kSignature.begin(), kSignature.end());
  for (const OwnedUnit& unit : units) append_unit(bytes, unit.type, unit.payload);
  for (const auto& error : {decode(bytes).error(), read_info(bytes).error()}) {
    EXPECT_STREQ(error.unit, "frame");
    EXPECT_STREQ(error.element, "frame_vectors");
  }
}

TEST(Spec_7_13_Hazards, SequencesThatFramesDoNotHaveAreRefused) {
  const auto f = small_frames();
  CodingParameters p = small_parameters();
  p.index = false;
  p.base_levels = 2;
  const auto moving = [&](const CodingParameters& parameters) {
    Frame units = split(*pack(small_fields(1)[0], parameters));
    units.insert(units.begin() + 1, split(f[0])[1]);
    return joined_units(units);
  };
  expect_error(moving(p), Errc::kOutOfRange, "sps_base_levels", "sequence");
  p.base_levels = 0;
  EXPECT_FALSE(decode_all(moving(p)));
  p.quality_layers = 2;
  expect_error(moving(p), Errc::kOutOfRange, "sps_coefficient_coder", "sequence");
  p.quality_layers = 1;
  p.coefficients = CoefficientCoder::kIndependent;
  expect_error(moving(p), Errc::kOutOfRange, "sps_coefficient_coder", "sequence");
}

/// A second frame with this motion, as it is coded: of other points than were moved so.
Bytes with_motion(const std::function<void(FrameHeader&)>& edit, const Bytes& vectors = {}) {
  const auto f = small_frames();
  Frame units = split(f[1]);
  std::span<const std::uint8_t> ignored;
  FrameHeader header = *parse_frame_header(units[0].payload, ignored);
  header.frame_motion_flag = 1;
  header.frame_lattice_flag = 0;
  header.motion = {};
  edit(header);
  BitWriter out;
  WriteSyntax write{out};
  frame_unit(write, header);
  units[0].payload = out.take();
  units[0].payload.insert(units[0].payload.end(), vectors.begin(), vectors.end());
  Bytes stream = f[0];
  for (const OwnedUnit& unit : units) append_unit(stream, unit.type, unit.payload);
  return stream;
}

TEST(Spec_8_12_1_Hazards, MotionOutOfTheGridDecodes) {
  for (const std::int32_t shift : {1 << 19, -(1 << 19), Motion::kMostShift, -Motion::kMostShift}) {
    const Bytes stream = with_motion([&](FrameHeader& h) {
      h.motion.shift = {shift, -shift, shift};
      h.motion.matrix[1][2] = shift < 0 ? -Motion::kMostEntry : Motion::kMostEntry;
    });
    const auto error = decode_all(stream, small_limits());  // of what was coded with another
    if (error) {
      EXPECT_STRNE(error->element, "");
    }
  }
}

/// size: of the lattice, minus one
Bytes with_lattice(const std::array<std::int32_t, 3>& size, const Bytes& vectors, int log2 = 3) {
  return with_motion(
      [&](FrameHeader& h) {
        h.frame_lattice_flag = 1;
        h.motion.lattice_log2 = log2;
        h.motion.lattice_size = size;
      },
      vectors);
}

TEST(Spec_7_13_Lattice, MoreThanItsMostPointsAreRefused) {
  expect_error(with_lattice({1 << 18, 0, 0}, {}), Errc::kOutOfRange, "frame_lattice_size_minus1",
               "frame");
  expect_error(with_lattice({63, 63, 64}, {}), Errc::kOutOfRange, "frame_lattice_size_minus1",
               "frame");
}

TEST(Spec_7_13_Lattice, ItsMostPointsInFewBytesAreSoonDone) {
  const auto begin = std::chrono::steady_clock::now();
  for (const int log2 : {3, 8})
    for (const Bytes& vectors : {Bytes{}, Bytes{1, 2, 3, 4, 5}, Bytes(12, 0xFF), Bytes(12, 0)})
      (void)decode_all(with_lattice({63, 63, 63}, vectors, log2), small_limits());
  (void)decode_all(with_lattice({(1 << 18) - 1, 0, 0}, Bytes(5, 0x5A)), small_limits());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(Spec_7_13_Lattice, CodewordThatGoesOnIsRefused) {
  expect_error(with_lattice({0, 0, 0}, Bytes(40, 0x55)), Errc::kOutOfRange, "frame_vectors",
               "frame");
}

TEST(Spec_9_Frames, AreHeldToLimitsWithWhatIsKept) {
  const Bytes stream = joined(small_frames());
  DecodeOptions options;
  for (const auto& change : std::vector<std::function<void(DecodeLimits&)>>{
           [](DecodeLimits& l) { l.max_points = 10; },
           [](DecodeLimits& l) { l.max_memory = 1 << 20; },
           [](DecodeLimits& l) { l.max_work = 1000; }}) {
    options.limits = {};
    change(options.limits);
    const auto error = decode_all(stream, options);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, Errc::kLimitExceeded);
  }
  options.limits.max_stream_bytes = stream.size() - 1;
  EXPECT_EQ(FrameDecoder::open(stream, options).error().code, Errc::kLimitExceeded);
  options = {};
  options.max_bytes = 100;
  EXPECT_EQ(FrameDecoder::open(stream, options).error().code, Errc::kInvalidArgument);
}

TEST(Spec_7_1_2_FrameVersions, AreOf1_1WithContextsByTheReferenceAlone) {
  const auto fields = fields_of(Moves::kTurn, 2);
  CodingParameters off = frame_parameters(8);
  off.reference_contexts = false;
  const Bytes with = joined(coded_frames(fields, frame_parameters(8))),
              without = joined(coded_frames(fields, off)),
              alone = joined(coded_frames(fields, frame_parameters(8), 1));
  EXPECT_EQ(with[10], 1);
  EXPECT_EQ(without[10], 0);
  EXPECT_EQ(alone[10], 0);  // no frame is predicted
  FrameDecoder a = opened(with), b = opened(without);
  expect_same(decoded_frame(a, 1), decoded_frame(b, 1));
}

TEST(Spec_7_2_1_Features, AndLevelStayWithATransform) {
  CodingParameters parameters = frame_parameters(8);
  parameters.transform = TransformMode::kFunctions;
  LightField field = frame_of(Moves::kNothing, 0);  // its functions are one, four times
  for (std::size_t i = 0; i < field.components.size(); ++i)
    field.components[i] = field.components[i - i % 12 + i % 3];
  const auto frames = coded_frames({field, field}, parameters);
  const auto set = parse_sequence_parameter_set(read_unit(frames[0], kSignature.size())->payload);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->sps_transform_flag, 1u);
  EXPECT_EQ(set->features, kReferenceContexts);
  EXPECT_EQ(set->sps_level, 1u);
}

TEST(Spec_7_2_1_Features, StayInWhatIsCutFromFrames) {
  const Bytes stream = joined(coded_frames(fields_of(Moves::kTurn, 3), frame_parameters(8)));
  DecodeOptions options;
  options.levels = 4;
  const auto cut = truncate_frames(stream, 0, 2, options);
  ASSERT_TRUE(cut);
  EXPECT_EQ((*cut)[10], 1);
  FrameDecoder of_cut = opened(*cut), of_whole = opened(stream, options);
  for (std::size_t t = 0; t < 3; ++t)
    EXPECT_EQ(decoded_frame(of_cut, t).components, decoded_frame(of_whole, t).components);
}

}  // namespace
}  // namespace slf::frames_units_test
