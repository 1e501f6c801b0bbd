// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/distance_blocks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kHalo = 2;  // nodes around a block: one for smoothing, one for the gradient
constexpr int kSide = kBlockNodes + 2 * kHalo;
constexpr std::size_t kWholeNodes = std::size_t(kSide) * kSide * kSide;

std::size_t at(int x, int y, int z) {
  return (std::size_t(z) * kSide + std::size_t(y)) * kSide + std::size_t(x);
}

/// A block with what is around it.
struct Surroundings {
  std::array<float, kWholeNodes> distance{}, weight{};
};

Surroundings gather(const DistanceBlocks& all, const BlockKey& key) {
  std::array<const DistanceBlock*, 27> blocks{};
  for (int i = 0; i < 27; ++i)
    blocks[std::size_t(i)] =
        all.find({key[0] + i % 3 - 1, key[1] + i / 3 % 3 - 1, key[2] + i / 9 - 1});
  Surroundings out;
  for (int z = 0; z < kSide; ++z)
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const std::array<int, 3> node = {x - kHalo + kBlockNodes, y - kHalo + kBlockNodes,
                                         z - kHalo + kBlockNodes};
        const auto which = std::size_t(node[0] / kBlockNodes + 3 * (node[1] / kBlockNodes) +
                                       9 * (node[2] / kBlockNodes));
        if (blocks[which] == nullptr) continue;
        const auto inner = std::size_t(
            (node[2] % kBlockNodes * kBlockNodes + node[1] % kBlockNodes) * kBlockNodes +
            node[0] % kBlockNodes);
        const float weight = blocks[which]->weight[inner];
        if (!(weight > 0)) continue;
        out.weight[at(x, y, z)] = weight;
        out.distance[at(x, y, z)] = blocks[which]->distance[inner] / weight;
      }
  return out;
}

/// Means over 3^3 nodes with weights 1, 2, 1 along each axis, of nodes that have one.
void smooth(Surroundings& of) {
  std::array<float, kWholeNodes> out = of.distance;
  for (int z = 1; z + 1 < kSide; ++z)
    for (int y = 1; y + 1 < kSide; ++y)
      for (int x = 1; x + 1 < kSide; ++x) {
        if (!(of.weight[at(x, y, z)] > 0)) continue;
        float sum = 0, weights = 0;
        for (int c = -1; c <= 1; ++c)
          for (int b = -1; b <= 1; ++b)
            for (int a = -1; a <= 1; ++a) {
              const std::size_t i = at(x + a, y + b, z + c);
              if (!(of.weight[i] > 0)) continue;
              const auto weight = float((2 - std::abs(a)) * (2 - std::abs(b)) * (2 - std::abs(c)));
              sum += weight * of.distance[i];
              weights += weight;
            }
        out[at(x, y, z)] = sum / weights;
      }
  of.distance = out;
}

/// Central differences, of one side where the other is not known.
Float3 gradient(const Surroundings& of, int x, int y, int z) {
  Float3 out{};
  const std::size_t here = at(x, y, z);
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t less = at(x - (a == 0), y - (a == 1), z - (a == 2));
    const std::size_t more = at(x + (a == 0), y + (a == 1), z + (a == 2));
    const bool has_less = of.weight[less] > 0, has_more = of.weight[more] > 0;
    const float low = of.distance[has_less ? less : here];
    const float high = of.distance[has_more ? more : here];
    out[a] = (high - low) / float(std::max(int(has_less) + int(has_more), 1));
  }
  return out;
}

/// Whether the surface passes between the node and a neighbour along `axis`, nearer to the node.
bool crosses(const Surroundings& of, int x, int y, int z, std::size_t axis, float least_weight) {
  const float here = of.distance[at(x, y, z)];
  for (const int step : {-1, 1}) {
    const std::size_t i =
        at(x + step * (axis == 0), y + step * (axis == 1), z + step * (axis == 2));
    const float there = of.distance[i];
    if (of.weight[i] < least_weight || (here < 0) == (there < 0)) continue;
    const float apart = std::abs(there) - std::abs(here);
    if (apart > 0 || (apart == 0 && step > 0)) return true;
  }
  return false;
}

void find_crossings(const DistanceBlocks& all, const DistanceBlock& block, float least_weight,
                    SurfacePoints& out) {
  Surroundings of = gather(all, block.key);
  smooth(of);
  for (int z = 0; z < kBlockNodes; ++z)
    for (int y = 0; y < kBlockNodes; ++y)
      for (int x = 0; x < kBlockNodes; ++x) {
        const int i = x + kHalo, j = y + kHalo, k = z + kHalo;
        if (of.weight[at(i, j, k)] < least_weight) continue;
        Float3 normal = gradient(of, i, j, k);
        const float length = std::sqrt(dot(normal, normal));
        if (!(length > 0)) continue;
        for (float& n : normal) n /= length;
        std::size_t axis = 0;
        for (std::size_t a = 1; a < 3; ++a)
          if (std::abs(normal[a]) > std::abs(normal[axis])) axis = a;
        if (!crosses(of, i, j, k, axis, least_weight)) continue;
        out.positions.push_back(all.world(block.key, x, y, z));
        out.normals.push_back(normal);
      }
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

}  // namespace

const DistanceBlock* DistanceBlocks::find(const BlockKey& key) const {
  const auto found =
      std::lower_bound(blocks.begin(), blocks.end(), key,
                       [](const DistanceBlock& block, const BlockKey& k) { return block.key < k; });
  return found != blocks.end() && found->key == key ? &*found : nullptr;
}

SurfacePoints zero_crossings(const DistanceBlocks& distances, float least_weight, int threads) {
  constexpr std::size_t kAtOnce = 64;
  std::vector<SurfacePoints> parts((distances.blocks.size() + kAtOnce - 1) / kAtOnce);
  parallel_ranges(
      distances.blocks.size(), kAtOnce, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
          find_crossings(distances, distances.blocks[i], least_weight, parts[begin / kAtOnce]);
      });
  SurfacePoints out;
  for (const SurfacePoints& part : parts) {
    out.positions.insert(out.positions.end(), part.positions.begin(), part.positions.end());
    out.normals.insert(out.normals.end(), part.normals.begin(), part.normals.end());
  }
  out.source.resize(out.size());
  std::iota(out.source.begin(), out.source.end(), 0u);
  return out;
}

SurfacePoints without_debris(SurfacePoints points, const Lattice& lattice, std::size_t least) {
  std::vector<std::pair<BlockKey, std::uint32_t>> nodes(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t a = 0; a < 3; ++a)
      nodes[p].first[a] = std::int32_t(
          std::lround((double(points.positions[p][a]) - lattice.origin[a]) / lattice.step));
    nodes[p].second = std::uint32_t(p);
  }
  std::sort(nodes.begin(), nodes.end());
  std::vector<std::uint32_t> parent(points.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const auto& [key, p] : nodes)
    for (int i = 0; i < 27; ++i) {
      const BlockKey other = {key[0] + i % 3 - 1, key[1] + i / 3 % 3 - 1, key[2] + i / 9 - 1};
      if (!(other < key)) continue;
      const auto found = std::lower_bound(nodes.begin(), nodes.end(), std::pair{other, 0u});
      if (found == nodes.end() || found->first != other) continue;
      parent[root_of(parent, p)] = root_of(parent, found->second);
    }
  std::vector<std::size_t> size(points.size(), 0);
  for (std::uint32_t p = 0; p < points.size(); ++p) ++size[root_of(parent, p)];
  SurfacePoints out;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    if (size[root_of(parent, p)] < least) continue;
    out.positions.push_back(points.positions[p]);
    out.normals.push_back(points.normals[p]);
    out.source.push_back(std::uint32_t(out.source.size()));
  }
  return out;
}

}  // namespace slf
