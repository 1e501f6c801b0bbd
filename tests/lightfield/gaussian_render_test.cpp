// SPDX-License-Identifier: Apache-2.0
// The renderer of splats against one that evaluates every splat in every pixel.
#include <gmock/gmock.h>

#include <numeric>

#include "gaussian_support.h"
#include "lightfield/harmonics.h"
#include "slf/gaussian_renderer.h"

namespace slf::gaussian_render_test {
namespace {

using test::random_gaussians;

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix turn_of(const std::array<float, 4>& q) {
  const double w = double{q[0]}, x = double{q[1]}, y = double{q[2]}, z = double{q[3]};
  return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
           {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
           {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

/// A splat as the equations of the paper put it into the picture.
struct Ellipse {
  double u, v, uu, uv, vv, opacity, depth;
  std::array<double, 3> rgb;
};

Ellipse ellipse_of(const Gaussians& g, std::size_t p, const Camera& camera) {
  const auto& b = g.positions[p];
  const Vec3 world{double{b[0]}, double{b[1]}, double{b[2]}};
  const Vec3 at = camera.in_camera(world);
  Matrix axes = turn_of(g.rotations[p]);  // columns: axes times deviations
  for (std::size_t k = 0; k < 3; ++k)
    for (auto& row : axes) row[k] *= std::exp(double{g.log_deviations[p][k]});
  const double lx = 1.3 * camera.width / (2 * camera.fx),
               ly = 1.3 * camera.height / (2 * camera.fy);
  const double x = std::clamp(at[0] / at[2], -lx, lx), y = std::clamp(at[1] / at[2], -ly, ly);
  std::array<std::array<double, 3>, 2> image{};  // of the axes
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 seen{0, 0, 0};
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j) seen[i] += camera.rotation[i][j] * axes[j][k];
    image[0][k] = camera.fx / at[2] * (seen[0] - x * seen[2]);
    image[1][k] = camera.fy / at[2] * (seen[1] - y * seen[2]);
  }
  const auto product = [&](std::size_t i, std::size_t j) {
    return std::inner_product(image[i].begin(), image[i].end(), image[j].begin(), 0.0);
  };
  const auto centre = *camera.project(world);
  Ellipse out{centre[0],
              centre[1],
              product(0, 0) + 0.3,
              product(0, 1),
              product(1, 1) + 0.3,
              1 / (1 + std::exp(-double{g.logits[p]})),
              at[2],
              {}};
  Vec3 direction = world;
  double length = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    direction[k] -= camera.centre()[k];
    length += direction[k] * direction[k];
  }
  for (double& d : direction) d /= std::sqrt(length);
  std::vector<double> row(g.num_harmonics());
  Harmonics(g.degree).evaluate(direction, row.data());
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < row.size(); ++k)
      out.rgb[c] += row[k] * double{g.harmonics[3 * (p * row.size() + k) + c]};
    out.rgb[c] = std::max(0.0, 0.5 + out.rgb[c] / std::sqrt(4 * M_PI));
  }
  return out;
}

/// Grey levels and coverage, one pixel after the other.
std::vector<std::array<double, 4>> naive(const Gaussians& g, const Camera& camera) {
  std::vector<Ellipse> splats;
  for (std::size_t p = 0; p < g.size(); ++p)
    if (camera.in_camera({double{g.positions[p][0]}, double{g.positions[p][1]},
                          double{g.positions[p][2]}})[2] > 0.05)
      splats.push_back(ellipse_of(g, p, camera));
  std::stable_sort(splats.begin(), splats.end(),
                   [](const Ellipse& a, const Ellipse& b) { return a.depth < b.depth; });
  std::vector<std::array<double, 4>> out;
  for (int row = 0; row < camera.height; ++row)
    for (int column = 0; column < camera.width; ++column) {
      double clear = 1;
      std::array<double, 4> sum{};
      for (const Ellipse& s : splats) {
        const double x = column + 0.5 - s.u, y = row + 0.5 - s.v;
        const double square =
            (s.vv * x * x - 2 * s.uv * x * y + s.uu * y * y) / (s.uu * s.vv - s.uv * s.uv);
        const double alpha = std::min(0.99, s.opacity * std::exp(-square / 2));
        if (alpha < 1.0 / 255) continue;
        if (clear * (1 - alpha) < 1e-4) break;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += 255 * clear * alpha * s.rgb[c];
        clear *= 1 - alpha;
      }
      sum[3] = 255 * (1 - clear);
      out.push_back(sum);
    }
  return out;
}

/// Looks at the origin from -z, a little turned.
Camera camera_at(double distance, int width, int height) {
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = 1.1 * height;
  camera.fy = 1.2 * height;
  camera.cx = width / 2.0 + 3.2;
  camera.cy = height / 2.0 - 1.7;
  const double c = std::cos(0.4), s = std::sin(0.4);
  camera.rotation = {{{c, 0, s}, {0, 1, 0}, {-s, 0, c}}};
  camera.translation = {0.1, 0, distance};
  return camera;
}

void expect_as_naive(const Gaussians& g, const Camera& camera) {
  RenderSettings settings;
  settings.background = {0, 0, 0};
  settings.threads = 1;
  const Rendering out = GaussianRenderer(g, settings).render(camera);
  const auto expected = naive(g, camera);
  double squares = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = out.image.data[3 * i + c] - std::clamp(expected[i][c], 0.0, 255.0);
      squares += d * d;
    }
    // A splat that one of them cuts at 1/255 and the other does not.
    ASSERT_NEAR(out.coverage[i], expected[i][3], 2.1) << i;
  }
  // Rounding to 8 bits alone is 1/12; what is left is 10 times less.
  EXPECT_LT(squares / double(3 * expected.size()), 0.1);
}

TEST(GaussianRenderer, DrawsWhatEverySplatInEveryPixelGives) {
  for (int degree = 0; degree <= 4; ++degree)
    expect_as_naive(random_gaussians(400, degree, 7), camera_at(3, 83, 61));
}

TEST(GaussianRenderer, DrawsLongSplatsAndThoseThatFillThePicture) {
  Gaussians g = random_gaussians(300, 1, 3);
  for (std::size_t p = 0; p < g.size(); ++p) {
    g.log_deviations[p][p % 3] += 2.5f;
    g.log_deviations[p][(p + 1) % 3] -= 3;
    if (p < 5) g.log_deviations[p] = {0.5f, 0.5f, 0.5f};
  }
  expect_as_naive(g, camera_at(3, 83, 61));
}

TEST(GaussianRenderer, DrawsFromAmongTheSplats) {
  expect_as_naive(random_gaussians(400, 2, 5), camera_at(0.1, 64, 64));
}

TEST(GaussianRenderer, HonoursDistortionAtCentres) {
  Camera camera = camera_at(3, 83, 61);
  camera.distortion = {-0.2, 0.05, 0.01, -0.02};
  expect_as_naive(random_gaussians(200, 1, 9), camera);
}

TEST(GaussianRenderer, IsTheSameForAnyNumberOfThreadsAndOrderOfSplats) {
  const Gaussians g = random_gaussians(9000, 1, 2);
  RenderSettings settings;
  settings.threads = 1;
  const Camera camera = camera_at(3, 150, 90);
  const Rendering one = GaussianRenderer(g, settings).render(camera);
  settings.threads = 3;
  const Rendering three = GaussianRenderer(g, settings).render(camera);
  EXPECT_EQ(one.image.data, three.image.data);
  EXPECT_EQ(one.depth, three.depth);
  EXPECT_EQ(one.coverage, three.coverage);
  Gaussians turned = g;
  std::reverse(turned.positions.begin(), turned.positions.end());
  std::reverse(turned.log_deviations.begin(), turned.log_deviations.end());
  std::reverse(turned.rotations.begin(), turned.rotations.end());
  std::reverse(turned.logits.begin(), turned.logits.end());
  for (std::size_t p = 0; p < g.size(); ++p)
    std::copy_n(g.harmonics.begin() + std::ptrdiff_t(12 * p), 12,
                turned.harmonics.end() - std::ptrdiff_t(12 * (p + 1)));
  EXPECT_EQ(GaussianRenderer(turned, settings).render(camera).image.data, one.image.data);
}

/// One splat of radius 1 at a place, of one colour.
void add_ball(Gaussians& g, const std::array<float, 3>& at, float logit, float grey) {
  g.positions.push_back(at);
  g.log_deviations.push_back({0, 0, 0});
  g.rotations.push_back({1, 0, 0, 0});
  g.logits.push_back(logit);
  for (int c = 0; c < 3; ++c) g.harmonics.push_back((grey - 0.5f) / 0.28209479f);
}

TEST(GaussianRenderer, DepthIsThatOfTheSplatWithWhichHalfIsCovered) {
  Gaussians g;
  add_ball(g, {0, 0, 1}, -0.4f, 1);  // 0.4 opaque
  add_ball(g, {0, 0, 2}, 10, 0.2f);
  Camera camera;
  camera.width = camera.height = 65;
  camera.fx = camera.fy = 60;
  camera.cx = camera.cy = 32.5;
  camera.translation = {0, 0, 3};
  RenderSettings settings;
  settings.background = {0, 0, 0};
  const Rendering out = GaussianRenderer(g, settings).render(camera);
  const std::size_t middle = 32 * 65 + 32;
  EXPECT_EQ(out.depth[middle], 5);
  EXPECT_NEAR(out.image.data[3 * middle], 255 * (0.4013 + 0.5987 * 0.99 * 0.2), 1);
  EXPECT_EQ(out.coverage[middle], 253);  // 1 - 0.5987 * 0.01
  EXPECT_EQ(out.depth[0], INFINITY);
  g.logits[1] = -0.4f;
  g.positions[1][2] = -10;  // behind the camera
  EXPECT_EQ(GaussianRenderer(g, settings).render(camera).depth[middle], INFINITY);
}

/// Is a grey splat shown that is so far before the eye, in a scene of which the rest, of this
/// radius, lies behind the eye and is not to be seen?
bool is_drawn(double depth, float radius) {
  Gaussians g;
  add_ball(g, {0, 0, 0}, 10, 0.8f);
  add_ball(g, {0, 0, -2 * radius}, -10, 1);
  Camera camera;
  camera.width = camera.height = 9;
  camera.fx = camera.fy = 20;
  camera.cx = camera.cy = 4.5;
  camera.translation = {0, 0, depth};
  return GaussianRenderer(g).render(camera).coverage[4 * 9 + 4] > 0;
}

TEST(Spec_E_6, PointsNearerThanTheLesserOfAFifthAndAFiftiethOfTheRadiusAreLeftOut) {
  for (const auto& [radius, nearest] :
       {std::pair{100.0f, 0.2}, {10.5f, 0.2}, {5.0f, 0.1}, {1.0f, 0.02}}) {
    EXPECT_TRUE(is_drawn(1.01 * nearest, radius)) << radius;
    EXPECT_FALSE(is_drawn(0.99 * nearest, radius)) << radius;
  }
  EXPECT_TRUE(is_drawn(0.202, 0));  // one place
  EXPECT_FALSE(is_drawn(0.198, 0));
}

TEST(GaussianRenderer, NothingIsTheBackground) {
  RenderSettings settings;
  settings.background = {9, 8, 7};
  const Gaussians none;
  const GaussianRenderer renderer(none, settings);
  const Rendering out = renderer.render(renderer.orbit(0, 0, 20, 10));
  EXPECT_THAT(std::vector(out.image.data.begin(), out.image.data.begin() + 3),
              testing::ElementsAre(9, 8, 7));
  EXPECT_EQ(out.coverage[0], 0);
}

TEST(GaussianRenderer, ValuesAtTheEndsOfTheirRangesAreDrawnSomehow) {
  Gaussians g = random_gaussians(600, 1, 4);
  for (std::size_t p = 0; p < g.size(); ++p) {
    if (p % 7 == 0) g.positions[p][p % 3] = p % 2 == 0 ? 3e38f : -1e20f;
    if (p % 5 == 0) g.log_deviations[p][p % 3] = p % 2 == 0 ? 40.0f : -40.0f;
    if (p % 11 == 0) g.harmonics[12 * p] = 1e4f;
    if (p % 13 == 0) g.positions[p] = {0, 0, 0};
  }
  for (const double distance : {3.0, 0.0, 1e-9}) {
    const Rendering out = GaussianRenderer(g).render(camera_at(distance, 40, 30));
    EXPECT_EQ(out.image.data.size(), 3600u);
  }
}

TEST(GaussianRenderer, AnOrbitShowsTheWholeSceneWithoutAFewSplatsFarAway) {
  Gaussians g = random_gaussians(1000, 0, 6);
  const Camera whole = GaussianRenderer(g).orbit(0.3, 20, 100, 100);
  for (int i = 0; i < 5; ++i) add_ball(g, {1000.0f + float(i), 0, 0}, 0, 1);
  const Camera same = GaussianRenderer(g).orbit(0.3, 20, 100, 100);
  EXPECT_EQ(same.translation, whole.translation);
  for (std::size_t p = 0; p < 1000; ++p) {
    const auto at = whole.project(
        {double{g.positions[p][0]}, double{g.positions[p][1]}, double{g.positions[p][2]}});
    ASSERT_TRUE(at);
    EXPECT_TRUE((*at)[0] > 0 && (*at)[0] < 100 && (*at)[1] > 0 && (*at)[1] < 100);
  }
}

TEST(GaussianRenderer, AnOrbitShowsSplatsThatAreAllInOnePlace) {
  Gaussians g;
  g.degree = 0;
  for (int i = 0; i < 2; ++i) add_ball(g, {5, 6, 7}, 10, 0.8f);
  const GaussianRenderer renderer(g);
  const Rendering out = renderer.render(renderer.orbit(0.3, 20, 60, 60));
  EXPECT_GT(out.coverage[30 * 60 + 30], 200);
  EXPECT_LT(out.coverage[0], 20) << "all of it";
}

}  // namespace
}  // namespace slf::gaussian_render_test
