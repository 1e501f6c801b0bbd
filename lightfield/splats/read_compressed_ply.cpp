// SPDX-License-Identifier: Apache-2.0
// SuperSplat's compressed PLY: chunks of 256 splats with their bounds, four words a splat, and
// bytes for the harmonics beyond degree 0.
#include <array>
#include <cmath>

#include "lightfield/splats/gaussian_readers.h"
#include "lightfield/splats/ply_rows.h"

namespace slf {
namespace {

constexpr std::size_t kChunk = 256;       // splats
constexpr float kHarmonicRange = 8;       // of a byte
constexpr std::size_t kColourBounds = 6;  // where they begin in a chunk: after places and sizes

/// Low and high of x, y, z; of the logarithms of deviations; of colours.
using ChunkBounds = std::array<std::array<float, 3>, 2 * 3>;

constexpr std::array<const char*, 18> kBoundNames{
    "min_x",       "min_y",       "min_z",       "max_x",       "max_y",       "max_z",
    "min_scale_x", "min_scale_y", "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z",
    "min_r",       "min_g",       "min_b",       "max_r",       "max_g",       "max_b"};
constexpr std::array<const char*, 4> kWordNames{"packed_position", "packed_rotation",
                                                "packed_scale", "packed_color"};

/// Columns by these names; fewer where one is missing.
std::vector<std::size_t> columns_named(const PlyElement& element,
                                       std::span<const char* const> names) {
  std::vector<std::size_t> columns;
  for (const char* name : names) {
    const auto column = column_of(element, {name});
    if (!column) break;
    columns.push_back(*column);
  }
  return columns;
}

/// `count` bits of a word from `shift` on, as 0 .. 1.
float fraction(std::uint32_t word, int shift, int count) {
  const std::uint32_t most = (1u << count) - 1;
  return static_cast<float>(word >> shift & most) / static_cast<float>(most);
}

float between(float low, float high, float t) { return low * (1 - t) + high * t; }

/// 11, 10 and 11 bits between two corners.
std::array<float, 3> unpacked(std::uint32_t word, const std::array<float, 3>& low,
                              const std::array<float, 3>& high) {
  return {between(low[0], high[0], fraction(word, 21, 11)),
          between(low[1], high[1], fraction(word, 11, 10)),
          between(low[2], high[2], fraction(word, 0, 11))};
}

/// Which component is the largest in two bits, the others of -sqrt(1/2) .. sqrt(1/2) in ten each.
std::array<float, 4> unpacked_rotation(std::uint32_t word) {
  std::array<float, 4> q{};
  const std::size_t largest = word >> 30;
  float square = 0;
  for (std::size_t k = 0, shift = 20; k < 4; ++k) {
    if (k == largest) continue;
    q[k] = (fraction(word, static_cast<int>(shift), 10) - 0.5f) * std::sqrt(2.0f);
    square += q[k] * q[k];
    shift -= 10;
  }
  q[largest] = std::sqrt(std::max(0.0f, 1 - square));
  return q;
}

/// The bounds of all chunks. Colours without bounds are 0 .. 1.
Result<std::vector<ChunkBounds>, InputError> read_bounds(const PlyRows& rows,
                                                         const PlyElement& element) {
  const auto columns = columns_named(element, kBoundNames);
  std::vector<ChunkBounds> chunks;
  chunks.reserve(static_cast<std::size_t>(element.count));
  SLF_CHECK(rows.for_each(element, [&](std::span<const double> row) {
    ChunkBounds bounds{};
    bounds[5] = {1, 1, 1};
    const std::size_t known = columns.size() == kBoundNames.size() ? columns.size() : 12;
    for (std::size_t i = 0; i < known; ++i)
      bounds[i / 3][i % 3] = static_cast<float>(row[columns[i]]);
    chunks.push_back(bounds);
  }));
  return chunks;
}

/// Bytes of the harmonics, [splats][channels][functions], which stand behind the splats.
Result<std::vector<std::uint8_t>, InputError> read_rest(const PlyRows& rows,
                                                        const PlyElement* element) {
  std::vector<std::uint8_t> bytes;
  if (element == nullptr) return bytes;
  bytes.reserve(static_cast<std::size_t>(element->count) * element->properties.size());
  SLF_CHECK(rows.for_each(*element, [&](std::span<const double> row) {
    for (const double value : row)
      bytes.push_back(static_cast<std::uint8_t>(value >= 0 && value <= 255 ? value : 128));
  }));
  return bytes;
}

/// A byte about 0; its ends are those of the range.
float harmonic_of_byte(std::uint8_t byte) {
  const float t = byte == 0 ? 0 : byte == 255 ? 1 : (static_cast<float>(byte) + 0.5f) / 256;
  return (t - 0.5f) * kHarmonicRange;
}

/// A splat but for its harmonics beyond degree 0.
RawGaussian unpacked_splat(const std::array<std::uint32_t, 4>& words, const ChunkBounds& bounds,
                           std::vector<float>& harmonics) {
  RawGaussian raw;
  raw.position = unpacked(words[0], bounds[0], bounds[1]);
  raw.rotation = unpacked_rotation(words[1]);
  raw.log_deviations = unpacked(words[2], bounds[2], bounds[3]);
  for (std::size_t c = 0; c < 3; ++c)
    harmonics[c] = harmonic_of_colour(
        between(bounds[4][c], bounds[5][c], fraction(words[3], 24 - 8 * static_cast<int>(c), 8)));
  raw.logit = logit_of_byte(static_cast<std::uint8_t>(words[3]));
  return raw;
}

const PlyElement* element_of(const PlyHeader& header, const char* name) {
  for (const PlyElement& element : header.elements)
    if (element.name == name && !element.has_lists()) return &element;
  return nullptr;
}

}  // namespace

bool is_compressed_ply(FileBytes head, std::uint64_t size) {
  if (head.size() < 4 || head[0] != 'p' || head[1] != 'l' || head[2] != 'y') return false;
  const auto header = parse_ply_header("", head, size);
  if (!header) return false;
  const PlyElement* chunk = element_of(*header, "chunk");
  const PlyElement* vertex = element_of(*header, "vertex");
  return chunk != nullptr && vertex != nullptr &&
         columns_named(*chunk, kBoundNames).size() >= 2 * kColourBounds &&
         columns_named(*vertex, kWordNames).size() == kWordNames.size();
}

Result<GaussianFile, InputError> read_compressed_ply(const std::string& name, FileBytes bytes) {
  SLF_TRY(const PlyRows rows, PlyRows::open(name, bytes));
  const auto invalid = [&](const std::string& cause) {
    return InputError{Errc::kInvalidInput, name + ": " + cause};
  };
  const PlyElement *chunk = rows.element("chunk"), *vertex = rows.element("vertex");
  const PlyElement* sh = rows.element("sh");
  if (!is_compressed_ply(bytes, bytes.size()) || chunk == nullptr || vertex == nullptr)
    return invalid("PLY without the elements of compressed splats: 'chunk' and 'vertex'");
  if (chunk->count < (vertex->count + kChunk - 1) / kChunk)
    return invalid("PLY element 'chunk' has too few rows for its splats");
  if (sh != nullptr && sh->count != vertex->count)
    return invalid("PLY element 'sh' has another number of rows than 'vertex'");
  const std::size_t rest = sh == nullptr ? 0 : sh->properties.size();
  const int degree = rest % 3 == 0 ? degree_of_rest(rest / 3) : -1;
  if (degree < 0)
    return invalid("PLY element 'sh' has " + std::to_string(rest) +
                   " properties: 9, 24, 45 or 72 are expected");
  SLF_TRY(const auto bounds, read_bounds(rows, *chunk));
  SLF_TRY(const auto harmonic_bytes, read_rest(rows, sh));
  const auto columns = columns_named(*vertex, kWordNames);
  GaussianCollector collector(degree, UpAxis::kMinusY, static_cast<std::size_t>(vertex->count));
  std::vector<float> harmonics(rest + 3);
  std::size_t p = 0;
  SLF_CHECK(rows.for_each(*vertex, [&](std::span<const double> row) {
    std::array<std::uint32_t, 4> words{};
    for (std::size_t i = 0; i < 4; ++i)
      words[i] = static_cast<std::uint32_t>(
          static_cast<std::int64_t>(std::clamp(row[columns[i]], 0.0, 4294967295.0)));  // 0 of NaN
    const RawGaussian raw = unpacked_splat(words, bounds[p / kChunk], harmonics);
    for (std::size_t i = 0; i < rest; ++i)  // channel by channel
      harmonics[3 * (i % (rest / 3) + 1) + i / (rest / 3)] =
          harmonic_of_byte(harmonic_bytes[p * rest + i]);
    collector.add(raw, harmonics);
    ++p;
  }));
  return std::move(collector).take(name, "compressed PLY");
}

}  // namespace slf
