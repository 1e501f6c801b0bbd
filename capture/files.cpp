// SPDX-License-Identifier: Apache-2.0
// Whole files out. They appear complete or not at all. In: input_file.cpp.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <span>
#include <string>

#include "capture/descriptor.h"
#include "slf/capture.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

InputError unwritable(const fs::path& file, int error) {
  return {Errc::kUnwritable, file.string() + ": cannot be written: " + std::strerror(error)};
}

using Pieces = std::span<const std::span<const std::byte>>;

// 0 or errno.
int write_all(int fd, Pieces pieces) {
  for (std::span<const std::byte> piece : pieces)
    while (!piece.empty()) {
      const ssize_t written =
          ::write(fd, piece.data(), std::min(piece.size(), std::size_t{1} << 30));
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return errno;
      piece = piece.subspan(static_cast<std::size_t>(written));
    }
  return 0;
}

// Symbolic links are written through, not replaced, also where they lead to nothing yet.
fs::path target_of(fs::path file) {
  constexpr int kMostLinks = 40;  // as the system's own limit
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(file, error); ++i) {
    const fs::path target = fs::read_symlink(file, error);
    if (error) break;
    file = file.parent_path() / target;  // an absolute target replaces all
  }
  return file;
}

// Devices, pipes and what /dev/stdout leads to: there is nothing to rename over.
int write_directly(const fs::path& file, Pieces pieces) {
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (!out.ok()) return errno;
  const int failed = write_all(out.get(), pieces);
  const int failed_close = out.close();
  return failed != 0 ? failed : failed_close;
}

int write_beside_and_rename(const fs::path& file, const struct stat* old, Pieces pieces) {
  std::string temporary;
  int fd = -1;
  for (int n = 0; n < 1000 && fd < 0; ++n) {
    temporary = file.string() + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(n);
    fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0 && errno != EEXIST) return errno;
  }
  if (fd < 0) return EEXIST;
  Descriptor out(fd);
  int failed = write_all(fd, pieces);
  if (failed == 0 && old != nullptr && ::fchmod(fd, old->st_mode & 07777) != 0) failed = errno;
  if (failed == 0 && ::fsync(fd) != 0) failed = errno;
  const int failed_close = out.close();
  if (failed == 0) failed = failed_close;
  if (failed == 0 && ::rename(temporary.c_str(), file.c_str()) != 0) failed = errno;
  if (failed != 0) ::unlink(temporary.c_str());
  return failed;
}

}  // namespace

Result<Done, InputError> write_file(const fs::path& file, const void* data, std::size_t size) {
  const std::span<const std::byte> bytes(static_cast<const std::byte*>(data), size);
  return write_file(file, Pieces(&bytes, 1));
}

Result<Done, InputError> write_file(const fs::path& file, Pieces pieces) {
  if (file == "-") {
    if (const int failed = write_all(STDOUT_FILENO, pieces); failed != 0)
      return unwritable("standard output", failed);
    return Done{};
  }
  struct stat status {};
  const bool exists = ::stat(file.c_str(), &status) == 0;
  if (!exists && errno == ELOOP) return unwritable(file, ELOOP);  // links that lead to each other
  if (exists && S_ISDIR(status.st_mode)) return unwritable(file, EISDIR);
  const bool direct = exists && (!S_ISREG(status.st_mode) || names_descriptor(file));
  const int failed =
      direct ? write_directly(file, pieces)
             : write_beside_and_rename(target_of(file), exists ? &status : nullptr, pieces);
  if (failed != 0) return unwritable(file, failed);
  return Done{};
}

}  // namespace slf
