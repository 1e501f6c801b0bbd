// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/grow_surfels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace slf {
namespace {

TEST(GrowSurfels, ASurfelThatIsPulledBecomesTwoAndOneThatShowsNothingGoes) {
  TrainedSurfels surfels = {flat_surfel({0, 0, 0}, {0, 0, 1}, 1, 0.9f),
                            flat_surfel({5, 0, 0}, {0, 0, 1}, 1, 0.001f),
                            flat_surfel({9, 0, 0}, {0, 0, 1}, 1, 0.9f)};
  AdamState state;
  state.resize(3);
  SurfelUse use;
  use.resize(3);
  use.drawn = {1, 1, 1};
  use.pull = {1, 5, 2};
  grow_surfels({.most = 3, .share = 1, .least_opacity = 0.02f}, use, state, surfels);
  ASSERT_EQ(surfels.size(), 3u);
  EXPECT_EQ(surfels[0].position(), (Float3{0, 0, 0}));
  EXPECT_LT(surfels[1].radius(0) * surfels[1].radius(1), 1);
  EXPECT_NEAR((surfels[1].position()[0] + surfels[2].position()[0]) / 2, 9, 1e-5);
  EXPECT_EQ(state.mean.size(), 3u);
  EXPECT_EQ(use.pull, (std::vector<float>{0, 0, 0}));
}

TEST(GrowSurfels, WhereThereIsNoRoomTheOneThatIsPulledLeastMakesIt) {
  for (const bool still : {false, true}) {
    TrainedSurfels surfels;
    for (const float x : {0.0f, 5.0f, 9.0f, 12.0f})
      surfels.push_back(flat_surfel({x, 0, 0}, {0, 0, 1}, 1, 0.9f));
    AdamState state;
    state.resize(4);
    SurfelUse use;
    use.resize(4);
    use.drawn = {1, 1, 1, 1};
    use.pull = {3, 1, 2, 4};
    const std::vector<std::uint8_t> moving(still ? 4 : 0, 1);
    grow_surfels({.most = 4, .share = 1, .replaced = 0.25, .moving = moving}, use, state, surfels);
    ASSERT_EQ(surfels.size(), 4u);
    const bool stays = std::any_of(surfels.begin(), surfels.end(),
                                   [](const TrainedSurfel& s) { return s.position()[0] == 5; });
    EXPECT_EQ(stays, still) << "of a scene that stands still in part none is moved";
    EXPECT_EQ(state.mean.size(), 4u);
    EXPECT_EQ(use.pull.size(), 4u);
  }
}

TEST(GrowSurfels, AnEllipsoidIsSplitAcrossItsLongestAxisAndADiscInItsPlane) {
  for (const std::size_t axes : {std::size_t(2), std::size_t(3)}) {
    TrainedSurfels surfels = {flat_surfel({0, 0, 0}, {0, 0, 1}, 1, 0.9f)};
    surfels[0].value[TrainedSurfel::kLogRadius + 2] = 1;
    AdamState state;
    state.resize(1);
    SurfelUse use;
    use.resize(1);
    use.drawn = use.pull = {1};
    grow_surfels({.most = 2, .share = 1, .axes = axes}, use, state, surfels);
    ASSERT_EQ(surfels.size(), 2u);
    EXPECT_EQ(surfels[0].position()[2] != surfels[1].position()[2], axes == 3);
  }
}

}  // namespace
}  // namespace slf
