// SPDX-License-Identifier: Apache-2.0
// Streams and fields of the C interface that release themselves.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "slf/slf.h"

namespace slf::test {

using Bytes = std::vector<std::uint8_t>;

inline Bytes stream_of(const std::string& id, const std::string& part = "streams") {
  std::ifstream in(std::string(SLF_CONFORMANCE) + "/" + part + "/" + id + "/stream.slf",
                   std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Releases at the end of a test.
struct Stream {
  explicit Stream(const Bytes& bytes) : held(bytes) {
    EXPECT_EQ(slf_open(held.data(), held.size(), nullptr, &handle, &error), SLF_OK)
        << error.message;
  }
  /// Through a reader.
  Stream(const Bytes& bytes, std::vector<slf_range>& reads) : held(bytes), log(&reads) {
    slf_reader reader{sizeof(slf_reader), 0, held.size(), this, read_at};
    EXPECT_EQ(slf_open_reader(&reader, nullptr, &handle, &error), SLF_OK) << error.message;
  }
  ~Stream() { slf_release_stream(handle); }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  static int read_at(void* user, std::uint64_t offset, void* to, std::size_t bytes) {
    auto& self = *static_cast<Stream*>(user);
    if (self.fails || offset > self.held.size() || bytes > self.held.size() - offset) return 1;
    std::memcpy(to, self.held.data() + offset, bytes);
    self.log->push_back({offset, bytes});
    return 0;
  }

  Bytes held;
  std::vector<slf_range>* log = nullptr;
  bool fails = false;
  slf_error error = SLF_ERROR_INIT;
  slf_stream* handle = nullptr;
};

struct Field {
  Field(const slf_stream* stream, const slf_options* options) {
    code = slf_decode(stream, options, &handle, &error);
    if (code == SLF_OK) {
      EXPECT_EQ(slf_get_shape(handle, &shape, nullptr), SLF_OK);
    }
  }
  ~Field() { slf_release_field(handle); }
  Field(const Field&) = delete;
  Field& operator=(const Field&) = delete;

  std::vector<std::int32_t> components() const {
    std::vector<std::int32_t> out(shape.points * shape.components * 3);
    EXPECT_EQ(slf_read_components(handle, 0, shape.points, out.data(), 0, nullptr), SLF_OK);
    return out;
  }
  std::vector<std::uint32_t> positions() const {
    std::vector<std::uint32_t> out(shape.points * 3);
    EXPECT_EQ(slf_read_positions(handle, 0, shape.points, out.data(), 0, nullptr), SLF_OK);
    return out;
  }

  slf_error error = SLF_ERROR_INIT;
  slf_field* handle = nullptr;
  slf_shape shape{sizeof(slf_shape), 0, 0, 0, 0, {}, 0, 0, 0, 0, 0, 0, 0, 0};
  slf_code code;
};

inline std::string name_of(const testing::TestParamInfo<const char*>& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace slf::test
