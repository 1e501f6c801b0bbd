// SPDX-License-Identifier: Apache-2.0
// A coder writes no header that a reader refuses: every element of every header, one beyond its
// range.
#include "bitstream/checked_syntax.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <set>
#include <string>
#include <type_traits>

#include "attributes/texture/texture_header.h"
#include "bitstream/index.h"
#include "bitstream/transform_header.h"
#include "codec/frame_header.h"
#include "tests/bitstream/header_sets.h"

namespace slf::checked_syntax_test {
namespace {

/// Puts one element beyond its range: the one at a place, below its least or above its most.
struct SpoilSyntax {
  std::size_t place;
  bool above;
  std::size_t at = 0;
  std::string spoiled;
  std::set<std::string> names;

  template <class T>
  void u(int n, const char* name, T& value, Range range) {
    EXPECT_TRUE(!ok() || n >= 63 || range.max < std::int64_t{1} << n) << name;  // it has room
    integer(name, value, range);
  }
  template <class T>
  void ue(const char* name, T& value, Range range) {
    EXPECT_GE(range.min, 0) << name;
    integer(name, value, range);
  }
  template <class T>
  void se(const char* name, T& value, Range range) {
    integer(name, value, range);
  }
  template <class T>
  void s8(const char* name, T& value, Range range) {
    EXPECT_TRUE(range.min >= -128 && range.max <= 127) << name;
    integer(name, value, range);
  }
  void f64(const char* name, double& value, bool positive) {
    if (!is_it(name)) return;
    value = above || !positive ? std::numeric_limits<double>::infinity() : 0;
  }
  template <class T>
  void resize(const char* name, std::vector<T>& list, std::uint64_t) {
    if (is_it(name)) list.resize(above || list.empty() ? list.size() + 1 : list.size() - 1);
  }
  void require(bool, Errc, const char*) {}
  bool ok() const { return spoiled.empty(); }

 private:
  template <class T>
  void integer(const char* name, T& value, Range range) {
    if (!is_it(name)) return;
    std::int64_t beyond = above ? range.max + 1 : range.min - 1;
    // What the member cannot hold is beyond its range on the other side.
    if constexpr (std::is_unsigned_v<T>)
      if (beyond < 0) beyond = std::numeric_limits<T>::max();
    value = static_cast<T>(beyond);
    if (static_cast<std::int64_t>(value) != beyond) spoiled = "?";
  }
  bool is_it(const char* name) {
    names.insert(name);
    if (at++ != place) return false;
    spoiled = name;
    return true;
  }
};

/// Each element of a good header, put beyond its range above and below, is refused by name.
/// @return the names of its elements
template <class Header, class Visit>
std::set<std::string> expect_each_refused(const Header& good, const Visit& visit) {
  const auto write = [&](const Header& header) {
    return checked_header([&](auto& v) { visit(v, header); });
  };
  EXPECT_TRUE(write(good));
  std::set<std::string> names;
  for (const bool above : {true, false})
    for (std::size_t place = 0;; ++place) {
      SpoilSyntax spoil{place, above, 0, {}, {}};
      Header header = good;
      visit(spoil, header);
      names.insert(spoil.names.begin(), spoil.names.end());
      if (spoil.spoiled.empty()) break;  // behind the last
      EXPECT_NE(spoil.spoiled, "?");
      const auto written = write(header);
      const std::string message = written ? "written" : written.error().message;
      EXPECT_EQ(message.substr(0, message.find(':')), spoil.spoiled) << place << ' ' << above;
    }
  return names;
}

using header_sets::cut_set;

TEST(Spec_7_2_Sequence, EveryElementBeyondItsRangeIsRefusedByNameBeforeItIsWritten) {
  std::set<std::string> names;
  for (const auto& [name, set] : header_sets::all())
    names.merge(expect_each_refused(set, [](auto& v, auto& s) { sequence_parameter_set(v, s); }));
  EXPECT_GE(names.size(), 45u);
}

TEST(Spec_7_2_Sequence, RulesOfTheWholeHeaderAreCheckedToo) {
  const auto refused = [](const std::function<void(SequenceParameterSet&)>& edit) {
    SequenceParameterSet set = header_sets::full_set();
    edit(set);
    const auto written = write_sequence_parameter_set(set);
    return written ? "" : written.error().message.substr(0, written.error().message.find(':'));
  };
  EXPECT_EQ(refused([](auto&) {}), "");
  EXPECT_EQ(refused([](auto& s) { s.sps_num_groups_minus1 = 3; }), "sps_num_groups_minus1");
  EXPECT_EQ(refused([](auto& s) { s.sps_cut_flag = s.sps_cut_levels = 1, s.sps_cut_groups = 4; }),
            "sps_cut_groups");
  EXPECT_EQ(refused([](auto& s) { s.features = 1; }), "sps_feature");
  EXPECT_EQ(refused([](auto& s) { s.runs.pop_back(); }), "sps_num_functions");
}

TEST(Spec_7_3_Slices, EveryElementBeyondItsRangeIsRefusedByNameBeforeItIsWritten) {
  const SliceTable table{2, 1, {{0, 0}, {5, 700}, {70000, kMaxSlicePoints - 1}}};
  EXPECT_EQ(expect_each_refused(table, [](auto& v, auto& t) { slice_table(v, t, 5); }).size(), 4u);
  const SliceTable full{1, 0, {{kMaxCells - 1, kMaxCells - 1}, {0, 0}}};
  EXPECT_FALSE(write_slice_table(full, cut_set()));
}

TEST(Spec_7_4_UnitHeaders, EveryElementBeyondItsRangeIsRefusedByNameBeforeItIsWritten) {
  SequenceParameterSet set = cut_set();
  set.sps_prediction_flag = set.sps_transform_flag = 1;
  for (const bool predicted : {false, true})
    for (const UnitType type : {UnitType::kGeometry, UnitType::kNormals, UnitType::kCoefficients,
                                UnitType::kRefinement, UnitType::kDigest}) {
      set.predicted = predicted;
      set.sps_base_levels = predicted ? 0 : 5;
      SliceUnitHeader header{7, 0, 1, 1, {}, 0};
      if (type == UnitType::kCoefficients)
        header.cu_prediction.resize(set.coefficient_end(0) - set.coefficient_begin(0), 2);
      const auto names = expect_each_refused(
          header, [&](auto& v, auto& h) { slice_unit_header(v, h, type, set); });
      EXPECT_GE(names.size(), 1u);
      EXPECT_EQ(names.count("cu_prediction"), type == UnitType::kCoefficients ? 1u : 0u);
    }
}

TEST(Spec_7_6_Texture, EveryElementBeyondItsRangeIsRefusedByNameBeforeItIsWritten) {
  const std::vector<TexturePlane> planes = {{1, -7}, {0, 1 << 20}};
  EXPECT_EQ(expect_each_refused(planes, [](auto& v, auto& p) { texture_header(v, p); }).size(), 2u);
}

TEST(Spec_7_7_Index, IsRefusedBeforeItIsWrittenWhereAReaderWouldRefuseIt) {
  const SequenceParameterSet set = cut_set();
  const auto refused = [&](const std::function<void(Index&)>& edit) {
    Index index{{{UnitType::kSlices, 40, {}}, {UnitType::kDigest, 50, {3, 0, 0, 0, {}, 0}}},
                {{0, 1, 2, 10, 11, 31}}};
    edit(index);
    const auto written = write_index(index, set);
    return written ? "" : written.error().message.substr(0, written.error().message.find(':'));
  };
  EXPECT_EQ(refused([](auto&) {}), "");
  EXPECT_EQ(refused([](auto& i) { i.entries[0].bytes = 5; }), "index_unit_bytes");
  EXPECT_EQ(refused([](auto& i) { i.entries[1].ids.slice_id = kMaxSlices; }), "index_slice_id");
  EXPECT_EQ(refused([](auto& i) { i.boxes[0][5] = 32; }), "index_box");
  EXPECT_EQ(refused([](auto& i) { i.boxes[0][3] = 0, i.boxes[0][0] = 1; }), "index_box");
}

TEST(Spec_7_11_Transform, EveryElementBeyondItsRangeIsRefusedByNameBeforeItIsWritten) {
  TransformHeader header;
  header.tr_first_group = 1;
  header.tr_num_groups_minus1 = 1;
  header.tr_colour_flag = 1;
  const auto names =
      expect_each_refused(header, [](auto& v, auto& h) { transform_header(v, h, 3); });
  EXPECT_EQ(names.size(), 6u);
}

TEST(Spec_7_13_Frames, EveryElementBeyondItsRangeIsRefusedByNameBeforeItIsWritten) {
  FrameHeader header;
  header.frame_number = 3;
  header.frame_time = 0.5;
  header.frame_predicted_flag = header.frame_motion_flag = header.frame_lattice_flag = 1;
  header.motion.lattice_log2 = 4;
  const auto names = expect_each_refused(header, [](auto& v, auto& h) { frame_unit(v, h); });
  EXPECT_EQ(names.size(), 11u);
}

}  // namespace
}  // namespace slf::checked_syntax_test
