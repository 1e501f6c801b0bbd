// SPDX-License-Identifier: Apache-2.0
#include "codec/frame_header.h"

#include <utility>

#include "bitstream/checked_syntax.h"
#include "codec/frame_vectors.h"

namespace slf {

Result<FrameHeader> parse_frame_header(std::span<const std::uint8_t> payload,
                                       std::span<const std::uint8_t>& vectors) {
  BitReader in(payload);
  ParseSyntax parse{in};
  FrameHeader header;
  frame_unit(parse, header);
  vectors = in.align_and_rest("alignment_zero_bits");
  if (in.ok() && header.frame_lattice_flag == 0 && !vectors.empty())
    in.fail(Errc::kOutOfRange, "frame_vectors");
  if (!in.ok()) return in.error();
  if (header.has_lattice())
    for (auto& size : header.motion.lattice_size) ++size;
  return header;
}

Result<std::vector<std::uint8_t>, InputError> frame_payload(FrameHeader header,
                                                            std::span<const std::uint8_t> vectors) {
  if (header.has_lattice())
    for (auto& size : header.motion.lattice_size) --size;
  SLF_TRY(auto payload, checked_header([&](auto& v) { frame_unit(v, std::as_const(header)); }));
  payload.insert(payload.end(), vectors.begin(), vectors.end());
  return payload;
}

Result<std::vector<std::uint8_t>, InputError> write_frame_header(FrameHeader& header,
                                                                 const ReferenceCells* reference,
                                                                 int bits) {
  header.frame_lattice_flag = header.has_lattice() || header.moves_points ? 1 : 0;
  header.frame_motion_flag = header.motion.is_zero() && !header.moves_points ? 0 : 1;
  std::vector<std::uint8_t> vectors;
  if (header.frame_lattice_flag != 0) vectors = write_vectors(*reference, bits, header);
  return frame_payload(header, vectors);
}

}  // namespace slf
