#include "codec/scene_decoder.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "base/huge_pages.h"
#include "base/stopwatch.h"
#include "codec/decode_cost.h"
#include "codec/slice_decoder.h"
#include "codec/slice_schedule.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// A slice on its way, and the error that ended it.
struct Task {
  SliceDecoder slice;
  std::size_t points = 0;                           ///< of its levels that are kept
  std::int32_t* components = nullptr;               ///< [points][planes]
  std::array<std::uint16_t, 2>* normals = nullptr;  ///< [points], where there are any
  LightField apart;  ///< where those are, and positions, until it is known where to put them
  std::optional<Error> error;

  /// Runs a step, unless one before it failed.
  template <class Step>
  void run(Step step) {
    if (error) return;
    if (auto done = step(); !done) {
      error = done.error();
      slice.drop();
    }
  }
};

class SceneDecoder {
 public:
  SceneDecoder(const SceneUnits& units, const SequencePlan& plan,
               const std::vector<std::uint8_t>& chosen, int threads, Base& base, LightField& field)
      : units_(units),
        plan_(plan),
        threads_(threads),
        in_place_(!plan.kept_levels_only() && !plan.region),
        base_(base),
        field_(field),
        rows_(plan.has_base() ? base.cells.size() : 0),
        lead_(slots_of(layout_of(plan.set), Owner::kSlice).size()) {
    SliceLead* lead = plan.table.shared() ? &lead_ : nullptr;
    for (std::size_t s = 0; s < units.slices.size(); ++s)
      if (chosen[s])
        tasks_.push_back({SliceDecoder(plan, base, units.slices[s], s, lead), 0, {}, {}, {}, {}});
  }

  Result<bool> decode(DecodeSeconds& seconds) {
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
    if (auto done = decode_base_components(units_.base, plan_, base_); !done) {
      base_error_ = done.error();
      schedule.stop();
    }
    schedule.finish_base();
  }

  bool is_first(const Task& task) const { return &task == &tasks_.front(); }

  void decode_geometry(Task& task) {
    const CloseAtEnd<OccupancyStates> close{lead_.geometry, is_first(task)};
    task.run([&] { return task.slice.decode_geometry(first_states(task)); });
  }

  /// What the octree of a slice starts from. Spec 8.4.1.
  OccupancyStates first_states(const Task& task) {
    const SliceTable& table = plan_.table;
    if (plan_.has_base() && table.apart()) return OccupancyStates(task.slice.points());
    if (table.shared() && !is_first(task)) return OccupancyStates(0);  // of slice 0, unit by unit
    if (table.shared() || tasks_.size() == 1) return std::move(base_.states);  // nobody else's
    return base_.states;
  }

  /// Room for the values of the next slice, if that is not too much.
  bool admit(Task& task) {
    const auto& positions = task.slice.positions;
    rows_ += task.points = positions.size();
    if (auto level = check_level(plan_, rows_); !level) {
      level_error_ = level.error();
      return false;
    }
    if (is_first(task) && task.error) in_place_ = false;  // room for what is not believed any more
    if (in_place_ && is_first(task)) reserve_points();
    if (in_place_) append(task, positions);
    return true;
  }

  /// Points, and components and normals of zero.
  void append(Task& task, const std::vector<Voxel>& positions) {
    field_.positions.insert(field_.positions.end(), positions.begin(), positions.end());
    make_room(task, field_);
  }

  void make_room(Task& task, LightField& field) const {
    const std::size_t before = field.components.size(), normals = field.normals.octahedral.size();
    reserve_large(field.components, before + task.points * plan_.planes());
    field.components.resize(before + task.points * plan_.planes());
    task.components = field.components.data() + before;
    if (plan_.set.sps_normal_bits == 0) return;
    field.normals.octahedral.resize(normals + task.points);
    task.normals = field.normals.octahedral.data() + normals;
  }

  void decode_values(Task& task, int plane_threads) {
    const CloseAtEnd<CoefficientStates> close{lead_.coefficients, is_first(task)};
    if (!in_place_) {
      if (is_first(task) && !plan_.region) reserve_levels(task);
      make_room(task, task.apart);
    }
    const std::span components(task.components, task.points * plan_.planes());
    const std::span normals(task.normals, task.normals == nullptr ? 0 : task.points);
    if (task.normals != nullptr) task.run([&] { return task.slice.decode_normals(normals); });
    task.run([&] { return task.slice.decode_components(components, plane_threads); });
    if (task.points > 0) task.run([&] { return task.slice.check_digest(components, normals); });
    if (!task.error) task.slice.add_means(components);
    if (!in_place_) task.apart.positions.swap(task.slice.positions);
    task.slice.drop();
  }

  /// Appends what was decoded apart: all there is, where nothing is there yet.
  void gather(Task& task) {
    if (in_place_ || task.error) return;
    LightField part = std::move(task.apart);
    part.normals.bits = field_.normals.bits;
    if (plan_.region) keep_region(plan_, part);
    if (field_.positions.empty()) {
      field_.positions.swap(part.positions);
      field_.components.swap(part.components);
      field_.normals.octahedral.swap(part.normals.octahedral);
      return;
    }
    task.points = part.num_points();
    append(task, part.positions);
    std::copy(part.components.begin(), part.components.end(), task.components);
    std::copy(part.normals.octahedral.begin(), part.normals.octahedral.end(), task.normals);
  }

  /// Room for all points that the slices say there are: within the limits (check_limits), and on
  /// pages that are not there until they are used. So nothing moves while others write to it.
  void reserve_points() {
    const auto points = static_cast<std::size_t>(plan_.table.num_points());
    reserve_large(field_.positions, points);
    reserve_large(field_.components, points * plan_.planes());
    if (plan_.set.sps_normal_bits > 0) field_.normals.octahedral.reserve(points);
  }

  /// Room for the levels kept of all slices behind those of the first, if they have as many points
  /// in proportion: more or less, where it is wrong.
  void reserve_levels(Task& task) const {
    const double share =
        1.03 * static_cast<double>(task.points) / static_cast<double>(task.slice.points());
    const auto points =
        static_cast<std::size_t>(share * static_cast<double>(plan_.table.num_points()));
    reserve_large(task.apart.components, points * plan_.planes());
  }

  Result<bool> finish() const {
    if (base_error_) return *base_error_;
    if (level_error_) return *level_error_;
    const Task* first = nullptr;
    bool partial = false;
    for (const Task& task : tasks_) {
      partial = partial || task.slice.partial;
      if (task.error && (first == nullptr || task.slice.offset < first->slice.offset))
        first = &task;
    }
    if (first != nullptr) return *first->error;
    return partial;
  }

  const SceneUnits& units_;
  const SequencePlan& plan_;
  int threads_;
  bool in_place_;  // every point that the slices say has its place in the field
  Base& base_;
  LightField& field_;
  std::uint64_t rows_;  // of the base and of all slices so far
  SliceLead lead_;
  std::vector<Task> tasks_;
  std::optional<Error> base_error_, level_error_;
};

}  // namespace

void keep_region(const SequencePlan& plan, LightField& field) {
  const std::size_t planes = plan.planes();
  std::size_t kept = 0;
  for (std::size_t p = 0; p < field.num_points(); ++p) {
    if (!plan.in_region(field.positions[p])) continue;
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

Result<bool> decode_slices(const SceneUnits& units, const SequencePlan& plan,
                           const std::vector<std::uint8_t>& chosen, int threads, Base& base,
                           DecodeSeconds& seconds, LightField& field) {
  return SceneDecoder(units, plan, chosen, threads, base, field).decode(seconds);
}

}  // namespace slf
