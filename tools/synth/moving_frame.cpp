// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/moving_frame.h"

#include "slf/parallel.h"

namespace slf::synth {
namespace {

constexpr std::size_t kGrain = 4096;  // samples that a thread takes at a time

Vec3 doubles_of(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

Vec3 blend(const Vec3& a, const Vec3& b, const Vec3& c, const TriangleHit& hit) {
  return (1 - hit.b - hit.c) * a + hit.b * b + hit.c * c;
}

/// Is the point in a part other than `own`?
bool hidden(const MovingScene& scene, std::uint32_t own, const Vec3& at, int frame) {
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    const MovingPart& part = scene.parts[i];
    if (i == own || !part.solid || part.first_frame > frame) continue;
    const Vec3 a = part.place(part.solid->a, frame), b = part.place(part.solid->b, frame);
    const double square = dot(b - a, b - a);
    const double t = square > 0 ? std::clamp(dot(at - a, b - a) / square, 0.0, 1.0) : 0;
    if (length(at - mix(a, b, t)) < part.solid->radius) return true;
  }
  return false;
}

}  // namespace

double spacing_of(const MovingScene& scene, double points) {
  double area = 0;
  for (const MovingPart& part : scene.parts) area += area_of(part.rest);
  return std::sqrt(area / points);
}

std::vector<MaterialSample> material_samples(const MovingScene& scene, double spacing) {
  std::vector<MaterialSample> samples;
  for (std::uint32_t part = 0; part < scene.parts.size(); ++part)
    for (const SurfacePoint& point : sample_mesh(scene.parts[part].rest, spacing))
      samples.push_back({part, point, scene.parts[part].albedo(point)});
  return samples;
}

MovingFrame::MovingFrame(const MovingScene& scene, int frame, int threads) : scene_(scene) {
  std::vector<TriangleTree::Corners> triangles;
  normals_.resize(scene.parts.size());
  for (std::uint32_t i = 0; i < scene.parts.size(); ++i) {
    const MovingPart& part = scene.parts[i];
    if (part.first_frame > frame) continue;
    const PointCloud& rest = part.rest.vertices;
    std::vector<Vec3> positions(rest.positions.size());
    normals_[i].resize(positions.size());
    parallel_ranges(positions.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const SurfacePoint now =
            placed(part, {doubles_of(rest.positions[v]), doubles_of(rest.normals[v])}, frame);
        positions[v] = now.position;
        normals_[i][v] = now.normal;
      }
    });
    for (const auto& corners : part.rest.triangles) {
      triangles.push_back({positions[corners[0]], positions[corners[1]], positions[corners[2]]});
      places_.push_back({i, corners});
    }
  }
  tree_ = TriangleTree(std::move(triangles));
}

bool MovingFrame::radiance(const Ray& ray, Colour& light, double& transmittance) const {
  const auto hit = tree_.nearest(ray);
  if (!hit) return false;
  const Place& place = places_[hit->triangle];
  const std::uint32_t number = place.part;
  const std::array<std::uint32_t, 3>& corners = place.corners;
  const MovingPart& part = scene_.parts[number];
  const PointCloud& rest = part.rest.vertices;
  const auto position = [&](std::size_t k) { return doubles_of(rest.positions[corners[k]]); };
  const auto normal = [&](std::size_t k) { return doubles_of(rest.normals[corners[k]]); };
  const SurfacePoint at_rest{blend(position(0), position(1), position(2), *hit),
                             normalised(blend(normal(0), normal(1), normal(2), *hit))};
  const auto& now = normals_[number];
  const SurfacePoint point{
      ray.at(hit->t), normalised(blend(now[corners[0]], now[corners[1]], now[corners[2]], *hit))};
  light = shade(point, part.albedo(at_rest), -1 * ray.direction, part.material, scene_.lamps);
  transmittance = 0;
  return true;
}

PointCloud moved_cloud(const MovingScene& scene, const std::vector<MaterialSample>& samples,
                       int frame, int threads) {
  const auto floats = [](const Vec3& v) {
    return std::array{static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
  };
  std::vector<SurfacePoint> now(samples.size());
  std::vector<std::uint8_t> seen(samples.size());
  parallel_ranges(samples.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const MovingPart& part = scene.parts[samples[i].part];
      if (part.first_frame > frame) continue;
      now[i] = placed(part, samples[i].at_rest, frame);
      seen[i] = !hidden(scene, samples[i].part, now[i].position, frame);
    }
  });
  PointCloud cloud;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (seen[i] == 0) continue;
    cloud.positions.push_back(floats(now[i].position));
    cloud.normals.push_back(floats(now[i].normal));
    auto& colour = cloud.colours.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      colour[k] =
          static_cast<std::uint8_t>(std::lround(255 * srgb_from_linear(samples[i].albedo[k])));
  }
  return cloud;
}

}  // namespace slf::synth
