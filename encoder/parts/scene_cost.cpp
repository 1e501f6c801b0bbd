// SPDX-License-Identifier: Apache-2.0
// What the work on a scene takes, and whether there is as much.
#include <algorithm>

#include "encoder/parts/planned_scene.h"

namespace slf {
namespace {

InputError too_little(const char* what, std::uint64_t bytes, const SceneWork& work,
                      const std::string& instead) {
  const auto mebibytes = [](std::uint64_t x) { return std::to_string(x >> 20) + " MiB"; };
  return {Errc::kLimitExceeded, what + mebibytes(bytes) + ", more than the " +
                                    mebibytes(work.memory) + " of --memory: " + "give " + instead +
                                    "more --memory"};
}

}  // namespace

namespace {

/// Work on slices of so many points.
std::uint64_t slice_memory(const ScenePlan& plan, double slice_points) {
  constexpr double kObservation = 2 * 24, kViews = 40, kBlockPoints = 24;
  const double points = std::max(kWithAround * slice_points, 2.0 * kPlanSample),
               functions = plan.fit.basis.num_functions();
  double bytes = double(64 << 20) + 16.0 * double(plan.points()) +  // codes, cells
                 points * (64 + 12 * 4 * functions);                // coefficients, planes, rows
  if (!plan.cameras.empty()) {
    bytes += points * kObservation * std::min(kViews, double(plan.cameras.size())) +
             points / kBlockPoints * 4 * functions * functions;  // blocks' sums
    if (plan.fit.pictures.rounds > 0) bytes += double{3 << 28};  // encoder/fit/picture_views.cpp
  }
  return static_cast<std::uint64_t>(bytes);
}

std::uint32_t largest_slice(const ScenePlan& plan) {
  std::uint32_t largest = 0;
  for (const PlannedSlice& slice : plan.slices) largest = std::max(largest, slice.points);
  return largest;
}

}  // namespace

SceneCost cost_of(const ScenePlan& plan) {
  SceneCost cost;
  cost.points = plan.points();
  cost.slices = plan.slices.size();
  cost.cameras = plan.cameras.size();
  cost.memory = slice_memory(plan, largest_slice(plan));
  cost.planning = plan.planning_bytes;
  cost.seconds = plan.seconds;
  cost.disk = cost.points * 32;
  return cost;
}

Result<Done, InputError> check_memory(const ScenePlan& plan, const SceneWork& work) {
  const SceneCost cost = cost_of(plan);
  if (cost.memory <= work.memory) return Done{};
  // Smaller slices help as long as they are what takes the memory.
  const bool smaller_help = slice_memory(plan, 0) <= work.memory;
  return too_little(
      "a slice takes ", cost.memory, work,
      smaller_help ? "--slice-points below " + std::to_string(largest_slice(plan)) + ", or " : "");
}

Result<Done, InputError> check_planning(const ScenePlan& plan, const SceneWork& work) {
  if (plan.planning_bytes <= work.memory) return Done{};
  return too_little("putting all points on the grid takes ", plan.planning_bytes, work, "");
}

}  // namespace slf
