// SPDX-License-Identifier: Apache-2.0
// Image-plus-geometry coding (IGC): what the paper compares with. Paper IV-F.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "slf/capture.h"
#include "slf/encoder.h"
#include "slf/error.h"
#include "slf/limits.h"
#include "slf/types.h"

namespace slf {

enum class IgcCodec : std::uint8_t {
  kHevcLowDelay = 0,  ///< the paper's: HEVC, each image predicted from earlier ones
  kHevcIntra = 1,     ///< HEVC, each image by itself
  kAv1 = 2,           ///< what a reader of today would compare with
};

enum class IgcChroma : std::uint8_t {
  k420 = 0,  ///< chroma averaged over 2 x 2 pixels, interpolated back
  k444 = 1,
};

struct IgcSettings {
  EncoderSettings slf;  ///< grid, geometry, observe, fit, search and colour: what the decoder shall
                        ///< use. Quantiser, coefficient coder and normals do not apply
  IgcCodec codec = IgcCodec::kHevcLowDelay;
  int qp = 32;  ///< HEVC: QP 0 .. 51; AV1: quality level 0 .. 63
  IgcChroma chroma = IgcChroma::k420;
  std::string speed;  ///< HEVC: an x265 preset, ultrafast .. veryslow; AV1: 0 (slow) .. 8. Empty:
                      ///< medium, or 4
};

struct IgcEncoded {
  std::vector<std::uint8_t> stream;
  std::size_t bytes_parameters = 0, bytes_geometry = 0, bytes_images = 0;  ///< sum: the stream's
  std::size_t points = 0, merged = 0;
  SurfaceReport surface;  ///< as Encoded has it
  Grid grid;              ///< Encoded
  Density density;        ///< Encoded
  double seconds_voxelise = 0, seconds_geometry = 0, seconds_images = 0;
};

/// Codes the photographs along a walk through neighbouring cameras with a video codec, and the
/// voxelised points as an .slf stream without functions. Colours are coded as 8-bit BT.709 YCbCr of
/// full range; masks and alpha are not coded, so
/// captures that have them are not for this comparison.
///
/// Calibration (K, R, t) is not in the file: the decoder takes it from the capture, by camera name.
/// Nor are normals, see IgcDecodeOptions. Both favour IGC in a comparison.
/// @param cameras  indices into capture.cameras, at least one; all images of one size
/// @errors kInvalidArgument: a setting out of range, no cameras. kInvalidInput: an image of another
///         size (names it). kUnsupported: x265 or libaom was left out of this build. Those of
///         voxelise, load_image and pack.
/// The video codec runs on one thread. What x265's slower presets do not promise of HEVC in low
/// delay: attributes/video/encoder/hevc_encoder.h.
Result<IgcEncoded, InputError> encode_igc(const Capture& capture, std::span<const int> cameras,
                                          const IgcSettings& settings,
                                          const Progress& progress = {});

struct IgcDecodeOptions {
  DecodeLimits limits;  ///< max_memory: each, of the images, of the view maps, of depth buffers
  bool estimate_normals = false;  ///< from the decoded points; else those of the capture's nearest
                                  ///< points, where it has any, which no byte of the file pays for
  int threads = 0;
};

struct IgcDecoded {
  LightField light_field;  ///< as the encoder of .slf would have coded it, without any quantiser
  std::size_t bytes_parameters = 0, bytes_geometry = 0, bytes_images = 0;
  double seconds_geometry = 0, seconds_images = 0;
  double seconds_observe = 0, seconds_fit = 0;  ///< normals count as observing
  Metadata
      metadata;  ///< the parameters of the file, without camera names; then chosen_...: the fit
};

/// Whether these are the bytes of an IGC file: looks at the signature alone.
bool is_igc(std::span<const std::uint8_t> stream);

/// Decodes geometry and images, then observes and fits: the SLF is made here.
/// @param capture  gives the calibration of the cameras that the file names, and normals; its
///                 images and masks are not touched
/// @errors kNotSlf, kTruncated, kChecksum, kOutOfRange, kInvalidInput: a damaged or foreign file;
///         cameras that the capture does not have in that size. kLimitExceeded. kUnsupported: the
///         video decoder was left out of this build. Those of observe and fit_view_maps.
/// The same for any thread count of one binary.
Result<IgcDecoded, InputError> decode_igc(std::span<const std::uint8_t> stream,
                                          const Capture& capture,
                                          const IgcDecodeOptions& options = {},
                                          const Progress& progress = {});

}  // namespace slf
