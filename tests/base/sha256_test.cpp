// SPDX-License-Identifier: Apache-2.0
// Digests against those of the standard.
#include "base/sha256.h"

#include <gtest/gtest.h>

namespace slf::sha256_test {
namespace {

TEST(Sha256, MatchesFips180_4) {
  const auto hex = [](std::string_view text) {
    Sha256 sha;
    for (const char c : text) {  // byte by byte: every block boundary
      const auto byte = static_cast<std::uint8_t>(c);
      sha.update({&byte, 1});
    }
    std::string digits;
    for (const std::uint8_t byte : sha.finish())
      digits += "0123456789abcdef"[byte >> 4], digits += "0123456789abcdef"[byte & 15];
    return digits;
  };
  EXPECT_EQ(hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

}  // namespace
}  // namespace slf::sha256_test
