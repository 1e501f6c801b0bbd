// SPDX-License-Identifier: Apache-2.0
// Any frame of a sequence, and what a lost unit costs: bench_seek FILE [FILE ...]. Files as `slf
// encode` of frames makes them, at least two groups. For every frame of the first group: bytes that
// a reader needs, milliseconds of a processor from nothing to the frame, and how many frames are
// not shown where its largest unit is missing.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>

#include "bitstream/units.h"
#include "slf/frame_reader.h"
#include "slf/frames.h"

namespace {

using namespace slf;
using Bytes = std::vector<std::uint8_t>;

template <class T>
T value_of(Result<T> result) {
  if (result) return *std::move(result);
  std::fprintf(stderr, "%s\n", to_string(result.error()).c_str());
  std::exit(1);
}

Bytes read_file(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

DecodeOptions on_one_thread() {
  DecodeOptions options;
  options.threads = 1;
  return options;
}

double processor_seconds() {
  return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

/// Mean and worst of what is added.
struct Spread {
  double sum = 0, worst = 0, count = 0;
  void add(double value) {
    sum += value;
    worst = std::max(worst, value);
    ++count;
  }
  double mean() const { return sum / std::max(count, 1.0); }
};

std::size_t length_of_group(const std::vector<FrameInfo>& frames) {
  std::size_t length = 1;
  while (length < frames.size() && frames[length].predicted) ++length;
  return length;
}

/// Frames that are not shown where bytes begin .. end - 1 of a stream are missing. Ends the program
/// where a group behind is touched.
std::size_t frames_lost(const Bytes& stream, std::size_t begin, std::size_t end, std::size_t group,
                        std::size_t frames) {
  Bytes damaged(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(begin));
  damaged.insert(damaged.end(), stream.begin() + static_cast<std::ptrdiff_t>(end), stream.end());
  FrameReader reader = value_of(FrameReader::open(on_one_thread()));
  if (!reader.push(damaged) || !reader.finish()) return group;
  std::size_t shown = 0, behind = 0;
  for (std::size_t f = 0; f < reader.frames().size(); ++f) {
    const FrameInfo& info = reader.frames()[f];
    if (info.lost || !reader.decode(f)) continue;
    ++shown;
    behind += info.number >= group;
  }
  if (behind != frames - group) {
    std::fprintf(stderr, "a unit of one group costs frames of another\n");
    std::exit(1);
  }
  return frames - shown;
}

/// The largest unit of a frame: where it begins and ends in the stream.
std::pair<std::size_t, std::size_t> largest_unit(const Bytes& stream, const FrameInfo& frame) {
  std::pair<std::size_t, std::size_t> largest;
  const auto end = static_cast<std::size_t>(frame.offset + frame.bytes);
  auto at = static_cast<std::size_t>(frame.offset);
  if (stream[at] == kSignature[0]) at += kSignature.size();
  while (at < end) {
    const auto bytes = static_cast<std::size_t>(value_of(read_unit(stream, at)).bytes);
    if (bytes > largest.second - largest.first) largest = {at, at + bytes};
    at += bytes;
  }
  return largest;
}

void measure(const char* path) {
  const Bytes stream = read_file(path);
  const std::vector<FrameInfo> frames = value_of(list_frames(stream));
  const std::size_t group = length_of_group(frames);
  Spread bytes, milliseconds, lost;
  for (std::size_t f = 0; f < group; ++f) {
    bytes.add(static_cast<double>(frames[f].offset + frames[f].bytes));
    const double begin = processor_seconds();
    FrameDecoder decoder = value_of(FrameDecoder::open(stream, on_one_thread()));
    value_of(decoder.decode(f));
    milliseconds.add(1e3 * (processor_seconds() - begin));
    const auto [first, last] = largest_unit(stream, frames[f]);
    lost.add(static_cast<double>(frames_lost(stream, first, last, group, frames.size())));
  }
  std::printf("%s, %zu frames, groups of %zu: %.0f %.0f %.1f %.1f %.1f %.0f\n", path, frames.size(),
              group, bytes.mean(), bytes.worst, milliseconds.mean(), milliseconds.worst,
              lost.mean(), lost.worst);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "bench_seek FILE [FILE ...]\n");
    return 2;
  }
  std::printf("bytes: mean, worst; ms: mean, worst; frames lost by a lost unit: mean, worst\n");
  for (int i = 1; i < argc; ++i) measure(argv[i]);
}
