// SPDX-License-Identifier: Apache-2.0
// Frames to be refused: their order, their units, their motion and what they are predicted from.
#include "codec/encoder/assemble.h"
#include "conformance/cases.h"
#include "conformance/edit_frames.h"
#include "conformance/fields.h"

namespace slf::conformance {
namespace {

void nothing(UnitList&) {}

/// Three frames of one group, of few points.
std::vector<Bytes> three_frames() {
  CodingParameters p = with_steps(1, 40);
  p.geometry_level_ends = p.coefficient_level_ends = {2, 4};
  FrameWriter writer(p);
  for (std::int32_t t = 0; t < 3; ++t) {
    std::vector<Voxel> voxels = lattice(3, 4, 5);
    for (Voxel& v : voxels) v[0] += 3 + t;
    const LightField f = field(voxels, 4, 1, 500);
    Motion motion;
    motion.shift = {-16, 0, 0};
    if (t == 0) {
      writer.add(f);
    } else {
      writer.add(f, motion);
    }
  }
  return writer.frames();
}

class Refused {
 public:
  explicit Refused(std::vector<RefusedCase>& cases) : cases_(cases), f_(three_frames()) {}

  void add_order() {
    add("frames-number-skipped", "a frame is missing", joined({f_[0], f_[2]}));
    add("frames-number-twice", "a frame stands twice", joined({f_[0], f_[1], f_[1]}), 2);
    add("frames-time", "a time that is not later",
        with(nothing, [](FrameHeader& h) { h.frame_time = 0; }));
    add("frames-intra-without-signature", "no frame that is not predicted begins so",
        with(nothing, [](FrameHeader& h) { h.frame_predicted_flag = 0; }));
    add("frames-bytes-shorter", "a length that ends within the frame",
        with(nothing, [](FrameHeader& h) { h.frame_bytes -= 20; }));
    add("frames-bytes-longer", "a length behind the end unit",
        with(nothing, [](FrameHeader& h) { ++h.frame_bytes; }));
  }

  void add_units() {
    const auto put = [&](const char* id, const char* purpose, UnitType type, std::size_t at) {
      const Bytes payload = type == UnitType::kFrame ? first_payload(f_[1]) : Bytes{0x80};
      add(id, purpose, with([&](auto& units) {
            units.insert(units.begin() + static_cast<std::ptrdiff_t>(at), {type, payload});
          }));
    };
    put("frames-sequence-in-predicted", "a sequence unit", UnitType::kSequence, 1);
    put("frames-transform-in-predicted", "a transform unit", UnitType::kTransform, 1);
    put("frames-index-in-predicted", "an index unit", UnitType::kIndex, 1);
    put("frames-metadata-in-predicted", "a metadata unit", UnitType::kMetadata, 3);
    put("frames-frame-unit-twice", "two frame units", UnitType::kFrame, 1);
    add("frames-end-count", "an end unit that counts one more",
        raw([](auto& units) { units.back().payload = end_payload(units.size()); }));
    add("frames-behind-end", "a unit behind the end unit", with([](auto& units) {
          units.push_back({UnitType::kFiller, {}});
        }));
    add("frames-digest", "a predicted frame that is not what its digest says",
        with([](auto& units) { first_of(units, UnitType::kDigest).payload.back() ^= 1; }));
  }

  void add_motion() {
    add("frames-vectors-without-lattice", "bytes behind a frame unit without a lattice",
        raw([](auto& units) { units[0].payload.push_back(1); }));
    const auto lattice_of = [&](const std::array<std::int32_t, 3>& size_minus_1,
                                const Bytes& vectors) {
      Bytes second = with_frame(nothing, [&](FrameHeader& h) {
        h.frame_lattice_flag = 1;
        h.motion.lattice_log2 = 3;
        h.motion.lattice_size = size_minus_1;
      });
      second = unit_edited(second, [&](auto& units) {
        Bytes& payload = units[0].payload;
        payload.insert(payload.end(), vectors.begin(), vectors.end());
      });
      return joined({f_[0], second});
    };
    add("frames-lattice-log2", "a lattice of 2 voxels a step", with(nothing, [](FrameHeader& h) {
          h.frame_motion_flag = h.frame_lattice_flag = h.motion.lattice_log2 = 1;
        }));
    add("frames-lattice-too-large", "2^18 + 1 points", lattice_of({1 << 18, 0, 0}, {}));
    add("frames-lattice-too-large-together", "64 * 64 * 65 points", lattice_of({63, 63, 64}, {}));
    add("frames-vectors-shorter", "vectors that end early", lattice_of({3, 3, 3}, {0x7F}));
    add("frames-vectors-longer", "bytes behind the vectors",
        lattice_of({0, 0, 0}, Bytes(40, 0x55)));
  }

  void add_references() {
    for (const std::size_t keep : {3u, 4u, 5u}) {
      const Bytes first = edited_frame(f_[0], [&](auto& units) { units.resize(keep); });
      add("frames-reference-of-" + std::to_string(keep) + "-units",
          "a frame predicted from one that lacks units", joined({first, f_[1]}));
    }
  }

 private:
  static Bytes first_payload(const Bytes& frame) {
    const Unit unit = *read_unit(frame, 0);
    return {unit.payload.begin(), unit.payload.end()};
  }

  /// Units changed, counts and lengths left as they were.
  static Bytes unit_edited(const Bytes& frame, const UnitEdit& edit) {
    UnitList units;
    for (std::size_t at = 0; at < frame.size();) {
      const Unit unit = *read_unit(frame, at);
      units.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}});
      at += static_cast<std::size_t>(unit.bytes);
    }
    edit(units);
    Bytes made;
    for (const EditableUnit& unit : units) append_unit(made, unit.type, unit.payload);
    return made;
  }

  Bytes with_frame(const UnitEdit& edit, const std::function<void(FrameHeader&)>& header) {
    return edited_frame(f_[1], edit, header);
  }
  Bytes with(const UnitEdit& edit, const std::function<void(FrameHeader&)>& header = {}) {
    return joined({f_[0], with_frame(edit, header)});
  }
  Bytes raw(const UnitEdit& edit) { return joined({f_[0], unit_edited(f_[1], edit)}); }

  void add(const std::string& id, const char* purpose, Bytes stream, int place = 1) {
    cases_.push_back({id, purpose, {"7.13", "8.12.5"}, std::move(stream), place});
  }

  std::vector<RefusedCase>& cases_;
  std::vector<Bytes> f_;
};

}  // namespace

std::vector<RefusedCase> refused_first_frames() {
  std::vector<RefusedCase> cases;
  const Bytes first = three_frames()[0];
  const auto add = [&](const char* id, const char* purpose, const UnitEdit& edit,
                       const std::function<void(FrameHeader&)>& header = {}) {
    cases.push_back({id, purpose, {"7.1", "7.13"}, edited_frame(first, edit, header)});
  };
  add("frames-unit-third", "a frame unit behind the second unit",
      [](auto& units) { std::swap(units[1], units[2]); });
  add("frames-unit-twice", "two frame units",
      [](auto& units) { units.insert(units.begin() + 1, units[1]); });
  add("frames-predicted-first", "nothing to predict from", nothing,
      [](FrameHeader& h) { h.frame_predicted_flag = 1; });
  add("frames-bytes-of-one", "a length behind the end of a stream that is whole", nothing,
      [](FrameHeader& h) { ++h.frame_bytes; });
  CodingParameters p = with_steps(1, 40);
  p.index = false;
  const Bytes frame_payload = [&] {
    const Unit sequence = *read_unit(first, kSignature.size());
    const Unit unit = *read_unit(first, static_cast<std::size_t>(sequence.offset + sequence.bytes));
    return Bytes(unit.payload.begin(), unit.payload.end());
  }();
  const auto add_still = [&](const char* id, const char* purpose, const CodingParameters& given) {
    Bytes stream = *pack(field(lattice(3, 4, 5), 4, 1, 500), given);
    const Unit sequence = *read_unit(stream, kSignature.size());
    Bytes unit;
    append_unit(unit, UnitType::kFrame, frame_payload);
    stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(sequence.offset + sequence.bytes),
                  unit.begin(), unit.end());
    cases.push_back({id, purpose, {"7.13"}, edited_frame(stream, nothing)});
  };
  p.base_levels = 2;
  add_still("frames-base", "a frame with a base", p);
  p.base_levels = 0;
  p.quality_layers = 2;
  add_still("frames-layers", "a frame of two quality layers", p);
  p.quality_layers = 1;
  p.coefficients = CoefficientCoder::kIndependent;
  add_still("frames-independent", "a frame of the independent coder", p);
  return cases;
}

std::vector<RefusedCase> refused_frames() {
  std::vector<RefusedCase> cases;
  Refused refused(cases);
  refused.add_order();
  refused.add_units();
  refused.add_motion();
  refused.add_references();
  for (RefusedCase& behind : refused_behind_empty()) cases.push_back(std::move(behind));
  cases.push_back(refused_frame_rate());
  for (RefusedCase& move : refused_moves()) cases.push_back(std::move(move));
  return cases;
}

}  // namespace slf::conformance
