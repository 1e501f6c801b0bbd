// SPDX-License-Identifier: Apache-2.0
// Plenoptic point clouds: voxels that have a colour for each of N cameras.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "slf/encoder.h"
#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// The most views of a cloud.
inline constexpr std::size_t kMostViews = 254;

/// A property of a PLY's vertices as its header has it.
struct PlenopticProperty {
  std::string type, name;
  bool operator==(const PlenopticProperty&) const = default;
};

struct PlenopticCloud {
  Grid grid;                     ///< of a file with whole coordinates: step 1, an origin of whole
                                 ///< numbers
  std::vector<Voxel> positions;  ///< [P] Morton order, no duplicates, of grid.bits
  std::size_t views = 0;         ///< N, 1 .. kMostViews
  bool own_colour = false;       ///< points have a colour beside those of views (red, green, blue)
  /// [P][F][3], F = num_colours(): the own colour, then views in the order of the file.
  std::vector<std::uint8_t> colours;
  std::vector<Vec3> view_positions;  ///< [N] world units of the file; or empty: not known
  /// Those of the file that are positions and colours, in its order; or empty: a file has x, y, z,
  /// then red, green, blue of points, then red_0, green_0, blue_0 and on.
  std::vector<PlenopticProperty> properties;
  std::string taken;       ///< for a person: which properties were taken for views
  std::size_t merged = 0;  ///< points that fell into an occupied voxel: colours are means

  std::size_t num_points() const { return positions.size(); }
  std::size_t num_colours() const { return views + (own_colour ? 1 : 0); }
};

struct PlenopticOptions {
  std::filesystem::path views;  ///< JSON of N positions; empty: comment lines of the PLY
  int grid_bits = 0;            ///< of a cloud whose coordinates are not whole; 0: it is refused
  bool one_of_several = false;  ///< of frames: such a cloud is refused without a word of grid_bits
};

/// How many views the vertices of a PLY have: every triple of 8-bit properties in file order but
/// red, green, blue. 0: it is no plenoptic cloud, or no PLY.
std::size_t count_plenoptic_views(const std::filesystem::path& file);

/// Reads a PLY with views. Points come in Morton order, those of one place as one.
/// @param warnings  or null; receives what was taken and what was left out
/// @errors kUnreadable. kInvalidInput: names the file, the property and what would do.
Result<PlenopticCloud, InputError> read_plenoptic(const std::filesystem::path& file,
                                                  const PlenopticOptions& options,
                                                  std::vector<std::string>* warnings = nullptr);

/// Binary little endian, with the properties of the cloud, and comment lines for positions of
/// views.
/// @errors kUnwritable; kInvalidArgument: properties that are not those of such a cloud
Result<Done, InputError> write_plenoptic(const std::filesystem::path& file,
                                         const PlenopticCloud& cloud);

enum class PlenopticCoding : std::uint8_t {
  kAuto,      ///< planes; view maps where views are held out
  kPlanes,    ///< every view a function of its own: exact, or with one step
  kViewMaps,  ///< functions of direction, fitted to the views
};

struct PlenopticSettings {
  PlenopticCoding as = PlenopticCoding::kAuto;
  std::vector<int> hold_out;  ///< views that view maps are not fitted to
  /// encoder.q of kAutomaticQ: planes are exact, view maps have kPlainQ.
  EncoderSettings encoder;
  /// Bytes that coefficients of view maps may take, 12 for a function and point: the degree of
  /// harmonics is lowered to it. 0: any.
  std::uint64_t memory = (std::uint64_t{4} << 30) / 3;
  /// Bytes that all of it may take, about; the degree of harmonics is lowered to it. 0: any.
  std::uint64_t most_memory = 0;
};

struct PlenopticEncoded {
  std::vector<std::uint8_t> stream;
  PlenopticCoding as = PlenopticCoding::kPlanes;
  std::string reason;  ///< of the choice, for a person
  bool exact = false;  ///< every byte comes back
  double q = 0;        ///< grey levels; of an exact file of its planes, which bytes correct
  std::uint64_t rest_bytes = 0;  ///< of these corrections
  double seconds_fit = 0, seconds_code = 0;
};

/// @param cloud  move it in where it is not needed again: it is given up on the way
/// @errors kInvalidArgument: a setting, names it. kInvalidInput: a cloud whose parts do not go
///         together, names the part. kLimitExceeded: most_memory is not enough; those
///         of fit_view_maps and pack
/// Memory: some 18 bytes for a function and point of view maps, 25 for a colour and point of
/// planes, and 150 for a point.
Result<PlenopticEncoded, InputError> encode_plenoptic(PlenopticCloud cloud,
                                                      const PlenopticSettings& settings,
                                                      const Progress& progress = {});

/// Whether a file was made by encode_plenoptic.
bool is_plenoptic(const Metadata& metadata);

/// The cloud of a decoded file: planes to bytes, with the corrections of an exact file; view maps
/// as they look from the positions of views.
/// @param stream  the whole file, or of a file of frames the bytes of this frame: for corrections,
///                which nobody looks for where the field is a part
/// @param warnings  or null; receives what is missing of an exact file
/// @errors kInvalidInput: metadata or corrections that are damaged
Result<PlenopticCloud, InputError> decode_plenoptic(std::span<const std::uint8_t> stream,
                                                    const LightField& field,
                                                    const Metadata& metadata,
                                                    std::vector<std::string>* warnings = nullptr,
                                                    int threads = 0);

/// PSNR of Y, U, V (BT.709, full range, peak 255); infinite where nothing differs.
struct ViewQuality {
  std::array<double, 3> yuv{};
};
struct PlenopticQuality {
  std::vector<ViewQuality> views;  ///< [N]
  std::size_t points = 0;
};

/// Compares the views of two clouds.
/// @errors kInvalidInput: other points or another number of views; as encode_plenoptic()
Result<PlenopticQuality, InputError> measure_plenoptic(const PlenopticCloud& decoded,
                                                       const PlenopticCloud& original);

/// How many views the cloud has that a file was made from.
/// @errors kInvalidInput: metadata that are damaged
Result<std::size_t, InputError> count_views_of(const Metadata& metadata);

/// Indices of the views that a file's view maps were not fitted to.
std::vector<int> held_out_views(const Metadata& metadata);

}  // namespace slf
