// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/point_store.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <span>

#include "base/hexadecimal.h"
#include "base/sha256.h"

namespace slf {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCodes = ".codes";  // appears last: the others are there
constexpr const char* kNormals = ".normals";
constexpr const char* kColours = ".colours";
constexpr std::uint64_t kTriple = sizeof(std::array<float, 3>);

fs::path file_of(const fs::path& directory, const std::string& digest, const char* what) {
  return directory / ("points-" + digest.substr(0, 16) + what);
}

/// A file that has another name until it is whole.
class GrowingFile {
 public:
  explicit GrowingFile(const fs::path& directory) {
    static std::atomic<int> files{0};
    name_ = directory / ("points.tmp" + std::to_string(::getpid()) + "-" + std::to_string(files++));
    file_ = std::fopen(name_.c_str(), "wbe");
    if (file_ == nullptr) error_ = errno;
  }
  ~GrowingFile() {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove(name_.c_str());
  }
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  template <class T>
  void put(const T& value) {
    if (error_ != 0) return;
    sha_.update({reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
    if (std::fwrite(&value, sizeof value, 1, file_) != 1) error_ = errno;
  }

  std::array<std::uint8_t, 32> digest() { return sha_.finish(); }

  Result<Done, InputError> appear_as(const fs::path& name) {
    if (error_ == 0 && (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0)) error_ = errno;
    if (error_ == 0 && std::rename(name_.c_str(), name.c_str()) != 0) error_ = errno;
    if (error_ != 0)
      return InputError{Errc::kUnwritable,
                        name.string() + ": cannot be written: " + std::strerror(error_)};
    std::fclose(file_);
    file_ = nullptr;
    return Done{};
  }

 private:
  fs::path name_;
  std::FILE* file_ = nullptr;
  int error_ = 0;
  Sha256 sha_;
};

InputError not_the_plans(const fs::path& file) {
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
  if (!in) return InputError{Errc::kUnreadable, file.string() + ": points are missing"};
  return values;
}

bool has_size(const fs::path& file, std::uint64_t bytes) {
  std::error_code error;
  return fs::file_size(file, error) == bytes && !error;
}

}  // namespace

Result<PointStore::Written, InputError> PointStore::write(
    const fs::path& directory, bool normals, bool colours,
    const std::function<Result<Done, InputError>(const Take&)>& give) {
  GrowingFile of_codes(directory), of_normals(directory), of_colours(directory);
  Written written;
  SLF_CHECK(give([&](const OccupiedVoxel& voxel) {
    of_codes.put(voxel.code);
    if (normals) of_normals.put(voxel.normal);
    if (colours) of_colours.put(voxel.colour);
    ++written.points;
  }));
  Sha256 sha;
  for (GrowingFile* file : {&of_codes, &of_normals, &of_colours}) sha.update(file->digest());
  written.digest = hexadecimal(sha.finish());
  const auto name = [&](const char* what) { return file_of(directory, written.digest, what); };
  if (normals) SLF_CHECK(of_normals.appear_as(name(kNormals)));
  if (colours) SLF_CHECK(of_colours.appear_as(name(kColours)));
  SLF_CHECK(of_codes.appear_as(name(kCodes)));
  return written;
}

Result<PointStore, InputError> PointStore::open(const fs::path& directory,
                                                const std::string& digest, std::uint64_t points) {
  PointStore store;
  store.points_ = points;
  store.codes_ = file_of(directory, digest, kCodes);
  if (!fs::exists(store.codes_))
    return InputError{Errc::kUnreadable, store.codes_.string() + ": no such file"};
  if (!has_size(store.codes_, points * sizeof(std::uint64_t))) return not_the_plans(store.codes_);
  const std::array<std::pair<fs::path*, const char*>, 2> optional{
      {{&store.normals_, kNormals}, {&store.colours_, kColours}}};
  for (const auto& [file, what] : optional) {
    const fs::path name = file_of(directory, digest, what);
    if (!fs::exists(name)) continue;
    if (!has_size(name, points * kTriple)) return not_the_plans(name);
    *file = name;
  }
  return store;
}

Result<std::vector<std::uint64_t>, InputError> PointStore::codes(std::uint64_t first,
                                                                 std::uint64_t count) const {
  return read_values<std::uint64_t>(codes_, first, count);
}

Result<StoredPoints, InputError> PointStore::read(std::uint64_t first, std::uint64_t count) const {
  StoredPoints points;
  SLF_TRY(points.codes, codes(first, count));
  using Triple = std::array<float, 3>;
  if (!normals_.empty()) {
    SLF_TRY(points.normals, read_values<Triple>(normals_, first, count));
  }
  if (!colours_.empty()) {
    SLF_TRY(points.colours, read_values<Triple>(colours_, first, count));
  }
  return points;
}

}  // namespace slf
