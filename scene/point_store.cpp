#include "scene/point_store.h"

#include <fstream>
#include <span>

#include "base/hexadecimal.h"
#include "base/sha256.h"
#include "geometry/morton.h"

namespace slf {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCodes = "points.codes";
constexpr const char* kNormals = "points.normals";
constexpr const char* kColours = "points.colours";
constexpr const char* kDigest = "points.sha256";  // written last: the others are whole

template <class T>
std::span<const std::uint8_t> bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const std::uint8_t*>(values.data()), values.size() * sizeof(T)};
}

InputError unreadable(const fs::path& file) {
  return {Errc::kInvalidInput, file.string() + ": not of as many points as the plan has"};
}

template <class T>
Result<std::vector<T>, InputError> read_values(const fs::path& file, std::uint64_t first,
                                               std::uint64_t count) {
  std::vector<T> values(static_cast<std::size_t>(count));
  std::ifstream in(file, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(first * sizeof(T)));
  in.read(reinterpret_cast<char*>(values.data()),
          static_cast<std::streamsize>(values.size() * sizeof(T)));
  if (!in) return unreadable(file);
  return values;
}

bool has_size(const fs::path& file, std::uint64_t bytes) {
  std::error_code error;
  return fs::file_size(file, error) == bytes && !error;
}

}  // namespace

Result<std::string, InputError> PointStore::write(const fs::path& directory,
                                                  const VoxelCloud& cloud) {
  std::error_code ignored;
  for (const char* name : {kDigest, kNormals, kColours}) fs::remove(directory / name, ignored);
  std::vector<std::uint64_t> codes;
  codes.reserve(cloud.positions.size());
  for (const Voxel& voxel : cloud.positions) codes.push_back(morton(voxel));
  Sha256 sha;
  const auto put = [&](const char* name,
                       std::span<const std::uint8_t> bytes) -> Result<Done, InputError> {
    if (bytes.empty()) return Done{};
    sha.update({reinterpret_cast<const std::uint8_t*>(name), std::char_traits<char>::length(name)});
    sha.update(bytes);
    return write_file(directory / name, bytes.data(), bytes.size());
  };
  SLF_CHECK(put(kCodes, bytes_of(codes)));
  SLF_CHECK(put(kNormals, bytes_of(cloud.normals)));
  SLF_CHECK(put(kColours, bytes_of(cloud.colours)));
  std::string digest = hexadecimal(sha.finish());
  SLF_CHECK(write_file(directory / kDigest, digest.data(), digest.size()));
  return digest;
}

Result<PointStore, InputError> PointStore::open(const fs::path& directory,
                                                const std::string& digest, std::uint64_t points) {
  SLF_TRY(const auto there, read_file(directory / kDigest, 64));
  if (std::string(there.begin(), there.end()) != digest)
    return InputError{Errc::kUnreadable, (directory / kDigest).string() + ": of another plan"};
  PointStore store(directory, points);
  if (!has_size(directory / kCodes, points * sizeof(std::uint64_t)))
    return unreadable(directory / kCodes);
  store.normals_ = fs::exists(directory / kNormals);
  store.colours_ = fs::exists(directory / kColours);
  constexpr std::uint64_t kTriple = sizeof(std::array<float, 3>);
  if (store.normals_ && !has_size(directory / kNormals, points * kTriple))
    return unreadable(directory / kNormals);
  if (store.colours_ && !has_size(directory / kColours, points * kTriple))
    return unreadable(directory / kColours);
  return store;
}

Result<std::vector<std::uint64_t>, InputError> PointStore::codes(std::uint64_t first,
                                                                 std::uint64_t count) const {
  return read_values<std::uint64_t>(directory_ / kCodes, first, count);
}

Result<StoredPoints, InputError> PointStore::read(std::uint64_t first, std::uint64_t count) const {
  StoredPoints points;
  SLF_TRY(points.codes, codes(first, count));
  using Triple = std::array<float, 3>;
  if (normals_) {
    SLF_TRY(points.normals, read_values<Triple>(directory_ / kNormals, first, count));
  }
  if (colours_) {
    SLF_TRY(points.colours, read_values<Triple>(directory_ / kColours, first, count));
  }
  return points;
}

}  // namespace slf
