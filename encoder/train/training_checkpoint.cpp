// SPDX-License-Identifier: Apache-2.0
// The file, little endian as the machine is: magic, digest of the training, iteration, views drawn,
// steps of Adam, surfels (64 bits each); rows of surfels, of both moments, then what use says of
// each; twists of cameras; SHA-256 of all before it.
#include "encoder/train/training_checkpoint.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "base/sha256.h"
#include "slf/capture.h"

namespace slf {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr char kMagic[] = "slftrn1";  // 8 bytes with its end
constexpr std::size_t kDigestBytes = 32;
constexpr std::size_t kHeaderBytes = sizeof kMagic + kDigestBytes + 4 * sizeof(std::uint64_t);
constexpr std::size_t kSurfelBytes = sizeof(float) * (3 * TrainedSurfel::kSize + 2);
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 32;

template <class T>
void put(Bytes& bytes, const T* values, std::size_t count) {
  const auto* from = reinterpret_cast<const std::uint8_t*>(values);
  bytes.insert(bytes.end(), from, from + count * sizeof(T));
}

TrainingDigest digest_of(std::span<const std::uint8_t> bytes) {
  Sha256 hash;
  hash.update(bytes);
  return hash.finish();
}

/// Reads what was checked to be there.
class Cursor {
 public:
  explicit Cursor(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t number() {
    std::uint64_t value = 0;
    std::memcpy(&value, bytes_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  /// @return false where a value is not finite
  template <class T>
  bool floats(T* to, std::size_t count) {
    if (count == 0) return true;
    std::memcpy(to, bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
    return std::all_of(to, to + count, [](T x) { return std::isfinite(x); });
  }

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

bool is_of(std::span<const std::uint8_t> bytes, const TrainingDigest& training) {
  if (bytes.size() < kHeaderBytes + kDigestBytes) return false;
  if (std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0) return false;
  if (!std::equal(training.begin(), training.end(), bytes.begin() + sizeof kMagic)) return false;
  const auto whole = digest_of(bytes.first(bytes.size() - kDigestBytes));
  return std::equal(whole.begin(), whole.end(), bytes.end() - kDigestBytes);
}

}  // namespace

TrainingCheckpoint::TrainingCheckpoint(std::filesystem::path directory,
                                       const TrainingDigest& digest)
    : directory_(std::move(directory)), digest_(digest) {
  std::string name = "training-";
  for (std::size_t i = 0; i < 8; ++i)
    for (const int shift : {4, 0}) name += "0123456789abcdef"[digest[i] >> shift & 15];
  file_ = directory_ / (name + ".checkpoint");
}

std::optional<TrainingState> TrainingCheckpoint::read(int iterations, std::size_t twists) const {
  const auto bytes = read_file(file_, kMostBytes);
  if (!bytes || !is_of(*bytes, digest_)) return std::nullopt;
  const std::span<const std::uint8_t> whole = *bytes;
  Cursor cursor(whole.subspan(sizeof kMagic + kDigestBytes));
  const std::uint64_t iteration = cursor.number(), views = cursor.number(), steps = cursor.number(),
                      count = cursor.number();
  const auto most = std::uint64_t(std::max(iterations, 0));
  if (iteration > most || views > most || steps > most) return std::nullopt;
  const std::size_t behind = kHeaderBytes + kDigestBytes + twists * sizeof(double);
  if (bytes->size() < behind) return std::nullopt;
  const std::size_t body = bytes->size() - behind;
  if (count != body / kSurfelBytes || body % kSurfelBytes != 0) return std::nullopt;
  TrainingState state;
  state.iteration = int(iteration);
  state.drawn_views = std::size_t(views);
  state.surfels.resize(std::size_t(count));
  state.adam.resize(state.surfels.size());
  state.adam.steps = int(steps);
  state.use.resize(state.surfels.size());
  for (auto* rows : {&state.surfels, &state.adam.mean, &state.adam.square})
    for (TrainedSurfel& row : *rows)
      if (!cursor.floats(row.value.data(), row.value.size())) return std::nullopt;
  for (auto* values : {&state.use.drawn, &state.use.pull})
    if (!cursor.floats(values->data(), values->size())) return std::nullopt;
  state.twists.resize(twists);
  if (!cursor.floats(state.twists.data(), twists)) return std::nullopt;
  return state;
}

Result<Done, InputError> TrainingCheckpoint::write(const TrainingState& state) const {
  Bytes bytes;
  bytes.reserve(kHeaderBytes + state.surfels.size() * kSurfelBytes + kDigestBytes);
  put(bytes, kMagic, sizeof kMagic);
  put(bytes, digest_.data(), digest_.size());
  for (const std::size_t number : {std::size_t(state.iteration), state.drawn_views,
                                   std::size_t(state.adam.steps), state.surfels.size()}) {
    const std::uint64_t wide = number;
    put(bytes, &wide, 1);
  }
  for (const auto* rows : {&state.surfels, &state.adam.mean, &state.adam.square})
    for (const TrainedSurfel& row : *rows) put(bytes, row.value.data(), row.value.size());
  for (const auto* values : {&state.use.drawn, &state.use.pull})
    put(bytes, values->data(), values->size());
  put(bytes, state.twists.data(), state.twists.size());
  const auto digest = digest_of(bytes);
  put(bytes, digest.data(), digest.size());
  std::error_code error;
  std::filesystem::create_directories(directory_, error);
  if (error) return InputError{Errc::kUnwritable, directory_.string() + ": " + error.message()};
  return write_file(file_, bytes.data(), bytes.size());
}

}  // namespace slf
