// SPDX-License-Identifier: Apache-2.0
#include "tools/spooled_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "slf/gaussian_files.h"
#include "tools/interrupt.h"

namespace slf::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMostSpooled = std::uint64_t{1} << 32;  // as of any input that is held
constexpr std::size_t kSpoolBlock = std::size_t{1} << 20;

/// Fills the span as far as there is something in the stream.
Result<std::size_t, Failure> read_stream(int from, std::span<std::uint8_t> to) {
  std::size_t done = 0;
  while (done < to.size()) {
    const ssize_t count = ::read(from, to.data() + done, to.size() - done);
    if (count == 0) break;
    if (count < 0 && errno != EINTR)
      return Failure{kInputUnreadable, std::string("standard input: ") + std::strerror(errno)};
    done += static_cast<std::size_t>(std::max<ssize_t>(count, 0));
  }
  return done;
}

/// By the first bytes; empty: nothing that is read from a stream.
std::string extension_by_content(std::span<const std::uint8_t> head, std::uint64_t size) {
  const std::string_view text(reinterpret_cast<const char*>(head.data()), head.size());
  if (text.starts_with("ply")) return ".ply";
  if (looks_like_gaussians(head, size)) {
    if (text.starts_with("glTF")) return ".glb";
    if (text.starts_with("PK")) return ".sog";
    return text.starts_with("{") ? "" : ".splat";  // readers of splats look at content alone
  }
  if (text.starts_with("LASF")) return head.size() > 104 && head[104] & 0x80 ? ".laz" : ".las";
  if (text.starts_with("ASTM-E57")) return ".e57";
  if (text.starts_with("glTF")) return ".glb";
  return "";
}

Failure no_room(const fs::path& file) {
  return {kWriteFailed, file.string() + ": standard input cannot be kept there: " +
                            std::strerror(errno) + " (TMPDIR says where)"};
}

Outcome write_all(int to, std::span<const std::uint8_t> bytes, const fs::path& file) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(to, bytes.data(), bytes.size());
    if (count < 0 && errno != EINTR) return no_room(file);
    bytes = bytes.subspan(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  }
  return Done{};
}

/// @param block  the first one; room for the others
Outcome copy_stream(int from, int to, std::vector<std::uint8_t> block, const fs::path& file) {
  std::uint64_t all = block.size();
  bool ended = block.size() < kSpoolBlock;
  SLF_CHECK(write_all(to, block, file));
  while (!ended) {
    block.resize(kSpoolBlock);
    SLF_TRY(const std::size_t count, read_stream(from, block));
    all += count;
    if (all > kMostSpooled)
      return Failure{kLimitExceeded, "standard input: larger than the " +
                                         std::to_string(kMostSpooled) + " bytes accepted here"};
    SLF_CHECK(write_all(to, std::span(block).first(count), file));
    ended = count < block.size();
  }
  return Done{};
}

std::string living;  // path of the one that there is

}  // namespace

std::optional<int> SpooledInput::stream_of(const std::string& name) {
  if (name == "-" || name == "/dev/stdin") return STDIN_FILENO;
  constexpr std::string_view kOpened = "/dev/fd/";
  int number = 0;
  if (!name.starts_with(kOpened)) return std::nullopt;
  const char* end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + kOpened.size(), end, number);
  return read.ec == std::errc() && read.ptr == end ? std::optional(number) : std::nullopt;
}

Result<SpooledInput, Failure> SpooledInput::read(int stream) {
  std::vector<std::uint8_t> head(kSpoolBlock);
  SLF_TRY(const std::size_t count, read_stream(stream, head));
  head.resize(count);
  if (count == 0) return Failure{kInputInvalid, "standard input: is empty"};
  const std::uint64_t size = count < kSpoolBlock ? count : kMostSpooled;
  const std::string extension = extension_by_content(head, size);
  if (extension.empty())
    return Failure{kInputInvalid,
                   "standard input: not a PLY, LAS, E57, GLB or a file of splats: encode reads "
                   "captures and other files by name"};
  std::error_code error;
  const fs::path temporary = fs::temp_directory_path(error);
  std::string name = (temporary / "slf-XXXXXX").string();
  if (error || ::mkdtemp(name.data()) == nullptr) return no_room(name);
  SpooledInput spooled{fs::path(name)};
  spooled.file_ = spooled.directory_ / ("standard input" + extension);
  remove_at_interrupt(spooled.file_.c_str(), spooled.directory_.c_str());
  const int to = ::open(spooled.file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (to < 0) return no_room(spooled.file_);
  Outcome copied = copy_stream(stream, to, std::move(head), spooled.file_);
  if (::close(to) != 0 && copied) copied = no_room(spooled.file_);
  if (!copied) return copied.error();
  living = spooled.path();
  return spooled;
}

std::string SpooledInput::named(std::string sentence) {
  if (const auto at = sentence.find(living); !living.empty() && at != std::string::npos)
    sentence.replace(at, living.size(), "standard input");
  return sentence;
}

SpooledInput::SpooledInput(SpooledInput&& other) noexcept
    : directory_(std::exchange(other.directory_, {})), file_(std::exchange(other.file_, {})) {}

SpooledInput::~SpooledInput() {
  if (directory_.empty()) return;
  remove_at_interrupt("", "");
  living.clear();
  ::unlink(file_.c_str());
  ::rmdir(directory_.c_str());
}

}  // namespace slf::tools
