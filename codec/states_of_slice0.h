// SPDX-License-Identifier: Apache-2.0
// What slice 0 leaves after each of its units, for the slices that start from it. Spec 7.3, 8.1.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "attributes/coefficient_models.h"
#include "base/monitor.h"
#include "geometry/occupancy_states.h"

namespace slf {

/// Slice 0 is worked on by one thread while others wait for what they need of it. Whoever runs the
/// slices has to begin with slice 0.
template <class States>
class SharedStates {
 public:
  /// units: the most that slice 0 has.
  explicit SharedStates(std::size_t units) : states_(units) {}

  void publish(std::size_t unit, States states) {
    monitor_.change([&] { states_[unit] = std::move(states); });
  }

  /// Nothing else will be published.
  void close() {
    monitor_.change([&] { closed_ = true; });
  }

  /// @return those after the unit of slice 0; nullptr where it failed before.
  const States* wait(std::size_t unit) {
    monitor_.wait([&] { return closed_ || states_[unit].has_value(); });
    return states_[unit] ? &*states_[unit] : nullptr;
  }

 private:
  std::vector<std::optional<States>> states_;  // [units] once set, never changed
  bool closed_ = false;
  Monitor monitor_;
};

/// Also where a step throws: others would wait for ever.
template <class States>
struct CloseAtEnd {
  SharedStates<States>& states;
  bool leads;  ///< is it slice 0 that ends?
  ~CloseAtEnd() {
    if (leads) states.close();
  }
};

/// By place in the list of slice 0's units.
struct StatesOfSlice0 {
  explicit StatesOfSlice0(std::size_t units) : geometry(units), coefficients(units) {}

  SharedStates<OccupancyStates> geometry;
  SharedStates<CoefficientStates> coefficients;
};

}  // namespace slf
