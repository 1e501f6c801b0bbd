// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/decode_cost.h"

#include <algorithm>

#include "attributes/vector_states.h"
#include "codec/decoder/frame_cost.h"
#include "codec/decoder/scene_decoder.h"
#include "geometry/occupancy_states.h"
#include "slf/parallel.h"

namespace slf {
namespace {
/// What is usual, and what nothing exceeds. Bytes, unless said.
struct Bytes {
  double usual = 0, most = 0;

  static Bytes both(double bytes) { return {bytes, bytes}; }
  Bytes operator+(const Bytes& other) const { return {usual + other.usual, most + other.most}; }
  Bytes operator*(double factor) const { return {usual * factor, most * factor}; }
  Bytes at_least(const Bytes& other) const {
    return {std::max(usual, other.usual), std::max(most, other.most)};
  }
};

// Bytes of a point, of what the arrays named hold. Where a figure depends on the scene, the usual
// one is what scenes of docs/decisions/009 have: surfaces, of a third as many nodes a level up,
// with ten neighbours each; 26 and as many nodes are the most.
constexpr double kVoxel = 12, kCode = 8;
constexpr double kTop = 16 + 1 + 4 + 4 + 4;  // RahtTop: merges, split, parent, order, first
constexpr Bytes kWaiting{kVoxel + kCode + 1.2 * kTop, kVoxel + kCode + 2 * kTop},  // SliceGeometry
    kWaitingAlone{kVoxel, kVoxel + kCode};                                         // without values
constexpr double kNode = 8 + 1 + 4 + 8;  // OctreeLevel without neighbours
constexpr Bytes kOctree{(kNode + 4 * 10) / 3 + kCode + 1, 2 * (kNode + 4 * 26) + kCode + 1};
constexpr Bytes kDraco{90, 160};            // inside the library: by measurement
constexpr double kNeighbours = 24 + 4 + 4;  // CoefficientNeighbours, weights beside
constexpr double kOfGroup = 2 + 4 + 1;      // VectorCoefficients: sum_, vector_of_, runs_
constexpr double kFlags = 2;                // ValueState: nonzero, of_unit
/// TransformLevels: codes, first, sums; begins, rows of two levels; places; nodes; which means.
constexpr Bytes kLevels{36 + 9 + 22 + 20 + 6, 2 * 36 + 9 + 32 + 2 * (kNode + 4 * 26) + 24};
constexpr double kKept = 2;           // bytes of a value in a vector that is kept
constexpr double kBitsOfHalf = 16;    // bits of a point with which half of the vectors are not zero
constexpr double kUsualOthers = 0.9;  // of slices beside one at its peak, on other threads
constexpr double kUsualMeans = 0.02;  // of all rows, whose means are needed at a time
constexpr double kSample = 2, kPicturesMost = 17, kPictures = 4, kSamplesMost = 16, kSamples = 2;
constexpr double kCellOfAtlas = 60;
constexpr double kCoefficientStates = sizeof(VectorStates);  // a group
constexpr double kIndependentStates = 300;                   // a plane
constexpr double kHistory = (3 << 18) + (3 << 14);  // of columns and slabs, of an octree at work

class Model {
 public:
  explicit Model(const DecodeShape& shape)
      : shape_(shape), planes_(static_cast<double>(shape.planes)) {
    for (const std::uint64_t points : shape.slices) {
      points_ += points;
      largest_ = std::max(largest_, points);
    }
  }

  /// threads: at most as many as there are slices.
  DecodeCost cost(int threads) {
    active_ = shape_.slices.empty() ? 0 : threads;
    const Bytes slices = shape_.base_alone ? Bytes{} : output() + in_flight() + frames();
    const Bytes bytes = lists() + base() + slices;
    return {static_cast<std::uint64_t>(bytes.usual), static_cast<std::uint64_t>(bytes.most),
            work()};
  }

 private:
  /// Bytes of units and slices, however little is in them.
  Bytes lists() const {
    return Bytes::both(static_cast<double>(kMemoryOfUnit * (shape_.units + shape_.slices.size())));
  }

  /// Bytes of a row, while its components are decoded.
  Bytes values() const {
    if (planes_ == 0) return {};
    if (shape_.texture) return texture();
    Bytes row = Bytes::both(kFlags) + contexts();
    if (shape_.ahead) row = row + Bytes::both(4 * planes_);
    if (shape_.prediction || shape_.kept)
      row = row + kLevels + Bytes{kUsualMeans, 1} * (4 * planes_);
    return row;
  }

  /// Bytes of a row, for the vectors coded around it.
  Bytes contexts() const {
    if (planes_ == 0 || !shape_.vector) return {};
    return Bytes::both(kNeighbours + kOfGroup * layers() * static_cast<double>(shape_.groups)) +
           Bytes{usual_vectors(), 1} * (kKept * layers() * planes_);
  }

  double layers() const { return static_cast<double>(shape_.layers); }

  /// Share of rows with a vector that is not zero: contexts keep these alone.
  double usual_vectors() const {
    if (shape_.coefficient_bits < 0) return 1;
    return shape_.coefficient_bits / (shape_.coefficient_bits + kBitsOfHalf);
  }

  /// Pictures that a video decoder keeps, and the map of points to pixels.
  Bytes texture() const {
    return Bytes{kPictures * kSamples, kPicturesMost * kSamplesMost} * kSample +
           Bytes::both(kCellOfAtlas + 8);
  }

  Bytes geometry() const { return shape_.draco ? kDraco : kOctree; }

  double row_of_output() const { return kVoxel + 4 * planes_ + (shape_.normals ? 4 : 0); }

  Bytes output() const { return Bytes::both(static_cast<double>(points_) * row_of_output()); }

  /// Slices that are begun (SliceSchedule); of them as many at work as there are threads.
  Bytes in_flight() const {
    const double points = static_cast<double>(points_), largest = static_cast<double>(largest_);
    const double usual = active_ > 1 ? active_ + 1 : 1,
                 most = active_ > 1 ? std::max(2 * active_ * largest, double{kPointsInFlight})
                                    : largest;
    const Bytes point = planes_ > 0 || shape_.normals ? kWaiting : kWaitingAlone;
    const Bytes waiting{point.usual * std::min(usual * largest, points),
                        point.most * std::min(most, points)};
    const Bytes octrees = at_work(geometry()) + Bytes::both(states_of_octrees(active_));
    const Bytes rows = at_work(values()) + Bytes::both(states_of_octrees(0) + states_of_values());
    return waiting + octrees.at_least(rows);
  }

  /// What a frame of several leaves to the next, and has of the one before.
  Bytes frames() const {
    const FrameCost cost = frame_cost(shape_, points_);
    return {cost.usual, cost.most};
  }

  double coefficient_states() const {
    return shape_.vector ? kCoefficientStates * layers() * static_cast<double>(shape_.groups)
                         : kIndependentStates * planes_;
  }

  /// As many slices as there are threads. All at their peak at once is not what happens.
  Bytes at_work(const Bytes& row) const {
    const double points = static_cast<double>(points_), largest = static_cast<double>(largest_);
    return {row.usual * std::min((1 + kUsualOthers * (active_ - 1)) * largest, points),
            row.most * std::min(active_ * largest, points)};
  }

  /// Those of the base, those that slice 0 hands on, and those of octrees at work.
  double states_of_octrees(double at_work) const {
    if (shape_.draco) return 0;
    const double handed = shape_.shared_states ? static_cast<double>(shape_.geometry_units) : 0;
    return (1 + handed + at_work) * static_cast<double>(OccupancyStates::bytes(points_)) +
           at_work * kHistory;
  }

  /// The same of coefficients.
  double states_of_values() const {
    if (planes_ == 0 || shape_.texture) return 0;
    const double handed = shape_.shared_states ? static_cast<double>(shape_.coefficient_units) : 0;
    const double of_base = shape_.cells > 0 ? 1 : 0;
    return (active_ + of_base) * coefficient_states() + handed * kCoefficientStates;
  }

  /// Cells, their values and contexts stay until the last slice is done; the rest is given back
  /// before the most is needed, as a rule.
  Bytes base() const {
    if (shape_.cells == 0 && !shape_.base_alone) return {};
    const auto cells = static_cast<double>(shape_.cells);
    Bytes row = Bytes::both(2 * kCode + kTop + 8 + 4 * planes_) + values().at_least(kOctree);
    if (shape_.base_alone) return (row + Bytes::both(kVoxel)) * cells;
    return Bytes{kCode + 8 + 4 * planes_ + contexts().usual, row.most} * cells;
  }

  std::uint64_t work() const {
    const std::uint64_t slices = shape_.base_alone ? 0 : points_;
    const std::uint64_t nodes = slices * (shape_.draco ? 1 : shape_.levels - shape_.base_levels) +
                                shape_.cells * shape_.base_levels;
    return 8 * nodes + (slices + shape_.cells) * std::max<std::uint64_t>(shape_.planes, 1) +
           copies();
  }

  /// Slices start from states of their own, a copy of the base's or, for each unit, of slice 0's:
  /// a step is 64 bytes, 6 GB a second.
  std::uint64_t copies() const {
    const bool each = shape_.shared_states;
    if (shape_.slices.size() < 2 || shape_.draco) return 0;
    const double geometry = each ? static_cast<double>(shape_.geometry_units) : 1,
                 values = static_cast<double>(each ? shape_.coefficient_units : shape_.groups),
                 bytes = kHistory +
                         geometry * static_cast<double>(OccupancyStates::bytes(points_)) +
                         values * (shape_.vector ? kCoefficientStates : 0);
    return static_cast<std::uint64_t>(static_cast<double>(shape_.slices.size()) * bytes / 64);
  }

  const DecodeShape& shape_;
  double planes_;
  std::uint64_t points_ = 0, largest_ = 0;
  double active_ = 1;
};

}  // namespace

CostOnThreads cost_of(const DecodeShape& shape, const DecodeOptions& options) {
  Model model(shape);
  int active = thread_count(options.threads, shape.slices.size()), threads = options.threads;
  DecodeCost cost = model.cost(active);
  while (active > 1 && cost.memory_most > options.limits.max_memory)
    cost = model.cost(threads = --active);
  return {cost, threads};
}

DecodeShape shape_of(const Request& request) {
  const StreamHeader& stream = request.stream;
  const SequenceParameterSet& set = stream.set;
  DecodeShape shape;
  for (const SliceEntry& slice : stream.table.slices) shape.slices.push_back(slice.points());
  shape.units = stream.units;
  shape.cells = stream.num_cells();
  shape.planes = request.planes();
  shape.groups = request.groups.size();
  shape.levels = set.grid_bits();
  shape.base_levels = set.sps_base_levels;
  shape.geometry_units = set.geometry_ranges() - set.base_geometry_ranges();
  shape.layers = static_cast<std::uint64_t>(request.layers);
  shape.coefficient_units =
      std::uint64_t{set.coefficient_ranges() - set.base_coefficient_ranges()} * shape.groups *
      shape.layers;
  shape.base_alone = request.base_alone();
  shape.vector = set.has_vectors();
  shape.prediction = set.sps_prediction_flag != 0;
  shape.draco = set.has_draco();
  shape.texture = set.has_texture();
  shape.normals = set.sps_normal_bits > 0;
  shape.shared_states = stream.table.shared();
  shape.kept = request.kept != nullptr;
  shape.reference_contexts = set.has_reference_contexts();
  shape.reference = request.reference;
  shape.ahead = (shape.shared_states || shape.kept) && request.kept_levels_only();
  return shape;
}

Result<Done> check_values(const Request& request, std::uint64_t rows) {
  if (rows > request.most_values / std::max<std::uint64_t>(request.planes(), 1))
    return Error{Errc::kLimitExceeded, "max_values_per_byte"};
  return Done{};
}

namespace {

Result<CostOnThreads> within_limits(const DecodeShape& shape, std::uint64_t points,
                                    const DecodeOptions& options) {
  const DecodeLimits& limits = options.limits;
  if (points > limits.max_points) return Error{Errc::kLimitExceeded, "max_points"};
  const CostOnThreads cost = cost_of(shape, options);
  if (cost.memory_most > limits.max_memory) return Error{Errc::kLimitExceeded, "max_memory"};
  if (cost.work > limits.max_work) return Error{Errc::kLimitExceeded, "max_work"};
  return cost;
}

/// The slices are not known that will be opened.
bool waits_for_base(const Request& request) {
  return request.region && request.stream.has_base() && !request.base_alone();
}

}  // namespace

Result<CostOnThreads> check_limits(const Request& request, const DecodeOptions& options) {
  const StreamHeader& stream = request.stream;
  DecodeShape shape = shape_of(request);
  if (waits_for_base(request)) shape.base_alone = true;
  const std::uint64_t points =
      shape.base_alone ? stream.table.num_cells() : stream.table.num_points();
  SLF_TRY(const CostOnThreads cost, within_limits(shape, points, options));
  // Other streams are held to what is there.
  if (stream.complete && !request.missing && !request.region)
    SLF_CHECK(check_values(request, points + (request.base_alone() ? 0 : stream.num_cells())));
  return cost;
}

Result<CostOnThreads> check_limits_of_slices(const Request& request, const DecodeOptions& options,
                                             const std::vector<std::uint8_t>& chosen) {
  DecodeShape shape = shape_of(request);
  shape.slices.clear();
  std::uint64_t points = 0;
  for (std::size_t s = 0; s < chosen.size(); ++s) {
    if (!chosen[s]) continue;
    shape.slices.push_back(request.stream.table.slices[s].points());
    points += shape.slices.back();
  }
  return within_limits(shape, points, options);
}

Result<DecodeCost> decode_cost(std::span<const std::uint8_t> stream, const DecodeOptions& options) {
  SLF_TRY(const OpenStream opened, open_stream(stream, options.limits, options.max_bytes));
  SLF_TRY(const Request request, request_of(opened.units, opened.scene, options));
  DecodeShape shape = shape_of(request);
  if (const std::uint64_t points = request.stream.table.num_points(); points > 0)
    shape.coefficient_bits = 8.0 * static_cast<double>(bytes_wanted(opened.scene, request, true)) /
                             static_cast<double>(points);
  return cost_of(shape, options);
}

}  // namespace slf
