// SPDX-License-Identifier: Apache-2.0
// COLMAP's cameras.txt, images.txt and points3D.txt.
#include <charconv>
#include <cmath>
#include <span>
#include <string_view>

#include "capture/colmap_model.h"
#include "capture/colmap_workspace.h"
#include "capture/exact_positions.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

// Lines of a file and the words of the current one.
class Lines {
 public:
  Lines(std::span<const std::uint8_t> bytes, std::string name)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(std::move(name)) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;  // a byte order mark, as editors put it
  }

  /// To the next line, whatever is in it. False at the end.
  bool next() {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    at_ = end + 1;
    ++number_;
    skip_space();
    return true;
  }
  /// To the next line that is neither empty nor a comment.
  bool next_entry() {
    while (next())
      if (!line_.empty() && line_.front() != '#') return true;
    return false;
  }

  bool line_done() const { return line_.empty(); }
  bool is_comment() const { return line_.starts_with('#'); }

  /// Nothing, or triples X Y POINT3D_ID: features of an image.
  bool is_features() const {
    std::size_t words = 0;
    for (Lines rest = *this; !rest.line_done(); ++words) {
      const std::string_view text = rest.word();
      double value = 0;
      const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
      if (error != std::errc() || stop != text.data() + text.size()) return false;
    }
    return words % 3 == 0;
  }
  /// IMAGE_ID and seven numbers, CAMERA_ID and a name.
  bool is_image() const {
    Lines rest = *this;
    bool numbers{rest.number<std::uint32_t>("")};
    for (int i = 0; i < 7; ++i) numbers = bool{rest.number<double>("")} && numbers;
    return numbers && rest.number<std::uint32_t>("") && !rest.line_done();
  }

  std::string_view word() {
    const std::size_t end = std::min(line_.find_first_of(" \t\r"), line_.size());
    const std::string_view word = line_.substr(0, end);
    line_.remove_prefix(end);
    skip_space();
    return word;
  }

  /// All that is left: an image name may hold spaces.
  std::string rest() {
    const std::size_t last = line_.find_last_not_of(" \t\r");
    return std::string(line_.substr(0, last == std::string_view::npos ? 0 : last + 1));
  }

  template <class T>
  Result<T, InputError> number(const char* what) {
    const std::string_view text = word();
    T value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (text.empty() || error != std::errc() || stop != text.data() + text.size())
      return invalid(std::string(what) + " is missing or damaged");
    return value;
  }
  Result<double, InputError> finite(const char* what) {
    SLF_TRY(const double value, number<double>(what));
    if (!std::isfinite(value)) return invalid(std::string(what) + " is not finite");
    return value;
  }

  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput, label() + ": " + cause};
  }
  std::string label() const { return name_ + ", line " + std::to_string(number_); }

 private:
  void skip_space() {
    line_.remove_prefix(std::min(line_.find_first_not_of(" \t\r"), line_.size()));
  }

  std::string_view text_, line_;
  std::string name_;
  std::size_t at_ = 0;
  std::size_t number_ = 0;
};

// CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]
Result<std::vector<ColmapCamera>, InputError> read_text_cameras(Lines in) {
  std::vector<ColmapCamera> cameras;
  while (in.next_entry()) {
    ColmapCamera camera;
    SLF_TRY(camera.id, in.number<std::uint32_t>("camera id"));
    camera.label = in.label();
    SLF_TRY(camera.kind, colmap_model_kind(std::string(in.word()), camera.label));
    SLF_TRY(camera.width, in.number<std::uint64_t>("width"));
    SLF_TRY(camera.height, in.number<std::uint64_t>("height"));
    for (std::size_t p = 0; p < camera.kind.num_params; ++p) {
      SLF_TRY(const double value, in.finite("a camera parameter"));
      camera.params.push_back(value);
    }
    if (!in.line_done())
      return in.invalid(std::string("too many parameters for ") + camera.kind.name);
    cameras.push_back(std::move(camera));
  }
  return cameras;
}

// IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then a line of features, which may be empty or, in
// files that other programs write, not there.
Result<std::vector<ColmapImage>, InputError> read_text_images(Lines in) {
  std::vector<ColmapImage> images;
  for (bool more = in.next_entry(); more;) {
    ColmapImage image;
    SLF_TRY(image.id, in.number<std::uint32_t>("image id"));
    for (double& q : image.quaternion) {
      SLF_TRY(q, in.finite("rotation"));
    }
    for (double& t : image.translation) {
      SLF_TRY(t, in.finite("translation"));
    }
    SLF_TRY(image.camera, in.number<std::uint32_t>("camera id"));
    image.name = in.rest();
    if (image.name.empty()) return in.invalid("image without a name");
    images.push_back(std::move(image));
    more = in.next();
    if (!more || (in.is_image() && !in.is_features())) continue;
    if (!in.is_comment() && !in.is_features())
      return in.invalid(
          "neither features of the image before (triples X Y POINT3D_ID) nor an image");
    more = in.next_entry();
  }
  return images;
}

// POINT3D_ID X Y Z R G B ERROR TRACK[]
Result<PointCloud, InputError> read_text_points(Lines in) {
  PointCloud cloud;
  std::vector<Vec3> positions;
  while (in.next_entry()) {
    Vec3 position{};
    std::array<std::uint8_t, 3> colour{};
    SLF_CHECK(in.number<std::uint64_t>("point id"));
    for (double& x : position) {
      SLF_TRY(x, in.finite("position"));
      if (!std::isfinite(static_cast<float>(x))) return in.invalid("position is beyond 3.4e38");
    }
    for (auto& c : colour) {
      SLF_TRY(c, in.number<std::uint8_t>("colour"));
    }
    positions.push_back(position);
    cloud.colours.push_back(colour);
  }
  set_positions(positions, cloud);
  return cloud;
}

}  // namespace

std::size_t colmap_num_images_text(const fs::path& directory) {
  const auto bytes = read_file(directory / "images.txt");
  if (!bytes) return 0;
  const auto images = read_text_images(Lines(*bytes, ""));
  return images ? images->size() : 0;
}

Result<Import, InputError> import_colmap_text(const fs::path& directory) {
  ColmapModel model;
  const auto name = [&](const char* file) { return (directory / file).string(); };
  SLF_TRY(const auto cameras, read_file(directory / "cameras.txt"));
  SLF_TRY(model.cameras, read_text_cameras(Lines(cameras, name("cameras.txt"))));
  SLF_TRY(const auto images, read_file(directory / "images.txt"));
  SLF_TRY(model.images, read_text_images(Lines(images, name("images.txt"))));
  SLF_CHECK(read_colmap_points(directory, ".txt", model));
  return import_of(std::move(model), directory, ".txt");
}

Result<PointCloud, InputError> read_colmap_points_text(const fs::path& file) {
  SLF_TRY(const auto bytes, read_file(file));
  return read_text_points(Lines(bytes, file.string()));
}

}  // namespace slf
