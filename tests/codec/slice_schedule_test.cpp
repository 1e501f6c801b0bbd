// SPDX-License-Identifier: Apache-2.0
// Which step of which slice a thread takes next: spec 8.2 leaves the order free, memory does not.
#include "codec/decoder/slice_schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>

#include "slf/parallel.h"

namespace slf::slice_schedule_test {
namespace {

/// What was done, in the order in which it was.
struct Journal {
  std::vector<std::size_t> admitted, gathered;
  std::atomic<std::size_t> in_flight{0}, most{0}, values{0};
  std::vector<std::atomic<int>> state;  // of a slice: 1 geometry, 2 admitted, 3 values
  std::atomic<bool> base{false}, good{true};

  explicit Journal(std::size_t slices) : state(slices) {}
  void expect(bool holds) { good = good && holds; }
};

void do_geometry(SliceSchedule& schedule, Journal& journal, std::size_t slice) {
  const std::size_t now = ++journal.in_flight;
  for (std::size_t most = journal.most; now > most;)
    if (journal.most.compare_exchange_weak(most, now)) break;
  journal.expect(journal.state[slice].exchange(1) == 0);
  schedule.finish_geometry(slice, [&](std::size_t s) {
    journal.expect(journal.state[s].exchange(2) == 1);
    journal.admitted.push_back(s);
    return true;
  });
}

void do_values(SliceSchedule& schedule, Journal& journal, std::size_t slice) {
  journal.expect(journal.base && journal.state[slice].exchange(3) == 2);
  ++journal.values;
  --journal.in_flight;
  schedule.finish_values(slice, [&](std::size_t s) { journal.gathered.push_back(s); });
}

void work(SliceSchedule& schedule, Journal& journal) {
  for (SliceWork work = schedule.next(); work.step != SliceWork::kNothing; work = schedule.next()) {
    if (work.step == SliceWork::kGeometry) do_geometry(schedule, journal, work.slice);
    if (work.step == SliceWork::kValues) do_values(schedule, journal, work.slice);
    if (work.step != SliceWork::kBase) continue;
    journal.base = true;
    schedule.finish_base();
  }
}

TEST(Spec_8_2_Schedule, EverySliceIsDoneInOrderAndFewAreBegun) {
  constexpr std::size_t kSlices = 200;
  for (const std::size_t threads : {1u, 2u, 5u}) {
    SliceSchedule schedule(std::vector<std::size_t>(kSlices, 1000), threads, 0);
    Journal journal(kSlices);
    parallel_ranges(threads, 1, static_cast<int>(threads), [&](std::size_t, std::size_t) {
      const StopAtEnd stop{schedule};
      work(schedule, journal);
    });
    EXPECT_TRUE(journal.good);
    EXPECT_EQ(journal.values, kSlices);
    EXPECT_EQ(journal.admitted.size(), kSlices);
    EXPECT_TRUE(std::is_sorted(journal.admitted.begin(), journal.admitted.end()));
    EXPECT_EQ(journal.gathered, journal.admitted);
    EXPECT_LE(journal.most, threads == 1 ? 1 : 2 * threads);
  }
}

TEST(Spec_8_2_Schedule, SmallSlicesAreBegunUpToTheirPointsTogether) {
  SliceSchedule schedule({10, 10, 10, 10, 10}, 1, 40);
  ASSERT_EQ(schedule.next().step, SliceWork::kBase);  // and not done: no values
  for (std::size_t s = 0; s < 4; ++s) {
    const SliceWork work = schedule.next();
    ASSERT_EQ(work.step, SliceWork::kGeometry);
    ASSERT_EQ(work.slice, s);
    schedule.finish_geometry(s, [](std::size_t) { return true; });
  }
  schedule.finish_base();
  EXPECT_EQ(schedule.next().step, SliceWork::kValues);
}

TEST(Spec_8_2_Schedule, NothingBeginsAfterASliceThatIsNotAdmitted) {
  SliceSchedule schedule({10, 10, 10}, 1, 0);
  schedule.next();
  schedule.finish_base();
  ASSERT_EQ(schedule.next().step, SliceWork::kGeometry);
  schedule.finish_geometry(0, [](std::size_t) { return false; });
  EXPECT_EQ(schedule.next().step, SliceWork::kNothing);
}

TEST(Spec_8_2_Schedule, OnlyTheLastValuesHaveAllThreads) {
  SliceSchedule schedule({10, 10}, 1, 0);
  std::vector<bool> last;
  for (SliceWork work = schedule.next(); work.step != SliceWork::kNothing; work = schedule.next()) {
    if (work.step == SliceWork::kBase) schedule.finish_base();
    if (work.step == SliceWork::kGeometry)
      schedule.finish_geometry(work.slice, [](std::size_t) { return true; });
    if (work.step != SliceWork::kValues) continue;
    last.push_back(work.last);
    schedule.finish_values(work.slice, [](std::size_t) {});
  }
  EXPECT_EQ(last, (std::vector<bool>{false, true}));
}

}  // namespace
}  // namespace slf::slice_schedule_test
