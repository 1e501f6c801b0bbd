// SPDX-License-Identifier: Apache-2.0
// File descriptors of POSIX.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string>

namespace slf {

/// Closes itself; standard streams stay open.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  bool ok() const { return fd_ >= 0; }
  /// 0 or errno. Some file systems report a full disk only here.
  int close() {
    const int result = fd_ > STDERR_FILENO ? ::close(fd_) : 0;
    fd_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int fd_;
};

/// /dev/stdout and the like lead to whatever is open there, be it a regular file.
inline bool names_descriptor(const std::filesystem::path& file) {
  const std::string name = file.string();
  return name.starts_with("/dev/std") || name.starts_with("/dev/fd/") || name.starts_with("/proc/");
}

}  // namespace slf
