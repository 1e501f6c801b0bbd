// SPDX-License-Identifier: Apache-2.0
#include "conformance/hevc_edit.h"

#include <cstddef>

#include "bitstream/bit_reader.h"
#include "bitstream/bit_writer.h"

namespace slf::conformance {
namespace {

/// H.265 7.3.1.1: 00 00 03 stands for 00 00.
Bytes without_prevention(const Bytes& unit) {
  Bytes raw;
  for (const std::uint8_t byte : unit) {
    const std::size_t n = raw.size();
    const bool prevents = byte == 3 && n >= 2 && raw[n - 1] == 0 && raw[n - 2] == 0;
    if (!prevents) raw.push_back(byte);
  }
  return raw;
}

Bytes with_prevention(const Bytes& raw) {
  Bytes unit;
  for (const std::uint8_t byte : raw) {
    const std::size_t n = unit.size();
    if (byte <= 3 && n >= 2 && unit[n - 1] == 0 && unit[n - 2] == 0) unit.push_back(3);
    unit.push_back(byte);
  }
  return unit;
}

/// Elements read, changed and written.
struct Copy {
  BitReader in;
  const SpsEdit& edit;
  BitWriter out{};

  void bits(std::uint64_t count) {
    for (; count > 0; --count) out.u(1, in.u(1, ""));
  }
  void ue(std::string_view name) { out.ue(edit(name, static_cast<std::uint32_t>(in.ue("")))); }
  /// @return is it switched on?
  bool flag(std::string_view name) {
    const auto before = static_cast<std::uint32_t>(in.u(1, ""));
    out.u(1, edit(name, before));
    return edit(name, before) > before;
  }
};

/// H.265 7.3.2.2, behind the header of the unit.
Bytes copied(const Bytes& raw, const SpsEdit& edit) {
  Copy copy{BitReader(raw), edit};
  copy.bits(4 + 3 + 1 + 88 + 8);  // ids and profile_tier_level, of one sub-layer
  for (const auto* name : {"sps_seq_parameter_set_id", "chroma_format_idc",
                           "pic_width_in_luma_samples", "pic_height_in_luma_samples"})
    copy.ue(name);
  if (copy.flag("conformance_window_flag"))
    for (const auto* name : {"conf_win_left_offset", "conf_win_right_offset", "conf_win_top_offset",
                             "conf_win_bottom_offset"})
      copy.out.ue(edit(name, 0));
  for (const auto* name :
       {"bit_depth_luma_minus8", "bit_depth_chroma_minus8", "log2_max_pic_order_cnt_lsb_minus4"})
    copy.ue(name);
  copy.bits(1);
  for (int element = 0; element < 3 + 6; ++element) copy.ue("");  // buffers; sizes of blocks
  if (copy.flag("scaling_list_enabled_flag")) copy.out.u(1, 0);   // no list of its own
  copy.bits(2);
  if (copy.flag("pcm_enabled_flag")) {
    copy.out.u(8, 0x77);  // 8 bits a sample
    for (int element = 0; element < 2; ++element) copy.out.ue(0);
    copy.out.u(1, 0);
  }
  copy.bits(copy.in.bits_left());
  return copy.out.take();
}

}  // namespace

std::vector<Bytes> nal_units(const Bytes& stream) {
  std::vector<Bytes> units;
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const auto at = stream.begin() + static_cast<std::ptrdiff_t>(i);
    if (i + 3 <= stream.size() && at[0] == 0 && at[1] == 0 && at[2] == 1) {
      while (!units.empty() && !units.back().empty() && units.back().back() == 0)
        units.back().pop_back();
      units.emplace_back();
      i += 2;
    } else if (!units.empty()) {
      units.back().push_back(*at);
    }
  }
  return units;
}

Bytes byte_stream(const std::vector<Bytes>& units) {
  Bytes stream;
  for (const Bytes& unit : units) {
    for (const int byte : {0, 0, 1}) stream.push_back(static_cast<std::uint8_t>(byte));
    stream.insert(stream.end(), unit.begin(), unit.end());
  }
  return stream;
}

Bytes with_sps(const Bytes& unit, const SpsEdit& edit) {
  constexpr std::ptrdiff_t kHeader = 2;
  const Bytes raw = without_prevention(Bytes(unit.begin() + kHeader, unit.end()));
  Bytes changed(unit.begin(), unit.begin() + kHeader);
  for (const std::uint8_t byte : with_prevention(copied(raw, edit))) changed.push_back(byte);
  return changed;
}

}  // namespace slf::conformance
