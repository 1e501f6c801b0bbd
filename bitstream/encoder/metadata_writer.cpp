// SPDX-License-Identifier: Apache-2.0
// Mirror of bitstream/metadata.cpp.
#include "bitstream/bit_writer.h"
#include "bitstream/encoder/deflate.h"
#include "bitstream/metadata.h"

namespace slf {

std::vector<std::uint8_t> write_metadata(const Metadata& metadata) {
  std::vector<std::uint8_t> text;
  for (const auto& [key, value] : metadata)
    for (const std::string* s : {&key, &value}) {
      text.insert(text.end(), s->begin(), s->end());
      text.push_back(0);
    }
  BitWriter out;
  out.ue(text.size());
  out.append(deflate(text));
  return out.take();
}

}  // namespace slf
