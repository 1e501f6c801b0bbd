// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/stored_zip.h"

#include "bitstream/crc32.h"

namespace slf {
namespace {

constexpr std::uint64_t kZipRoom = std::uint64_t{1} << 32;
constexpr std::uint64_t kZipHeaders = 30 + 46, kZipEnd = 22;  // bytes beside names, for each file
constexpr std::uint32_t kZipVersion = 20;                     // 2.0
constexpr std::uint32_t kZipDate = 1 << 5 | 1;                // day 1 of month 1, from 1980 on

void put_bytes(std::vector<std::uint8_t>& out, std::uint64_t value, int count) {
  for (int i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

/// From the version to the length of extra fields, which both headers of a file have.
void put_about(std::vector<std::uint8_t>& out, const NamedBytes& file) {
  put_bytes(out, kZipVersion, 2);
  put_bytes(out, 0, 2 + 2 + 2);  // flags, no packing, time
  put_bytes(out, kZipDate, 2);
  put_bytes(out, crc32(file.bytes), 4);
  put_bytes(out, file.bytes.size(), 4);
  put_bytes(out, file.bytes.size(), 4);
  put_bytes(out, file.name.size(), 2);
  put_bytes(out, 0, 2);
}

}  // namespace

Result<std::vector<std::uint8_t>, InputError> stored_zip(const std::vector<NamedBytes>& files) {
  std::uint64_t whole = kZipEnd;
  for (const auto& file : files) whole += file.bytes.size() + 2 * file.name.size() + kZipHeaders;
  if (whole >= kZipRoom)
    return InputError{Errc::kInvalidInput, "a zip holds less than 4 GiB, and its files take " +
                                               std::to_string(whole) + " bytes"};
  std::vector<std::uint8_t> out, directory;
  out.reserve(static_cast<std::size_t>(whole));
  for (const auto& file : files) {
    const std::size_t at = out.size();
    put_bytes(out, 0x04034b50, 4);  // "PK", 3, 4
    put_about(out, file);
    out.insert(out.end(), file.name.begin(), file.name.end());
    out.insert(out.end(), file.bytes.begin(), file.bytes.end());
    put_bytes(directory, 0x02014b50, 4);
    put_bytes(directory, kZipVersion, 2);
    put_about(directory, file);
    put_bytes(directory, 0, 2 + 2 + 2);  // comment, disk, attributes inside
    put_bytes(directory, 0, 4);          // and outside
    put_bytes(directory, at, 4);
    directory.insert(directory.end(), file.name.begin(), file.name.end());
  }
  const std::size_t at = out.size();
  out.insert(out.end(), directory.begin(), directory.end());
  put_bytes(out, 0x06054b50, 4);
  put_bytes(out, 0, 2 + 2);  // disks
  put_bytes(out, files.size(), 2);
  put_bytes(out, files.size(), 2);
  put_bytes(out, directory.size(), 4);
  put_bytes(out, at, 4);
  put_bytes(out, 0, 2);  // comment
  return out;
}

}  // namespace slf
