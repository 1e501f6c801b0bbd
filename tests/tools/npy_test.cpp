// SPDX-License-Identifier: Apache-2.0
#include "tools/npy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace slf::tools::npy_test {
namespace {

/// A file with the given dictionary, written by hand as numpy.lib.format describes it.
std::vector<std::uint8_t> file_of(int version, const std::string& dictionary,
                                  const std::string& elements) {
  std::string file = "\x93NUMPY";
  file += static_cast<char>(version);
  file += '\0';
  file += static_cast<char>(dictionary.size() & 255);
  file += static_cast<char>(dictionary.size() >> 8);
  if (version == 2) file += std::string(2, '\0');
  file += dictionary + elements;
  return {file.begin(), file.end()};
}

std::string dictionary(const std::string& descr, const std::string& shape,
                       const char* order = "False") {
  return "{'descr': '" + descr + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }\n";
}

TEST(Npy, ReadsVersionsOneAndTwo) {
  for (const int version : {1, 2}) {
    const auto array = parse_npy(
        file_of(version, dictionary("<i2", "(2, 1)"), std::string("\x01\x00\xff\xff", 4)));
    ASSERT_TRUE(array) << version;
    EXPECT_THAT(array->shape, testing::ElementsAre(2, 1));
    const auto values = int32_values(*array);
    ASSERT_TRUE(values);
    EXPECT_THAT(*values, testing::ElementsAre(1, -1));
  }
}

TEST(Npy, WidensEveryIntegerTypeAndRefusesWhatDoesNotFit) {
  const std::string max64 = std::string("\x00\x00\x00\x80\x00\x00\x00\x00", 8);  // 2^31
  const auto u1 = parse_npy(file_of(1, dictionary("|u1", "(1,)"), "\xff"));
  ASSERT_TRUE(u1);
  EXPECT_THAT(*int32_values(*u1), testing::ElementsAre(255));
  for (const char* type : {"<i8", "<u8"}) {
    const auto wide = parse_npy(file_of(1, dictionary(type, "(1,)"), max64));
    ASSERT_TRUE(wide);
    EXPECT_FALSE(int32_values(*wide)) << type;
  }
  const auto u4 = parse_npy(file_of(1, dictionary("<u4", "(1,)"), "\xff\xff\xff\xff"));
  ASSERT_TRUE(u4);
  EXPECT_FALSE(int32_values(*u4)) << "4294967295 is not -1";
  const auto real = parse_npy(file_of(1, dictionary("<f4", "(1,)"), "abcd"));
  ASSERT_TRUE(real);
  EXPECT_FALSE(int32_values(*real));
}

TEST(Npy, RefusesWhatItsBytesDoNotBack) {
  const std::string four = "abcd";
  const char* shapes[] = {"(2,)",
                          "(0,)",
                          "(4294967296, 4294967296)",
                          "(18446744073709551615, 2)",
                          "(99999999999999999999,)",
                          "(-1,)",
                          "(1, 1",
                          "(1, 1, 1, 1, 1, 1, 1, 1, 1)"};
  for (const char* shape : shapes)
    EXPECT_FALSE(parse_npy(file_of(1, dictionary("<i4", shape), four))) << shape;
  EXPECT_TRUE(parse_npy(file_of(1, dictionary("<i4", "()"), four)));
  EXPECT_FALSE(parse_npy(file_of(1, dictionary(">i4", "(1,)"), four))) << "big endian";
  EXPECT_FALSE(parse_npy(file_of(1, dictionary("<i4", "(1,)", "True"), four))) << "Fortran order";
  EXPECT_FALSE(parse_npy(file_of(1, dictionary("|O8", "(1,)"), four + four))) << "objects";
  EXPECT_FALSE(parse_npy(file_of(3, dictionary("<i4", "(1,)"), four))) << "version 3";
}

TEST(Npy, EveryTruncationIsRefused) {
  const auto whole = file_of(1, dictionary("<i4", "(2, 3)"), std::string(24, 'x'));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // A fresh exact-size buffer, so that AddressSanitizer sees a read one byte too far.
    std::vector<std::uint8_t> cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(parse_npy(std::move(cut))) << size;
  }
  EXPECT_TRUE(parse_npy(whole));
}

std::vector<std::uint8_t> bytes_of(const NpyFile& file) {
  std::vector<std::uint8_t> bytes(file.head.begin(), file.head.end());
  for (const std::byte b : file.elements) bytes.push_back(std::to_integer<std::uint8_t>(b));
  return bytes;
}

TEST(Npy, WhatIsWrittenReadsBackAndIsAligned) {
  const std::vector<std::int32_t> values{1, -2, 3, 4, 5, -2147483647};
  const auto file = npy_file({2, 3}, std::span<const std::int32_t>(values));
  const auto array = parse_npy(bytes_of(file));
  ASSERT_TRUE(array);
  EXPECT_EQ(array->first % 64, 0u);
  EXPECT_THAT(array->shape, testing::ElementsAre(2, 3));
  EXPECT_THAT(*int32_values(*array), testing::ElementsAreArray(values));
  const auto empty = parse_npy(bytes_of(npy_file({7, 0, 3}, std::span<const std::int32_t>())));
  ASSERT_TRUE(empty);
  EXPECT_THAT(empty->shape, testing::ElementsAre(7, 0, 3));
}

}  // namespace
}  // namespace slf::tools::npy_test
