// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/ply_stream.h"

#include <unistd.h>

#include <bit>
#include <cerrno>
#include <cstring>

namespace slf::synth {
namespace {

/// As long for any count: a comment makes up for its digits.
std::string header(std::uint64_t points) {
  const std::string count = std::to_string(points);
  return "ply\nformat binary_little_endian 1.0\ncomment slf synth" +
         std::string(20 - count.size(), '.') + "\nelement vertex " + count +
         "\nproperty float x\nproperty float y\nproperty float z\n"
         "property float nx\nproperty float ny\nproperty float nz\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
}

void put_floats(std::vector<std::uint8_t>& out, const std::array<float, 3>& values) {
  for (const float value : values) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8)
      out.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
}

}  // namespace

PlyStream::PlyStream(std::filesystem::path file)
    : file_(std::move(file)),
      temporary_(file_.string() + ".tmp" + std::to_string(getpid()) + "-0"),
      open_(std::fopen(temporary_.c_str(), "wbx")) {
  if (!open_) failed_ = errno;
  const std::string empty = header(0);
  put(empty.data(), empty.size());
}

PlyStream::~PlyStream() {
  if (!open_) return;
  open_.reset();
  ::unlink(temporary_.c_str());
}

bool PlyStream::put(const void* data, std::size_t size) {
  if (failed_ == 0 && std::fwrite(data, 1, size, open_.get()) != size) failed_ = errno;
  return failed_ == 0;
}

void PlyStream::append(const PointCloud& cloud) {
  std::vector<std::uint8_t> out;
  out.reserve(27 * cloud.positions.size());
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    put_floats(out, cloud.positions[i]);
    put_floats(out, cloud.normals[i]);
    out.insert(out.end(), cloud.colours[i].begin(), cloud.colours[i].end());
  }
  put(out.data(), out.size());
  points_ += cloud.positions.size();
}

Result<Done, InputError> PlyStream::finish() {
  const std::string whole = header(points_);
  if (failed_ == 0 && std::fseek(open_.get(), 0, SEEK_SET) != 0) failed_ = errno;
  put(whole.data(), whole.size());
  if (failed_ == 0 && (std::fflush(open_.get()) != 0 || ::fsync(fileno(open_.get())) != 0))
    failed_ = errno;
  if (failed_ == 0 && ::rename(temporary_.c_str(), file_.c_str()) != 0) failed_ = errno;
  if (failed_ != 0)
    return InputError{Errc::kUnwritable,
                      file_.string() + ": cannot be written: " + std::strerror(failed_)};
  open_.reset();
  return Done{};
}

}  // namespace slf::synth
