// SPDX-License-Identifier: Apache-2.0
#include "lightfield/view_planes.h"

#include <algorithm>

#include "slf/given_planes.h"

namespace slf {

bool needs_view_planes(const LightFieldHeader& header) {
  return !header.attributes.empty() ||
         std::any_of(header.transforms.begin(), header.transforms.end(),
                     [](const PlaneTransform& t) { return t.lanes == 1; });
}

LightFieldHeader view_header(LightFieldHeader header) {
  header.num_functions = header.num_view_functions();
  if (!header.shift.empty()) header.shift.resize(static_cast<std::size_t>(header.num_functions));
  header.attributes.clear();
  header.transforms.clear();
  header.coded.clear();
  return header;
}

std::vector<std::int32_t> view_planes(const LightField& field, int threads) {
  std::vector<std::int32_t> planes = given_planes(field, threads);
  const auto all = 3 * static_cast<std::ptrdiff_t>(field.header.num_functions),
             kept = 3 * static_cast<std::ptrdiff_t>(field.header.num_view_functions());
  if (all == kept) return planes;
  auto to = planes.begin();
  for (auto from = planes.begin(); from != planes.end(); from += all)
    to = std::copy_n(from, kept, to);
  planes.erase(to, planes.end());
  return planes;
}

}  // namespace slf
