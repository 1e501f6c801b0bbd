// The decoder's main path. Spec clause 8; steps and names are mirrored in codec/pack.cpp.
#include "base/stopwatch.h"
#include "bitstream/index.h"
#include "codec/base_decoder.h"
#include "codec/decode_cost.h"
#include "codec/decode_units.h"
#include "codec/scene_decoder.h"
#include "codec/scene_units.h"
#include "codec/selection.h"
#include "codec/sequence_plan.h"
#include "slf/decoder.h"

namespace slf {
namespace {

/// Boxes of slices, where an index has them and the base is there to compare them with.
Result<Done> check_boxes_of_index(const Units& units, const SequencePlan& plan, const Base& base) {
  if (!plan.has_base() || !base.is_known(plan)) return Done{};
  const Unit* unit = units.first(UnitType::kIndex);
  if (unit == nullptr) return Done{};
  SLF_TRY(const Index index, read_index(*unit, plan.set));
  return in_unit(*unit, check_boxes(index.boxes, plan, base));
}

/// Is what comes out less than the stream was made of?
bool is_partial(const Units& units, const SequencePlan& plan) {
  return !units.complete || plan.missing || plan.set.sps_cut_flag || plan.region;
}

/// The points of the scene, with what goes with them.
Result<Done> decode_scene(const Units& units, const SceneUnits& scene, const SequencePlan& plan,
                          const DecodeOptions& options, DecodeSeconds& seconds, LightField& field) {
  Stopwatch watch;
  SLF_TRY(Base base, decode_base_geometry(scene.base, plan));  // 8.4
  SLF_CHECK(check_boxes_of_index(units, plan, base));          // 7.7
  seconds.geometry += watch.lap();
  if (plan.base_alone() || !base.is_known(plan)) {  // 8.9
    SLF_CHECK(give_out_base(scene.base, plan, options.threads, base, field));
    if (plan.region) keep_region(plan, field);
    seconds.coefficients += watch.lap();
    return Done{};
  }
  Selection selection(plan);
  selection.choose_slices(base);  // 8.9
  SLF_TRY(const CostOnThreads cost,
          check_limits_of_slices(plan, options, selection.slices()));  // 9
  SLF_TRY(const bool partial, decode_slices(scene, plan, selection.slices(), cost.threads, base,
                                            seconds, field));  // 8.2
  field.partial = field.partial || partial;
  return Done{};
}

/// Bytes of the units of a part that will be decoded, or nearly.
std::uint64_t bytes_of(const PartUnits& units, const SequencePlan& plan) {
  std::uint64_t bytes = 0;
  for (const PartUnit& unit : units)
    if (!has_values(unit.type) || plan.wants_values(unit.type, unit.header))
      bytes += unit.payload.size();
  return bytes;
}

/// Whoever wants to know how far it has come.
void watch(const SceneUnits& scene, const DecodeOptions& options, SequencePlan& plan) {
  if (!options.progress) return;
  std::uint64_t bytes = bytes_of(scene.base, plan);
  for (const PartUnits& slice : scene.slices) bytes += bytes_of(slice, plan);
  plan.watch = std::make_shared<DecodeWatch>(options.progress, bytes);
}

}  // namespace

Result<LightField> decode(std::span<const std::uint8_t> stream, const DecodeOptions& options) {
  if (stream.size() > options.limits.max_stream_bytes) return Error{Errc::kLimitExceeded, "stream"};
  SLF_TRY(const Units units, split_units(stream, options.max_bytes));  // 7.1
  SLF_TRY(const SequenceParameterSet set, find_sequence(units));       // 7.2
  return decode_units(units, set, options);
}

Result<LightField> decode_units(const Units& units, const SequenceParameterSet& set,
                                const DecodeOptions& options) {
  SLF_TRY(const SceneUnits scene, collect_units(units, set));                   // 7.3 - 7.6
  SLF_CHECK(check_index(units, set, scene.slices.size()));                      // 7.7
  SLF_CHECK(collect_metadata(units));                                           // 7.8
  SLF_TRY(SequencePlan plan, plan_sequence(units, set, scene.table, options));  // 8.2
  SLF_CHECK(check_limits(plan, options));                                       // 9
  watch(scene, options, plan);
  LightField field = empty_field(plan);
  DecodeSeconds seconds;
  field.partial = is_partial(units, plan);  // 8.9
  if (!scene.slices.empty()) SLF_CHECK(decode_scene(units, scene, plan, options, seconds, field));
  if (options.seconds != nullptr) *options.seconds = seconds;
  return field;
}

}  // namespace slf
