// SPDX-License-Identifier: Apache-2.0
#include "tools/decode_cost_text.h"

#include <algorithm>

#include "slf/gaussians.h"
#include "tools/text.h"

namespace slf::tools {

namespace {

// web/viewer/packed_field.js, packed_functions.js: bytes of a point's places and discs, of its
// weights in four functions, and of a layer of the table (faces of 65 x 65, four floats).
constexpr std::uint64_t kPointBytes = 60, kWeightBytes = 24, kLayerBytes = 195 * 130 * 16;
constexpr std::uint64_t kMostPoints = std::uint64_t{1} << 40;  // headers may say more

}  // namespace

std::optional<PageMemory> page_memory(const StreamInfo& info, const DecodeCost& cost,
                                      std::size_t frames) {
  if (frames > 1 || !info.header.has_basis || has_gaussians(info.header) || info.texture_bits > 0 ||
      info.num_points > kMostPoints)
    return std::nullopt;
  auto functions = static_cast<std::uint64_t>(info.header.num_functions);
  for (const TransformInfo& t : info.transforms)  // those that are not coded have no weights
    functions -= std::min(functions, static_cast<std::uint64_t>(t.functions - t.coded_functions));
  const std::uint64_t layers = (functions + 3) / 4;
  PageMemory page;
  page.graphics = info.num_points * (kPointBytes + kWeightBytes * layers) + layers * kLayerBytes;
  page.most = cost.memory + 2 * page.graphics;  // the worker's texels, and those that go up
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
