// SPDX-License-Identifier: Apache-2.0
#include "capture/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstring>

#include "slf/capture.h"

namespace slf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kReadBlock = std::size_t{1} << 20;

InputError unreadable(const fs::path& file, const std::string& cause) {
  return {Errc::kUnreadable, file.string() + ": " + cause};
}

}  // namespace

Result<InputFile, InputError> InputFile::open(const fs::path& file, std::uint64_t max_held) {
  const bool standard = file == "-";
  // Without waiting: a pipe that nobody writes to would hold up open() for ever.
  Descriptor in(standard ? STDIN_FILENO : ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  InputFile input(std::move(in), standard ? fs::path("standard input") : file);
  const int fd = input.in_.get();
  struct stat status {};
  if (fd < 0 || ::fstat(fd, &status) != 0) return unreadable(input.name_, std::strerror(errno));
  if (S_ISDIR(status.st_mode)) return unreadable(input.name_, std::strerror(EISDIR));
  const bool regular = S_ISREG(status.st_mode);
  // What the caller has opened, as <(command) does, may be anything.
  if (!regular && !standard && !names_descriptor(file))
    return unreadable(input.name_, "is not a regular file");
  if (!standard && ::fcntl(fd, F_SETFL, 0) != 0)
    return unreadable(input.name_, std::strerror(errno));
  if (regular) {
    input.size_ = static_cast<std::uint64_t>(std::max<off_t>(status.st_size, 0));
    return input;
  }
  SLF_TRY(input.content_, input.read_rest(max_held));
  input.held_ = true;
  input.size_ = input.content_.size();
  return input;
}

Result<std::size_t, InputError> InputFile::read(std::span<std::uint8_t> to) {
  if (held_) {
    const std::size_t count = std::min(to.size(), content_.size() - given_);
    std::copy_n(content_.begin() + static_cast<std::ptrdiff_t>(given_), count, to.begin());
    given_ += count;
    return count;
  }
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t count =
        ::read(in_.get(), to.data() + done, std::min(to.size() - done, std::size_t{1} << 30));
    if (count == 0) break;
    if (count < 0 && errno != EINTR) return unreadable(name_, std::strerror(errno));
    done += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  }
  return done;
}

Result<std::vector<std::uint8_t>, InputError> InputFile::read_rest(std::uint64_t max_bytes) {
  const InputError too_large{
      Errc::kLimitExceeded,
      name_.string() + ": larger than the " + std::to_string(max_bytes) + " bytes accepted here"};
  if (size_ > max_bytes) return too_large;
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(size_) + 1);  // one more, so that the end shows at once
  for (;;) {
    const std::size_t old = bytes.size();
    bytes.resize(bytes.capacity() > old ? bytes.capacity() : old + kReadBlock);
    SLF_TRY(const std::size_t count, read(std::span(bytes).subspan(old)));
    const bool ended = count < bytes.size() - old;
    bytes.resize(old + count);
    if (bytes.size() > max_bytes) return too_large;
    if (ended) return bytes;
  }
}

Result<std::vector<std::uint8_t>, InputError> read_file(const fs::path& file,
                                                        std::uint64_t max_bytes) {
  SLF_TRY(InputFile input, InputFile::open(file, max_bytes));
  return input.read_rest(max_bytes);
}

}  // namespace slf
