// SPDX-License-Identifier: Apache-2.0
// The decoder's main path. Spec clause 8; steps and names are mirrored in codec/encoder/pack.cpp.
#include "base/stopwatch.h"
#include "codec/decoder/base_decoder.h"
#include "codec/decoder/decode_cost.h"
#include "codec/decoder/decode_units.h"
#include "codec/decoder/frame_chain.h"
#include "codec/decoder/scene_decoder.h"
#include "slf/decoder.h"

namespace slf {
namespace {

/// The points of the scene, with what goes with them.
Result<Done> decode_scene(const Units& units, const SceneUnits& scene, const Request& request,
                          const DecodeOptions& options, DecodeSeconds& seconds, LightField& field) {
  Stopwatch watch;
  SLF_TRY(BaseState base, decode_base_geometry(scene.base, request));  // 8.4
  SLF_CHECK(check_boxes(units, scene.stream, base));                   // 7.7
  seconds.geometry += watch.lap();
  if (request.base_alone() || !base.is_known(scene.stream)) {  // 8.9
    SLF_CHECK(give_out_base(scene.base, request, options.threads, base, field));
    if (request.region) keep_region(request, field);
    seconds.coefficients += watch.lap();
    return Done{};
  }
  const auto chosen = choose_slices_by_cell(request, base);                             // 8.9
  SLF_TRY(const CostOnThreads cost, check_limits_of_slices(request, options, chosen));  // 9
  SceneState state(scene.stream, std::move(base));                                      // 8.1
  return decode_slices(scene, request, chosen, cost.threads, state, seconds, field);    // 8.2
}

}  // namespace

Result<LightField> decode(std::span<const std::uint8_t> stream, const DecodeOptions& options) {
  FrameUnits all;  // a chain of one: nothing is kept for a frame that would follow
  all.bytes = stream.size();
  return FrameChain().decode(stream, all, options);  // 7
}

Result<LightField> decode_units(const OpenStream& opened, const DecodeOptions& options,
                                const FrameContext& frame) {
  const auto& [units, scene] = opened;
  SLF_CHECK(collect_metadata(units));                                        // 7.8
  SLF_TRY(Request request, request_of(units, scene, options, frame.group));  // 7.11, 8.9
  request.reference = frame.reference;                                       // 8.12
  request.kept = frame.kept;
  if (frame.asked != nullptr) *frame.asked = request;
  SLF_CHECK(check_limits(request, options));  // 9
  LightField field = empty_field(request);
  DecodeSeconds seconds;
  field.partial = !scene.stream.complete || request.missing || request.region;  // 8.9
  if (!scene.slices.empty())
    SLF_CHECK(decode_scene(units, scene, request, options, seconds, field));  // 8.2
  if (options.seconds != nullptr) *options.seconds = seconds;
  return field;
}

}  // namespace slf
