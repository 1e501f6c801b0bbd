// SPDX-License-Identifier: Apache-2.0
#include "tools/options.h"

#include <charconv>
#include <string_view>

#include "tools/text.h"

namespace slf::tools {
namespace {

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

}  // namespace

CLI::Validator range(double low, double high) {
  const std::string between = shortest(low) + " to " + shortest(high);
  return CLI::Validator(
      [=](std::string& given) {
        double value = 0;
        const char* end = given.data() + given.size();
        const auto [stopped, error] = std::from_chars(given.data(), end, value);
        if (error == std::errc::invalid_argument || stopped != end)
          return given + " is not a number";
        if (error != std::errc() || !(value >= low && value <= high))
          return given + " is not in the range " + between;
        return std::string();
      },
      between);
}

CLI::Validator whole_range(std::int64_t low, std::int64_t high) {
  const std::string between = std::to_string(low) + " to " + std::to_string(high);
  return CLI::Validator(
      [=](std::string& given) {
        std::int64_t value = 0;
        const char* end = given.data() + given.size();
        const auto [stopped, error] = std::from_chars(given.data(), end, value);
        if (error == std::errc::invalid_argument || stopped != end)
          return given + " is not a whole number";
        if (error != std::errc() || value < low || value > high)
          return given + " is not in the range " + between;
        return std::string();
      },
      between);
}

CLI::Validator byte_range(std::int64_t low, std::int64_t high) {
  const std::string between = std::to_string(low) + " to " + std::to_string(high);
  const auto check = [=](std::string& given) {
    constexpr std::string_view kUnits = "KMGT";
    std::string_view digits = given;
    const std::size_t unit = digits.empty() ? kUnits.npos : kUnits.find(upper(digits.back()));
    const int shift = unit == kUnits.npos ? 0 : 10 * static_cast<int>(unit + 1);
    if (unit != kUnits.npos) digits.remove_suffix(1);
    std::int64_t number = 0;
    const char* end = digits.data() + digits.size();
    const auto [stopped, error] = std::from_chars(digits.data(), end, number);
    if (error == std::errc::invalid_argument || stopped != end)
      return given + " is not a whole number of bytes, alone or with K, M, G or T behind it";
    if (error != std::errc() || number < 0 || number > high >> shift || number << shift < low)
      return given + " is not in the range " + between;
    given = std::to_string(number << shift);
    return std::string();
  };
  return CLI::Validator(check, between);
}

void add_threads(CLI::App& verb, CommonOptions& options) {
  verb.add_option("-j,--threads", options.threads,
                  "Threads; 0 is all cores. Never changes a result")
      ->capture_default_str()
      ->check(whole_range(0, 1024));
}

void add_quiet(CLI::App& verb, CommonOptions& options) {
  verb.add_flag("--quiet", options.quiet, "No progress, no report, no warnings; errors only");
}

void add_json(CLI::App& verb, CommonOptions& options) {
  verb.add_flag("--json", options.json, "Report as JSON on standard output");
}

void add_part(CLI::App& verb, PartOptions& options) {
  verb.add_option("--levels", options.levels,
                  "Octree levels to decode, 1 to the grid's bits; 0 is all. Fewer: a coarser cloud")
      ->capture_default_str()
      ->check(whole_range(0, 21));
  verb.add_option(
          "--groups", options.groups,
          "Plane groups to decode, 1 to what the file has; 0 is all. Fewer: smoother colour")
      ->capture_default_str()
      ->check(whole_range(0, 16));
  verb.add_option(
          "--layers", options.layers,
          "Quality layers to decode, 1 to what the file has; 0 is all. Fewer: a coarser quantiser")
      ->capture_default_str()
      ->check(whole_range(0, 4));
  verb.add_option("--max-bytes", options.max_bytes,
                  "Use only the units that end within the first BYTES; 0 is all")
      ->capture_default_str()
      ->check(whole_range(0, std::int64_t{1} << 40));
  verb.add_option("--region", options.region,
                  "Only points in a box: X0,Y0,Z0,X1,Y1,Z1, two corners in world units. Slices "
                  "outside are not decoded")
      ->delimiter(',')
      ->expected(6)
      ->check(range(-1e300, 1e300));
}

void add_points(CLI::App& verb, std::string& points, std::optional<WorldChange>& world) {
  verb.add_option("--points", points,
                  "Cloud (PLY, LAS, E57; LAZ with PDAL) or mesh (PLY with faces, OBJ, STL, GLB, "
                  "glTF) in place of the capture's own")
      ->type_name("FILE");
  verb.add_option_function<std::string>(
          "--points-world",
          [&world](const std::string& text) {
            const auto change = parse_world_change(text);
            if (!change) throw CLI::ValidationError("--points-world", change.error().message);
            world = *change;
          },
          "Brings points into the world of the cameras: new axes, as x,-z,y, then a scale and a "
          "shift, as x,y,z,0.001,0,0,2; write --points-world=-y,x,z where a sign comes first")
      ->type_name("X,Y,Z[,S[,X,Y,Z]]");
}

void add_frame(CLI::App& verb, PartOptions& options) {
  verb.add_option(
          "--frame", options.frame,
          "Frame to decode of a light field that moves: 0 is the first. Those before it in its "
          "group are decoded, too")
      ->type_name("N")
      ->check(whole_range(0, (std::int64_t{1} << 31) - 1));
}

void add_frames_to_show(CLI::App& verb, PartOptions& options) {
  add_frame(verb, options);
  verb.add_option("--frames", options.frames,
                  "Several, both included; the name of the output has %d or %04d for the number")
      ->type_name("A:B")
      ->excludes("--frame");
}

double Stopwatch::lap() {
  const auto now = std::chrono::steady_clock::now();
  const std::chrono::duration<double> taken = now - last_;
  last_ = now;
  return taken.count();
}

bool parse_size(const std::string& given, int& width, int& height) {
  const char* end = given.data() + given.size();
  const auto [cross, first] = std::from_chars(given.data(), end, width);
  if (first != std::errc() || cross == end || (*cross != 'x' && *cross != 'X')) return false;
  const auto [last, second] = std::from_chars(cross + 1, end, height);
  return second == std::errc() && last == end && width >= 1 && width <= 16384 && height >= 1 &&
         height <= 16384;
}

}  // namespace slf::tools
