// One description of a header, visited to parse it and to write it. Rows stand in the order of the
// spec's syntax tables: v.u(4, "sps_level", s.sps_level, {0, 15});
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "bitstream/bit_reader.h"
#include "bitstream/bit_writer.h"

namespace slf {

struct Range {
  std::int64_t min, max;
};

/// Reads; a value outside its range fails with the element's name. See BitReader.
struct ParseSyntax {
  BitReader& in;

  template <class T>
  void u(int n, const char* element, T& value, Range range) {
    store(element, value, static_cast<std::int64_t>(in.u(n, element)), range);
  }
  template <class T>
  void ue(const char* element, T& value, Range range) {
    store(element, value, static_cast<std::int64_t>(in.ue(element)), range);
  }
  template <class T>
  void se(const char* element, T& value, Range range) {
    store(element, value, in.se(element), range);
  }
  template <class T>
  void s8(const char* element, T& value, Range range) {  // two's complement
    store(element, value, static_cast<std::int8_t>(in.u(8, element)), range);
  }
  /// Finite numbers only; positive says > 0.
  void f64(const char* element, double& value, bool positive) {
    value = in.f64(element);
    if (!std::isfinite(value) || (positive && !(value > 0))) in.fail(Errc::kOutOfRange, element);
  }
  /// `count` elements, each of which takes at least one bit: believed only if the bits are there.
  template <class T>
  void resize(const char* element, std::vector<T>& list, std::uint64_t count) {
    if (count > in.bits_left()) in.fail(Errc::kTruncated, element);
    list.assign(in.ok() ? count : 0, T{});
  }
  void require(bool condition, Errc code, const char* element) {
    if (!condition) in.fail(code, element);
  }
  bool ok() const { return in.ok(); }

 private:
  template <class T>
  void store(const char* element, T& value, std::int64_t read, Range range) {
    if (in.ok() && (read < range.min || read > range.max)) in.fail(Errc::kOutOfRange, element);
    value = static_cast<T>(in.ok() ? read : range.min);
  }
};

/// Writes. Values are the encoder's own and within range.
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

}  // namespace slf
