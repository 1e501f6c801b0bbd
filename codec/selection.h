// Which units of a stream a part of the light field needs. Spec 8.9.
#pragma once

#include <span>
#include <vector>

#include "bitstream/index.h"
#include "codec/base_decoder.h"
#include "codec/sequence_plan.h"

namespace slf {

class Selection {
 public:
  explicit Selection(const SequencePlan& plan)
      : plan_(plan), slice_(plan.table.slices.size(), true) {}

  /// Keeps slices that meet the region, and the one they start from.
  void choose_slices(const Base& base);
  /// The same by their boxes in an index, which may keep more. boxes: [slices]
  void choose_slices(std::span<const CellBox> boxes);

  bool all_slices() const;
  const std::vector<std::uint8_t>& slices() const { return slice_; }  ///< kept

  /// Does what was asked for need this unit of a slice, or of the base? Never a digest, which is of
  /// the whole.
  bool wants(UnitType type, const SliceUnitHeader& ids) const;

 private:
  const SequencePlan& plan_;
  std::vector<std::uint8_t> slice_;  // [slices] kept
};

/// What the sequence says of a stream with so much in it.
SequenceParameterSet cut_sequence(const SequencePlan& plan, bool all_slices);

}  // namespace slf
