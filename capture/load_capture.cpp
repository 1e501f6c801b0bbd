// SPDX-License-Identifier: Apache-2.0
// Which importer reads a path, and the checks of the whole.
#include "capture/check_capture.h"
#include "capture/check_photographs.h"
#include "capture/colmap_workspace.h"
#include "capture/file_names.h"
#include "capture/foreign_captures.h"
#include "capture/frame_photographs.h"
#include "capture/importer.h"
#include "capture/json.h"
#include "capture/json_numbers.h"
#include "capture/load_cloud.h"
#include "capture/photograph_names.h"
#include "capture/read_scan.h"
#include "slf/frame_inputs.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

Result<Import, InputError> import_colmap(const fs::path& directory, const std::string& extension) {
  SLF_TRY(Import import,
          extension == ".bin" ? import_colmap_binary(directory) : import_colmap_text(directory));
  find_colmap_masks(import);
  if (!import.images.empty() && import.images.front().starts_with("images/"))
    count_other_photographs(import.capture.root / "images", import);
  return import;
}

// By content: any name will do for a JSON file.
Result<Import, InputError> import_json(const fs::path& file, const fs::path& images) {
  if (file.filename() == "cameras.json") return import_cameras_json(file);
  SLF_TRY(const auto text, read_file(file, kMaxJsonBytes));
  SLF_TRY(const auto document, parse_json(file.string(), text));
  const JsonView json(document, file.string());
  if (json.find("frames")) return import_transforms_json(file, images);
  if (json.find("cameras")) return import_cameras_json(file);
  if (json.find("sfm_data_version")) return import_openmvg(file);
  if (const std::string what = foreign_capture(file); !what.empty()) return json.error(what);
  return json.error("neither 'cameras' nor 'frames': not a capture");
}

Result<Import, InputError> import_file(const fs::path& file, const fs::path& images) {
  const std::string extension = extension_of(file);
  if (extension == ".json") return import_json(file, images);
  if (extension == ".cams") return import_index_cams(file, images);
  if (extension == ".out") return import_bundler(file, images);
  if (extension == ".xml") return import_metashape(file);
  const std::string stem = file.stem().string();
  const bool colmap = stem == "cameras" || stem == "images" || stem == "points3D";
  if (colmap && (extension == ".bin" || extension == ".txt"))
    return import_colmap(file.parent_path(), extension);
  if (extension == ".ply" || is_scan(file)) {
    Import import;
    import.capture.root = file.parent_path();
    import.cloud_file = file;
    return import;
  }
  const std::string what = foreign_capture(file);
  return InputError{
      Errc::kInvalidInput,
      file.string() + ": " + (what.empty() ? "not a capture that is understood" : what)};
}

Result<Import, InputError> import_found(const ColmapPlace& model) {
  SLF_TRY(Import import, import_colmap(model.directory, model.extension));
  if (!model.warning.empty()) import.capture.warnings.push_back(model.warning);
  return import;
}

Result<Import, InputError> import_directory(const fs::path& directory, const fs::path& images) {
  if (is_file(directory / "cameras.json")) return import_cameras_json(directory / "cameras.json");
  if (const auto model = find_colmap(directory)) return import_found(*model);
  if (is_file(directory / "transforms.json"))
    return import_transforms_json(directory / "transforms.json", images);
  if (is_file(directory / "transforms_train.json"))
    return import_transforms_splits(directory, images);
  if (const auto model = find_colmap(directory / "colmap")) return import_found(*model);
  if (is_file(directory / "index.cams")) return import_index_cams(directory / "index.cams", images);
  if (is_file(directory / "cameras.xml")) return import_metashape(directory / "cameras.xml");
  for (const char* name : {"bundle.out", "bundle.rd.out", "bundle/bundle.out"})
    if (is_file(directory / name)) return import_bundler(directory / name, images);
  if (is_file(directory / "sfm_data.json")) return import_openmvg(directory / "sfm_data.json");
  const std::string what = foreign_capture(directory);
  return InputError{Errc::kInvalidInput, directory.string() +
                                             ": not a capture: no cameras.json, COLMAP model or "
                                             "transforms.json" +
                                             (what.empty() ? "" : "; " + what)};
}

// Photographs are in the capture, or in a folder that was named.
Result<Done, InputError> resolve_files(const fs::path& folder, std::optional<std::uint32_t> frame,
                                       Import& import) {
  auto& capture = import.capture;
  for (std::size_t i = 0; i < import.images.size(); ++i) {
    SLF_TRY(auto image, photograph_file(capture.root, import.images[i], folder,
                                        frame ? at_frame(capture.cameras[i].name, *frame)
                                              : capture.cameras[i].name,
                                        import.labels[i]));
    capture.image_files.push_back(std::move(image));
    if (import.masks.empty()) continue;
    fs::path mask;
    if (!import.masks[i].empty()) {
      SLF_TRY(mask, path_inside(capture.root, import.masks[i], import.labels[i]));
    }
    capture.mask_files.push_back(std::move(mask));
  }
  return Done{};
}

Result<Capture, InputError> load_any(const fs::path& given, const CaptureOptions& options,
                                     std::optional<std::uint32_t> frame) {
  std::error_code error;
  fs::path path = fs::absolute(given, error).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // "name/"
  const auto status = fs::status(path, error);
  if (given.empty() || !fs::exists(status))
    return InputError{Errc::kUnreadable, given.string() + ": no such file or directory"};

  SLF_TRY(Import import, fs::is_directory(status) ? import_directory(path, options.images)
                                                  : import_file(path, options.images));
  const bool lone_cloud = import.labels.empty() && import.cloud_file == path;
  if (import.capture.cameras.empty() && !lone_cloud)
    return InputError{Errc::kInvalidInput, path.string() + ": the capture has no cameras"};
  SLF_CHECK(check_cameras(import));
  if (frame) SLF_CHECK(take_frame(*frame, import));
  SLF_CHECK(resolve_files(options.images, frame, import));
  if (options.check_images) SLF_CHECK(check_photographs(import.capture));
  if (options.cloud) SLF_CHECK(load_geometry(path.string(), options, import));
  // Nothing is known of the world of a COLMAP model; the other formats mean z up unless their
  // photographs say otherwise.
  const UpAxis usual = import.cloud_name.empty() ? UpAxis::kPlusZ : UpAxis::kUnknown;
  import.capture.up = import.up ? *import.up : up_of(import.capture.cameras, usual);
  return std::move(import.capture);
}

}  // namespace

Result<Capture, InputError> load_capture(const fs::path& given, const CaptureOptions& options) {
  return load_any(given, options, std::nullopt);
}

Result<Capture, InputError> load_frame(const FrameInput& frame, const CaptureOptions& options) {
  return load_any(frame.path, options, frame.of_all ? std::optional(frame.number) : std::nullopt);
}

}  // namespace slf
