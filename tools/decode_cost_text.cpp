// SPDX-License-Identifier: Apache-2.0
#include "tools/decode_cost_text.h"

#include <algorithm>

#include "slf/gaussians.h"
#include "tools/text.h"

namespace slf::tools {

namespace {

// web/viewer/packed_texels.js, packed_functions.js: bytes of a texel of 16 bytes, and of a layer of
// the table (faces of 65 x 65, four half floats).
constexpr std::uint64_t kTexelBytes = 16, kLayerBytes = 195 * 130 * 8;
// Means and colours of a surface's point; of a splat also more of its shape, and its turn.
constexpr std::uint64_t kSurfaceBytes = 4 + 4, kSplatBytes = 4 + 8 + 8 + 4, kMirrorBytes = 4;
constexpr std::uint64_t kFineFunctions = 4;  // usually: of those that take a second byte
// The code of the decoder and of the page, and what their heaps begin with.
constexpr std::uint64_t kPageBytes = std::uint64_t{24} << 20;
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 40;  // headers may say more

}  // namespace

std::optional<PageMemory> page_memory(const StreamInfo& info, const DecodeCost& cost,
                                      std::size_t frames) {
  if (frames > 1 || !info.header.has_basis || info.texture_bits > 0 ||
      info.num_points > kMostPoints)
    return std::nullopt;
  auto functions = static_cast<std::uint64_t>(info.header.num_functions);
  for (const TransformInfo& t : info.transforms)  // those that are not coded have no weights
    functions -= std::min(functions, static_cast<std::uint64_t>(t.functions - t.coded_functions));
  const std::uint64_t layers = (functions + 3) / 4,
                      words = 3 * layers + std::min(kFineFunctions, functions);
  std::uint64_t point = kTexelBytes * (1 + (words + 3) / 4);
  point += has_gaussians(info.header) ? kSplatBytes : kSurfaceBytes;
  if (info.header.directions == Directions::kReflected) point += kMirrorBytes;
  PageMemory page;
  page.graphics = info.num_points * point + layers * kLayerBytes;
  page.most =
      kPageBytes + cost.memory + 2 * page.graphics;  // the worker's texels, and those that go up
  return page;
}

nlohmann::ordered_json decode_cost_json(const DecodeCost& cost,
                                        const std::optional<PageMemory>& page) {
  nlohmann::ordered_json json = {
      {"memory", cost.memory}, {"memory_most", cost.memory_most}, {"work", cost.work}};
  if (page) json["page"] = {{"memory", page->most}, {"graphics", page->graphics}};
  return json;
}

std::string decode_cost_text(const DecodeCost& cost, const std::optional<PageMemory>& page) {
  std::string out = text("  decoding      takes %s MiB of memory, %s at most; %s steps at most\n",
                         grouped(cost.memory >> 20).c_str(),
                         grouped(cost.memory_most >> 20).c_str(), grouped(cost.work).c_str());
  if (page)
    out += text("  in a page     some %s MiB while it opens, then %s MiB of textures\n",
                grouped(page->most >> 20).c_str(), grouped(page->graphics >> 20).c_str());
  return out;
}

}  // namespace slf::tools
