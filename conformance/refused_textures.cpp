// SPDX-License-Identifier: Apache-2.0
// What is wrong with textures and with the HEVC streams in them.
#include <algorithm>
#include <functional>

#include "attributes/texture/texture_header.h"
#include "bitstream/bit_writer.h"
#include "bitstream/parameter_sets.h"
#include "codec/scene_units.h"
#include "conformance/cases.h"
#include "conformance/edit_units.h"
#include "conformance/fields.h"
#include "conformance/hevc_edit.h"

namespace slf::conformance {
namespace {

/// A texture of two groups; empty where this build has no x265.
Bytes texture_stream(int bits) {
  CodingParameters parameters;
  parameters.coefficients = CoefficientCoder::kTexture;
  parameters.step = {{8, 8, 8}, {8, 8, 8}};
  parameters.group = {0, 1};
  parameters.texture.bits = 8;
  parameters.texture.qp = 38;
  parameters.index = false;
  auto stream = pack(field(sphere(bits), bits, 2, 600), parameters);
  return stream ? *std::move(stream) : Bytes{};
}

/// The first unit with pictures: other flags and offsets, and bytes behind them.
/// pictures: empty: those that are there
void edit_textures(UnitList& units,
                   const std::function<void(std::vector<TexturePlane>&, Bytes&)>& edit) {
  const auto set = *parse_sequence_parameter_set(units[0].payload);
  EditableUnit& unit = first_of(units, UnitType::kCoefficients);
  PartUnit part = *read_part_unit({unit.type, unit.payload, 0, 0}, set);
  BitReader in(part.payload);
  ParseSyntax parse{in};
  std::vector<TexturePlane> planes(3);  // of one function
  texture_header(parse, planes);
  const auto rest = in.align_and_rest("");
  Bytes pictures(rest.begin(), rest.end());
  edit(planes, pictures);
  BitWriter out;
  WriteSyntax write{out};
  slice_unit_header(write, part.header, unit.type, set);
  out.align();
  texture_header(write, planes);
  out.append(pictures);
  unit.payload = out.take();
}

void add_texture_headers(std::vector<RefusedCase>& cases, const Bytes& base) {
  const auto add = [&](const char* id, const char* purpose, const char* clause,
                       const UnitEdit& edit) {
    cases.push_back({id, purpose, {clause}, edited(base, edit)});
  };
  add("texture-damaged", "a byte of a picture changed", "7.9", [](auto& units) {
    auto& payload = first_of(units, UnitType::kCoefficients).payload;
    payload[payload.size() - 20] ^= 0x5A;
  });
  add("texture-level-range", "a second level range", "7.6", [](auto& units) {
    first_of(units, UnitType::kCoefficients).payload[0] ^= 0xB8;  // ue 0, 0, 0 to ue 1, 0, 0
  });
  add("texture-picture-count", "a flag that is 0 where there is a picture", "7.6",
      [](auto& units) { first_of(units, UnitType::kCoefficients).payload[1] ^= 0x80; });
  add("texture-pictures-shorter", "pictures without their last bytes", "7.6", [](auto& units) {
    auto& payload = first_of(units, UnitType::kCoefficients).payload;
    payload.resize(payload.size() * 3 / 4);
  });
  add("texture-profile", "pictures in the main profile", "7.2", [](auto& units) {
    units[0].payload[0] = static_cast<std::uint8_t>(units[0].payload[0] & 0x0F);
  });
  const Bytes larger = texture_stream(6);
  add("texture-picture-size", "pictures of a larger atlas", "7.6", [&](auto& units) {
    if (larger.empty()) return;
    const slf::Units split = *split_units(larger);
    for (const Unit& unit : split.units)
      if (unit.type == UnitType::kCoefficients) {
        first_of(units, UnitType::kCoefficients)
            .payload.assign(unit.payload.begin(), unit.payload.end());
        return;
      }
  });
  add("texture-bits", "samples of 14 bits", "7.2",
      [](auto& units) { edit_sequence(units, [](auto& set) { set.sps_texture_bits = 3; }); });
  add("texture-ranges", "two level ranges", "7.2", [](auto& units) {
    edit_sequence(units, [](auto& set) {
      set.sps_num_coefficient_ranges_minus1 = 1, set.sps_coefficient_range_end = {2};
    });
  });
  add("texture-offset", "an offset of 2^30", "7.6", [](auto& units) {
    edit_textures(units, [](auto& planes, Bytes& pictures) {
      for (TexturePlane& plane : planes) plane = {0, kTextureLimit};
      pictures.clear();
    });
  });
  add("texture-offset-most", "an offset to which a sample adds to 2^30", "7.6", [](auto& units) {
    edit_textures(units,
                  [](auto& planes, Bytes&) { planes[0].tx_offset = kTextureLimit - 255 * 8; });
  });
  add("texture-pictures-of-none", "pictures where no flag is 1", "7.6", [](auto& units) {
    edit_textures(units, [](auto& planes, Bytes&) {
      for (TexturePlane& plane : planes) plane.tx_picture_flag = 0;
    });
  });
}

/// What NAL units and their headers say; but for the last no picture is decoded to see it.
void add_hevc(std::vector<RefusedCase>& cases, const Bytes& base) {
  using Nals = std::vector<Bytes>;
  const auto add = [&](const char* id, const char* purpose,
                       const std::function<void(Nals&)>& edit) {
    cases.push_back({id, purpose, {"7.6"}, edited(base, [&](UnitList& units) {
                       edit_textures(units, [&](auto&, Bytes& pictures) {
                         Nals nals = nal_units(pictures);
                         edit(nals);
                         pictures = byte_stream(nals);
                       });
                     })});
  };
  add("hevc-layer", "a NAL unit of layer 1", [](Nals& nals) { nals.back()[1] |= 1 << 3; });
  add("hevc-type", "a NAL unit of type 41", [](Nals& nals) {
    nals.insert(nals.end() - 1, {41 << 1, 1, 0x80});
  });
  add("hevc-parameter-sets", "more picture parameter sets than pictures", [](Nals& nals) {
    const Bytes set = *std::find_if(nals.begin(), nals.end(), [](const Bytes& unit) {
      return nal_type(unit) == kPictureParameterSet;
    });
    nals.insert(nals.end() - 1, 3, set);
  });
  const auto add_sps = [&](const char* id, const char* purpose, const SpsEdit& edit) {
    add(id, purpose, [&](Nals& nals) {
      for (Bytes& unit : nals)
        if (nal_type(unit) == kSequenceParameterSet) unit = with_sps(unit, edit);
    });
  };
  const auto add_element = [&](const char* id, const char* purpose, std::string_view element,
                               std::uint32_t value) {
    add_sps(id, purpose,
            [=](std::string_view name, std::uint32_t v) { return name == element ? value : v; });
  };
  add_element("hevc-chroma", "pictures in colour", "chroma_format_idc", 1);
  add_element("hevc-depth", "samples of 10 bits in place of 8", "bit_depth_luma_minus8", 2);
  add_element("hevc-scaling-lists", "scaling lists", "scaling_list_enabled_flag", 1);
  add_element("hevc-pcm", "blocks of samples that are not coded", "pcm_enabled_flag", 1);
  add_sps("hevc-window", "a window of less than the picture",
          [](std::string_view name, std::uint32_t v) {
            return name == "conformance_window_flag" || name == "conf_win_right_offset" ? 1 : v;
          });
  add_sps("hevc-size", "a coded size of 64 samples more than its window",
          [](std::string_view name, std::uint32_t v) {
            if (name == "conformance_window_flag") return 1u;
            if (name == "pic_width_in_luma_samples") return v + 64;
            return name == "conf_win_right_offset" ? 64u : v;
          });
  add("hevc-output", "a picture that is not for output", [](Nals& nals) {
    nals.back()[0] = 9 << 1;  // RASL_R, behind a picture that the stream begins with
  });
}

}  // namespace

/// x265 3.5 decides the bytes of what they are made from.
std::vector<RefusedCase> refused_textures() {
  std::vector<RefusedCase> cases;
  const Bytes base = texture_stream(4);
  add_texture_headers(cases, base);
  add_hevc(cases, base);
  return cases;
}

}  // namespace slf::conformance
