// SPDX-License-Identifier: Apache-2.0
// Splats made by hand, and bytes of files made of them.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "slf/gaussian_files.h"

namespace slf::test {

/// Around the origin, of any turn, all of them sane.
inline Gaussians random_gaussians(std::size_t count, int degree, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-1, 1);
  Gaussians out;
  out.degree = degree;
  out.up = UpAxis::kMinusY;
  for (std::size_t p = 0; p < count; ++p) {
    out.positions.push_back({uniform(random), uniform(random), uniform(random)});
    out.log_deviations.push_back(
        {-3 + uniform(random), -3 + uniform(random), -4 + uniform(random)});
    std::array<float, 4> q{uniform(random), uniform(random), uniform(random), uniform(random)};
    const float length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (float& x : q) x /= length;
    out.rotations.push_back(q);
    out.logits.push_back(4 * uniform(random));
    for (std::size_t k = 0; k < out.num_harmonics(); ++k)
      for (std::size_t c = 0; c < 3; ++c)
        out.harmonics.push_back((k == 0 ? 1.5f : 0.4f) * uniform(random));
  }
  return out;
}

/// Little endian values, one after the other.
class FileOfBytes {
 public:
  FileOfBytes& text(const std::string& t) {
    bytes.insert(bytes.end(), t.begin(), t.end());
    return *this;
  }
  FileOfBytes& integer(std::uint64_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    return *this;
  }
  FileOfBytes& number(float value) { return integer(std::bit_cast<std::uint32_t>(value), 4); }
  FileOfBytes& up_to(std::size_t size) {
    bytes.resize(size);
    return *this;
  }

  std::vector<std::uint8_t> bytes;
};

/// A .splat of a few records.
inline std::vector<std::uint8_t> splat_bytes(std::size_t count) {
  FileOfBytes file;
  for (std::size_t p = 0; p < count; ++p) {
    for (const float x : {0.5f * float(p), -2.0f, 3.0f, 0.1f, 0.2f, 0.05f}) file.number(x);
    for (const int byte : {255, 0, 51, 204, 128, 128, 0, 128}) file.integer(std::uint64_t(byte), 1);
  }
  return file.bytes;
}

/// A .ksplat of two splats in two buckets, one of which is partly full.
/// @param level  0 or 1
inline std::vector<std::uint8_t> ksplat_bytes(int level) {
  const int size = level == 0 ? 4 : 2;
  const auto value = [&](FileOfBytes& file, float x, std::uint16_t half) {
    level == 0 ? file.number(x) : file.integer(half, 2);
  };
  FileOfBytes file;
  file.integer(0, 1).integer(1, 1).integer(0, 2).integer(1, 4).integer(1, 4).integer(2, 4);
  file.integer(2, 4).integer(std::uint64_t(level), 2).up_to(4096);
  file.integer(2, 4).integer(2, 4).integer(1, 4).integer(2, 4).number(2).integer(12, 2);
  file.integer(0, 2).integer(0, 4).integer(0, 4);                     // range: the usual one
  file.integer(1, 4).integer(1, 4).integer(1, 2).up_to(4096 + 1024);  // one full, one partly
  file.integer(1, 4);                                                 // its splats
  for (const float x : {10.0f, 20.0f, 30.0f, -10.0f, -20.0f, -30.0f}) file.number(x);
  for (int p = 0; p < 2; ++p) {
    for (int k = 0; k < 3; ++k)
      if (level == 0)
        file.number(float(p * 3 + k));
      else
        file.integer(std::uint64_t(32767 + (k == 0 ? 32767 : 0)),
                     2);  // a block's half to the right
    for (int k = 0; k < 3; ++k) value(file, 0.5f, 0x3800);
    value(file, 0, 0);
    for (int k = 0; k < 3; ++k) value(file, k == 1 ? 1.0f : 0.0f, k == 1 ? 0x3c00 : 0);
    file.integer(0xff0000ff, 4);  // red, opaque
    for (int i = 0; i < 9; ++i)
      size == 4 ? file.number(float(i)) : file.integer(i == 4 ? 0x4000 : 0, 2);
  }
  return file.bytes;
}

/// SuperSplat's PLY of two splats with harmonics of degree 1.
inline std::vector<std::uint8_t> compressed_ply_bytes() {
  std::string head = "ply\nformat binary_little_endian 1.0\nelement chunk 1\n";
  for (const char* kind : {"", "scale_"})
    for (const char* end : {"min_", "max_"})
      for (const char* axis : {"x", "y", "z"})
        head += "property float " + std::string(end) + kind + axis + "\n";
  head += "element vertex 2\n";
  for (const char* name : {"position", "rotation", "scale", "color"})
    head += std::string("property uint packed_") + name + "\n";
  head += "element sh 2\n";
  for (int i = 0; i < 9; ++i) head += "property uchar f_rest_" + std::to_string(i) + "\n";
  FileOfBytes file;
  file.text(head + "end_header\n");
  for (const float x : {-1.f, -2.f, -3.f, 1.f, 2.f, 3.f, -6.f, -6.f, -6.f, -2.f, -2.f, -2.f})
    file.number(x);
  for (const std::uint32_t position : {0u, 0xffffffffu})
    for (const std::uint32_t word : {position, 0x20080200u, 0xffffffffu, 0xff0000ffu})
      file.integer(word, 4);
  for (int i = 0; i < 18; ++i) file.integer(i % 9 == 3 ? 255 : 0, 1);
  return file.bytes;
}

/// A PLY of floats as text, but for its rows.
inline std::string ascii_header(int count, const std::vector<std::string>& names) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) + "\n";
  for (const auto& name : names) text += "property float " + name + "\n";
  return text + "end_header\n";
}

inline std::vector<std::uint8_t> bytes_of(const std::string& text) {
  return {text.begin(), text.end()};
}

inline const std::vector<std::string> kSplatNames{
    "x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
    "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

}  // namespace slf::test
