// SPDX-License-Identifier: Apache-2.0
#include "capture/glb_accessor.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace slf {

namespace {

constexpr std::uint64_t kMost = std::uint64_t{1} << 32;  // offsets and counts: a GLB has 32 bits

/// glTF's names of scalar types.
enum ComponentType : std::uint16_t {
  kByte = 5120,
  kUnsignedByte = 5121,
  kShort = 5122,
  kUnsignedShort = 5123,
  kUnsignedInt = 5125,
  kFloat = 5126,
};

/// Bytes; 0: no such type.
std::size_t size_of(std::uint64_t type) {
  switch (type) {
    case kByte:
    case kUnsignedByte:
      return 1;
    case kShort:
    case kUnsignedShort:
      return 2;
    case kUnsignedInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

double value_at(const std::uint8_t* bytes, std::uint64_t type, bool normalised) {
  std::uint32_t bits = 0;
  for (std::size_t i = size_of(type); i-- > 0;) bits = bits << 8 | bytes[i];
  switch (type) {
    case kByte: {
      const double value = static_cast<std::int8_t>(bits);
      return normalised ? std::max(value / 127, -1.0) : value;
    }
    case kShort: {
      const double value = static_cast<std::int16_t>(bits);
      return normalised ? std::max(value / 32767, -1.0) : value;
    }
    case kUnsignedByte:
      return normalised ? bits / 255.0 : bits;
    case kUnsignedShort:
      return normalised ? bits / 65535.0 : bits;
    case kFloat:
      return static_cast<double>(std::bit_cast<float>(bits));
    default:
      return bits;
  }
}

}  // namespace

Result<std::span<const std::uint8_t>, InputError> glb_view_bytes(const GlbData& data,
                                                                 const JsonView& view) {
  SLF_TRY(const JsonView index, view.at("buffer"));
  SLF_TRY(const JsonView buffer, glb_item(index, data.buffers, "buffer"));
  SLF_TRY(const double number, index.number());
  const auto content = data.contents.of(static_cast<std::size_t>(number));
  if (!content)
    return buffer.error("a buffer that is outside the file; export one file with all in it");
  SLF_TRY(const auto offset, glb_number(view, "byteOffset", 0, kMost));
  SLF_TRY(const auto length, glb_number(view, "byteLength", 0, kMost));
  if (offset > content->size() || length > content->size() - offset)
    return view.error("reaches beyond its buffer");
  return content->subspan(static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

Result<std::uint64_t, InputError> glb_number(const JsonView& json, const char* key,
                                             std::uint64_t otherwise, std::uint64_t most) {
  const auto found = json.find(key);
  if (!found) return otherwise;
  SLF_TRY(const double value, found->number());
  if (!(value >= 0 && value <= static_cast<double>(most)) || value != std::floor(value))
    return found->error("a whole number of 0 to " + std::to_string(most) + " is expected");
  return static_cast<std::uint64_t>(value);
}

Result<JsonView, InputError> glb_item(const JsonView& json, const JsonItems& list,
                                      const char* kind) {
  SLF_TRY(const double value, json.number());
  if (!(value >= 0 && value < static_cast<double>(list.size())) || value != std::floor(value))
    return json.error(std::string("there is no such ") + kind);
  return list[static_cast<std::size_t>(value)];
}

Result<std::vector<double>, InputError> read_accessor(const GlbData& data, const JsonView& accessor,
                                                      const char* type, std::size_t components) {
  SLF_TRY(const JsonView type_json, accessor.at("type"));
  SLF_TRY(const std::string given, type_json.string());
  if (given != type) return type_json.error(std::string(type) + " is expected");
  if (accessor.find("sparse"))
    return accessor.error(
        "sparse accessors are not read: export the mesh as PLY or OBJ (Blender, MeshLab)");
  SLF_TRY(const auto component, glb_number(accessor, "componentType", 0, kMost));
  SLF_TRY(const auto count, glb_number(accessor, "count", 0, kMost));
  SLF_TRY(const auto offset, glb_number(accessor, "byteOffset", 0, kMost));
  const std::size_t size = size_of(component) * components;
  if (size == 0) return accessor.error("componentType is none of glTF's");
  bool normalised = false;
  if (const auto found = accessor.find("normalized")) {
    SLF_TRY(normalised, found->boolean());
  }
  SLF_TRY(const JsonView index, accessor.at("bufferView"));
  SLF_TRY(const JsonView view, glb_item(index, data.buffer_views, "buffer view"));
  SLF_TRY(const auto bytes, glb_view_bytes(data, view));
  SLF_TRY(const auto stride, glb_number(view, "byteStride", size, 252));
  if (stride < size) return view.error("byteStride is less than an element");
  const std::uint64_t needed = count == 0 ? 0 : (count - 1) * stride + size;  // < 2^41
  if (offset > bytes.size() || needed > bytes.size() - offset)
    return accessor.error("reaches beyond its buffer view");
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count) * components);
  for (std::uint64_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < components; ++c)
      values.push_back(value_at(
          bytes.data() + static_cast<std::size_t>(offset + i * stride) + c * size_of(component),
          component, normalised));
  return values;
}

}  // namespace slf
