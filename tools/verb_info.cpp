// SPDX-License-Identifier: Apache-2.0
// slf info: what a file holds, from its headers alone.
#include <map>
#include <memory>

#include "tools/decode_cost_text.h"
#include "tools/describe.h"
#include "tools/frame_source.h"
#include "tools/info_syntax.h"
#include "tools/long_json.h"
#include "tools/stream_input.h"
#include "tools/text.h"
#include "tools/unit_listing.h"
#include "tools/verb.h"

namespace slf::tools {
namespace {

struct InfoOptions {
  std::string input;
  bool units = false, syntax = false;
  LimitOptions limits;
  DecodeLimits asked = DecodeLimits::none();  ///< of limits those that were given
  CommonOptions common;
};

const char* start_name(SliceStart start) {
  constexpr const char* kNames[] = {"shared", "base", "apart"};
  return kNames[static_cast<std::size_t>(start)];
}

nlohmann::ordered_json base_json(const StreamInfo& info) {
  std::uint64_t cells = 0, bytes = 0;
  for (const SliceInfo& slice : info.slices) cells += slice.cells;
  for (const UnitInfo& unit : info.units) bytes += unit.base ? unit.bytes : 0;
  return {
      {"levels", info.base_levels}, {"cells", info.base_levels > 0 ? cells : 0}, {"bytes", bytes}};
}

nlohmann::ordered_json transforms_json(const StreamInfo& info) {
  auto list = nlohmann::ordered_json::array();
  for (const TransformInfo& t : info.transforms)
    list.push_back({{"groups", {t.first_group, t.last_group}},
                    {"functions", t.functions},
                    {"coded_functions", t.coded_functions},
                    {"joint", t.joint},
                    {"colour", t.colour}});
  return list;
}

/// What decoding the whole file takes.
Result<DecodeCost, Failure> cost_of(const StreamFile& file, const InfoOptions& given,
                                    const LimitOptions& limits) {
  auto cost = decode_cost(file.bytes, decode_options(file.info, {}, limits, given.common));
  // More units than the limits of a decode have room for: what that takes is told all the same.
  if (!cost && cost.error().code == Errc::kLimitExceeded)
    cost = decode_cost(file.bytes, decode_options(file.info, {}, {given.asked}, given.common));
  return from(input_name(given.input), cost);
}

/// What decoding takes is told of any file; limits that were given are held against it.
Outcome check_limits(const StreamFile& file, const DecodeCost& cost, const InfoOptions& given) {
  const DecodeLimits& asked = given.asked;
  const char* beyond = file.info.num_points > asked.max_points ? "max_points"
                       : cost.memory_most > asked.max_memory   ? "max_memory"
                       : cost.work > asked.max_work            ? "max_work"
                                                               : nullptr;
  if (beyond == nullptr) return Done{};
  return decode_failure(given.input, {Errc::kLimitExceeded, beyond}, file,
                        decode_options(file.info, {}, given.limits, given.common));
}

nlohmann::ordered_json info_json(const StreamInfo& info, std::uint64_t bytes,
                                 const std::vector<FrameInfo>& frames, const DecodeCost& cost) {
  nlohmann::ordered_json json;
  json["bytes"] = bytes;
  json["version"] = {info.version_major, info.version_minor};
  json["profile"] = info.profile;
  json["level"] = info.level;
  json["complete"] = info.complete;
  json["partial"] = is_partial(info);
  json["decode"] = decode_cost_json(cost, page_memory(info, cost, frames.size()));
  if (frames.size() > 1) json["frames"] = nullptr;
  json["points"] = info.num_points;
  json["slices"] = info.num_slices;
  json["slice_start"] = start_name(info.slice_start);
  json["base"] = base_json(info);
  json["slice"] = nullptr;  // as a list, as units
  if (info.cut)
    json["cut"] = {{"levels", info.cut->levels},
                   {"groups", info.cut->groups},
                   {"layers", info.cut->layers},
                   {"slices", info.cut->slices}};
  json["bits_per_point"] = bits_per_point(frames.front().bytes, info.num_points);
  json["geometry_coder"] = info.geometry_coder;
  json["coefficient_coder"] = info.coefficient_coder;
  json["header"] = header_json(info.header);
  json["groups"] = info.num_groups;
  json["group"] = info.group;
  json["layers"] = info.layers;
  json["step"] = info.step;
  json["transforms"] = transforms_json(info);
  json["bytes_by_type"] = bytes_by_type_json(info, bytes);
  json["units"] = nullptr;
  json["metadata"] = metadata_json(info.metadata);
  return json;
}

/// Functions, shifts and steps of every group on one line.
std::string groups_text(const StreamInfo& info) {
  std::string out;
  for (int g = 0; g < info.num_groups; ++g) {
    std::uint32_t low = 0, high = 0;
    int functions = 0;
    for (std::size_t k = 0; k < info.group.size(); ++k) {
      if (info.group[k] != g) continue;
      for (const std::uint32_t step : info.step[k]) {
        low = functions == 0 ? step : std::min(low, step);
        high = std::max(high, step);
        functions += functions == 0;
      }
    }
    const auto members = std::count(info.group.begin(), info.group.end(), g);
    std::uint64_t bytes = 0;
    for (const UnitInfo& unit : info.units)
      if (unit.group == g) bytes += unit.bytes;
    const int layers = info.layers[static_cast<std::size_t>(g)];
    out += text("  group %-3d %5d function%s steps %u to %u, %s%s bytes\n", g,
                static_cast<int>(members), members == 1 ? ", " : "s,", low, high,
                layers > 1 ? text("%d layers, ", layers).c_str() : "", grouped(bytes).c_str());
  }
  return out;
}

Outcome print_json(const StreamInfo& info, std::uint64_t bytes,
                   const std::vector<FrameInfo>& frames, const PointsOfFrames& points,
                   const DecodeCost& cost) {
  std::vector<LongList> lists;
  if (frames.size() > 1)
    lists.push_back(
        {"frames", frames.size(), [&](std::size_t f) { return frame_json(frames[f], points[f]); }});
  lists.push_back(
      {"slice", info.slices.size(), [&](std::size_t s) { return slice_json(info.slices[s]); }});
  lists.push_back(
      {"units", info.units.size(), [&](std::size_t u) { return unit_json(info.units[u]); }});
  return print(info_json(info, bytes, frames, cost), lists);
}

std::string cut_text(const CutInfo& cut) {
  const auto left = [](int count) { return count > 0 ? std::to_string(count) : "all"; };
  return text(
      "  cut           to levels %d, groups %s, layers %s, slices %s; its end may be cut too\n",
      cut.levels, left(cut.groups).c_str(), left(cut.layers).c_str(), cut.slices ? "some" : "all");
}

std::string base_text(const StreamInfo& info) {
  constexpr const char* how[] = {"after the first", "each alone", "apart"};
  const auto base = base_json(info);
  const std::string slices =
      info.num_slices > 1
          ? std::string("; slices ") + how[static_cast<std::size_t>(info.slice_start)]
          : "";
  return text("  base          %d levels, %s cells, %s bytes%s\n", info.base_levels,
              grouped(base["cells"].get<std::uint64_t>()).c_str(),
              grouped(base["bytes"].get<std::uint64_t>()).c_str(), slices.c_str());
}

std::string info_text(const StreamInfo& info, const std::string& file, std::uint64_t all_bytes,
                      const std::vector<FrameInfo>& frames, const PointsOfFrames& points,
                      bool units, const DecodeCost& cost) {
  const std::uint64_t bytes = frames.front().bytes;
  std::string out = printable(input_name(file)) + ": " + grouped(all_bytes) +
                    " bytes, .slf version " +
                    text("%d.%d, profile %d, level %d", info.version_major, info.version_minor,
                         info.profile, info.level) +
                    (info.complete ? "\n" : ", CUT SHORT (no end unit)\n");
  out += frames_text(frames);
  out += text("  points        %s in %llu slice%s, %.3f bits per point%s\n",
              grouped(info.num_points).c_str(), static_cast<unsigned long long>(info.num_slices),
              info.num_slices == 1 ? "" : "s", bits_per_point(bytes, info.num_points),
              is_partial(info) ? " of the whole" : "");
  if (info.base_levels > 0) out += base_text(info);
  if (info.cut) out += cut_text(*info.cut);
  out += decode_cost_text(cost, page_memory(info, cost, frames.size()));
  out += header_text(info.header);
  out += text("  coders        %s geometry", info.geometry_coder.c_str());
  out += info.header.num_functions > 0 ? ", " + info.coefficient_coder + " coefficients" : "";
  out += info.texture_bits > 0 ? text(" of %d bits\n", info.texture_bits) : "\n";
  if (info.header.num_functions > 0) out += groups_text(info);
  for (const TransformInfo& t : info.transforms)
    out += text("  transform     groups %d to %d, %d of %d functions coded, %s\n", t.first_group,
                t.last_group, t.coded_functions, t.functions,
                t.joint    ? "joint"
                : t.colour ? "with channels"
                           : "channels alike");
  out += "\n" + bytes_by_type_text(info, bytes);
  out += frame_table_text(frames, points);
  if (info.num_slices > 1) out += slices_text(info);
  if (units) out += units_text(info);
  if (!info.metadata.empty()) out += "\nmetadata\n";
  for (const auto& [key, value] : info.metadata)
    out += text("  %-20s %s\n", printable(key).c_str(), printable(value).c_str());
  return out;
}

Outcome run_info(const InfoOptions& given) {
  const LimitOptions any{given.asked, given.limits.strict};  // but for those that were given
  SLF_TRY(const StreamFile file, read_stream(given.input, any, given.common, UnitList::kKept));
  auto cost = cost_of(file, given, given.limits);
  if (cost) SLF_CHECK(check_limits(file, *cost, given));
  if (given.syntax) return print_syntax(file.bytes, given.input, given.asked, given.common.json);
  if (!cost) return cost.error();
  cost->memory += file.bytes.size();
  cost->memory_most += file.bytes.size();
  SLF_TRY(const auto frames, from(input_name(given.input), list_frames(file.bytes, given.asked)));
  PointsOfFrames points;
  if (frames.size() > 1) {
    SLF_TRY(points, from(input_name(given.input), list_points(file.bytes, given.asked)));
  }
  const std::uint64_t bytes = file.bytes.size();
  if (given.common.json) return print_json(file.info, bytes, frames, points, *cost);
  return print(info_text(file.info, given.input, bytes, frames, points, given.units, *cost));
}

}  // namespace

void add_info(CLI::App& program, Run& run) {
  auto* verb =
      program.add_subcommand("info", "Show what an .slf file holds, from its headers alone");
  auto o = std::make_shared<InfoOptions>();
  verb->add_option("FILE", o->input, "The .slf file; - is standard input")
      ->type_name("")
      ->required();
  verb->add_flag("--units", o->units, "List every unit (JSON always does)");
  verb->add_flag("--syntax", o->syntax,
                 "Print every element of the headers with its byte and bit, coding and value");
  add_limits(*verb, o->limits);
  for (const char* limit : {"--max-memory", "--max-points", "--max-work"})
    verb->get_option(limit)->group(
        "Limits (info tells of any file; those given refuse, exit code 5)");
  verb->get_option("--strict")->group(verb->get_option("--max-memory")->get_group());
  add_threads(*verb, o->common);
  verb->get_option("--threads")->description("Threads of the decoding whose memory is told");
  add_quiet(*verb, o->common);
  verb->get_option("--quiet")->description("No warnings");
  add_json(*verb, o->common);
  verb->callback([&run, o, verb] {
    const DecodeLimits& limits = o->limits.limits;
    if (verb->count("--max-memory") > 0) o->asked.max_memory = limits.max_memory;
    if (verb->count("--max-points") > 0) o->asked.max_points = limits.max_points;
    if (verb->count("--max-work") > 0) o->asked.max_work = limits.max_work;
    run = [o] { return run_info(*o); };
  });
}

}  // namespace slf::tools
