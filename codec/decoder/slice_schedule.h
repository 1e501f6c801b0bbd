// SPDX-License-Identifier: Apache-2.0
// Which step of which slice a thread takes next. Spec 8.2 leaves the order free.
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/monitor.h"

namespace slf {

/// What a thread is to do.
struct SliceWork {
  /// kNothing: all is done, or somebody stopped.
  enum Step { kBase, kGeometry, kValues, kNothing };
  Step step = kNothing;
  std::size_t slice = 0;
  bool last = false;  ///< nothing is left for other threads
};

/// Begins with the base's components and, beside them, the geometry of slice 0. Slices are admitted
/// in their order, each when its geometry is there; values come before the geometry of others, so
/// that little waits. Each step is begun in the order of slices.
class SliceSchedule {
 public:
  /// Slices that are begun and not done are at most two a thread, or have at most `in_flight`
  /// points together. points: [slices]
  SliceSchedule(std::vector<std::size_t> points, std::size_t threads, std::size_t in_flight)
      : points_(std::move(points)),
        has_(points_.size(), kNone),
        most_slices_(2 * threads),
        most_points_(in_flight) {}

  /// Waits until there is something.
  SliceWork next() {
    SliceWork work;
    monitor_.wait([&] { return take(work); });
    return work;
  }

  void finish_base() {
    monitor_.change([&] { base_done_ = true; });
  }

  /// admit(s) is called for every slice in turn, by one thread at a time. False: the rest is not
  /// begun.
  template <class Admit>
  void finish_geometry(std::size_t slice, const Admit& admit) {
    monitor_.change([&] {
      has_[slice] = kGeometry;
      for (; admitted_ < has_.size() && has_[admitted_] == kGeometry && !stopped_; ++admitted_)
        stopped_ = !admit(admitted_);
    });
  }

  /// gather(s): the same.
  template <class Gather>
  void finish_values(std::size_t slice, const Gather& gather) {
    monitor_.change([&] {
      has_[slice] = kValues;
      points_in_flight_ -= points_[slice];
      --slices_in_flight_;
      for (; gathered_ < has_.size() && has_[gathered_] == kValues; ++gathered_) gather(gathered_);
    });
  }

  void stop() {
    monitor_.change([&] { stopped_ = true; });
  }

 private:
  bool take(SliceWork& work) {
    if (stopped_) {
      work.step = SliceWork::kNothing;
    } else if (!base_begun_) {
      base_begun_ = true;
      work.step = SliceWork::kBase;
    } else if (values_begun_ == points_.size()) {
      work.step = SliceWork::kNothing;
    } else if (base_done_ && values_begun_ < admitted_) {
      work = {SliceWork::kValues, values_begun_++, values_begun_ == points_.size()};
    } else if (geometry_begun_ < points_.size() && has_room(points_[geometry_begun_])) {
      points_in_flight_ += points_[geometry_begun_];
      ++slices_in_flight_;
      work = {SliceWork::kGeometry, geometry_begun_++, false};
    } else {
      return false;
    }
    return true;
  }

  bool has_room(std::size_t points) const {
    return slices_in_flight_ < most_slices_ || points_in_flight_ + points <= most_points_;
  }

  std::vector<std::size_t> points_;
  enum Has : std::uint8_t { kNone, kGeometry, kValues };
  std::vector<std::uint8_t> has_;  // [slices] what is decoded of each
  std::size_t most_slices_, most_points_;
  bool base_begun_ = false, base_done_ = false, stopped_ = false;
  std::size_t geometry_begun_ = 0, admitted_ = 0, values_begun_ = 0, gathered_ = 0;  // slices
  std::size_t slices_in_flight_ = 0, points_in_flight_ = 0;
  Monitor monitor_;
};

/// Whoever leaves has done all there was, or threw: others would wait for ever.
struct StopAtEnd {
  SliceSchedule& schedule;
  ~StopAtEnd() { schedule.stop(); }
};

}  // namespace slf
