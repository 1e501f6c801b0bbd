// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/scene_decoder.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/huge_pages.h"
#include "base/stopwatch.h"
#include "codec/decoder/base_decoder.h"
#include "codec/decoder/decode_cost.h"
#include "codec/decoder/slice_decoder.h"
#include "codec/decoder/slice_schedule.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// A slice on its way, and the error that ended it.
struct Task {
  SliceToDecode slice;
  std::optional<Error> error = {};
  SliceGeometry geometry = {};  ///< from its geometry to its values; its positions till admitted
  LightField apart = {};        ///< its points until it is known where to put them, or all in place
  SliceOutput output = {};

  /// Runs a step, unless one before it failed.
  template <class Step>
  void run(Step step) {
    if (error) return;
    if (auto done = step(); !done) error = done.error();
  }
};

class SceneDecoder {
 public:
  SceneDecoder(const SceneUnits& units, const Request& request,
               const std::vector<std::uint8_t>& chosen, int threads, SceneState& scene,
               LightField& field)
      : units_(units),
        request_(request),
        threads_(threads),
        in_place_(!request.kept_levels_only() && !request.region),
        scene_(scene),
        field_(field),
        rows_(request.stream.has_base() ? scene.base.cells.size() : 0) {
    for (std::size_t s = 0; s < units.slices.size(); ++s)
      if (chosen[s]) tasks_.push_back({{request, scene, units.slices[s], s}});
  }

  Result<Done> decode(DecodeSeconds& seconds) {
    std::vector<std::size_t> points;
    for (const Task& task : tasks_) points.push_back(task.slice.points());
    const auto threads = static_cast<std::size_t>(thread_count(threads_, points.size() + 1));
    SliceSchedule schedule(std::move(points), threads, kPointsInFlight);
    std::vector<DecodeSeconds> of_threads(threads);
    parallel_ranges(threads, 1, threads_, [&](std::size_t begin, std::size_t) {
      const StopAtEnd stop{schedule};
      work(schedule, of_threads[begin]);
    });
    for (const DecodeSeconds& s : of_threads) {
      seconds.geometry += s.geometry;
      seconds.coefficients += s.coefficients;
    }
    return finish();
  }

 private:
  void work(SliceSchedule& schedule, DecodeSeconds& seconds) {
    Stopwatch watch;
    for (;;) {
      const SliceWork work = schedule.next();
      watch.lap();  // waiting is no work
      if (work.step == SliceWork::kNothing) return;
      if (work.step == SliceWork::kBase) {
        decode_base(schedule);
      } else if (work.step == SliceWork::kGeometry) {
        decode_geometry(tasks_[work.slice]);
        schedule.finish_geometry(work.slice, [&](std::size_t s) { return admit(tasks_[s]); });
      } else {
        decode_values(tasks_[work.slice], work.last ? threads_ : 1);
        schedule.finish_values(work.slice, [&](std::size_t s) { gather(tasks_[s]); });
      }
      (work.step == SliceWork::kGeometry ? seconds.geometry : seconds.coefficients) += watch.lap();
    }
  }

  void decode_base(SliceSchedule& schedule) {
    if (auto values = decode_base_components(units_.base, request_, scene_.base)) {
      scene_.base.values = *std::move(values);
    } else {
      base_error_ = values.error();
      schedule.stop();
    }
    schedule.finish_base();
  }

  bool is_first(const Task& task) const { return &task == &tasks_.front(); }

  void decode_geometry(Task& task) {
    const CloseAtEnd<OccupancyStates> close{scene_.lead.geometry, is_first(task)};
    task.run([&]() -> Result<Done> {
      SLF_TRY(task.geometry,
              decode_slice_geometry(task.slice, start_octree(task.slice, tasks_.size() == 1)));
      return Done{};
    });
  }

  /// Room for the points of the next slice, if that is not too much.
  bool admit(Task& task) {
    std::vector<Voxel> positions = std::move(task.geometry.positions);
    rows_ += positions.size();
    if (auto level = check_values(request_, rows_); !level) {
      level_error_ = level.error();
      return false;
    }
    if (is_first(task) && task.error) in_place_ = false;  // room for what is not believed any more
    if (in_place_ && is_first(task)) reserve_points();
    if (in_place_) {
      task.output = append(positions);
    } else {
      task.apart.positions = std::move(positions);
    }
    return true;
  }

  /// Points, and components and normals of zero, behind those of the field.
  SliceOutput append(std::span<const Voxel> positions) {
    field_.positions.insert(field_.positions.end(), positions.begin(), positions.end());
    return make_room(positions.size(), field_);
  }

  /// Components and normals of the last points of a field.
  SliceOutput make_room(std::size_t points, LightField& field) const {
    const std::size_t values = field.components.size(), normals = field.normals.octahedral.size();
    reserve_large(field.components, values + points * request_.planes());
    field.components.resize(values + points * request_.planes());
    if (request_.stream.set.sps_normal_bits > 0) field.normals.octahedral.resize(normals + points);
    return {std::span(field.positions).last(points), std::span(field.components).subspan(values),
            std::span(field.normals.octahedral).subspan(normals)};
  }

  void decode_values(Task& task, int plane_threads) {
    const CloseAtEnd<CoefficientStates> close{scene_.lead.coefficients, is_first(task)};
    if (!in_place_) {
      if (is_first(task) && !request_.region) reserve_levels(task);
      task.output = make_room(task.apart.num_points(), task.apart);
    }
    SliceGeometry geometry = std::move(task.geometry);
    task.run([&] {
      return decode_slice_values(task.slice, std::move(geometry), task.output, plane_threads);
    });
  }

  /// Appends what was decoded apart: all there is, where nothing is there yet.
  void gather(Task& task) {
    LightField part = std::move(task.apart);
    if (in_place_ || task.error) return;
    part.normals.bits = field_.normals.bits;
    if (request_.region) keep_region(request_, part);
    if (field_.positions.empty()) {
      field_.positions.swap(part.positions);
      field_.components.swap(part.components);
      field_.normals.octahedral.swap(part.normals.octahedral);
      return;
    }
    const SliceOutput place = append(part.positions);
    std::copy(part.components.begin(), part.components.end(), place.components.begin());
    std::copy(part.normals.octahedral.begin(), part.normals.octahedral.end(),
              place.normals.begin());
  }

  /// Room for all points that the slices say there are: within the limits (check_limits), and on
  /// pages that are not there until they are used. So nothing moves while others write to it.
  void reserve_points() {
    const auto points = static_cast<std::size_t>(request_.stream.table.num_points());
    reserve_large(field_.positions, points);
    reserve_large(field_.components, points * request_.planes());
    if (request_.stream.set.sps_normal_bits > 0) field_.normals.octahedral.reserve(points);
  }

  /// Room for the levels kept of all slices behind those of the first, if they have as many points
  /// in proportion: more or less, where it is wrong.
  void reserve_levels(Task& task) const {
    const double share = 1.03 * static_cast<double>(task.apart.num_points()) /
                         static_cast<double>(task.slice.points());
    const auto points =
        static_cast<std::size_t>(share * static_cast<double>(request_.stream.table.num_points()));
    reserve_large(task.apart.components, points * request_.planes());
  }

  /// The error that stands first in the stream.
  Result<Done> finish() const {
    if (base_error_) return *base_error_;
    if (level_error_) return *level_error_;
    const Error* first = nullptr;
    for (const Task& task : tasks_)
      if (task.error && (first == nullptr || place_of(*task.error) < place_of(*first)))
        first = &*task.error;
    if (first != nullptr) return *first;
    return Done{};
  }

  /// No unit is to blame where the caller cancels: that comes first.
  static std::uint64_t place_of(const Error& error) {
    return error.code == Errc::kCancelled ? 0 : error.bit_offset;
  }

  const SceneUnits& units_;
  const Request& request_;
  int threads_;
  bool in_place_;  // every point that the slices say has its place in the field
  SceneState& scene_;
  LightField& field_;
  std::uint64_t rows_;  // of the base and of all slices so far
  std::vector<Task> tasks_;
  std::optional<Error> base_error_, level_error_;
};

}  // namespace

void keep_region(const Request& request, LightField& field) {
  const std::size_t planes = request.planes();
  std::size_t kept = 0;
  for (std::size_t p = 0; p < field.num_points(); ++p) {
    if (!request.in_region(field.positions[p])) continue;
    field.positions[kept] = field.positions[p];
    std::copy_n(field.components.begin() + static_cast<std::ptrdiff_t>(p * planes), planes,
                field.components.begin() + static_cast<std::ptrdiff_t>(kept * planes));
    if (field.normals.bits > 0) field.normals.octahedral[kept] = field.normals.octahedral[p];
    ++kept;
  }
  field.positions.resize(kept);
  field.components.resize(kept * planes);
  field.normals.octahedral.resize(field.normals.bits > 0 ? kept : 0);
}

Result<Done> decode_slices(const SceneUnits& units, const Request& request,
                           const std::vector<std::uint8_t>& chosen, int threads, SceneState& scene,
                           DecodeSeconds& seconds, LightField& field) {
  return SceneDecoder(units, request, chosen, threads, scene, field).decode(seconds);
}

}  // namespace slf
