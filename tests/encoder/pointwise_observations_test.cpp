// SPDX-License-Identifier: Apache-2.0
// Observations that are made when they are read, and what a fit makes of them.
#include "encoder/fit/pointwise_observations.h"

#include <gtest/gtest.h>

#include <cmath>

#include "encoder/component_planes.h"
#include "encoder/fit/fit_hierarchical.h"
#include "encoder/fit/fit_search.h"
#include "encoder/fit/local_observations.h"
#include "lightfield/directions.h"
#include "tests/codec/field_support.h"

namespace slf::pointwise_observations_test {
namespace {

constexpr std::size_t kCameras = 12;

/// Every point is seen by every camera, in directions of the world.
struct Scene {
  std::vector<Voxel> positions = test::sphere_cloud(5);
  Observations kept;

  Scene() {
    kept.first.push_back(0);
    for (const Voxel& v : positions) {
      for (std::size_t i = 0; i < kCameras; ++i) {
        const double turn = 0.5 * double(i);
        const Vec3 to{300 * std::cos(turn) - v[0], 300 * std::sin(turn) - v[1],
                      (i % 3 == 0 ? 200.0 : -150.0) - v[2]};
        const auto d = direction_of(to);
        kept.direction.push_back(d);
        kept.colour.push_back({100 + 3 * float(v[0]) * d[1], 80 + 40 * std::sin(d[0]), 50});
        kept.camera.push_back(static_cast<std::uint16_t>(i));
      }
      kept.first.push_back(kept.direction.size());
    }
  }

  PointwiseObservations made() const {
    return {positions.size(), kCameras, [this](std::size_t p, SeenRoom& room) {
              SeenRoom other;
              const SeenPoint seen = PointwiseObservations(kept).of(p, other);
              room.direction.assign(seen.direction.begin(), seen.direction.end());
              room.colour.assign(seen.colour.begin(), seen.colour.end());
              room.camera.assign(seen.camera.begin(), seen.camera.end());
              return room.seen();
            }};
  }
};

FitSettings settings_of(Directions directions, int environment_degree) {
  FitSettings s;
  s.method = FitMethod::kHierarchical;
  s.basis = {BasisId::kHarmonics, 2, 0, 0, 4};
  s.directions = directions;
  s.environment.degree = environment_degree;
  s.environment.radius = 4;
  s.threads = 2;
  return s;
}

TEST(PointwiseObservations, AreMirroredAsThoseThatAreKept) {
  const Scene scene;
  const auto normals = mirror_normals(Directions::kReflected, scene.positions, 0, 1);
  const Observations local = in_local(scene.kept, normals, 1);
  for (const PointwiseObservations& world : {scene.made(), PointwiseObservations(scene.kept)}) {
    const PointwiseObservations mirrored = world.mirrored_at(normals);
    EXPECT_EQ(mirrored.count(), local.direction.size());
    SeenRoom room;
    for (std::size_t p = 0; p < scene.positions.size(); ++p) {
      const SeenPoint seen = mirrored.of(p, room);
      ASSERT_EQ(seen.count(), kCameras);
      for (std::size_t i = 0; i < kCameras; ++i) {
        EXPECT_EQ(seen.direction[i], local.direction[p * kCameras + i]);
        EXPECT_EQ(seen.colour[i], local.colour[p * kCameras + i]);
        EXPECT_EQ(seen.camera[i], local.camera[p * kCameras + i]);
      }
    }
  }
}

TEST(PointwiseObservations, GiveTheSameFitInAnyPieces) {
  const Scene scene;
  for (const Directions directions : {Directions::kWorld, Directions::kReflected})
    for (const int degree : {0, 6}) {
      const FitSettings s = settings_of(directions, degree);
      const auto normals = mirror_normals(directions, scene.positions, 0, 1);
      const Observations local = in_local(scene.kept, normals, 1);
      const auto whole = *fit_view_maps(local, scene.positions, s);
      for (const std::size_t of_piece : {std::size_t{1}, std::size_t{1000}, whole.size()}) {
        auto rows = fit_hierarchical(scene.made().mirrored_at(normals), scene.positions,
                                     mirror_points(scene.positions, 0, 1), s, of_piece, {});
        std::vector<float> joined;
        for (const auto& piece : rows.pieces())
          joined.insert(joined.end(), piece.begin(), piece.end());
        EXPECT_EQ(joined, whole) << of_piece;
        const auto shifts = component_shifts(rows, 25, 1000);
        EXPECT_EQ(shifts, component_shifts(whole, 25, 1000));
        EXPECT_EQ(to_components(std::move(rows), shifts, 2), to_components(whole, shifts, 2));
      }
    }
}

TEST(PointwiseObservations, ChooseTheSameSettings) {
  const Scene scene;
  FitSettings s = settings_of(Directions::kReflected, 6);
  s.environment.radius = 0;
  const auto kept = choose_fit(scene.kept, scene.positions, s, {});
  const auto made =
      choose_fit(scene.made(), scene.positions, mirror_points(scene.positions, 0, 1), s, {});
  ASSERT_TRUE(kept && made);
  EXPECT_EQ(kept->outcome, ChosenFit::kSearched);
  EXPECT_EQ(made->psnr_chosen, kept->psnr_chosen);
  EXPECT_EQ(made->settings.environment.radius, kept->settings.environment.radius);
  EXPECT_EQ(made->settings.hierarchy.strength, kept->settings.hierarchy.strength);
}

}  // namespace
}  // namespace slf::pointwise_observations_test
