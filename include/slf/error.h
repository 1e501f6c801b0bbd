// SPDX-License-Identifier: Apache-2.0
// Errors and results. Nothing in this library throws an exception of its own.
#pragma once

#include <cassert>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace slf {

/// What went wrong. One value per kind of remedy, not per site; the site is in the message.
enum class Errc : std::uint8_t {
  kNotSlf,           ///< the signature is missing: another kind of file
  kTruncated,        ///< the stream ends inside a unit
  kChecksum,         ///< a CRC-32 or a digest does not match
  kOutOfRange,       ///< a syntax element is outside the range of its clause
  kReserved,         ///< a reserved bit or value is in use
  kUnsupported,      ///< another version of the format, unknown profile, or a component left out of
                     ///< this build
  kLimitExceeded,    ///< sound, but larger than the caller's DecodeLimits
  kInvalidArgument,  ///< a setting or an argument outside its documented range
  kUnreadable,       ///< a file is missing or cannot be read
  kInvalidInput,     ///< a file was read and its content cannot be used
  kUnwritable,       ///< an output could not be written; what was there before is untouched
  kCancelled,        ///< the caller's progress function said so
};

/// The spelling of the code, as conformance manifests have it ("kOutOfRange").
const char* to_string(Errc code);

/// The version of a stream that is refused for it, and the major version that is read.
struct FormatVersions {
  std::uint8_t major = 0, minor = 0, read = 0;
};

/// An error of a bitstream, by the names of the specification (clause 7, annex F). They always
/// point at literals, so an Error copies freely and never allocates.
struct Error {
  Errc code{};
  const char* element = "";  ///< of a syntax table; of limits and arguments their own name
  /// From the first byte of the stream: of the element, or of what holds it (annex F). 0 where no
  /// place of the stream is to blame. What reads a part of a stream counts from that part.
  std::uint64_t bit_offset = 0;
  const char* unit = "";         ///< type of the unit it is in: "sequence", "geometry"; "": in none
  FormatVersions versions = {};  ///< of kUnsupported sps_version_major; else zeros
};

/// An error of anything else a person hands in: a file, a capture, a setting.
struct InputError {
  Errc code{};
  std::string message;  ///< one line, names the file (or the setting) and the cause, no full stop
};

/// Is a place in the stream to blame? Not of arguments and limits.
inline bool has_place(const Error& error) {
  return *error.unit != 0 || error.code <= Errc::kUnsupported;
}

/// "sps_step in the sequence unit, bit 237"; "max_points" where there is no place; "format 0.4,
/// where 1.x is read: sps_version_major in the sequence unit, bit 72".
std::string where(const Error& error);

/// "kOutOfRange: sps_step in the sequence unit, bit 237"
std::string to_string(const Error& error);

/// A value or an error. Reading the value of a failed Result is a mistake of the caller.
template <class T, class E = Error>
class [[nodiscard]] Result {
 public:
  Result(T value) : value_(std::move(value)) {}
  Result(E error) : error_(std::move(error)) {}

  explicit operator bool() const { return value_.has_value(); }
  T& operator*() & { return *pointer(*this); }
  const T& operator*() const& { return *pointer(*this); }
  T&& operator*() && { return std::move(*pointer(*this)); }
  T* operator->() { return pointer(*this); }
  const T* operator->() const { return pointer(*this); }
  const E& error() const {
    assert(!value_);
    return error_;
  }

 private:
  template <class Self>
  static auto* pointer(Self& self) {
    assert(self.value_);
    return std::addressof(*self.value_);
  }
  // Side by side: a variant's moves go through tables, which is code for every type.
  std::optional<T> value_;
  E error_{};
};

/// What a step that yields nothing returns on success.
struct Done {};

}  // namespace slf

#define SLF_CONCAT_(a, b) a##b
#define SLF_CONCAT(a, b) SLF_CONCAT_(a, b)
/// SLF_TRY(const auto x, f()); declares x, or returns f()'s error from the function around it.
#define SLF_TRY(declaration, expression) \
  SLF_TRY_(declaration, expression, SLF_CONCAT(slf_try_, __LINE__))
/// SLF_CHECK(f()); returns f()'s error from the function around it, if there is one.
#define SLF_CHECK(expression) SLF_CHECK_(expression, SLF_CONCAT(slf_check_, __LINE__))
#define SLF_CHECK_(expression, result) \
  if (auto result = (expression); !result) return result.error()
#define SLF_TRY_(declaration, expression, result) \
  auto result = (expression);                     \
  if (!result) return result.error();             \
  declaration = *std::move(result)
