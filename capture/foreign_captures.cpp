// SPDX-License-Identifier: Apache-2.0
#include "capture/foreign_captures.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "capture/file_names.h"
#include "capture/frame_files.h"
#include "capture/input_file.h"
#include "slf/gaussian_files.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHead = 4096;               // bytes of a file that tell
constexpr std::size_t kMostPhotographs = 100000;  // of a folder

constexpr const char* kCalibrate =
    "calibrate them first by structure from motion: COLMAP (colmap automatic_reconstructor "
    "--workspace_path DIR --image_path DIR/images) leaves DIR/sparse, and slf encode DIR reads "
    "that; with --dense 1, its default, a cloud too";

/// A file by its extension, or by what it begins with; an empty one is any.
struct Foreign {
  const char* extension;
  const char* text;  // within its head
  const char* sentence;
};
constexpr std::array kForeign = {
    Foreign{"", "# Bundle file",
            "cameras of Bundler: name the file x.out, with list.txt beside it"},
    Foreign{".psx", "",
            "a project of Metashape: export its cameras (File, Export, Export Cameras) as "
            "cameras.xml, and the cloud or the mesh as PLY or OBJ"},
    Foreign{".nvm", "NVM_V3", "cameras of VisualSFM, which are not read: calibrate by COLMAP"},
    Foreign{".sfm", "",
            "cameras of Meshroom, which are not read: its node ExportColmap (or "
            "ConvertSfMFormat) writes a COLMAP model"},
    Foreign{".rsproj", "",
            "a project of RealityScan: export its registration for COLMAP or as Bundler"},
    Foreign{".rcproj", "",
            "a project of RealityCapture: export its registration for COLMAP or as Bundler"},
    Foreign{".csv", "#name,x,y",
            "cameras of RealityScan, which are not read: export its registration for COLMAP or as "
            "Bundler"},
    Foreign{".pcd", "", "a cloud of PCL: save it as PLY (pcl_pcd2ply, CloudCompare)"},
    Foreign{".xyz", "", "a cloud as text: save it as PLY (CloudCompare, MeshLab)"},
    Foreign{".pts", "", "a cloud as text: save it as PLY (CloudCompare, MeshLab)"},
    Foreign{".slf", "SLF", "is coded already: slf render, decode, export and info read it"},
    Foreign{".igc", "", "is coded already: slf eval reads it"},
    Foreign{".mp4", "",
            "a video: take photographs from it (ffmpeg -i x.mp4 -r 2 images/%04d.jpg) "
            "and calibrate them by COLMAP"},
    Foreign{".mov", "",
            "a video: take photographs from it (ffmpeg -i x.mov -r 2 images/%04d.jpg) "
            "and calibrate them by COLMAP"},
};

std::string foreign_file(const fs::path& file) {
  std::vector<std::uint8_t> head(kHead);
  auto input = InputFile::open(file);
  if (!input) return {};
  const auto count = input->read(head);
  if (count && *count == 0) return "is empty";
  const std::string_view text(reinterpret_cast<const char*>(head.data()), count ? *count : 0);
  const std::string extension = extension_of(file);
  for (const Foreign& foreign : kForeign)
    if ((*foreign.extension == '\0' || extension == foreign.extension) &&
        text.find(foreign.text) != text.npos)
      return foreign.sentence;
  if (is_splat_name(file))
    return looks_like_gaussians(file)
               ? "Gaussian splats, which slf encode takes by themselves, or as "
                 "points of a capture (--points)"
               : kNoSplats;
  if (extension == ".jpg" || extension == ".jpeg" || extension == ".png")
    return "a photograph, not a capture, which is a folder of photographs with their cameras";
  if (extension == ".txt" || extension == ".csv" || extension == ".asc")
    return "not a capture that is understood; a cloud as text is to be saved as PLY (CloudCompare, "
           "MeshLab)";
  if (extension == ".obj" || extension == ".glb" || extension == ".gltf" || extension == ".stl")
    return "a mesh needs photographs and their cameras: slf encode CAPTURE --points " +
           file.filename().string() + "; alone, save it as a coloured PLY: its vertices are coded";
  if (extension == ".tif" || extension == ".tiff" || extension == ".heic" || extension == ".webp")
    return "a photograph of a format that is not read: convert to PNG or JPEG (mogrify -format "
           "png, heif-convert)";
  return {};
}

std::size_t photographs_in(const fs::path& folder) {
  std::size_t found = 0, entries = 0;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; at != end && !error; at.increment(error)) {
    if (++entries > kMostPhotographs) break;
    const std::string extension = extension_of(at->path());
    found += extension == ".jpg" || extension == ".jpeg" || extension == ".png" ||
             extension == ".heic" || extension == ".ppm" || extension == ".tif" ||
             extension == ".tiff";
  }
  return found;
}

/// What to do before, where some of the photographs are of other formats.
std::string to_convert(const fs::path& folder) {
  std::error_code error;
  std::size_t entries = 0;
  for (fs::directory_iterator at(folder, error), end; at != end && !error; at.increment(error)) {
    if (++entries > kMostPhotographs) break;
    const std::string extension = extension_of(at->path());
    if (extension == ".heic" || extension == ".tif" || extension == ".tiff")
      return "; TIFF and HEIC are not read: convert them to PNG or JPEG before (mogrify -format "
             "png, heif-convert)";
  }
  return {};
}

std::string foreign_directory(const fs::path& directory) {
  std::error_code error;
  if (fs::is_directory(directory / "keyframes", error))
    return "a capture of Polycam, which is not read: ns-process-data polycam (nerfstudio) makes a "
           "transforms.json of its raw export";
  for (const char* folder : {"", "images", "input"})
    if (const std::size_t found = photographs_in(directory / folder); found > 0)
      return std::to_string(found) + " photographs without cameras: " + kCalibrate +
             to_convert(directory / folder);
  return {};
}

}  // namespace

std::string foreign_capture(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error) ? foreign_directory(path) : foreign_file(path);
}

}  // namespace slf
