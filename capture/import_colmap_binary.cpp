// SPDX-License-Identifier: Apache-2.0
// COLMAP's cameras.bin, images.bin and points3D.bin: little endian, no padding.
#include <bit>
#include <cmath>
#include <span>

#include "capture/colmap_model.h"
#include "capture/exact_positions.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

// Bytes one entry takes at the least.
constexpr std::uint64_t kMinCamera = 4 + 4 + 8 + 8 + 3 * 8;
constexpr std::uint64_t kMinImage = 4 + 7 * 8 + 4 + 1 + 8;
constexpr std::uint64_t kMinPoint = 8 + 3 * 8 + 3 + 8 + 8;

// Reads on; after the end everything is zero and ok() is false.
class Cursor {
 public:
  Cursor(std::span<const std::uint8_t> bytes, std::string name)
      : bytes_(bytes), name_(std::move(name)) {}

  bool ok() const { return ok_; }
  const std::string& name() const { return name_; }
  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput, name_ + ": " + cause};
  }
  InputError cut_off() const { return invalid("the file ends too early"); }

  std::uint64_t unsigned_of(int size) {
    if (!has(static_cast<std::uint64_t>(size))) return 0;
    std::uint64_t value = 0;
    for (int i = 0; i < size; ++i)
      value |= std::uint64_t{bytes_[at_ + static_cast<std::size_t>(i)]} << (8 * i);
    at_ += static_cast<std::size_t>(size);
    return value;
  }
  std::uint8_t u8() { return static_cast<std::uint8_t>(unsigned_of(1)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(unsigned_of(4)); }
  std::uint64_t u64() { return unsigned_of(8); }
  double f64() { return std::bit_cast<double>(u64()); }

  std::string text() {  // ends with a zero byte
    for (std::size_t end = at_; end < bytes_.size(); ++end) {
      if (bytes_[end] != 0) continue;
      std::string value(bytes_.begin() + std::ptrdiff_t(at_), bytes_.begin() + std::ptrdiff_t(end));
      at_ = end + 1;
      return value;
    }
    ok_ = false;
    return {};
  }

  void skip(std::uint64_t count, std::uint64_t size) {
    if (count > left() / size) ok_ = false;
    if (ok_) at_ += static_cast<std::size_t>(count * size);
  }

  /// A number of entries, believed only if the bytes for them are there.
  Result<std::uint64_t, InputError> count(std::uint64_t min_bytes_each) {
    const std::uint64_t entries = u64();
    if (!ok_) return cut_off();
    if (entries > left() / min_bytes_each)
      return invalid("announces " + std::to_string(entries) + " entries, more than the file holds");
    return entries;
  }

  Result<Done, InputError> expect_end() const {
    if (left() > 0) return invalid(std::to_string(left()) + " bytes behind the last entry");
    return Done{};
  }

 private:
  std::uint64_t left() const { return bytes_.size() - at_; }
  bool has(std::uint64_t size) {
    ok_ = ok_ && size <= left();
    return ok_;
  }

  std::span<const std::uint8_t> bytes_;
  std::string name_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

Result<std::vector<ColmapCamera>, InputError> read_binary_cameras(Cursor in) {
  SLF_TRY(const auto count, in.count(kMinCamera));
  std::vector<ColmapCamera> cameras;
  for (std::uint64_t i = 0; i < count; ++i) {
    ColmapCamera camera;
    camera.id = in.u32();
    const auto model = static_cast<std::int32_t>(in.u32());
    camera.width = in.u64();
    camera.height = in.u64();
    if (!in.ok()) return in.cut_off();
    camera.label = in.name() + ": camera " + std::to_string(camera.id);
    SLF_TRY(camera.kind, colmap_model_kind(std::int64_t{model}, camera.label));
    for (std::size_t p = 0; p < camera.kind.num_params; ++p) camera.params.push_back(in.f64());
    if (!in.ok()) return in.cut_off();
    cameras.push_back(std::move(camera));
  }
  SLF_CHECK(in.expect_end());
  return cameras;
}

Result<std::vector<ColmapImage>, InputError> read_binary_images(Cursor in) {
  SLF_TRY(const auto count, in.count(kMinImage));
  std::vector<ColmapImage> images;
  for (std::uint64_t i = 0; i < count; ++i) {
    ColmapImage image;
    image.id = in.u32();
    for (double& q : image.quaternion) q = in.f64();
    for (double& t : image.translation) t = in.f64();
    image.camera = in.u32();
    image.name = in.text();
    in.skip(in.u64(), 8 + 8 + 8);  // where its features are
    if (!in.ok()) return in.cut_off();
    images.push_back(std::move(image));
  }
  SLF_CHECK(in.expect_end());
  return images;
}

Result<PointCloud, InputError> read_binary_points(Cursor in) {
  SLF_TRY(const auto count, in.count(kMinPoint));
  PointCloud cloud;
  std::vector<Vec3> positions;
  for (std::uint64_t i = 0; i < count; ++i) {
    in.u64();  // id
    Vec3 position{};
    for (double& x : position) x = in.f64();
    std::array<std::uint8_t, 3> colour{};
    for (auto& c : colour) c = in.u8();
    in.f64();                  // reprojection error
    in.skip(in.u64(), 4 + 4);  // which images see it
    if (!in.ok()) return in.cut_off();
    for (const double x : position)
      if (!std::isfinite(static_cast<float>(x)))
        return in.invalid("point " + std::to_string(i) + " is not finite");
    positions.push_back(position);
    cloud.colours.push_back(colour);
  }
  SLF_CHECK(in.expect_end());
  set_positions(positions, cloud);
  return cloud;
}

}  // namespace

Result<Import, InputError> import_colmap_binary(const fs::path& directory) {
  ColmapModel model;
  const auto name = [&](const char* file) { return (directory / file).string(); };
  SLF_TRY(const auto cameras, read_file(directory / "cameras.bin"));
  SLF_TRY(model.cameras, read_binary_cameras(Cursor(cameras, name("cameras.bin"))));
  SLF_TRY(const auto images, read_file(directory / "images.bin"));
  SLF_TRY(model.images, read_binary_images(Cursor(images, name("images.bin"))));
  SLF_CHECK(read_colmap_points(directory, ".bin", model));
  return import_of(std::move(model), directory, ".bin");
}

Result<PointCloud, InputError> read_colmap_points_binary(const fs::path& file) {
  SLF_TRY(const auto bytes, read_file(file));
  return read_binary_points(Cursor(bytes, file.string()));
}

}  // namespace slf
