// SPDX-License-Identifier: Apache-2.0
// Gradients of trained surfels, written by hand, against differences of the loss itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "encoder/train/draw_surfels.h"
#include "encoder/train/picture_loss.h"
#include "encoder/train/train_gaussians.h"
#include "slf/gaussian_renderer.h"

namespace slf::train_gradients_test {
namespace {

using Surfel = TrainedSurfel;

/// Numbers between -1 and 1.
class Noise {
 public:
  float next() {
    state_ = state_ * 1664525u + 1013904223u;
    return float(state_ >> 8) / float(1 << 23) - 1;
  }

 private:
  std::uint32_t state_ = 7;
};

struct Scene {
  TrainingView view;
  TrainedSurfels surfels;
};

/// A turned camera that looks at a few large overlapping discs; not a multiple of a tile in size.
/// Hiding the background costs something in half of the pixels.
/// @param depth  of the space that they are in and of their turns, over their usual ones
Scene scene(int count, float depth = 1, bool gaussian = false) {
  Noise noise;
  Scene s;
  TrainingCamera& camera = s.view.camera;
  camera.gaussian = gaussian;
  camera.width = 45, camera.height = 38;
  camera.fx = 60, camera.fy = 62, camera.cx = 23, camera.cy = 18;
  const float angle = 0.4f;
  camera.rotation = {Float3{std::cos(angle), 0, std::sin(angle)}, Float3{0, 1, 0},
                     Float3{-std::sin(angle), 0, std::cos(angle)}};
  camera.translation = {0.1f, -0.05f, 4};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t a = 0; a < 3; ++a)
      camera.centre[a] -= camera.rotation[r][a] * camera.translation[r];
  camera.depth = 4;
  s.view.background = {0.5f, 0.4f, 0.3f};
  s.view.picture = {camera.width, camera.height, {}};
  s.view.picture.value.resize(3 * s.view.picture.pixels());
  for (float& x : s.view.picture.value) x = 0.5f + 0.3f * noise.next();
  s.view.hiding.resize(s.view.picture.pixels());
  for (std::size_t i = 0; i < s.view.hiding.size(); i += 2) s.view.hiding[i] = 0.3f;
  for (int i = 0; i < count; ++i) {
    TrainedSurfel surfel;
    for (std::size_t k = 0; k < TrainedSurfel::kSize; ++k) {
      if (k == TrainedSurfel::kLogRadius + 2) continue;
      const float x = noise.next();
      surfel.value[k] = k < TrainedSurfel::kTurn        ? 0.6f * x
                        : k < TrainedSurfel::kLogRadius ? depth * x
                        : k < TrainedSurfel::kOpacity   ? -0.5f + 0.4f * x
                        : k < TrainedSurfel::kColour    ? 1.2f * x
                                                        : 0.3f * x;
    }
    surfel.value[TrainedSurfel::kLogRadius + 2] = 0.1f * float(i % 7) - 0.8f;
    if (depth < 1) {  // and so far apart that a difference changes nobody's turn
      surfel.value[0] = 0.15f * float(i * 5 % 12) - 0.8f;
      surfel.value[2] *= depth;
      surfel.value[TrainedSurfel::kTurn] = 1;
    }
    s.surfels.push_back(surfel);
  }
  return s;
}

/// Squared error, for which differences say more than for |error|, plus the spread and what hiding
/// costs.
double loss_of(const Scene& s, float spread, PlanarPicture* gradient, DrawnSurfels& drawn) {
  draw_surfels(tile_surfels(s.surfels, s.view.camera, 1), s.view, 1, drawn);
  double sum = 0;
  if (gradient != nullptr) *gradient = drawn.picture;
  for (std::size_t i = 0; i < drawn.picture.value.size(); ++i) {
    const float error = drawn.picture.value[i] - s.view.picture.value[i];
    sum += double(error) * double(error) / 2;
    if (gradient != nullptr) gradient->value[i] = error;
  }
  for (std::size_t i = 0; i < s.view.hiding.size(); ++i)
    sum += double(s.view.hiding[i]) * double(1 - drawn.transparency[i]);
  for (std::size_t i = 0; i < drawn.near.size(); ++i)
    sum += double(spread) * (double(1 - drawn.transparency[i]) * double(drawn.near_square[i]) -
                             double(drawn.near[i]) * double(drawn.near[i]));
  return sum;
}

std::vector<TrainedSurfel> gradients_of(const Scene& s, float spread, int threads) {
  DrawnSurfels drawn;
  PlanarPicture picture;
  (void)loss_of(s, spread, &picture, drawn);
  const SurfelTiles tiles = tile_surfels(s.surfels, s.view.camera, threads);
  std::vector<TrainedSurfel> gradients(s.surfels.size());
  ProjectedGradients projected;
  surfel_gradients(tiles, s.view, drawn, picture, spread, threads, projected);
  set_surfel_gradients(s.surfels, s.view.camera, tiles, projected.sums, gradients, threads);
  return gradients;
}

/// Root of the mean squared difference between both gradients over values first .. last, relative.
/// Kinks (order in depth, ends of kernels) and floats make it some hundredths.
double mismatch(std::size_t first, std::size_t last, float spread, float depth,
                bool gaussian = false) {
  Scene s = scene(12, depth, gaussian);
  for (TrainedSurfel& surfel : s.surfels)
    for (std::size_t k = 0; gaussian && k < 3; ++k) surfel.value[Surfel::kLogRadius + k] += 2.5f;
  const auto gradients = gradients_of(s, spread, 1);
  constexpr float kStep = 2e-3f;
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < s.surfels.size(); ++i)
    for (std::size_t k = first; k < last; ++k) {
      DrawnSurfels drawn;
      Scene moved = s;
      moved.surfels[i].value[k] += kStep;
      const double more = loss_of(moved, spread, nullptr, drawn);
      moved.surfels[i].value[k] -= 2 * kStep;
      const double less = loss_of(moved, spread, nullptr, drawn);
      const double difference = (more - less) / (2 * double(kStep));
      apart += std::pow(difference - double(gradients[i].value[k]), 2);
      size += difference * difference;
    }
  EXPECT_GT(size, 0);
  return std::sqrt(apart / size);
}

TEST(TrainGradientsTest, ColoursAreThoseOfDifferences) {
  EXPECT_LT(mismatch(Surfel::kColour, Surfel::kSize, 0, 1), 0.01);
}
TEST(TrainGradientsTest, OpacitiesAreThoseOfDifferences) {
  EXPECT_LT(mismatch(Surfel::kOpacity, Surfel::kColour, 0, 1), 0.02);
}
TEST(TrainGradientsTest, RadiiAreThoseOfDifferences) {
  EXPECT_LT(mismatch(Surfel::kLogRadius, Surfel::kOpacity, 0, 1), 0.03);
}
TEST(TrainGradientsTest, TurnsAreThoseOfDifferences) {
  EXPECT_LT(mismatch(Surfel::kTurn, Surfel::kLogRadius, 0, 1), 0.03);
}
TEST(TrainGradientsTest, PositionsAreThoseOfDifferences) {
  EXPECT_LT(mismatch(Surfel::kPosition, Surfel::kTurn, 0, 1), 0.03);
}
/// Flat enough that nothing is as far apart as counts no more.
TEST(TrainGradientsTest, SpreadInDepthIsThatOfDifferences) {
  EXPECT_LT(mismatch(Surfel::kPosition, Surfel::kColour, 20, 0.05f), 0.05);
}

/// Discs reach beyond the picture: a Gaussian ends in a step of 1/255 of its opacity, as 3DGS has
/// it, which differences see where pixels come over it, and gradients do not.
TEST(TrainGradientsTest, GradientsOfGaussiansAreThoseOfDifferences) {
  EXPECT_LT(mismatch(Surfel::kColour, Surfel::kSize, 0, 1, true), 0.01);
  EXPECT_LT(mismatch(Surfel::kOpacity, Surfel::kColour, 0, 1, true), 0.02);
  EXPECT_LT(mismatch(Surfel::kLogRadius, Surfel::kOpacity, 0, 1, true), 0.03);
  EXPECT_LT(mismatch(Surfel::kTurn, Surfel::kLogRadius, 0, 1, true), 0.03);
  EXPECT_LT(mismatch(Surfel::kPosition, Surfel::kTurn, 0, 1, true), 0.03);
}

/// What photographs are compared with is what a reader of the splats draws.
TEST(TrainGradientsTest, GaussiansAreThoseThatTheRendererDraws) {
  const Scene s = scene(40, 0.8f, true);
  DrawnSurfels drawn;
  draw_surfels(tile_surfels(s.surfels, s.view.camera, 1), s.view, 1, drawn);
  Camera camera;
  const TrainingCamera& c = s.view.camera;
  camera.width = c.width, camera.height = c.height;
  camera.fx = double{c.fx}, camera.fy = double{c.fy}, camera.cx = double{c.cx};
  camera.cy = double{c.cy};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t a = 0; a < 3; ++a) camera.rotation[r][a] = double{c.rotation[r][a]};
    camera.translation[r] = double{c.translation[r]};
  }
  RenderSettings settings;
  for (std::size_t a = 0; a < 3; ++a)
    settings.background[a] = std::uint8_t(std::lround(255 * double{s.view.background[a]}));
  const Gaussians splats = gaussians_of(s.surfels);
  const Rendering rendering = GaussianRenderer(splats, settings).render(camera);
  double squares = 0;
  const std::size_t pixels = drawn.picture.pixels();
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t a = 0; a < 3; ++a) {
      const double value = std::clamp(double{drawn.picture.plane(a)[i]}, 0.0, 1.0);
      squares += std::pow(255 * value - double(rendering.image.data[3 * i + a]), 2);
    }
  EXPECT_GT(10 * std::log10(255 * 255 * 3 * double(pixels) / squares), 38);
}

TEST(TrainGradientsTest, LossIsThatOfDifferences) {
  const Scene s = scene(12);
  DrawnSurfels drawn;
  draw_surfels(tile_surfels(s.surfels, s.view.camera, 1), s.view, 1, drawn);
  SimilarityBuffers buffers;
  PictureLoss loss, more, less;
  picture_loss(s.view, drawn.picture, {0.5f, 0.4f}, {}, 1, buffers, loss);
  const auto pixels = double(drawn.picture.pixels());
  double apart = 0, size = 0;
  for (std::size_t i = 0; i < drawn.picture.value.size(); i += 17) {
    constexpr float kStep = 1e-2f;
    PlanarPicture moved = drawn.picture;
    moved.value[i] += kStep;
    picture_loss(s.view, moved, {0.5f, 0.4f}, {}, 1, buffers, more);
    moved.value[i] -= 2 * kStep;
    picture_loss(s.view, moved, {0.5f, 0.4f}, {}, 1, buffers, less);
    if (std::abs(drawn.picture.value[i] - s.view.picture.value[i]) < kStep) continue;  // a kink
    const double difference = pixels * (more.value - less.value) / (2 * double(kStep));
    apart += std::pow(difference - double(loss.gradient.value[i]), 2);
    size += difference * difference;
  }
  EXPECT_LT(std::sqrt(apart / size), 0.02);
}

TEST(TrainGradientsTest, AreTheSameForAnyNumberOfThreads) {
  const Scene s = scene(300);
  const auto one = gradients_of(s, 20, 1), three = gradients_of(s, 20, 3);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].value, three[i].value) << i;
}

TEST(TrainGradientsTest, AnOpaqueSurfelHidesWhatIsBehind) {
  Scene s = scene(0);
  const Float3 towards = {std::sin(-0.4f), 0, -std::cos(0.4f)};
  s.surfels = {flat_surfel({0, 0, 0}, towards, 2, 0.99f),
               flat_surfel({0.4f, 0, 1}, towards, 2, 0.99f)};
  for (std::size_t c = 0; c < 3; ++c) s.surfels[1].value[Surfel::kColour + c] = 9;
  DrawnSurfels drawn;
  draw_surfels(tile_surfels(s.surfels, s.view.camera, 1), s.view, 1, drawn);
  const SurfelDepths depths =
      surfel_depths(tile_surfels(s.surfels, s.view.camera, 1), s.view.camera, 1);
  const std::size_t middle = 18 * 45 + 23;
  EXPECT_NEAR(drawn.picture.plane(0)[middle], 0.5f, 0.06f);
  EXPECT_LT(drawn.transparency[middle], 0.02f);
  EXPECT_EQ(depths.surfel[middle], 0u);
  EXPECT_NEAR(depths.depth[middle], 4, 0.1);
}

TEST(PictureLoss, ABoxHasTheGradientOfTheWholePictureInIt) {
  const Scene s = scene(12);
  const SurfelTiles tiles = tile_surfels(s.surfels, s.view.camera, 1);
  DrawnSurfels drawn;
  draw_surfels(tiles, s.view, 1, drawn);
  SimilarityBuffers buffers;
  PictureLoss whole, part;
  picture_loss(s.view, drawn.picture, {0.5f, 0.4f}, {}, 1, buffers, whole);
  const PictureBox box{13, 10, 9, 5};
  picture_loss(s.view, drawn.picture, {0.5f, 0.4f}, box, 1, buffers, part);
  ASSERT_EQ(part.gradient.value.size(), whole.gradient.value.size());
  int differing = 0;
  for (std::size_t c = 0; c < 3; ++c)
    for (int y = 0; y < whole.gradient.height; ++y)
      for (int x = 0; x < whole.gradient.width; ++x) {
        const auto i = std::size_t(y) * std::size_t(whole.gradient.width) + std::size_t(x);
        const float is = part.gradient.plane(c)[i], was = whole.gradient.plane(c)[i];
        const bool inside =
            x >= box.left && x < box.left + box.width && y >= box.top && y < box.top + box.height;
        EXPECT_TRUE(!inside || std::abs(is - was) < 1e-6f) << x << " " << y;
        differing += is != was;
      }
  EXPECT_GT(differing, 0) << "the box left nothing out";
}

}  // namespace
}  // namespace slf::train_gradients_test
