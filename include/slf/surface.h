// SPDX-License-Identifier: Apache-2.0
// Which surface is coded: the capture's own, or one that photographs mend or train.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "slf/refine.h"

namespace slf {

enum class Surface : std::uint8_t {
  kGiven,    ///< the capture's points: scans, exact models
  kMended,   ///< moved to where photographs agree (RefineGeometry::kOn)
  kTrained,  ///< trained by photographs, from the capture's points on
  kAuto,     ///< what predicts held-out input photographs best: one of those above, or splats
  kSplats,   ///< no surface: trained splats, translucent, of any size (slf/gaussians.h)
};

/// Where the points are from that a surface starts with.
enum class StartId : std::uint8_t {
  kPoints,  ///< the capture's own
  kHull,    ///< of the object's outlines: of masks, of alpha, or before an even background
  kVolume,  ///< points anywhere in what the cameras look at
};

/// A file of some photographs, for others; bytes 0: none was made.
struct TrialFile {
  double psnr = 0, ssim = 0;  ///< of all pixels
  std::size_t bytes = 0;
  double inside_psnr = 0, inside_ssim = 0;  ///< of the object's pixels; 0: no outline is known
  std::size_t splats = 0;                   ///< of a file of these
};

/// What became of the capture's points before anything else. PSNRs are of input photographs that
/// were held out, all of their pixels, drawn from a quick fit to the others; 0: not judged.
struct SurfaceReport {
  StartId start = StartId::kPoints;
  Surface kept = Surface::kGiven;
  RefineReport mended;
  std::string untrained;    ///< why nothing was trained; empty: it was
  std::size_t surfels = 0;  ///< that were trained
  std::size_t points_before = 0, points_after = 0;
  double before_psnr = 0;  ///< of the points as given, or mended where those are better
  double trained_psnr = 0;
  TrialFile as_splats;   ///< where they may be chosen and were tried
  TrialFile as_surface;  ///< of the best surface, where splats are near it: by its whole fit
  std::vector<TrialFile> more_splats;  ///< trials of more and more of them, in their order
  double seconds_train = 0, seconds_judge = 0;

  double seconds() const { return mended.seconds + seconds_train + seconds_judge; }
};

/// "given", "mended", "trained", "auto"
const char* word_of(Surface surface);
/// "points", "hull", "volume"
const char* word_of(StartId start);

}  // namespace slf
