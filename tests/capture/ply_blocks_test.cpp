// SPDX-License-Identifier: Apache-2.0
// PLY files that are larger than what is read of them at once.
#include "capture_support.h"

namespace slf::ply_blocks_test {
namespace {

using test::ByteString;
using test::TemporaryDirectory;
using Position = std::array<float, 3>;

Result<PointCloud, InputError> read(const std::string& text) {
  const TemporaryDirectory directory;
  test::write_text(directory / "cloud.ply", text);
  return read_ply(directory / "cloud.ply");
}

// What lies across the end of one is read as anything else.
TEST(PlyReader, ReadsFilesOfManyBlocks) {
  constexpr int kPoints = 150000;
  const std::string count = std::to_string(kPoints);
  const std::string properties =
      "property float x\nproperty list uchar uchar tail\nproperty float y\nproperty float z\n";
  std::string ascii = "ply\nformat ascii 1.0\nelement vertex " + count + "\n" + properties +
                      "element after 1\nproperty int i\nend_header\n";
  ByteString binary;
  binary.text("ply\nformat binary_little_endian 1.0\nelement skipped 300000\nproperty int i\n");
  binary.text("element vertex " + count + "\n" + properties + "end_header\n");
  for (int i = 0; i < 300000; ++i) binary.put(std::int32_t{i}, false);
  for (int i = 0; i < kPoints; ++i) {
    const int half = i / 2;
    ascii += std::to_string(i) + " 2 " + std::to_string(i % 256) + " 7\n-" + std::to_string(half) +
             ".5 1e2" + std::string(static_cast<std::size_t>(i % 7), ' ') + "\n";
    binary.put(static_cast<float>(i), false).put(std::uint8_t{1}).put(std::uint8_t{9});
    binary.put(-0.5f - static_cast<float>(half), false).put(100.0f, false);
  }
  ascii += "5\n";
  for (const std::string& text : {ascii, binary.bytes}) {
    const auto cloud = read(text);
    ASSERT_TRUE(cloud) << cloud.error().message;
    ASSERT_EQ(cloud->positions.size(), std::size_t{kPoints});
    for (int i = 0; i < kPoints; ++i) {
      const int half = i / 2;
      ASSERT_EQ(cloud->positions[static_cast<std::size_t>(i)],
                (Position{static_cast<float>(i), -0.5f - static_cast<float>(half), 100}))
          << i;
    }
    EXPECT_FALSE(read(text.substr(0, text.size() - 12)));
  }
  EXPECT_FALSE(read("ply\ncomment " + std::string(2 << 20, 'c') + ascii.substr(4)));
}

}  // namespace
}  // namespace slf::ply_blocks_test
