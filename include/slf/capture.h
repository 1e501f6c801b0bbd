// SPDX-License-Identifier: Apache-2.0
// A capture: a point cloud and calibrated photographs, however they were stored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "slf/error.h"
#include "slf/points_world.h"
#include "slf/types.h"

namespace slf {

/// 8-bit image, rows top to bottom, channels interleaved, no padding.
struct Image {
  int width = 0, height = 0;
  int channels = 3;                ///< 3 (RGB) or 4 (RGBA, alpha not premultiplied)
  std::vector<std::uint8_t> data;  ///< [height][width][channels]
};

/// A pinhole camera with OpenCV axes (x right, y down, z forward): x_cam = R x_world + t.
/// Image coordinates have the corner convention: the centre of the top left pixel is (0.5, 0.5).
struct Camera {
  std::string name;  ///< the image's name within its capture; unique
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  /// Brown distortion k1, k2, p1, p2, undistorted -> distorted, as COLMAP's OPENCV model has it.
  std::array<double, 4> distortion{0, 0, 0, 0};
  std::array<std::array<double, 3>, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Vec3 translation{0, 0, 0};

  Vec3 centre() const;                   ///< -R^T t
  Vec3 in_camera(const Vec3& at) const;  ///< R at + t
  /// Image point of a world point, with distortion; nothing if it is not in front of the camera.
  /// z receives the depth along the optical axis.
  std::optional<std::array<double, 2>> project(const Vec3& world, double* z = nullptr) const;
};

/// The camera, moved with all that it sees by a vector of the world.
Camera moved(Camera camera, const Vec3& by);
/// The camera of the same photograph with sides of a 2^log2-th, rounded up.
Camera reduced(Camera camera, int log2);
inline Grid moved(Grid grid, const Vec3& by) {
  for (std::size_t k = 0; k < 3; ++k) grid.origin[k] += by[k];
  return grid;
}

/// Float point cloud.
struct PointCloud {
  std::vector<std::array<float, 3>> positions;       ///< [P] from `origin`
  std::vector<std::array<float, 3>> normals;         ///< [P] unit, outward; or empty
  std::vector<std::array<std::uint8_t, 3>> colours;  ///< [P]; or empty
  Vec3 origin{0, 0, 0};  ///< world; readers move it where floats would lose digits of the file, as
                         ///< of georeferenced scans
};

/// A surface of triangles; may be open, and may have triangles without area.
struct Mesh {
  PointCloud vertices;  ///< normals: those of the vertices; empty: of the faces
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< [F] vertices, counter-clockwise outside
};

class ImageCache;

/// Cameras and cloud are in memory; images are read when they are needed (load_image), or in memory
/// too where `images` has them.
struct Capture {
  std::filesystem::path root;
  Vec3 origin{0, 0, 0};  ///< world; cloud, mesh and cameras are given from it, and so are grids
                         ///< and points that are made of a capture. Origins of cloud and mesh are 0
  PointCloud cloud;
  bool has_geometry = true;  ///< false: cameras alone, not even a cloud without points
  Mesh mesh;  ///< what `cloud` is a sample of, one point for every voxel that the photographs
              ///< resolve; without triangles: the cloud is the capture's own
  std::vector<Camera> cameras;                     ///< in the capture's order
  std::vector<std::filesystem::path> image_files;  ///< [cameras], absolute
  std::vector<Image> images;                       ///< [cameras], in place of the files; or empty
  std::vector<std::filesystem::path>
      mask_files;  ///< [cameras] or empty: docs/captures.md, Conventions
  /// [cameras] or empty: EXIF orientations by which photographs are turned as they are read, where
  /// only so turned they have the size of the calibration; else 1.
  std::vector<int> orientation;
  /// [cameras] or empty: photographs and masks are made smaller as they are read, as reduced() has
  /// it; `cameras` are reduced already.
  std::vector<int> reduction;
  /// [cameras] or empty: factors of R, G, B that load_image multiplies display values by.
  std::vector<std::array<float, 3>> gains;
  std::shared_ptr<ImageCache> cache;               ///< what load_image keeps; or none
  std::map<std::string, std::vector<int>> splits;  ///< "dense", "evaluation", ...: camera indices
  UpAxis up = UpAxis::kPlusZ;
  std::string
      crs;  ///< what coordinates mean, as WKT: of a .prj beside the cloud, of a scan; or empty
  std::vector<std::string> warnings;  ///< one line each, for the person to read
};

/// Two corners of a box, in world units.
struct WorldBox {
  Vec3 low{0, 0, 0}, high{0, 0, 0};
};

/// What load_capture looks for, all optional.
struct CaptureOptions {
  std::filesystem::path points;  ///< the cloud or mesh, where it is not the capture's own
  bool check_images = true;      ///< open every image and compare its size with the calibration
  std::optional<WorldBox> crop = {};  ///< points and faces outside of it are left out
  bool cloud = true;          ///< false: cameras alone, as the file has them; Capture::origin is 0
  bool points_needed = true;  ///< false: a capture with cameras may have no points
  bool may_be_empty = false;  ///< true: of a PLY without vertices come no points, and no error
  /// Where the photographs are, by their names in the capture, else by those without folders.
  /// Empty: where the format has them.
  std::filesystem::path images = {};
  std::optional<WorldChange> world = {};  ///< what brings the points to the cameras; before crop
};

/// Reads a capture. `path` is a directory that holds cameras.json (shared convention), a COLMAP
/// model (cameras, images, points3D as .bin or .txt, in it, in sparse/0, sparse/1, ... or sparse),
/// transforms.json, index.cams of the surface light fields of Wood et al., cameras.xml of
/// Metashape, bundle.out of Bundler or sfm_data.json of openMVG; or one of those files; or a lone
/// .ply, .las, .laz or .e57 (a cloud without cameras). Every value is checked as `docs/captures.md`
/// lists; what is suspicious but usable becomes a warning.
/// @errors kUnreadable: a file is missing. kInvalidInput: names file and cause.
Result<Capture, InputError> load_capture(const std::filesystem::path& path,
                                         const CaptureOptions& options = {});

/// A capture that a program made in memory, and cameras of it: indices, calibrations, vectors that
/// go together, images as large as they say, finite points, faces of vertices that are there,
/// places within Grid::kMostCoordinate. What encodes a capture calls it; load_capture() gives
/// nothing else but of places. O(points + faces + cameras).
/// @errors kInvalidArgument: an index that is no camera. kInvalidInput: the rest, by name
Result<Done, InputError> check_capture(const Capture& capture, std::span<const int> cameras);

/// A coordinate reference system as well-known text (OGC 01-009, ISO 19162), of a .prj or .wkt
/// file.
/// @errors kUnreadable; kInvalidInput: something else, or over 64 KiB
Result<std::string, InputError> read_crs(const std::filesystem::path& file);

/// The image of camera i with three channels, or four where the file has alpha or a mask exists
/// (alpha = mask; an alpha that is 255 everywhere is none). 16-bit and grey files are converted.
/// Size equals the camera's, or it is an error. Thread-safe on a const capture. Reduced ones: each
/// pixel is the mean of those that it takes the place of, its alpha the least of theirs; JPEG is
/// decoded to that size. Colours are multiplied by Capture::gains, rounded, 255 at most.
/// @errors those of read_image; kInvalidInput: another size
Result<Image, InputError> load_image(const Capture& capture, int camera);

/// Those of the cameras whose mask or alpha shows no pixel of the object. Photographs that cannot
/// be read are none of them.
std::vector<int> cameras_without_object(const Capture& capture, std::span<const int> cameras,
                                        int threads = 0);

/// Camera indices of a split. "" and "default" mean `dense` where the capture names splits, else
/// all but every fourth; "1/n" is every n-th of those that are not for evaluation; "all" is every
/// camera; "evaluation" is the named split, else every fourth.
/// @errors kInvalidArgument: no such split.
Result<std::vector<int>, InputError> split_cameras(const Capture& capture, const std::string& name);

/// PNG (8 and 16 bit; grey, RGB, palette, alpha), JPEG, PPM or PGM, by content.
/// @errors kUnreadable; kInvalidInput: something else, damaged, or larger than 65535 a side
Result<Image, InputError> read_image(const std::filesystem::path& file);
/// Written to a temporary name beside `file` and renamed. "-" is standard output.
/// @errors kUnwritable: what was there before is untouched
Result<Done, InputError> write_png(const std::filesystem::path& file, const Image& image);

/// PLY, ascii or binary of either endianness, properties by name. Extra properties are skipped with
/// one warning appended to `warnings`.
/// @errors as read_mesh
Result<PointCloud, InputError> read_ply(const std::filesystem::path& file,
                                        std::vector<std::string>* warnings = nullptr);
/// PLY (its faces; none: a cloud), OBJ, STL or GLB, by the name's extension; LAS and E57; LAZ with
/// the program `pdal` of PDAL where it is on PATH (docs/captures.md). Polygons are taken apart
/// into fans; nodes of a GLB are put where they stand; materials, textures and points that no face
/// has are left out.
/// @errors kUnreadable. kUnsupported: LAZ without PDAL.
///         kInvalidInput: names the file, the face or vertex and the cause: an index
///         that is no vertex, a coordinate that is not finite, a damaged file, no vertices.
///         Bounded: OBJ, STL, GLB files of up to 2 GiB, scenes of up to 2^24 triangles.
Result<Mesh, InputError> read_mesh(const std::filesystem::path& file,
                                   std::vector<std::string>* warnings = nullptr);
/// Ends PDAL where read_mesh() waits for it: for handlers of signals that end the
/// process.
void end_other_program() noexcept;
/// Binary little endian; positions are doubles where the cloud's origin is not 0, else floats.
/// Atomic like write_png; "-" is standard output.
/// @errors kUnwritable
Result<Done, InputError> write_ply(const std::filesystem::path& file, const PointCloud& cloud);

/// All bytes to a temporary file beside `file`, flushed, renamed over it. "-" is standard output.
/// @errors kUnwritable
Result<Done, InputError> write_file(const std::filesystem::path& file, const void* data,
                                    std::size_t size);
/// The same of bytes that are not in one place: pieces, one after the other.
Result<Done, InputError> write_file(const std::filesystem::path& file,
                                    std::span<const std::span<const std::byte>> pieces);
/// All bytes of a file; "-" is standard input.
/// @errors kUnreadable; kLimitExceeded: more than max_bytes
Result<std::vector<std::uint8_t>, InputError> read_file(const std::filesystem::path& file,
                                                        std::uint64_t max_bytes = std::uint64_t{1}
                                                                                  << 32);

/// Normals by PCA over the k nearest points (nanoflann), turned towards `viewpoints` (those that
/// see a point decide, found with a coarse depth map; where they do not say, its neighbours do; no
/// viewpoints: away from the centroid). Unit length. Viewpoints are from the cloud's origin.
/// The same for any thread count. O(P log P).
std::vector<std::array<float, 3>> estimate_normals(const PointCloud& cloud,
                                                   const std::vector<Vec3>& viewpoints, int k = 16,
                                                   int threads = 0);

/// Whether points are made up between those of a cloud that is coarser than the photographs.
enum class Densify : std::uint8_t {
  kOff,
  kOn,    ///< wherever the grid is finer than the cloud
  kAuto,  ///< of automatic grids: where enough pixels lie between points that lie on a surface,
          ///< evenly
};

struct DensifySettings {
  Densify mode = Densify::kOff;
  double from = 2;  ///< kAuto: pixels between neighbouring points, 1 or more
};

/// How finely the photographs of a capture resolve its surface, and what grid follows from that.
struct Density {
  double pixel = 0;    ///< world units that a pixel spans on the surface, in the sharpest view of a
                       ///< point (median over points); 0: no camera sees the cloud
  double spacing = 0;  ///< between neighbouring points of the cloud, world units (median); 0: a
                       ///< surface, which has points anywhere
  double voxel_size = 0;          ///< a pixel where points are merged, else half a spacing
  bool merged = false;            ///< the cloud has more points than the photographs resolve
  bool limited_by_cloud = false;  ///< the photographs would resolve more than the cloud has
  bool densified = false;         ///< points were made up between the cloud's own
};

/// Without cameras, or where they see nothing, half of the cloud's own spacing.
/// @param cameras  the input cameras, which check_capture() accepts
/// The same for any thread count. O(cameras + log P) for each of a sample of points.
Density choose_density(const Capture& capture, std::span<const int> cameras,
                       DensifySettings densify = {});

/// A cloud on the grid: Morton order, duplicates merged.
struct VoxelCloud {
  Grid grid;
  std::vector<Voxel> positions;               ///< [P] Morton order, x least significant
  std::vector<std::array<float, 3>> normals;  ///< [P] mean of the merged, renormalised; or empty
  std::vector<std::array<float, 3>> colours;  ///< [P] mean of the merged, 0 .. 255; or empty
  std::size_t merged = 0;                     ///< points that fell into an occupied voxel
  Density density;                            ///< of a capture: voxelise_geometry
};

/// voxel = floor((x - min) / step + 1/2), step = largest extent / (2^bits - 1), or `voxel_size`
/// where > 0 (then bits is what it takes). Spec 6.1 (informative there).
/// @param bits  1 .. 21; ignored where voxel_size > 0
/// @errors kInvalidInput: no points; NaN or Inf; all points in one voxel (a cloud of two or more);
///         voxel_size so small that more than 21 bits are needed; a grid that no picture shows
///         (Grid::fits_floats()).
Result<VoxelCloud, InputError> voxelise(const PointCloud& cloud, int bits, double voxel_size = 0);

/// A capture's geometry on the grid that it is coded on: `bits` or `voxel_size` as voxelise has
/// them, or with both 0 what choose_density finds. VoxelCloud::density is filled in. The grid is
/// from capture.origin.
/// @param cloud  capture.cloud, or that with normals, which densifying needs
/// @errors those of voxelise. kInvalidInput: densified, the grid is too fine for the cloud.
Result<VoxelCloud, InputError> voxelise_geometry(const Capture& capture, const PointCloud& cloud,
                                                 std::span<const int> cameras, int bits,
                                                 double voxel_size, DensifySettings densify = {},
                                                 int threads = 0);

}  // namespace slf
