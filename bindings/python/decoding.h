// SPDX-License-Identifier: Apache-2.0
// Decoding on the C++ library, for what the C interface does not do.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "arrays.h"
#include "failure.h"
#include "interrupts.h"
#include "module.h"
#include "ranges.h"
#include "slf/decoder.h"
#include "slf/part_decoder.h"

namespace slf::python {

/// @param ended  ends the decode where it is set; outlives the options
inline DecodeOptions decode_options(const Part& part, const std::atomic<bool>& ended) {
  DecodeOptions options;
  options.progress = [&ended](double) { return !ended.load(); };
  options.levels = static_cast<int>(part.levels);
  options.groups = static_cast<int>(part.groups);
  options.layers = static_cast<int>(part.layers);
  options.max_bytes = part.max_bytes;
  options.threads = part.threads;
  if (part.max_memory > 0) options.limits.max_memory = part.max_memory;
  if (part.region) {
    const auto& r = *part.region;
    options.region = VoxelBox{{r[0], r[1], r[2]}, {r[3], r[4], r[5]}};
  }
  return options;
}

/// No more is read than is asked for, unless that is all. Called without Python's lock.
inline LightField decoded_in_parts(RangesView& ranges, const DecodeOptions& options) {
  const StreamSource source{ranges.size(), [&](std::uint64_t offset, std::span<std::uint8_t> to) {
                              return ranges.read(offset, to);
                            }};
  if (const auto beginning = value_of(read_beginning(source, options.limits)))
    if (auto field = value_of(decode_part(source, *beginning, options))) return *std::move(field);
  if (source.bytes > options.limits.max_memory)
    throw failure_of(Error{Errc::kLimitExceeded, "max_memory"});
  std::vector<std::uint8_t> all(static_cast<std::size_t>(source.bytes));
  if (!source.read(0, all)) throw failure_of(Error{Errc::kUnreadable, "stream"});
  return value_of(decode(all, options));
}

inline LightField decoded(const py::object& source, const Part& part) {
  std::atomic<bool> ended = false;
  const DecodeOptions options = decode_options(part, ended);
  LightField field;
  if (RangesView::is(source)) {
    RangesView ranges(source);
    try {
      run_interruptibly(ended, [&] { field = decoded_in_parts(ranges, options); });
    } catch (const Failure&) {
      ranges.rethrow();
      throw;
    }
    return field;
  }
  const BytesView view(source);
  run_interruptibly(ended, [&] { field = value_of(decode(view.bytes(), options)); });
  return field;
}

}  // namespace slf::python
