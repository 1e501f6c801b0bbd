// SPDX-License-Identifier: Apache-2.0
// Streams that break one rule each and are sound but for it: a decoder that does not check it
// decodes them.
#include <algorithm>
#include <functional>
#include <limits>
#include <string>

#include "bitstream/bit_writer.h"
#include "bitstream/encoder/deflate.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

/// A few points whose coefficients are all zero: of empty codewords, which fit any number of
/// functions and steps.
Bytes plain_stream(int functions, int normal_bits = 0) {
  LightField f = field({{0, 1, 2}, {3, 3, 3}, {7, 6, 5}}, 3, functions);
  f.normals.bits = normal_bits;
  if (normal_bits > 0) f.normals.octahedral.assign(3, {0, 0});
  CodingParameters p = with_steps(functions, 1);
  p.index = p.digest = p.predict = false;
  return edited(*pack(f, p), [](UnitList& units) {
    for (EditableUnit& unit : units)
      if (unit.type == UnitType::kCoefficients) unit.payload.resize(1);  // ue 0, ue 0, ue 0
  });
}

void add_refused_headers(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose,
                       const std::function<void(SequenceParameterSet&)>& edit, int functions = 2,
                       int normal_bits = 0) {
    cases.push_back(
        {id, purpose, {"7.2"}, edited(plain_stream(functions, normal_bits), [&](UnitList& units) {
           edit_sequence(units, edit);
         })});
  };
  const auto with_basis = [](SequenceParameterSet& s, std::uint32_t theta, std::uint32_t gamma) {
    s.sps_basis_flag = 1, s.sps_scales_theta = theta, s.sps_scales_gamma = gamma;
  };
  add(
      "scales-theta", "a scale of 7", [&](auto& s) { with_basis(s, 7, 0); }, 128);
  add(
      "scales-gamma", "a scale of 7", [&](auto& s) { with_basis(s, 0, 7); }, 128);
  add("gamma-least", "a gamma of -128",
      [&](auto& s) { with_basis(s, 1, 0), s.sps_gamma_min = -128; });
  add("transfer-idc", "an unknown transfer",
      [&](auto& s) { with_basis(s, 1, 0), s.sps_transfer_idc = 2; });
  for (const double metres : {0.0, -1.0, std::numeric_limits<double>::infinity()})
    add(metres == 0  ? "metres-zero"
        : metres < 0 ? "metres-negative"
                     : "metres-infinite",
        metres == 0  ? "a unit of no length"
        : metres < 0 ? "a unit of less than no length"
                     : "a unit without end",
        [&](auto& s) { s.sps_metres_flag = 1, s.sps_metres_per_unit = metres; });
  add("functions-too-many", "4097 functions",
      [](auto& s) { s.sps_num_functions = 4097, s.runs[0].sps_run_length_minus1 = 4096; });
  add("plane-step-zero", "a step of 0", [](auto& s) { s.runs[0].sps_plane_step[0] = 0; });
  add("plane-step-most", "a step of 2^27", [](auto& s) { s.runs[0].sps_plane_step[0] = 1u << 27; });
  add("plane-group", "a function in a group that there is not",
      [](auto& s) { s.runs[0].sps_plane_group = 1; });
  add("geometry-coder", "Draco in the main profile", [](auto& s) { s.sps_geometry_coder = 1; });
  add("geometry-coder-two", "an unknown geometry coder", [](auto& s) { s.sps_geometry_coder = 2; });
  add(
      "normal-bits-most", "normals of 13 bits", [](auto& s) { s.sps_normal_bits = 13; }, 2, 12);
  add("cut-levels-most", "a cut to more levels than there are",
      [](auto& s) { s.sps_cut_flag = 1, s.sps_cut_levels = 4; });
  add("range-end-most", "a level range that ends at the last level",
      [](auto& s) { s.sps_num_geometry_ranges_minus1 = 1, s.sps_geometry_range_end = {3}; });
  add("ranges-too-many", "more level ranges than levels", [](auto& s) {
    s.sps_num_geometry_ranges_minus1 = 3, s.sps_geometry_range_end = {1, 2, 3};
  });
  cases.push_back({"transforms-too-many",
                   "more transforms than groups",
                   {"7.2"},
                   edited(plain_stream(2), [](UnitList& units) {
                     edit_sequence(units, [](SequenceParameterSet& s) {
                       s.sps_transform_flag = 1, s.sps_num_transforms_minus1 = 1;
                     });
                     // of the first group, joint, of one component
                     units.insert(units.begin() + 1, 2, {UnitType::kTransform, {0xF0}});
                   })});
}

/// Bits, most significant first.
Bytes bits(const std::string& text) {
  Bytes bytes((text.size() + 7) / 8);
  for (std::size_t i = 0; i < text.size(); ++i)
    bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | (text[i] == '1') << (7 - i % 8));
  return bytes;
}

void add_framing(std::vector<RefusedCase>& cases) {
  const Bytes sound = plain_stream(1);
  Bytes counted(sound.begin(), sound.end() - 7);  // without the end unit
  append_unit(counted, UnitType::kEnd, bits("00001000"));
  cases.push_back({"end-count", "an end unit that counts wrongly", {"7.10"}, counted});
  Bytes longer(sound.begin(), sound.end() - 7);
  append_unit(longer, UnitType::kEnd, bits("0010100000000000"));
  cases.push_back({"end-longer", "a byte after the number of units", {"7.10", "3.3"}, longer});
  Bytes seven(kSignature.begin(), kSignature.end());
  for (const int byte : {1, kVersionMajor, 0, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 1})
    seven.push_back(static_cast<std::uint8_t>(byte));
  cases.push_back({"length-of-seven-bytes", "a unit length of seven bytes", {"7.1"}, seven});
  cases.push_back({"truncated-in-length",
                   "ends inside a unit length",
                   {"7.1"},
                   Bytes(seven.begin(), seven.begin() + 13)});
  Bytes zeros = bits(std::string(33, '0'));
  zeros.resize(20);
  cases.push_back({"ue-of-32-zeros",
                   "a number that begins with 32 zeros",
                   {"3.3"},
                   edited(sound, [&](UnitList& units) {
                     first_of(units, UnitType::kSlices).payload = zeros;
                   })});
}

/// One point, whose row 0 is the only one, and a codeword for a range without rows.
void add_range_without_rows(UnitList& units) {
  edit_sequence(units, [](SequenceParameterSet& set) {
    set.sps_num_coefficient_ranges_minus1 = 1, set.sps_coefficient_range_end = {2};
  });
  first_of(units, UnitType::kSlices).payload = bits("11");  // one point: row 0 alone
  units.erase(units.begin() + 2, units.end() - 1);
  const std::string numbers[] = {"1", "1", "111", "01011"};
  const UnitType types[] = {UnitType::kGeometry, UnitType::kNormals, UnitType::kCoefficients,
                            UnitType::kCoefficients};
  const Bytes of_point = *pack(field({{0, 1, 2}}, 3, 0), {});
  const slf::Units all = *split_units(of_point);
  for (std::size_t i = 0; i < 4; ++i) {
    Bytes payload = bits(i < 2 ? "11" : numbers[i]);
    if (i == 0)
      for (const Unit& unit : all.units)
        if (unit.type == UnitType::kGeometry)
          payload.assign(unit.payload.begin(), unit.payload.end());
    if (i == 1) payload = {0x80, 0xFF, 0xFF};
    if (i == 3) payload.insert(payload.end(), 8, 0xFF);
    units.insert(units.end() - 1, {types[i], payload});
  }
}

const char* clause_of(UnitType type) {
  return type == UnitType::kGeometry ? "7.4" : type == UnitType::kNormals ? "7.5" : "7.6";
}

void add_parts(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose, const char* clause, const Bytes& stream,
                       const UnitEdit& edit) {
    cases.push_back({id, purpose, {clause}, edited(stream, edit)});
  };
  const Bytes plain = plain_stream(1, 4);
  for (const auto& [id, type] : {std::pair{"geometry-alignment", UnitType::kGeometry},
                                 std::pair{"normals-alignment", UnitType::kNormals},
                                 std::pair{"coefficients-alignment", UnitType::kCoefficients}})
    add(id, "a bit before the codeword that is not 0", clause_of(type), plain,
        [part = type](UnitList& units) { first_of(units, part).payload[0] |= 1; });
  add("slices-longer", "a byte after the slices", "3.3", plain,
      [](UnitList& units) { first_of(units, UnitType::kSlices).payload.push_back(0); });
  add("sequence-bits", "a bit after the header that is not 0", "3.3", plain,
      [](UnitList& units) { units[0].payload.back() |= 1; });
  add("normals-missing", "no normals where there should be", "7.1", plain, [](UnitList& units) {
    units.erase(units.begin() + (&first_of(units, UnitType::kNormals) - units.data()));
  });
  add("normals-shorter", "normals without their bytes", "8.10", plain_stream(1, 4),
      [](UnitList& units) { first_of(units, UnitType::kNormals).payload = {0x80}; });
  add("normals-longer", "bytes after the normals", "8.3.1", plain, [](UnitList& units) {
    auto& payload = first_of(units, UnitType::kNormals).payload;
    payload.resize(payload.size() + 8);
  });
  add("normals-escape", "a residual of 28 ones", "8.3.4", plain, [](UnitList& units) {
    first_of(units, UnitType::kNormals).payload = Bytes(40, 0);
    first_of(units, UnitType::kNormals).payload[0] = 0x80;
  });
  add("coefficients-escape", "a magnitude of 28 ones", "8.3.4", plain, [](UnitList& units) {
    first_of(units, UnitType::kCoefficients).payload = Bytes(80, 0);
    first_of(units, UnitType::kCoefficients).payload[0] = 0xE0;
  });
  add("coefficients-of-no-row", "a codeword where no row is coded", "7.1", plain,
      add_range_without_rows);
}

void add_limits(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose, const char* clause, const Bytes& stream,
                       const UnitEdit& edit) {
    cases.push_back({id, purpose, {clause}, edited(stream, edit)});
  };
  LightField f = field({{0, 1, 2}, {3, 3, 3}}, 3, 0);
  f.normals = {5, {{8, 0}, {0, 0}}};
  CodingParameters p;
  p.index = p.digest = false;
  add("normals-residual", "a residual of 2^(bits - 1)", "8.10", *pack(f, p), [](UnitList& units) {
    edit_sequence(units, [](SequenceParameterSet& set) { set.sps_normal_bits = 4; });
  });
  p.step = {{1, 1, 1}};
  f = field(scattered(40, 3, 12), 3, 1);
  std::fill(f.components.begin(), f.components.end(), 15000000);
  add("coefficient-limit", "a coefficient above 2^27", "8.7.4", *pack(f, p), [](UnitList& units) {
    edit_sequence(units, [](SequenceParameterSet& set) { set.runs[0].sps_plane_step[0] = 2; });
  });
}

void add_digests(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose, const UnitEdit& edit) {
    cases.push_back({id, purpose, {"7.1", "7.9"}, edited(edit)});
  };
  const auto digest = [](UnitList& units) {
    return units.begin() + (&first_of(units, UnitType::kDigest) - units.data());
  };
  add("digest-twice", "a second digest of a slice", [&](UnitList& units) {
    const EditableUnit again = *digest(units);
    units.insert(digest(units), again);
  });
  add("digest-early", "a digest before the last unit of its slice", [&](UnitList& units) {
    std::iter_swap(digest(units), digest(units) - static_cast<std::ptrdiff_t>(1));
    const EditableUnit moved = *digest(units);
    units.erase(digest(units));
    units.insert(units.begin() + (&first_of(units, UnitType::kGeometry) - units.data()) + 4, moved);
  });
  add("digest-shorter", "a digest of 31 bytes",
      [&](UnitList& units) { digest(units)->payload.pop_back(); });
  add("digest-longer", "a digest of 33 bytes",
      [&](UnitList& units) { digest(units)->payload.push_back(0); });
}

Bytes metadata_unit(const std::string& text, std::uint64_t stated) {
  BitWriter out;
  out.ue(stated);
  out.append(deflate({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
  return out.take();
}

void add_metadata(std::vector<RefusedCase>& cases) {
  const auto add = [&](const char* id, const char* purpose, const UnitEdit& edit) {
    cases.push_back({id, purpose, {"7.8"}, edited(edit)});
  };
  const auto add_text = [&](const char* id, const char* purpose, const std::string& text,
                            std::uint64_t more = 0) {
    add(id, purpose, [&](UnitList& units) {
      first_of(units, UnitType::kMetadata).payload = metadata_unit(text, text.size() + more);
    });
  };
  using namespace std::string_literals;
  add_text("metadata-empty-key", "a key without a character", "\0value\0"s);
  add_text("metadata-odd", "a key without a value", "key\0"s);
  add_text("metadata-open", "a value without its zero byte", "key\0value"s);
  add_text("metadata-not-utf8", "a value that is not UTF-8", "key\0\xFF\0"s);
  add_text("metadata-length", "a byte more stated than there is", "key\0value\0"s, 1);
  add_text("metadata-too-long", "more than 2^20 bytes",
           "key\0"s + std::string((1u << 20) - 4, 'v') + "\0"s);
  add("metadata-twice", "a second metadata unit", [](UnitList& units) {
    const EditableUnit again = first_of(units, UnitType::kMetadata);
    units.insert(units.end() - 1, again);
  });
  add("metadata-longer", "a byte after the zlib stream",
      [](UnitList& units) { first_of(units, UnitType::kMetadata).payload.push_back(0); });
}

}  // namespace

std::vector<RefusedCase> refused_units() {
  std::vector<RefusedCase> cases;
  add_refused_headers(cases);
  add_framing(cases);
  add_parts(cases);
  add_limits(cases);
  add_digests(cases);
  add_metadata(cases);
  return cases;
}

}  // namespace slf::conformance
