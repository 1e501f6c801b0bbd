// SPDX-License-Identifier: Apache-2.0
// A training that was interrupted goes on to the same bytes.
#include "encoder/train/training_checkpoint.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "encoder/train/camera_twists.h"
#include "encoder/train/train_surfels.h"
#include "traced_scene.h"

namespace slf::training_checkpoint_test {
namespace {

namespace fs = std::filesystem;

class TrainingCheckpointTest : public testing::Test {
 protected:
  static constexpr int kIterations = 500;

  static void SetUpTestSuite() {
    const test::TracedScene traced("vase", 3, 6, 64, 2000);
    const SurfacePoints points{traced.exact.positions, traced.exact.normals, {}};
    auto views = load_training_views(traced.capture, traced.cameras, points, traced.step, 0, 0);
    ASSERT_TRUE(views);
    views_ = *std::move(views);
    first_ = start_surfels(points, traced.step, views_, 300, kSolidOpacity, 0);
  }
  void SetUp() override {
    directory_ =
        fs::path(testing::TempDir()) / ("slf_training_checkpoint_" + std::to_string(getpid()));
    fs::remove_all(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  TrainSettings settings() const {
    TrainSettings s;
    s.iterations = kIterations;
    s.surfels = 600;
    s.work = directory_;
    s.checkpoint_every = 0;
    return s;
  }
  static std::vector<std::array<float, TrainedSurfel::kSize>> trained(const TrainSettings& s,
                                                                      int* steps = nullptr) {
    TrainSettings counted = s;
    int calls = 0;
    counted.progress = [&](double done) { return ++calls, !s.progress || s.progress(done); };
    TrainedSurfels surfels = first_;
    EXPECT_TRUE(train_surfels(views_, counted, surfels));
    if (steps) *steps = calls;
    std::vector<std::array<float, TrainedSurfel::kSize>> values;
    for (const TrainedSurfel& surfel : surfels) values.push_back(surfel.value);
    return values;
  }
  fs::path file() const {
    for (const auto& entry : fs::directory_iterator(directory_)) return entry.path();
    return {};
  }

  fs::path directory_;
  static inline std::vector<TrainingView> views_;
  static inline TrainedSurfels first_;
};

TEST_F(TrainingCheckpointTest, AnInterruptedTrainingComesToTheSameBytes) {
  TrainSettings whole = settings();
  whole.work.clear();
  const auto expected = trained(whole);
  for (const double at : {0.05, 0.3, 0.5, 0.9}) {
    fs::remove_all(directory_);
    TrainSettings cut = settings();
    cut.progress = [at](double done) { return done < at; };
    EXPECT_NE(trained(cut), expected);
    TrainSettings again = settings();
    again.resume = true;
    again.threads = 1;
    int steps = 0;
    EXPECT_EQ(trained(again, &steps), expected) << at;
    EXPECT_LT(steps, at < 0.2 ? 11 : 9) << "it began anew";
    EXPECT_EQ(trained(again, &steps), expected);
    EXPECT_EQ(steps, 0) << "what is done is not done again";
  }
}

TEST_F(TrainingCheckpointTest, PosesGoOnToTheSameTwists) {
  const auto twists_of = [](TrainSettings s) {
    CameraTwists twists(views_.size(), first_, 0.01);
    s.twists = &twists;
    trained(s);
    return twists.state();
  };
  TrainSettings whole = settings();
  whole.work.clear();
  const auto expected = twists_of(whole);
  EXPECT_NE(expected, CameraTwists(views_.size(), first_, 0.01).state());
  TrainSettings cut = settings();
  cut.progress = [](double done) { return done < 0.5; };
  EXPECT_NE(twists_of(cut), expected);
  TrainSettings again = settings();
  again.resume = true;
  EXPECT_EQ(twists_of(again), expected);
  int steps = 0;
  trained(again, &steps);
  EXPECT_EQ(steps, kIterations / 50) << "without poses it is another training";
}

TEST_F(TrainingCheckpointTest, WithoutResumeItBeginsAnew) {
  int steps = 0;
  trained(settings());
  trained(settings(), &steps);
  EXPECT_EQ(steps, kIterations / 50);
}

TEST_F(TrainingCheckpointTest, AnotherTrainingIsNotGoneOnWith) {
  trained(settings());
  TrainSettings other = settings();
  other.resume = true;
  other.structure = 0.3f;
  int steps = 0;
  trained(other, &steps);
  EXPECT_EQ(steps, kIterations / 50);
  other = settings();
  other.resume = true;
  views_[0].picture.value[7] += 0.5f;
  trained(other, &steps);
  views_[0].picture.value[7] -= 0.5f;
  EXPECT_EQ(steps, kIterations / 50);
}

TEST_F(TrainingCheckpointTest, ADirectoryThatCannotBeWrittenIsAnError) {
  TrainSettings s = settings();
  fs::create_directories(directory_);
  std::ofstream(directory_ / "file") << "x";
  s.work = directory_ / "file";
  TrainedSurfels surfels = first_;
  const auto result = train_surfels(views_, s, surfels);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Errc::kUnwritable);
}

TEST_F(TrainingCheckpointTest, AFileThatIsCutOrChangedIsNotRead) {
  TrainingState state;
  state.iteration = 40;
  state.surfels = {first_.begin(), first_.begin() + 3};
  state.adam.resize(3);
  state.adam.steps = 40;
  state.use.resize(3);
  const TrainingCheckpoint checkpoint(directory_, {1, 2, 3});
  ASSERT_TRUE(checkpoint.write(state));
  const auto back = checkpoint.read(100);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->iteration, 40);
  EXPECT_EQ(back->adam.steps, 40);
  EXPECT_EQ(back->surfels[2].value, state.surfels[2].value);
  EXPECT_FALSE(checkpoint.read(39)) << "more iterations than there are";
  std::ifstream in(checkpoint.file(), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  const auto read_changed = [&](const std::string& changed) {
    std::ofstream(checkpoint.file(), std::ios::binary) << changed;
    return checkpoint.read(100).has_value();
  };
  for (std::size_t size = 0; size < bytes.size(); size += 13)
    EXPECT_FALSE(read_changed(bytes.substr(0, size))) << size;
  for (std::size_t at = 0; at < bytes.size(); at += 7) {
    std::string changed = bytes;
    changed[at] = char(changed[at] ^ 1);
    EXPECT_FALSE(read_changed(changed)) << at;
  }
  EXPECT_TRUE(read_changed(bytes));
}

}  // namespace
}  // namespace slf::training_checkpoint_test
