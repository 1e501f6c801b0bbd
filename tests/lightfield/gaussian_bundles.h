// SPDX-License-Identifier: Apache-2.0
// Files of splats that are made with zstd and WebP.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bitstream/crc32.h"
#include "bitstream/encoder/deflate.h"
#include "gaussian_support.h"
#if SLF_WITH_ZSTD
#include <zstd.h>
#endif
#if SLF_WITH_WEBP
#include <webp/encode.h>
#endif

namespace slf::test {

#if SLF_WITH_ZSTD
/// SPZ 4 of the same splats as an SPZ 3 of degree 1.
inline std::vector<std::uint8_t> spz4_of(const std::vector<std::uint8_t>& spz3) {
  const auto raw = gunzip(spz3, std::size_t{1} << 24).bytes;
  const std::size_t count = raw[8];
  FileOfBytes list, packed;
  std::size_t from = 16;
  for (const std::size_t bytes : std::initializer_list<std::size_t>{9, 1, 3, 3, 4, 9}) {
    std::vector<std::uint8_t> to(ZSTD_compressBound(bytes * count));
    to.resize(ZSTD_compress(to.data(), to.size(), raw.data() + from, bytes * count, 3));
    list.integer(to.size(), 8).integer(bytes * count, 8);
    packed.bytes.insert(packed.bytes.end(), to.begin(), to.end());
    from += bytes * count;
  }
  FileOfBytes file;
  file.text("NGSP").integer(4, 4).integer(count, 4).integer(raw[12], 1).integer(raw[13], 1);
  file.integer(0, 1).integer(6, 1).integer(40, 4).up_to(40);  // 8 bytes of something later
  file.bytes.insert(file.bytes.end(), list.bytes.begin(), list.bytes.end());
  file.bytes.insert(file.bytes.end(), packed.bytes.begin(), packed.bytes.end());
  return file.bytes;
}
#endif

/// Files that are stored, not packed.
inline std::vector<std::uint8_t> zip_of(
    const std::map<std::string, std::vector<std::uint8_t>>& files) {
  FileOfBytes zip, directory;
  for (const auto& file : files) {
    const std::string& name = file.first;  // clang 14 captures no bindings
    const std::vector<std::uint8_t>& bytes = file.second;
    const std::size_t offset = zip.bytes.size();
    const auto head = [&](FileOfBytes& to) {
      to.integer(20, 2).integer(0, 2).integer(0, 2).integer(0, 4).integer(crc32(bytes), 4);
      to.integer(bytes.size(), 4).integer(bytes.size(), 4).integer(name.size(), 2).integer(0, 2);
    };
    head(zip.text("PK\3\4"));
    zip.text(name).bytes.insert(zip.bytes.end(), bytes.begin(), bytes.end());
    head(directory.text("PK\1\2").integer(20, 2));
    directory.integer(0, 2).integer(0, 2).integer(0, 2).integer(0, 4).integer(offset, 4).text(name);
  }
  const std::size_t at = zip.bytes.size();
  zip.bytes.insert(zip.bytes.end(), directory.bytes.begin(), directory.bytes.end());
  zip.text("PK\5\6").integer(0, 4).integer(files.size(), 2).integer(files.size(), 2);
  zip.integer(directory.bytes.size(), 4).integer(at, 4).integer(0, 2);
  return zip.bytes;
}

#if SLF_WITH_WEBP
inline std::vector<std::uint8_t> webp_of(int width, int height, std::vector<std::uint8_t> pixels) {
  pixels.resize(std::size_t(4 * width * height), 255);
  // Exact: what is transparent keeps its colours.
  WebPConfig config;
  WebPPicture picture;
  WebPMemoryWriter writer;
  WebPConfigInit(&config);
  WebPPictureInit(&picture);
  WebPMemoryWriterInit(&writer);
  config.lossless = config.exact = 1;
  picture.use_argb = 1;
  picture.width = width;
  picture.height = height;
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  WebPPictureImportRGBA(&picture, pixels.data(), 4 * width);
  WebPEncode(&config, &picture);
  std::vector<std::uint8_t> bytes(writer.mem, writer.mem + writer.size);
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  return bytes;
}

/// Two splats of degree 1, a palette of one vector; the second has none of it.
inline std::map<std::string, std::vector<std::uint8_t>> sog_files() {
  const std::string meta = R"({"version": 2, "count": 2,
    "means": {"mins": [-1, 0, 0], "maxs": [1, 2, 0], "files": ["means_l.webp", "means_u.webp"]},
    "scales": {"codebook": [-7, -6, -5], "files": ["scales.webp"]},
    "quats": {"files": ["quats.webp"]},
    "sh0": {"codebook": [0.5, -0.5], "files": ["sh0.webp"]},
    "shN": {"count": 1, "bands": 1, "codebook": [0, 0.25, 0.75],
            "files": ["shN_centroids.webp", "shN_labels.webp"]}})";
  std::map<std::string, std::vector<std::uint8_t>> files;
  files["meta.json"].assign(meta.begin(), meta.end());
  files["means_l.webp"] = webp_of(2, 1, {255, 0, 7, 255, 0, 255, 0, 255});
  files["means_u.webp"] = webp_of(2, 1, {255, 0, 9, 255, 0, 255, 0, 255});
  files["scales.webp"] = webp_of(2, 1, {0, 1, 2, 255, 2, 2, 2, 255});
  files["quats.webp"] = webp_of(2, 1, {255, 0, 0, 253, 0, 0, 0, 251});
  files["sh0.webp"] = webp_of(2, 1, {0, 1, 0, 51, 1, 1, 1, 204});
  files["shN_centroids.webp"] = webp_of(192, 1, {0, 1, 2, 255, 1, 1, 1, 255, 2, 0, 0, 255});
  files["shN_labels.webp"] = webp_of(2, 1, {0, 0, 0, 255, 1, 0, 0, 255});
  return files;
}
#endif

}  // namespace slf::test
