// Whole files in and out. Outputs appear complete or not at all.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>

#include "slf/capture.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 20;

InputError unreadable(const fs::path& file, const std::string& cause) {
  return {Errc::kUnreadable, file.string() + ": " + cause};
}

InputError unwritable(const fs::path& file, int error) {
  return {Errc::kUnwritable, file.string() + ": cannot be written: " + std::strerror(error)};
}

// A descriptor that closes itself; standard streams stay open.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return fd_; }
  bool ok() const { return fd_ >= 0; }
  // 0 or errno. Some file systems report a full disk only here.
  int close() {
    const int result = fd_ > STDERR_FILENO ? ::close(fd_) : 0;
    fd_ = -1;
    return result == 0 ? 0 : errno;
  }

 private:
  int fd_;
};

// 0 or errno.
int write_all(int fd, const unsigned char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(fd, data, std::min(size, std::size_t{1} << 30));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    data += written;
    size -= static_cast<std::size_t>(written);
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

// /dev/stdout and the like lead to whatever is open there, be it a regular file.
bool names_descriptor(const fs::path& file) {
  const std::string name = file.string();
  return name.starts_with("/dev/std") || name.starts_with("/dev/fd/") || name.starts_with("/proc/");
}

// Devices, pipes and what /dev/stdout leads to: there is nothing to rename over.
int write_directly(const fs::path& file, const unsigned char* data, std::size_t size) {
  Descriptor out(::open(file.c_str(), O_WRONLY | O_CLOEXEC));
  if (!out.ok()) return errno;
  const int failed = write_all(out.get(), data, size);
  const int failed_close = out.close();
  return failed != 0 ? failed : failed_close;
}

int write_beside_and_rename(const fs::path& file, const struct stat* old, const unsigned char* data,
                            std::size_t size) {
  std::string temporary;
  int fd = -1;
  for (int n = 0; n < 1000 && fd < 0; ++n) {
    temporary = file.string() + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(n);
    fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0 && errno != EEXIST) return errno;
  }
  if (fd < 0) return EEXIST;
  Descriptor out(fd);
  int failed = write_all(fd, data, size);
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
  const auto* bytes = static_cast<const unsigned char*>(data);
  if (file == "-") {
    if (const int failed = write_all(STDOUT_FILENO, bytes, size); failed != 0)
      return unwritable("standard output", failed);
    return Done{};
  }
  struct stat status {};
  const bool exists = ::stat(file.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return unwritable(file, EISDIR);
  const bool direct = exists && (!S_ISREG(status.st_mode) || names_descriptor(file));
  const int failed =
      direct ? write_directly(file, bytes, size)
             : write_beside_and_rename(target_of(file), exists ? &status : nullptr, bytes, size);
  if (failed != 0) return unwritable(file, failed);
  return Done{};
}

Result<std::vector<std::uint8_t>, InputError> read_file(const fs::path& file,
                                                        std::uint64_t max_bytes) {
  const bool standard = file == "-";
  const fs::path name = standard ? fs::path("standard input") : file;
  // Without waiting: a pipe that nobody writes to would hold up open() for ever.
  Descriptor in(standard ? STDIN_FILENO : ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!in.ok()) return unreadable(name, std::strerror(errno));
  struct stat status {};
  if (::fstat(in.get(), &status) != 0) return unreadable(name, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) return unreadable(name, std::strerror(EISDIR));
  // What the caller has opened, as <(command) does, may be anything.
  if (!S_ISREG(status.st_mode) && !standard && !names_descriptor(file))
    return unreadable(name, "is not a regular file");
  if (!standard && ::fcntl(in.get(), F_SETFL, 0) != 0)
    return unreadable(name, std::strerror(errno));
  const std::string too_large =
      "larger than the " + std::to_string(max_bytes) + " bytes accepted here";

  std::vector<std::uint8_t> bytes;
  if (S_ISREG(status.st_mode)) {
    const auto size = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
    if (size > max_bytes) return InputError{Errc::kInvalidInput, name.string() + ": " + too_large};
    bytes.reserve(static_cast<std::size_t>(size) + 1);  // one more, so that the end shows at once
  }
  for (;;) {
    const std::size_t old = bytes.size();
    const std::size_t room = bytes.capacity() > old ? bytes.capacity() - old : kReadBlock;
    bytes.resize(old + std::min(room, std::size_t{1} << 30));
    const ssize_t count = ::read(in.get(), bytes.data() + old, bytes.size() - old);
    const int error = errno;
    bytes.resize(old + static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    if (count == 0) return bytes;
    if (count < 0 && error != EINTR) return unreadable(name, std::strerror(error));
    if (bytes.size() > max_bytes)
      return InputError{Errc::kInvalidInput, name.string() + ": " + too_large};
  }
}

}  // namespace slf
