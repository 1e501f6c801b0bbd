// SPDX-License-Identifier: Apache-2.0
// What conformance/run.py asks of a decoder, with nothing but the decoder's library and a compiler:
// machines.sh builds it for other processors, where the program slf has no libraries to link.
//
//   suite_decoder decode FILE --dump DIRECTORY [--levels N] [--groups N] [--layers N] [--frame N]
//                        [--region=X0,Y0,Z0,X1,Y1,Z1] [--planes]
//   suite_decoder info FILE
//   suite_decoder radiance FILE POINT X Y Z
//
// Files are written in little endian whatever the machine is, as .npy of version 1.
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "slf/decoder.h"
#include "slf/frames.h"
#include "slf/given_planes.h"
#include "slf/view_map.h"

namespace {

using slf::LightField;
using slf::LightFieldHeader;

constexpr int kUsage = 2, kRefused = 4, kUnwritable = 3;

struct Asked {
  std::string dump;
  slf::DecodeOptions options;
  std::size_t frame = 0;
  bool planes = false;
};

std::vector<std::uint8_t> read_file(const char* name) {
  std::ifstream file(name, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return {bytes.begin(), bytes.end()};
}

bool write_file(const std::string& name, const std::string& bytes) {
  std::ofstream file(name, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return static_cast<bool>(file.flush());
}

/// Version 1 of .npy: 10 bytes, then a dictionary of 118, so that the values begin at byte 128.
template <class T>
std::string npy_of(std::span<const T> values, const std::string& descr, const std::string& shape) {
  std::string dictionary =
      "{'descr': '" + descr + "', 'fortran_order': False, 'shape': (" + shape + "), }";
  dictionary.resize(117, ' ');
  std::string bytes("\x93NUMPY\x01\x00\x76\x00", 10);
  bytes += dictionary + '\n';
  for (const T value : values)
    for (unsigned i = 0; i < sizeof(T); ++i)
      bytes += static_cast<char>(static_cast<std::uint32_t>(value) >> (8 * i) & 255u);
  return bytes;
}

std::string number(double value) {
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof(text), value);
  return error == std::errc() ? std::string(text, end) : "null";
}

template <class List, class Print>
std::string list_of(const List& values, Print print) {
  std::string text;
  for (const auto& value : values) text += (text.empty() ? "" : ", ") + print(value);
  return "[" + text + "]";
}

std::string flag(bool value) { return value ? "true" : "false"; }

std::string basis_of(const LightFieldHeader& h) {
  const slf::Basis& b = h.basis;
  if (b.id == slf::BasisId::kHarmonics)
    return R"({"id": "harmonics", "degree": )" + std::to_string(b.degree) + "}";
  return R"({"id": "bspline", "order": )" + std::to_string(b.order) + R"(, "scales_theta": )" +
         std::to_string(b.scales_theta) + R"(, "scales_gamma": )" + std::to_string(b.scales_gamma) +
         "}";
}

/// The keys that mean something with a basis alone.
std::string directions_of(const LightFieldHeader& h) {
  const bool reflected = h.directions == slf::Directions::kReflected;
  std::string text = R"(, "basis": )" + basis_of(h);
  text += std::string(R"(, "directions": ")") + (reflected ? "reflected" : "world") + '"';
  if (reflected) text += R"(, "normal_cell": )" + std::to_string(1 << h.normal_cell_log2);
  const bool opponent = h.colour == slf::ColourTransform::kOpponent;
  text += std::string(R"(, "colour": {"transform": ")") + (opponent ? "opponent" : "none") + "\"}";
  const bool linear = h.transfer == slf::Transfer::kLinear;
  text += std::string(R"(, "transfer": ")") + (linear ? "linear" : "display") + '"';
  return text + R"(, "gamma_range": [)" + number(h.gamma_min_q7 / 127.0) + ", " +
         number(h.gamma_max_q7 / 127.0) + "]";
}

/// light_field.json: keys as in the table of README.md.
std::string header_of(const LightField& field) {
  constexpr const char* kAxes[] = {"+x", "-x", "+y", "-y", "+z", "-z", "unknown"};
  const LightFieldHeader& h = field.header;
  const auto integer = [](int value) { return std::to_string(value); };
  std::string text = R"({"points": )" + std::to_string(field.num_points());
  text += R"(, "partial": )" + flag(field.partial);
  text += R"(, "grid": {"origin": )" + list_of(h.grid.origin, number);
  text += R"(, "step": )" + number(h.grid.step) + R"(, "bits": )" + integer(h.grid.bits) + "}";
  text += std::string(R"(, "up": ")") + kAxes[static_cast<int>(h.up)] + '"';
  text += R"(, "right_handed": )" + flag(h.right_handed);
  text += R"(, "metres_per_unit": )" + number(h.metres_per_unit);
  text += R"(, "num_functions": )" + integer(h.num_functions);
  text += R"(, "shift": )" + list_of(h.shift, integer);
  text += R"(, "normal_bits": )" + integer(field.normals.bits);
  if (!h.attributes.empty())
    text += R"(, "attributes": )" + list_of(h.attributes, [&](const slf::Attribute& a) {
              return R"({"id": )" + integer(static_cast<int>(a.id)) + R"(, "functions": )" +
                     integer(a.num_functions) + "}";
            });
  const bool has_basis = h.has_basis && h.num_functions > 0;
  return text + R"(, "has_basis": )" + flag(has_basis) + (has_basis ? directions_of(h) : "") +
         "}\n";
}

bool dump(const LightField& field, const Asked& asked) {
  const std::string points = std::to_string(field.num_points()), directory = asked.dump + "/";
  std::vector<std::int32_t> positions;
  for (const auto& voxel : field.positions)
    positions.insert(positions.end(), voxel.begin(), voxel.end());
  const std::string components =
      points + ", " + std::to_string(field.header.num_components()) + ", 3";
  bool good = write_file(directory + "positions.npy",
                         npy_of<std::int32_t>(positions, "<i4", points + ", 3")) &&
              write_file(directory + "components.npy",
                         npy_of<std::int32_t>(field.components, "<i4", components));
  if (asked.planes)
    good =
        good && write_file(directory + "planes.npy",
                           npy_of<std::int32_t>(
                               slf::given_planes(field), "<i4",
                               points + ", " + std::to_string(field.header.num_functions) + ", 3"));
  std::vector<std::uint16_t> normals;
  for (const auto& pair : field.normals.octahedral)
    normals.insert(normals.end(), pair.begin(), pair.end());
  if (field.normals.bits > 0)
    good = good && write_file(directory + "octahedral.npy",
                              npy_of<std::uint16_t>(normals, "<u2", points + ", 2"));
  return good && write_file(directory + "light_field.json", header_of(field));
}

slf::Result<LightField> decode(std::span<const std::uint8_t> stream, const Asked& asked) {
  SLF_TRY(auto decoder, slf::FrameDecoder::open(stream, asked.options));
  return decoder.decode(asked.frame);
}

int refuse(const char* file, const slf::Error& error) {
  std::fprintf(stderr, "%s: %s\n", file, slf::to_string(error).c_str());
  return kRefused;
}

int run_decode(const char* file, const Asked& asked) {
  const std::vector<std::uint8_t> stream = read_file(file);
  const auto field = decode(stream, asked);
  if (!field) return refuse(file, field.error());
  return dump(*field, asked) ? 0 : kUnwritable;
}

int run_info(const char* file) {
  const std::vector<std::uint8_t> stream = read_file(file);
  const auto info = slf::read_info(stream);
  return info ? 0 : refuse(file, info.error());
}

int run_radiance(const char* file, char** words) {
  const std::vector<std::uint8_t> stream = read_file(file);
  const auto field = decode(stream, {});
  if (!field) return refuse(file, field.error());
  const std::size_t point = std::strtoul(words[0], nullptr, 10);
  if (!field->header.has_basis || point >= field->num_points()) return kUsage;
  const slf::ViewMaps maps(*field);
  const auto [theta, gamma] =
      slf::direction_of({std::atof(words[1]), std::atof(words[2]), std::atof(words[3])});
  for (const float value : maps.radiance(point, theta, gamma))
    std::printf("%.4f ", static_cast<double>(value));
  std::printf("\n");
  return 0;
}

/// "X0,Y0,Z0,X1,Y1,Z1"
bool parse_region(std::string_view text, slf::DecodeOptions& options) {
  slf::VoxelBox box;
  for (std::size_t i = 0; i < 6; ++i) {
    std::int32_t& to = i < 3 ? box.low[i] : box.high[i - 3];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), to);
    if (error != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    if (!text.empty()) text.remove_prefix(1);
  }
  options.region = box;
  return true;
}

bool parse(std::span<char*> words, Asked& asked) {
  constexpr std::string_view kRegion = "--region=";
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = words[i];
    if (word == "--planes") {
      asked.planes = true;
      continue;
    }
    if (word.substr(0, kRegion.size()) == kRegion) {
      if (!parse_region(word.substr(kRegion.size()), asked.options)) return false;
      continue;
    }
    if (++i == words.size()) return false;
    if (word == "--dump")
      asked.dump = words[i];
    else if (word == "--levels")
      asked.options.levels = std::atoi(words[i]);
    else if (word == "--groups")
      asked.options.groups = std::atoi(words[i]);
    else if (word == "--layers")
      asked.options.layers = std::atoi(words[i]);
    else if (word == "--frame")
      asked.frame = std::strtoul(words[i], nullptr, 10);
    else
      return false;
  }
  return !asked.dump.empty();
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view verb = argc > 2 ? argv[1] : "";
  Asked asked;
  const std::span<char*> words(argv, static_cast<std::size_t>(argc));
  if (verb == "info" && argc == 3) return run_info(argv[2]);
  if (verb == "radiance" && argc == 7) return run_radiance(argv[2], argv + 3);
  if (verb == "decode" && parse(words.subspan(3), asked)) return run_decode(argv[2], asked);
  std::fprintf(stderr, "usage: suite_decoder decode|info|radiance FILE ...\n");
  return kUsage;
}
