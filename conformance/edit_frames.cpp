// SPDX-License-Identifier: Apache-2.0
#include "conformance/edit_frames.h"

#include <cstdio>
#include <cstdlib>

#include "bitstream/crc32.h"
#include "codec/encoder/assemble.h"

namespace slf::conformance {
namespace {

bool is_intra(const Bytes& frame) { return frame[0] == kSignature[0]; }

/// The frame unit with its elements changed; the vectors stay.
Bytes changed_header(const Bytes& payload, const std::function<void(FrameHeader&)>& edit) {
  std::span<const std::uint8_t> vectors;
  FrameHeader header = *parse_frame_header(payload, vectors);
  if (header.has_lattice())  // as they are coded
    for (auto& size : header.motion.lattice_size) --size;
  edit(header);
  BitWriter out;
  WriteSyntax write{out};
  frame_unit(write, header);
  Bytes made = out.take();
  made.insert(made.end(), vectors.begin(), vectors.end());
  return made;
}

}  // namespace

FrameWriter::FrameWriter(const CodingParameters& parameters, std::uint32_t level,
                         std::uint32_t features)
    : parameters_(parameters) {
  group_.level = level;
  group_.features = features;
  parameters_.base_levels = 0;
  parameters_.max_slice_points = kMostSlicePoints;
  parameters_.index = false;
}

FrameHeader FrameWriter::next_header() const {
  FrameHeader header;
  header.frame_number = static_cast<std::uint32_t>(frames_.size());
  header.frame_time = 0.25 * static_cast<double>(frames_.size());
  return header;
}

void FrameWriter::add(const LightField& field) {
  FrameHeader header = next_header();
  append(*pack_frame(field, parameters_, &header, &group_));
}

void FrameWriter::add(const LightField& field, const Motion& motion) {
  FrameHeader header = next_header();
  header.frame_predicted_flag = 1;
  header.motion = motion;
  append(*pack_predicted(field, parameters_, group_, chain_.state(), header));
}

void FrameWriter::add_moved(const LightField& field, const Motion& motion,
                            const std::function<PointMove(std::size_t)>& of) {
  FrameHeader header = next_header();
  header.frame_predicted_flag = 1;
  header.motion = motion;
  const FrameState& state = chain_.state();
  append(*pack_predicted(field, parameters_, group_, state, header, [&](auto, auto) {
    std::vector<PointMove> moves(state.cells.codes(state.cells.levels()).size());
    for (std::size_t p = 0; p < moves.size(); ++p) moves[p] = of(p);
    return moves;
  }));
}

void FrameWriter::add_empty(LightField field) {
  field.positions.clear();
  field.components.clear();
  field.normals.octahedral.clear();
  FrameHeader header = next_header();
  append(*pack_empty(field, parameters_, header));
}

void FrameWriter::append(Bytes bytes) {
  const auto field = chain_.decode(bytes, *read_frame(bytes, 0), {});
  if (!field) {
    std::fprintf(stderr, "a frame does not decode: %s\n", to_string(field.error()).c_str());
    std::exit(1);
  }
  frames_.push_back(std::move(bytes));
}

Bytes FrameWriter::stream() const { return joined(frames_); }

Bytes joined(const std::vector<Bytes>& frames) {
  Bytes all;
  for (const Bytes& frame : frames) all.insert(all.end(), frame.begin(), frame.end());
  return all;
}

Bytes of_version(Bytes stream, int major, int minor) {
  const std::size_t begin = kSignature.size();
  const auto bytes = static_cast<std::size_t>(read_unit(stream, begin)->bytes);
  stream[begin + 1] = static_cast<std::uint8_t>(major);
  stream[begin + 2] = static_cast<std::uint8_t>(minor);
  const std::uint32_t crc = crc32(std::span(stream).subspan(begin, bytes - 4));
  for (std::size_t i = 0; i < 4; ++i)
    stream[begin + bytes - 4 + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  return stream;
}

Bytes edited_frame(const Bytes& frame, const UnitEdit& edit,
                   const std::function<void(FrameHeader&)>& header) {
  UnitList units;
  for (std::size_t at = is_intra(frame) ? kSignature.size() : 0; at < frame.size();) {
    const Unit unit = *read_unit(frame, at);
    units.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}});
    at += static_cast<std::size_t>(unit.bytes);
  }
  edit(units);
  const std::size_t own = is_intra(frame) ? 1 : 0;  // the frame unit
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (units[i].type == UnitType::kEnd) units[i].payload = end_payload(i);
    if (i > own) bytes += unit_bytes(units[i].type, units[i].payload.size());
  }
  if (units[own].type == UnitType::kFrame)
    units[own].payload = changed_header(units[own].payload, [&](FrameHeader& h) {
      h.frame_bytes = static_cast<std::uint32_t>(bytes);
      if (header) header(h);
    });
  Bytes made;
  if (is_intra(frame)) made.assign(kSignature.begin(), kSignature.end());
  for (const EditableUnit& unit : units) append_unit(made, unit.type, unit.payload);
  return made;
}

}  // namespace slf::conformance
