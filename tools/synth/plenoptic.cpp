// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/plenoptic.h"

#include <algorithm>
#include <numbers>
#include <numeric>

#include "slf/parallel.h"
#include "slf/plenoptic.h"
#include "tools/synth/scene.h"
#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

constexpr double kFullCells = 4095;    // of 12 bits
constexpr std::uint32_t kShare = 4;    // of the surface's voxels, one is kept
constexpr double kCameraDistance = 5;  // as in rings.cpp
constexpr double kLift = 1e-6;         // rays begin so far above the surface
constexpr double kBehind = 0.05;       // least cosine of a view that sees a voxel

/// A number of 32 bits that looks random (Steele et al., SplitMix).
std::uint32_t mixed_bits(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return static_cast<std::uint32_t>((x ^ x >> 31) >> 32);
}

/// A voxel of the lattice and the surface in it.
struct Kept {
  Voxel voxel;
  std::array<float, 3> position, normal;
};

struct RayLattice {
  Vec3 low;
  double step;
};

/// Voxels of one row of rays along an axis that the seed keeps.
void keep_row(const Scene& scene, const RayLattice& lattice, std::size_t axis, std::size_t columns,
              std::size_t row, std::uint32_t seed, std::vector<Kept>& kept) {
  const std::size_t across = (axis + 1) % 3, up = (axis + 2) % 3;
  std::vector<SurfacePoint> found;
  for (std::size_t column = 0; column < columns; ++column) {
    // Lines that no voxel is kept of are not traced: each keeps all or none of its crossings.
    const std::uint64_t line = (std::uint64_t{axis} << 42) | (std::uint64_t{row} << 21) | column;
    if (mixed_bits(line ^ std::uint64_t{seed} << 45) % kShare != 0) continue;
    Ray ray;
    ray.origin[across] = lattice.low[across] + lattice.step * static_cast<double>(column);
    ray.origin[up] = lattice.low[up] + lattice.step * static_cast<double>(row);
    ray.origin[axis] = lattice.low[axis] - 1;
    ray.direction = {0, 0, 0};
    ray.direction[axis] = 1;
    found.clear();
    scene.crossings(ray, found);
    for (const SurfacePoint& point : found) {
      const auto n = point.normal;
      const double most = std::max({std::abs(n[0]), std::abs(n[1]), std::abs(n[2])});
      if (std::abs(n[axis]) < most) continue;
      Kept k{};
      for (std::size_t i = 0; i < 3; ++i) {
        const double cell = (point.position[i] - lattice.low[i]) / lattice.step;
        k.voxel[i] = std::max(0, static_cast<std::int32_t>(std::lround(cell)));
        k.position[i] = static_cast<float>(point.position[i]);
        k.normal[i] = static_cast<float>(n[i]);
      }
      kept.push_back(k);
    }
  }
}

/// In the order of their voxels, each once.
std::vector<Kept> keep_voxels(const Scene& scene, double cells, std::uint32_t seed, int threads,
                              RayLattice& lattice) {
  const Scene::Bounds bounds = scene.bounds();
  const Vec3 extent = bounds.high - bounds.low;
  lattice = {bounds.low, std::max({extent[0], extent[1], extent[2]}) / cells};
  std::vector<Kept> all;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto lines = [&](std::size_t k) {
      return static_cast<std::size_t>(extent[k] / lattice.step + 1e-6) + 1;
    };
    std::vector<std::vector<Kept>> rows(lines((axis + 2) % 3));
    parallel_ranges(rows.size(), 8, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        keep_row(scene, lattice, axis, lines((axis + 1) % 3), row, seed, rows[row]);
    });
    for (std::vector<Kept>& row : rows) {
      all.insert(all.end(), row.begin(), row.end());
      std::vector<Kept>().swap(row);
    }
  }
  const auto by_voxel = [](const Kept& a, const Kept& b) { return a.voxel < b.voxel; };
  std::stable_sort(all.begin(), all.end(), by_voxel);
  all.erase(std::unique(all.begin(), all.end(),
                        [](const Kept& a, const Kept& b) { return a.voxel == b.voxel; }),
            all.end());
  return all;
}

Vec3 to_double(const std::array<float, 3>& v) { return {v[0], v[1], v[2]}; }

/// A byte with noise of about one grey level.
std::uint8_t noisy_byte(double display, std::uint64_t number) {
  const std::uint32_t bits = mixed_bits(number);
  double noise = 0;  // of four uniform ones
  for (int i = 0; i < 4; ++i) noise += (bits >> 8 * i & 255) / 255.0 - 0.5;
  return static_cast<std::uint8_t>(
      std::clamp(std::lround(255 * display + noise * std::sqrt(3.0)), 0l, 255l));
}

/// The own colour, then what each view sees.
void colour_point(const Scene& scene, const Kept& kept, std::span<const Vec3> views,
                  std::uint64_t number, std::uint8_t* colours) {
  const Vec3 normal = to_double(kept.normal);
  const Vec3 at = to_double(kept.position) + kLift * normal;
  std::vector<std::optional<Vec3>> seen(views.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    const Vec3 to_view = normalised(views[v] - at);
    if (!sees(to_view, normal)) continue;
    Vec3 light{0, 0, 0};
    double through = 1;
    const Ray ray{at + 1e-4 * to_view, -1 * to_view};
    if (!scene.radiance(ray, light, through)) continue;
    Vec3& colour = seen[v].emplace();
    for (std::size_t c = 0; c < 3; ++c) colour[c] = srgb_from_linear(std::min(1.0, light[c]));
  }
  const Colour albedo = scene.albedo({to_double(kept.position), normal});
  Vec3 unseen{};
  for (std::size_t c = 0; c < 3; ++c) unseen[c] = srgb_from_linear(albedo[c]);
  write_views(seen, unseen, number, colours);
}

std::vector<PlenopticProperty> property_names(std::size_t views) {
  std::vector<PlenopticProperty> names = {{"float", "x"},   {"float", "y"},     {"float", "z"},
                                          {"uchar", "red"}, {"uchar", "green"}, {"uchar", "blue"}};
  for (std::size_t v = 0; v < views; ++v)
    for (const char* channel : {"red_", "green_", "blue_"})
      names.push_back({"uchar", channel + std::to_string(v)});
  return names;
}

}  // namespace

std::vector<Vec3> view_places(int views) {
  std::vector<Vec3> places;  // Fibonacci
  for (int i = 0; i < views; ++i) {
    const double z = 1 - (2.0 * i + 1) / views;
    const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0)), across = std::sqrt(1 - z * z);
    places.push_back(kCameraDistance * Vec3{across * std::cos(turn), across * std::sin(turn), z});
  }
  return places;
}

bool sees(const Vec3& to_view, const Vec3& normal) { return dot(to_view, normal) >= kBehind; }

PlenopticCloud cloud_of_views(std::span<const Vec3> views, const Vec3& low, double step) {
  PlenopticCloud cloud;
  cloud.views = views.size();
  cloud.own_colour = true;
  cloud.properties = property_names(cloud.views);
  for (const Vec3& view : views) cloud.view_positions.push_back((1 / step) * (view - low));
  return cloud;
}

void write_views(std::span<const std::optional<Vec3>> seen, const Vec3& unseen,
                 std::uint64_t number, std::uint8_t* colours) {
  Vec3 sum{0, 0, 0};
  double count = 0;
  for (const auto& colour : seen) {
    if (!colour) continue;
    sum = sum + *colour;
    ++count;
  }
  if (count == 0) {
    sum = unseen;
    count = 1;
  }
  std::array<unsigned, 3> total{};
  for (std::size_t v = 0; v < seen.size(); ++v)
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = seen[v] ? (*seen[v])[c] : sum[c] / count;
      const std::uint8_t byte = noisy_byte(value, number * 3 * seen.size() + 3 * v + c);
      colours[3 + 3 * v + c] = byte;
      total[c] += byte;
    }
  const auto n = static_cast<unsigned>(seen.size());
  for (std::size_t c = 0; c < 3; ++c)
    colours[c] = static_cast<std::uint8_t>((total[c] + n / 2) / n);
}

Result<Done, InputError> synthesise_plenoptic(const PlenopticScene& settings,
                                              const std::filesystem::path& file,
                                              const Progress& progress) {
  const auto scene = make_scene(settings.scene);
  if (!scene)
    return InputError{Errc::kInvalidArgument,
                      "scene " + settings.scene + " has no plenoptic cloud; can, die, vase have"};
  if (settings.views < 2 || settings.views > int{kMostViews})
    return InputError{Errc::kInvalidArgument, "views: 2 to 254"};
  double cells = kFullCells;
  RayLattice lattice{};
  if (settings.points > 0) {  // the count grows with the square of the lattice
    const auto few = keep_voxels(*scene, 255, settings.seed, settings.threads, lattice);
    cells = 255 * std::sqrt(settings.points / static_cast<double>(few.size()));
  }
  if (progress) progress("points", 0);
  const std::vector<Kept> kept =
      keep_voxels(*scene, cells, settings.seed, settings.threads, lattice);
  const std::vector<Vec3> views = view_places(settings.views);
  PlenopticCloud cloud = cloud_of_views(views, lattice.low, lattice.step);
  const std::size_t row = 3 * cloud.num_colours();
  cloud.positions.reserve(kept.size());
  for (const Kept& k : kept) cloud.positions.push_back(k.voxel);
  cloud.colours.resize(kept.size() * row);
  parallel_ranges(
      kept.size(), 4096, settings.threads,
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          colour_point(*scene, kept[i], views, i + (std::uint64_t{settings.seed} << 40),
                       &cloud.colours[i * row]);
      },
      [&](std::size_t done) {
        if (progress)
          progress("colours", static_cast<double>(done) / static_cast<double>(kept.size()));
      });
  return write_plenoptic(file, cloud);
}

}  // namespace slf::synth
