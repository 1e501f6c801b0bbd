// SPDX-License-Identifier: Apache-2.0
// Whether a mended surface predicts photographs that did not make it.
#pragma once

#include <limits>

#include "encoder/refine/held_out.h"
#include "encoder/refine/mending_job.h"

namespace slf {

/// A surface that may take the place of the capture's.
struct Candidate {
  SurfacePoints points;
  double error = std::numeric_limits<double>::infinity();  ///< mean square of held-out photographs,
                                                           ///< what is uncovered counted
  bool torn = false;  ///< too much is uncovered for what is gained
  std::size_t kept_back = 0;
  MendingLattice on;
};

/// job.start inside of the object's hull, where that helps; its errors.
/// @param given  those of job.start
/// @errors those of observe
Result<HeldOutErrors, InputError> carve_start(MendingJob& job, const HeldOutErrors& given);

/// Mean square of held-out photographs, sampled, before another background: what is uncovered of
/// the object counts as much as another colour.
/// @errors those of observe
Result<double, InputError> quick_error(const MendingJob& job, const SurfacePoints& mended);

/// Mended where that helps, on the lattice of the grid; without points where nothing is left.
/// @param before  errors at job.start
/// @errors those of observe
Result<Candidate, InputError> judge_mended(const MendingJob& job, const HeldOutErrors& before,
                                           const SurfacePoints& mended);

}  // namespace slf
