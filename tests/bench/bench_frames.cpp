// SPDX-License-Identifier: Apache-2.0
// Frames of a moving cloud, each predicted and each by itself:
//   bench_frames [--brightness] STEP DIR [DIR ...]       --brightness: the other channels are zero
// A DIR is what `slf synth rot1 --frames N -o DIR` makes: integers on a grid of 8 bits and a
// colour. STEP: grey levels of brightness, twice that of the other channels. Bytes by kind, PSNR of
// brightness, milliseconds of a processor for encoding and decoding, over all frames but the first.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string_view>

#include "bitstream/units.h"
#include "geometry/morton.h"
#include "slf/capture.h"
#include "slf/frame_inputs.h"
#include "slf/frames.h"

namespace {

using namespace slf;

constexpr int kShift = 4;  // of components
constexpr int kThreads = 1;

template <class T, class E>
T value_of(Result<T, E> result) {
  if (result) return *std::move(result);
  if constexpr (std::is_same_v<E, InputError>)
    std::fprintf(stderr, "%s\n", result.error().message.c_str());
  else
    std::fprintf(stderr, "%s\n", to_string(result.error()).c_str());
  std::exit(1);
}

/// Brightness, red against blue, green against both: of colours, in 1/16.
LightField field_of(const FrameInput& input, bool brightness_alone) {
  const PointCloud cloud = value_of(read_ply(input.path));
  const VoxelCloud voxels = value_of(voxelise(cloud, 0, 1));
  LightField field;
  field.header.grid.bits = 8;
  field.header.has_basis = false;
  field.header.num_functions = 1;
  field.header.shift = {kShift};
  for (std::size_t i = 0; i < voxels.positions.size(); ++i) {
    Voxel v = voxels.positions[i];  // back to where the file has it
    for (std::size_t k = 0; k < 3; ++k)
      v[k] += static_cast<std::int32_t>(std::lround(voxels.grid.origin[k]));
    field.positions.push_back(v);
    std::array<int, 3> c{};
    for (std::size_t k = 0; k < 3; ++k)
      c[k] = static_cast<int>(std::lround(voxels.colours[i][k] * (1 << kShift)));
    const int brightness = (c[0] + 2 * c[1] + c[2]) / 4 - 128 * (1 << kShift);
    const int across[] = {(c[0] - c[2]) / 2, (2 * c[1] - c[0] - c[2]) / 4};
    const int shown = brightness_alone ? 0 : 1;
    field.components.insert(field.components.end(),
                            {brightness, shown * across[0], shown * across[1]});
  }
  return field;
}

/// The mean of brightness, grey levels squared. Decoded points come in Morton order.
double squared_error(const LightField& given, const LightField& decoded) {
  std::vector<std::pair<std::uint64_t, std::size_t>> order;
  for (std::size_t i = 0; i < given.num_points(); ++i)
    order.emplace_back(morton(given.positions[i]), i);
  std::sort(order.begin(), order.end());
  double sum = 0;
  for (std::size_t i = 0; i < order.size(); ++i)
    sum += std::pow(
        (given.components[3 * order[i].second] - decoded.components[3 * i]) / double{1 << kShift},
        2);
  return sum / static_cast<double>(order.size());
}

/// Processor time of a call.
struct Seconds {
  double seconds = 0;

  template <class Work>
  auto of(const Work& work) {
    const std::clock_t start = std::clock();
    auto result = work();
    seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    return result;
  }
};

struct Sums {
  double frames = 0, bytes = 0, geometry = 0, values = 0, error = 0, encoding = 0, decoding = 0;

  void add(std::span<const std::uint8_t> stream, const Seconds& time) {
    encoding += time.seconds;
    bytes += static_cast<double>(stream.size());
    std::size_t at = stream[0] == kSignature[0] ? kSignature.size() : 0;
    while (at < stream.size()) {
      const Unit unit = value_of(read_unit(stream, at));
      if (unit.type == UnitType::kGeometry) geometry += static_cast<double>(unit.bytes);
      if (unit.type == UnitType::kCoefficients) values += static_cast<double>(unit.bytes);
      at += static_cast<std::size_t>(unit.bytes);
    }
  }
  void add_decoded(const LightField& given, const LightField& decoded, const Seconds& time) {
    error += squared_error(given, decoded);
    decoding += time.seconds;
    frames += 1;
  }
  void print(const char* what) const {
    std::printf("  %-10s %9.0f %9.0f %9.0f %8.2f %8.1f %8.1f\n", what, bytes / frames,
                geometry / frames, values / frames, 10 * std::log10(255 * 255 / (error / frames)),
                1e3 * encoding / frames, 1e3 * decoding / frames);
  }
};

void measure(const char* directory, std::uint32_t step, bool brightness_alone) {
  CodingParameters parameters;
  parameters.base_levels = 0;
  parameters.index = false;
  parameters.threads = kThreads;
  parameters.step = {{step, 2 * step, 2 * step}};
  const FrameInputs inputs = value_of(list_frames(std::filesystem::path(directory)));
  FrameEncoder encoder(parameters, static_cast<int>(inputs.frames.size())), alone(parameters, 1);
  std::vector<std::uint8_t> stream;
  std::vector<LightField> fields;
  Sums intra, predicted;
  DecodeOptions options;
  options.threads = kThreads;
  for (std::size_t f = 0; f < inputs.frames.size(); ++f) {
    fields.push_back(field_of(inputs.frames[f], brightness_alone));
    const LightField& field = fields.back();
    Seconds of_frame, of_alone;
    const auto frame =
        of_frame.of([&] { return value_of(encoder.add(field, static_cast<double>(f))); });
    of_alone.of([&] { return value_of(alone.add(field, static_cast<double>(f))); });
    stream.insert(stream.end(), frame.begin(), frame.end());
    if (f == 0) continue;
    predicted.add(frame, of_frame);
    const auto packed = value_of(pack(field, parameters));
    intra.add(packed, of_alone);
    Seconds of_decoding;
    intra.add_decoded(field, of_decoding.of([&] { return value_of(decode(packed, options)); }),
                      of_decoding);
  }
  FrameDecoder decoder = value_of(FrameDecoder::open(stream, options));
  for (std::size_t f = 0; f < fields.size(); ++f) {
    Seconds of_decoding;
    const LightField decoded = of_decoding.of([&] { return value_of(decoder.decode(f)); });
    if (f > 0) predicted.add_decoded(fields[f], decoded, of_decoding);
  }
  std::printf("%s, %zu frames\n", directory, fields.size());
  intra.print("by itself");
  predicted.print("predicted");
  std::printf("  %-10s %8.1f%% %8.1f%% %8.1f%%\n", "", 100 * (predicted.bytes / intra.bytes - 1),
              100 * (predicted.geometry / intra.geometry - 1),
              100 * (predicted.values / intra.values - 1));
}

}  // namespace

int main(int argc, char** argv) {
  const bool brightness_alone = argc > 1 && std::string_view(argv[1]) == "--brightness";
  const int first = brightness_alone ? 2 : 1;
  if (argc < first + 2) {
    std::fprintf(stderr, "bench_frames [--brightness] STEP DIR [DIR ...]\n");
    return 2;
  }
  const auto step = static_cast<std::uint32_t>(std::max(std::atoi(argv[first]), 1)) << kShift;
  std::printf("  %-10s %9s %9s %9s %8s %8s %8s\n", "", "bytes", "geometry", "values", "dB",
              "enc ms", "dec ms");
  for (int i = first + 1; i < argc; ++i) measure(argv[i], step, brightness_alone);
}
