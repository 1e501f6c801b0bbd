// SPDX-License-Identifier: Apache-2.0
// Adaptive states that several coders start from, and a copy that one of them works on. Spec 8.1.
#pragma once

#include <memory>
#include <utility>

namespace slf {

/// A copy is made where coding goes on, so states that only stay as they are cost nothing.
template <class States>
class StatesInUse {
 public:
  /// What begin() starts from; nullptr: fresh states.
  using Shared = std::shared_ptr<const States>;

  void start_from(Shared start) {
    start_ = std::move(start);
    own_.reset();
  }

  /// To be called before the states are used. size: what fresh states are made with.
  void begin(std::size_t size) {
    if (own_ != nullptr) return;
    own_ = start_ != nullptr ? std::make_unique<States>(*start_) : std::make_unique<States>(size);
    start_.reset();
  }

  /// The states as they are. They are not changed any more: this goes on with a copy.
  Shared share() {
    if (own_ != nullptr) start_ = std::move(own_);
    return start_;
  }

  States* operator->() { return own_.get(); }

 private:
  Shared start_;  // one of the two at most
  std::unique_ptr<States> own_;
};

}  // namespace slf
