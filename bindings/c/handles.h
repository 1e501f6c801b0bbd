// SPDX-License-Identifier: Apache-2.0
// What the handles of the C interface are.
#pragma once

#include <memory>
#include <span>

#include "base/monitor.h"
#include "bindings/c/memory.h"
#include "lightfield/function_weights.h"
#include "lightfield/gaussian_values.h"
#include "lightfield/render/surfel_cloud.h"
#include "slf/decoder.h"
#include "slf/frame_reader.h"
#include "slf/gaussians.h"
#include "slf/slf.h"

namespace slf::capi {

/// Made when it is first asked for, whichever thread asks.
template <class Value>
class Lazy {
 public:
  template <class Make>
  const Value& get(const Make& make) const {
    monitor_.change([&] {
      if (!value_) value_.reset(new const Value(make()));
    });
    return *value_;
  }

 private:
  mutable Monitor monitor_;
  mutable std::unique_ptr<const Value> value_;
};

}  // namespace slf::capi

struct slf_stream {
  slf::capi::Allocator allocator;
  slf_reader reader{};                 // of a stream that is read in parts; read_at: none
  std::uint64_t size = 0;              // of the whole stream
  std::span<const std::uint8_t> head;  // the beginning that is known; of a stream in memory all
  slf::capi::Block block;              // where it was read
  bool complete = false;               // as far as an index tells
  slf::StreamInfo info = {};

  bool in_memory() const { return head.size() == size; }
};

struct slf_frames {
  slf::capi::Allocator allocator;
  slf::FrameReader reader;
  int threads = 1;
};

struct slf_field {
  slf::capi::Allocator allocator;
  slf::LightField field;
  int threads = 1;
  slf::capi::Lazy<slf::FunctionWeights> weights = {};
  slf::capi::Lazy<std::vector<std::array<float, 3>>> mirror_normals = {};
  slf::capi::Lazy<slf::SurfelCloud> discs = {};
  slf::capi::Lazy<slf::SplatShapes> splats = {};

  bool has_basis() const { return field.header.has_basis && field.header.num_functions > 0; }
  bool has_splats() const { return slf::has_gaussians(field.header); }
  const slf::FunctionWeights& function_weights() const {
    return weights.get([this] { return slf::FunctionWeights(field, threads); });
  }
};
