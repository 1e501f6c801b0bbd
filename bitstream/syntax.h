// SPDX-License-Identifier: Apache-2.0
// One description of a header, visited to parse it, to check it and to write it. Rows stand in the
// order of the spec's syntax tables: v.u(4, "sps_level", s.sps_level, {0, 15});
#pragma once

#include <cmath>
#include <cstdint>
#include <string_view>
#include <variant>
#include <vector>

#include "bitstream/bit_reader.h"
#include "bitstream/bit_writer.h"

namespace slf {

struct Range {
  std::int64_t min, max;
  Errc beyond = Errc::kOutOfRange;  ///< what a value outside of it is
};
/// Spec 3.4: a later version may give the other values a meaning.
constexpr Range defined(std::int64_t min, std::int64_t max) {
  return {min, max, Errc::kUnsupported};
}

/// An element that was read, and where.
struct SyntaxEntry {
  const char* element;  ///< its name; a literal
  const char* kind;     ///< u, ue, se, s8, f64: how it is coded. Spec 3.3
  std::uint64_t bit;    ///< of its first bit in the unit's payload
  std::uint64_t bits;
  std::variant<std::int64_t, double> value;
};
using SyntaxLog = std::vector<SyntaxEntry>;

/// Reads; a value outside its range fails with the element's name. See BitReader.
struct ParseSyntax {
  BitReader& in;
  SyntaxLog* log;

  /// @param syntax_log  receives every element, where given
  explicit ParseSyntax(BitReader& reader, SyntaxLog* syntax_log = nullptr)
      : in(reader), log(syntax_log) {}

  template <class T>
  void u(int n, const char* element, T& value, Range range) {
    const std::uint64_t bit = in.bit_position();
    store({element, "u", bit, 0, static_cast<std::int64_t>(in.u(n, element))}, value, range);
  }
  template <class T>
  void ue(const char* element, T& value, Range range) {
    const std::uint64_t bit = in.bit_position();
    store({element, "ue", bit, 0, static_cast<std::int64_t>(in.ue(element))}, value, range);
  }
  template <class T>
  void se(const char* element, T& value, Range range) {
    const std::uint64_t bit = in.bit_position();
    store({element, "se", bit, 0, in.se(element)}, value, range);
  }
  template <class T>
  void s8(const char* element, T& value, Range range) {  // two's complement
    const std::uint64_t bit = in.bit_position();
    store({element, "s8", bit, 0, static_cast<std::int8_t>(in.u(8, element))}, value, range);
  }
  /// Finite numbers only; positive says > 0.
  void f64(const char* element, double& value, bool positive) {
    const std::uint64_t bit = in.bit_position();
    value = in.f64(element);
    if (!std::isfinite(value) || (positive && !(value > 0)))
      in.fail(Errc::kOutOfRange, element, bit);
    note({element, "f64", bit, 0, value});
  }
  /// `count` elements, each of which takes at least one bit: believed only if the bits are there.
  template <class T>
  void resize(const char* element, std::vector<T>& list, std::uint64_t count) {
    if (count > in.bits_left()) in.fail(Errc::kTruncated, element, begin_of(element));
    list.assign(in.ok() ? count : 0, T{});
  }
  void require(bool condition, Errc code, const char* element) {
    if (!condition) in.fail(code, element, begin_of(element));
  }
  bool ok() const { return in.ok(); }

 private:
  template <class T>
  void store(const SyntaxEntry& entry, T& value, Range range) {
    const std::int64_t read = *std::get_if<std::int64_t>(&entry.value);
    if (in.ok() && (read < range.min || read > range.max))
      in.fail(range.beyond, entry.element, entry.bit);
    value = static_cast<T>(in.ok() ? read : range.min);
    note(entry);
  }
  /// Begin of the element that was read last; for another one, where reading stands.
  std::uint64_t begin_of(std::string_view element) const {
    return element == last_ ? last_begin_ : in.bit_position();
  }
  void note(SyntaxEntry entry) {
    last_ = entry.element;
    last_begin_ = entry.bit;
    if (log == nullptr || !in.ok()) return;
    entry.bits = in.bit_position() - entry.bit;
    log->push_back(entry);
  }

  std::string_view last_;
  std::uint64_t last_begin_ = 0;
};

/// Writes what it is given. See checked_header().
struct WriteSyntax {
  BitWriter& out;

  template <class T>
  void u(int n, const char*, const T& value, Range) {
    out.u(n, static_cast<std::uint64_t>(value));
  }
  template <class T>
  void ue(const char*, const T& value, Range) {
    out.ue(static_cast<std::uint64_t>(value));
  }
  template <class T>
  void se(const char*, const T& value, Range) {
    out.se(value);
  }
  template <class T>
  void s8(const char*, const T& value, Range) {
    out.u(8, static_cast<std::uint8_t>(value));
  }
  void f64(const char*, double value, bool) { out.f64(value); }
  template <class T>
  void resize(const char*, const std::vector<T>&, std::uint64_t) {}
  void require(bool, Errc, const char*) {}
  bool ok() const { return true; }
};

/// Checks what is about to be written: a reader would refuse what this does. See ParseSyntax.
/// A list has as many elements as are coded.
struct CheckSyntax {
  const char* element = nullptr;  ///< the first that is wrong; nullptr: none
  std::int64_t found = 0;
  Range range{0, -1};  ///< that `found` is outside of; where another rule is broken, none

  template <class T>
  void u(int, const char* name, const T& value, Range allowed) {
    check(name, static_cast<std::int64_t>(value), allowed);
  }
  template <class T>
  void ue(const char* name, const T& value, Range allowed) {
    check(name, static_cast<std::int64_t>(value), allowed);
  }
  template <class T>
  void se(const char* name, const T& value, Range allowed) {
    check(name, value, allowed);
  }
  template <class T>
  void s8(const char* name, const T& value, Range allowed) {
    check(name, value, allowed);
  }
  void f64(const char* name, double value, bool positive) {
    require(std::isfinite(value) && (!positive || value > 0), Errc::kOutOfRange, name);
  }
  template <class T>
  void resize(const char* name, const std::vector<T>& list, std::uint64_t count) {
    require(list.size() == count, Errc::kOutOfRange, name);
  }
  void require(bool condition, Errc, const char* name) {
    if (ok() && !condition) element = name;
  }
  bool ok() const { return element == nullptr; }

 private:
  void check(const char* name, std::int64_t value, Range allowed) {
    if (!ok() || (value >= allowed.min && value <= allowed.max)) return;
    element = name;
    found = value;
    range = allowed;
  }
};

}  // namespace slf
