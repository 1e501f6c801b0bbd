// SPDX-License-Identifier: Apache-2.0
// Tiny captures in a temporary directory.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf::test {

/// A directory that is gone when the test is.
class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = (std::filesystem::temp_directory_path() / "slf-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) std::abort();
    path_ = name;
  }
  ~TemporaryDirectory() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryDirectory(const TemporaryDirectory&) = delete;
  TemporaryDirectory& operator=(const TemporaryDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::size_t num_entries() const {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      count += !entry.path().empty();
    return count;
  }

 private:
  std::filesystem::path path_;
};

/// Bytes of a file written by hand, little endian unless said.
struct ByteString {
  std::string bytes;

  template <class T>
  ByteString& put(T value, bool big_endian = false) {
    const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);  // x86: little endian
    for (std::size_t i = 0; i < raw.size(); ++i)
      bytes.push_back(raw[big_endian ? raw.size() - 1 - i : i]);
    return *this;
  }
  ByteString& text(const std::string& value) {
    bytes += value;
    return *this;
  }
};

inline void write_text(const std::filesystem::path& file, const std::string& text) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary);  // write_file waits for the disk each time
  out << text;
  ASSERT_TRUE(out.flush()) << file;
}

inline std::string read_text(const std::filesystem::path& file) {
  const auto bytes = read_file(file);
  return bytes ? std::string(bytes->begin(), bytes->end()) : "(unreadable)";
}

/// Replaces the one occurrence of `from`.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

/// Looks along +z from (0, 0, -z).
inline Camera camera_at(double z, double focal) {
  Camera camera;
  camera.width = camera.height = 64;
  camera.fx = camera.fy = focal;
  camera.cx = camera.cy = 32;
  camera.translation = {0, 0, z};
  return camera;
}

/// Where the shared captures are, or nothing.
inline std::filesystem::path shared_data() {
  if (const char* given = std::getenv("SLF_DATA")) return given;
  return std::filesystem::path(__FILE__).parent_path().parent_path().parent_path().parent_path() /
         "shared" / "data";
}

}  // namespace slf::test
