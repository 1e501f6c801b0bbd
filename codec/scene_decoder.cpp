#include "codec/scene_decoder.h"

#include <algorithm>
#include <atomic>
#include <optional>

#include "base/huge_pages.h"
#include "base/stopwatch.h"
#include "codec/decode_cost.h"
#include "codec/slice_decoder.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// A slice on its way, and the error that ended it.
struct Task {
  SliceDecoder slice;
  std::size_t begin = 0, end = 0;  ///< points of the light field
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
  SceneDecoder(const SceneUnits& units, const SequencePlan& plan, const Base& base,
               const std::vector<std::uint8_t>& chosen, int threads, LightField& field)
      : plan_(plan),
        base_cells_(plan.has_base() ? base.cells.size() : 0),
        threads_(threads),
        field_(field),
        lead_(PartList(plan.set, false).size()) {
    SliceLead* lead = plan.table.shared() ? &lead_ : nullptr;
    for (std::size_t s = 0; s < units.slices.size(); ++s)
      if (chosen[s])
        tasks_.push_back({SliceDecoder(plan, base, units.slices[s], s, lead), 0, 0, {}});
  }

  /// Values of a batch beside the geometry of the next.
  Result<bool> decode(DecodeSeconds& seconds) {
    Stopwatch watch;
    std::span<Task> now;
    for (std::size_t at = 0; at < tasks_.size() || !now.empty();) {
      const std::span<Task> next = std::span(tasks_).subspan(at, batch_size(at));
      run(now, next);
      if (plan_.region && !now.empty()) keep_region(plan_, now.front().begin, field_);
      if (at == 0 && !next.front().error) reserve_points();
      SLF_CHECK(check_rows(next));
      append_points(next);
      at += next.size();
      (now.empty() ? seconds.geometry : seconds.coefficients) += watch.lap();
      now = next;
    }
    return finish();
  }

 private:
  std::size_t batch_size(std::size_t begin) const {
    std::size_t count = 0, points = 0;
    const auto least = static_cast<std::size_t>(thread_count(threads_, tasks_.size() - begin));
    for (; begin + count < tasks_.size(); ++count) {
      points += tasks_[begin + count].slice.points();
      if (count >= least && points > kBatchPoints) break;
    }
    return count;
  }

  void run(std::span<Task> values, std::span<Task> geometry) {
    parallel_ranges(values.size() + geometry.size(), 1, threads_,
                    [&](std::size_t begin, std::size_t end) {
                      for (std::size_t i = begin; i < end; ++i)
                        if (i < values.size()) {
                          decode_values(values[i], values.size() > 1 ? 1 : threads_);
                        } else {
                          decode_geometry(geometry[i - values.size()]);
                        }
                    });
  }

  bool is_first(const Task& task) const { return &task == &tasks_.front(); }

  void decode_geometry(Task& task) {
    const CloseAtEnd<OccupancyStates> close{lead_.geometry, is_first(task)};
    task.run([&] { return task.slice.decode_geometry(); });
  }

  void decode_values(Task& task, int plane_threads) {
    const CloseAtEnd<CoefficientStates> close{lead_.coefficients, is_first(task)};
    const std::size_t count = task.end - task.begin, planes = plan_.planes();
    const auto components =
        std::span(field_.components).subspan(task.begin * planes, count * planes);
    std::span<std::array<std::uint16_t, 2>> normals;
    if (field_.normals.bits > 0) {
      normals = std::span(field_.normals.octahedral).subspan(task.begin, count);
      task.run([&] { return task.slice.decode_normals(normals); });
    }
    task.run([&] { return task.slice.decode_components(components, plane_threads); });
    if (count > 0) task.run([&] { return task.slice.check_digest(components, normals); });
    if (!task.error) task.slice.add_means(components);
    task.slice.drop();
  }

  /// Room for all points that the slices say there are: within the limits (check_limits), and on
  /// pages that are not there until they are used.
  void reserve_points() {
    if (plan_.kept_levels_only() || plan_.region) return;
    const auto points = static_cast<std::size_t>(plan_.table.num_points());
    field_.positions.reserve(points);
    field_.components.reserve(points * plan_.planes());
    advise_huge_pages(field_.components.data(), points * plan_.planes() * sizeof(std::int32_t));
  }

  /// What was found so far, before there is room for its components.
  Result<Done> check_rows(std::span<const Task> batch) const {
    std::uint64_t rows = base_cells_ + field_.num_points();
    for (const Task& task : batch) rows += task.slice.positions.size();
    return check_level(plan_, rows);
  }

  /// Components and normals of zero.
  void append_points(std::span<Task> batch) {
    for (Task& task : batch) {
      const auto& positions = task.slice.positions;
      task.begin = field_.num_points();
      field_.positions.insert(field_.positions.end(), positions.begin(), positions.end());
      task.end = field_.num_points();
    }
    field_.components.resize(field_.num_points() * plan_.planes());
    field_.normals.octahedral.resize(field_.normals.bits > 0 ? field_.num_points() : 0);
  }

  Result<bool> finish() const {
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

  const SequencePlan& plan_;
  std::uint64_t base_cells_;
  int threads_;
  LightField& field_;
  SliceLead lead_;
  std::vector<Task> tasks_;
};

}  // namespace

void keep_region(const SequencePlan& plan, std::size_t begin, LightField& field) {
  const std::size_t planes = plan.planes();
  std::size_t kept = begin;
  for (std::size_t p = begin; p < field.num_points(); ++p) {
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

Result<bool> decode_slices(const SceneUnits& units, const SequencePlan& plan, const Base& base,
                           const std::vector<std::uint8_t>& chosen, int threads,
                           DecodeSeconds& seconds, LightField& field) {
  SceneDecoder decoder(units, plan, base, chosen, threads, field);
  return decoder.decode(seconds);
}

}  // namespace slf
