// SPDX-License-Identifier: Apache-2.0
// Streams and fields of the C interface.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "failure.h"
#include "interrupts.h"
#include "module.h"
#include "ranges.h"
#include "slf/slf.h"

namespace slf::python {

inline void check(slf_code code, const slf_error& error) {
  if (code == SLF_OK) return;
  Failure failure;
  failure.code = slf_code_name(error.code);
  failure.message = error.message;
  failure.element = error.element;
  failure.unit = error.unit;
  failure.bit_offset = error.bit_offset;
  throw failure;
}

struct ReleaseStream {
  void operator()(slf_stream* stream) const { slf_release_stream(stream); }
};
struct ReleaseField {
  void operator()(slf_field* field) const { slf_release_field(field); }
};

/// An open stream, and the memory that it is in, or what it is read through.
class Stream {
 public:
  explicit Stream(std::shared_ptr<RangesView> ranges) : ranges_(std::move(ranges)) {
    const slf_reader reader{sizeof reader, 0, ranges_->size(), ranges_.get(), &Stream::read_at};
    open([&](slf_stream** stream, slf_error* error) {
      return slf_open_reader(&reader, nullptr, stream, error);
    });
  }
  explicit Stream(std::shared_ptr<const BytesView> view) : Stream(view, view->bytes()) {}
  /// @param bytes  some of the view's
  Stream(std::shared_ptr<const BytesView> view, std::span<const std::uint8_t> bytes)
      : view_(std::move(view)) {
    open([&](slf_stream** stream, slf_error* error) {
      return slf_open(bytes.data(), bytes.size(), nullptr, stream, error);
    });
  }

  const slf_stream* get() const { return stream_.get(); }

  /// What a source's own exception was, if it could not be read.
  void rethrow() const {
    if (ranges_) ranges_->rethrow();
  }

  py::dict info() const {
    slf_info i{};
    i.size = sizeof i;
    slf_error error = SLF_ERROR_INIT;
    check(slf_get_info(get(), &i, &error), error);
    static constexpr std::array kUp{"+x", "-x", "+y", "-y", "+z", "-z", "unknown"};
    static constexpr std::array kProfiles{"main", "draco", "texture"};
    using namespace py::literals;
    return py::dict(
        "format_version"_a = py::make_tuple(i.format_version >> 16, i.format_version & 0xffff),
        "profile"_a = kProfiles.at(i.profile), "bytes"_a = i.bytes, "points"_a = i.points,
        "functions"_a = i.functions, "components"_a = i.components, "slices"_a = i.slices,
        "groups"_a = i.groups, "layers"_a = i.layers, "bits"_a = i.levels,
        "normal_bits"_a = i.normal_bits, "has_splats"_a = i.has_splats != 0,
        "origin"_a = py::make_tuple(i.origin[0], i.origin[1], i.origin[2]), "step"_a = i.step,
        "metres_per_unit"_a = i.metres_per_unit, "up"_a = kUp.at(i.up),
        "right_handed"_a = i.left_handed == 0,
        "basis"_a = i.has_basis == 0 ? "none"
                    : i.basis == 0   ? "bspline"
                                     : "harmonics",
        "directions"_a = i.directions == SLF_DIRECTIONS_REFLECTED ? "reflected" : "world",
        "transfer"_a = i.transfer == SLF_TRANSFER_LINEAR ? "linear" : "display",
        "gamma_range"_a = py::make_tuple(i.gamma_min, i.gamma_max), "complete"_a = i.complete != 0,
        "metadata"_a = metadata(i.metadata_pairs));
  }

 private:
  static int read_at(void* user, std::uint64_t offset, void* to, std::size_t bytes) {
    const std::span out(static_cast<std::uint8_t*>(to), bytes);
    return static_cast<RangesView*>(user)->read(offset, out) ? 0 : 1;
  }

  template <class Open>
  void open(const Open& opened) {
    slf_error error = SLF_ERROR_INIT;
    slf_stream* stream = nullptr;
    slf_code code;
    {
      const py::gil_scoped_release no_gil;
      code = opened(&stream, &error);
    }
    rethrow();
    check(code, error);
    stream_.reset(stream);
  }

  py::tuple metadata(std::uint32_t pairs) const {
    py::tuple all(pairs);
    for (std::uint32_t i = 0; i < pairs; ++i) {
      const char *key = nullptr, *value = nullptr;
      slf_error error = SLF_ERROR_INIT;
      check(slf_get_metadata(get(), i, &key, &value, &error), error);
      all[i] = py::make_tuple(text(key), text(value));
    }
    return all;
  }

  /// What is not UTF-8 is replaced: a foreign file must not make its other texts unreadable.
  static py::object text(const char* utf8) {
    return py::reinterpret_steal<py::object>(PyUnicode_DecodeUTF8(
        utf8, static_cast<py::ssize_t>(std::char_traits<char>::length(utf8)), "replace"));
  }

  std::shared_ptr<const BytesView> view_;
  std::shared_ptr<RangesView> ranges_;
  std::unique_ptr<slf_stream, ReleaseStream> stream_;
};

/// @param ended  ends the decode where it is set; outlives the options
inline slf_options options_of(const Part& part, std::atomic<bool>& ended) {
  slf_options options = SLF_OPTIONS_INIT;
  options.user = &ended;
  options.progress = [](void* user, double) {
    return static_cast<const std::atomic<bool>*>(user)->load() ? 1 : 0;
  };
  options.levels = part.levels;
  options.groups = part.groups;
  options.layers = part.layers;
  options.max_bytes = part.max_bytes;
  options.threads = part.threads == 0 ? -1 : part.threads;
  options.max_memory_bytes = part.max_memory;
  if (part.region) {
    options.has_region = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      options.region_low[k] = (*part.region)[k];
      options.region_high[k] = (*part.region)[k + 3];
    }
  }
  return options;
}

/// A decoded field.
class Field {
 public:
  /// @param ended   of the options of `decode`
  /// @param decode  gives it: called without Python's lock, on a thread of its own
  template <class Decode>
  Field(std::shared_ptr<const Stream> stream, std::atomic<bool>& ended, const Decode& decode)
      : stream_(std::move(stream)) {
    slf_error error = SLF_ERROR_INIT;
    slf_code code{};
    run_interruptibly(ended, [&] {
      slf_field* field = nullptr;
      code = decode(&field, &error);
      field_.reset(field);
    });
    stream_->rethrow();
    check(code, error);
    shape_.size = sizeof shape_;
    check(slf_get_shape(field_.get(), &shape_, &error), error);
  }

  py::dict info() const { return stream_->info(); }

  py::dict shape() const {
    using namespace py::literals;
    return py::dict(
        "points"_a = shape_.points, "components"_a = shape_.components, "bits"_a = shape_.levels,
        "partial"_a = shape_.partial != 0, "has_splats"_a = shape_.has_splats != 0,
        "step"_a = shape_.step,
        "origin"_a = py::make_tuple(shape_.origin[0], shape_.origin[1], shape_.origin[2]));
  }

  py::array positions() const {  // below 2^21: the same bits signed or not
    return read<std::int32_t>({3}, [](auto* field, auto count, std::int32_t* to, auto* error) {
      return slf_read_positions(field, 0, count, reinterpret_cast<std::uint32_t*>(to), 0, error);
    });
  }
  py::array components() const {
    return read<std::int32_t>({static_cast<py::ssize_t>(shape_.components), 3},
                              [](auto* field, auto count, std::int32_t* to, auto* error) {
                                return slf_read_components(field, 0, count, to, 0, error);
                              });
  }
  py::array normals() const {
    return read<float>({3}, [](auto* field, auto count, float* to, auto* error) {
      return slf_read_disc_normals(field, 0, count, to, 0, error);
    });
  }
  py::array radii() const {
    return read<float>({}, [](auto* field, auto count, float* to, auto* error) {
      return slf_read_disc_radii(field, 0, count, to, 0, error);
    });
  }
  py::array opacities() const {
    return read<float>({}, [](auto* field, auto count, float* to, auto* error) {
      return slf_read_splat_opacities(field, 0, count, to, 0, error);
    });
  }
  py::array covariances() const {  // the upper triangle, row by row
    return read<float>({6}, [](auto* field, auto count, float* to, auto* error) {
      return slf_read_splat_covariances(field, 0, count, to, 0, error);
    });
  }
  py::array mean_colours() const {
    return read<std::uint8_t>({3}, [](auto* field, auto count, std::uint8_t* to, auto* error) {
      return slf_read_mean_colours(field, 0, count, to, 0, error);
    });
  }

  py::array radiance(const Array<std::uint32_t>& points, const Array<float>& directions) const {
    check_shape(points, {-1}, "points");
    check_shape(directions, {points.shape(0), 3}, "directions");
    py::array_t<float> out({points.shape(0), py::ssize_t{3}});
    slf_error error = SLF_ERROR_INIT;
    slf_code code;
    const std::uint32_t* from = points.data();
    const float* along = directions.data();
    float* to = out.mutable_data();
    const auto count = static_cast<std::uint64_t>(points.shape(0));
    {
      const py::gil_scoped_release no_gil;
      code = slf_read_radiance(field_.get(), count, from, along, to, &error);
    }
    check(code, error);
    return out;
  }

 private:
  /// Straight into an array's own memory. [P, row...]
  template <class T, class Read>
  py::array read(std::vector<py::ssize_t> row, const Read& call) const {
    row.insert(row.begin(), static_cast<py::ssize_t>(shape_.points));
    py::array_t<T> out(row);
    T* to = out.mutable_data();
    slf_error error = SLF_ERROR_INIT;
    slf_code code;
    {
      const py::gil_scoped_release no_gil;
      code = call(field_.get(), shape_.points, to, &error);
    }
    check(code, error);
    return out;
  }

  std::shared_ptr<const Stream> stream_;  // whose headers it has
  std::unique_ptr<slf_field, ReleaseField> field_;
  slf_shape shape_{};
};

}  // namespace slf::python
