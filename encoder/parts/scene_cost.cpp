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

SceneCost cost_of(const ScenePlan& plan) {
  constexpr double kObservation = 2 * 24, kViews = 40, kBlockPoints = 24;
  SceneCost cost;
  cost.points = plan.points();
  cost.slices = plan.slices.size();
  cost.cameras = plan.cameras.size();
  std::uint32_t largest = 0;
  for (const PlannedSlice& slice : plan.slices) largest = std::max(largest, slice.points);
  const double points = std::max(kWithAround * largest, 2.0 * kPlanSample),
               functions = plan.fit.basis.num_functions();
  double bytes = double(64 << 20) + 16.0 * double(cost.points) +  // codes, cells
                 points * (64 + 12 * 4 * functions);              // coefficients, planes, rows
  if (!plan.cameras.empty()) {
    bytes += points * kObservation * std::min(kViews, double(cost.cameras)) +
             points / kBlockPoints * 4 * functions * functions;  // blocks' sums
    if (plan.fit.pictures.rounds > 0) bytes += double{3 << 28};  // encoder/fit/picture_views.cpp
  }
  cost.memory = static_cast<std::uint64_t>(bytes);
  cost.planning = plan.planning_bytes;
  cost.seconds = plan.seconds;
  cost.disk = cost.points * 32;
  return cost;
}

Result<Done, InputError> check_memory(const ScenePlan& plan, const SceneWork& work) {
  const SceneCost cost = cost_of(plan);
  if (cost.memory <= work.memory) return Done{};
  std::uint32_t largest = 0;
  for (const PlannedSlice& slice : plan.slices) largest = std::max(largest, slice.points);
  return too_little("a slice takes ", cost.memory, work,
                    "--slice-points below " + std::to_string(largest) + ", or ");
}

Result<Done, InputError> check_planning(const ScenePlan& plan, const SceneWork& work) {
  if (plan.planning_bytes <= work.memory) return Done{};
  return too_little("putting all points on the grid takes ", plan.planning_bytes, work, "");
}

}  // namespace slf
