// SPDX-License-Identifier: Apache-2.0
#include "capture/read_scan.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <string_view>

#include "capture/child_process.h"
#include "capture/e57_reader.h"
#include "capture/file_names.h"
#include "capture/json.h"
#include "capture/las_reader.h"
#include "capture/ply_reader.h"

namespace slf {
namespace {

constexpr std::uint64_t kMostSummary = 1 << 24;

/// What `pdal info` says of a scan.
struct Summary {
  std::vector<std::string> dimensions;
  std::string crs;

  bool has(std::string_view dimension) const {
    return std::find(dimensions.begin(), dimensions.end(), dimension) != dimensions.end();
  }
};

InputError no_pdal(const std::filesystem::path& file) {
  return {Errc::kUnsupported,
          file.string() +
              ": LAZ is read by PDAL, which is not there: install "
              "its package pdal (of conda-forge, or of a Debian that has it), or "
              "make a LAS, an E57 or a PLY of it elsewhere"};
}

/// The last line that a program had to say.
std::string last_line(const UnnamedFile& errors) {
  const auto bytes = read_file(errors.path(), kMostSummary);
  if (!bytes) return "";
  std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
  text = text.substr(0, text.find_last_not_of(" \r\n") + 1);
  return std::string(text.substr(text.find_last_of('\n') + 1));
}

/// Runs pdal with these words behind it; what it prints goes to `output`.
Result<Done, InputError> run_pdal(const std::filesystem::path& file, std::vector<std::string> words,
                                  const UnnamedFile& output) {
  words.insert(words.begin(), "pdal");
  SLF_TRY(const UnnamedFile errors, UnnamedFile::create());
  const auto code = run_program(words, output, errors);
  if (!code && code.error().code == Errc::kUnsupported) return no_pdal(file);
  if (!code) return InputError{code.error().code, file.string() + ": " + code.error().message};
  if (*code == 0) return Done{};
  std::string cause = last_line(errors);
  if (cause.empty()) cause = "exit code " + std::to_string(*code);
  return InputError{Errc::kInvalidInput, file.string() + ": pdal " + words[1] + ": " + cause};
}

/// Absolute: a name may begin with anything.
std::string argument(const std::filesystem::path& file) {
  return std::filesystem::absolute(file).string();
}

/// Names with commas and spaces between them.
std::vector<std::string> names_in(const std::string& list) {
  std::vector<std::string> names(1);
  for (const char c : list) {
    if (c == ',')
      names.emplace_back();
    else if (c != ' ')
      names.back().push_back(c);
  }
  return names;
}

Result<Summary, InputError> summary_of(const std::filesystem::path& file) {
  SLF_TRY(const UnnamedFile output, UnnamedFile::create());
  SLF_CHECK(run_pdal(file, {"info", "--summary", argument(file)}, output));
  SLF_TRY(const auto text, read_file(output.path(), kMostSummary));
  SLF_TRY(const JsonValue document, parse_json("pdal info", text));
  SLF_TRY(const JsonView summary, JsonView(document, "pdal info").at("summary"));
  SLF_TRY(const JsonView dimensions, summary.at("dimensions"));
  SLF_TRY(const std::string names, dimensions.string());
  Summary found{names_in(names), {}};
  const auto srs = summary.find("srs");
  for (const char* kind : {"wkt", "compoundwkt"})
    if (const auto entry = srs ? srs->find(kind) : std::nullopt)
      if (const auto wkt = entry->string(); wkt && !wkt->empty()) found.crs = *wkt;
  return found;
}

/// Coordinates, and of colours and normals what is there.
/// @param colour  their type
std::string wanted_dimensions(const Summary& summary, const char* colour) {
  std::string wanted = "X=double,Y=double,Z=double";
  const auto add = [&](const std::array<const char*, 3>& names, const char* type) {
    if (!std::all_of(names.begin(), names.end(), [&](auto name) { return summary.has(name); }))
      return;
    for (const char* name : names) wanted += std::string(",") + name + "=" + type;
  };
  add({"Red", "Green", "Blue"}, colour);
  add({"NormalX", "NormalY", "NormalZ"}, "float");
  return wanted;
}

Result<Mesh, InputError> read_points(const std::filesystem::path& file, const Summary& summary,
                                     const char* colour, std::vector<std::string>* warnings) {
  SLF_TRY(const UnnamedFile ply, UnnamedFile::create());
  SLF_TRY(const UnnamedFile output, UnnamedFile::create());
  SLF_CHECK(run_pdal(file,
                     {"translate", argument(file), ply.path().string(), "--writer", "writers.ply",
                      "--writers.ply.storage_mode=little endian",
                      "--writers.ply.dims=" + wanted_dimensions(summary, colour)},
                     output));
  const std::string name = ply.path().string();  // of no use to a reader
  std::vector<std::string> told;
  auto points = read_ply_mesh(name, false, &told);
  const auto of_scan = [&](const std::string& text) {
    return file.string() + (text.starts_with(name) ? text.substr(name.size()) : ": " + text);
  };
  if (!points) return InputError{points.error().code, of_scan(points.error().message)};
  if (warnings) std::transform(told.begin(), told.end(), std::back_inserter(*warnings), of_scan);
  return points;
}

/// Do colours of 16 bits come from a scanner that wrote 8? Then all are nearly black.
bool has_eight_bits(const PointCloud& cloud) {
  const auto& colours = cloud.colours;
  return !colours.empty() && std::all_of(colours.begin(), colours.end(), [](const auto& colour) {
    return *std::max_element(colour.begin(), colour.end()) <= 1;
  });
}

}  // namespace

bool is_scan(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return extension == ".las" || extension == ".laz" || extension == ".e57";
}

Result<Scan, InputError> read_scan(const std::filesystem::path& file,
                                   std::vector<std::string>* warnings) {
  if (!is_file(file)) return InputError{Errc::kUnreadable, file.string() + ": no such file"};
  if (is_plain_las(file)) return read_las(file, warnings);
  if (extension_of(file) == ".e57") return read_e57(file, warnings);
  SLF_TRY(const Summary summary, summary_of(file));
  SLF_TRY(Mesh points, read_points(file, summary, "uint16_t", warnings));
  if (has_eight_bits(points.vertices))
    if (auto again = read_points(file, summary, "uint8_t", nullptr)) points = *std::move(again);
  return Scan{std::move(points), summary.crs};
}

}  // namespace slf
