#include "attributes/plane_transform.h"

#include <atomic>

#include "attributes/quantiser.h"
#include "bitstream/multiversion.h"
#include "bitstream/prefetch.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kRowGrain = 1024;
constexpr std::size_t kAhead = 8;  // rows

/// sums[i] += component * column[i]. |component| < 2^27, |column[i]| <= 2^20, fewer than 2^12
/// columns of as many rows (their product is at most 2^20): below 2^59.
SLF_MULTIVERSION
void add_column(const std::int32_t* column, std::int32_t component, std::int64_t* sums,
                std::size_t rows) {
  for (std::size_t i = 0; i < rows; ++i) sums[i] += std::int64_t{column[i]} * component;
}

/// Dequantises, and lists the columns whose components are not all zero: few are. False where a
/// component reaches 2^27.
bool dequantise_components(const PlaneTransform& t, std::span<const std::uint32_t> steps,
                           std::int32_t* row, std::vector<std::uint32_t>& columns) {
  bool fits = true;
  columns.clear();
  for (std::size_t c = 0, count = t.columns(); c < count; ++c) {
    const std::size_t begin = t.plane(c), end = begin + t.lanes;
    std::int32_t any = 0;
    for (std::size_t j = begin; j < end; ++j) any |= row[j];
    if (any == 0) continue;
    columns.push_back(static_cast<std::uint32_t>(c));
    for (std::size_t j = begin; j < end; ++j) {
      const std::int64_t product = std::int64_t{row[j]} * steps[j];
      const bool good = product < kCoefficientLimit && product > -kCoefficientLimit;
      row[j] = static_cast<std::int32_t>(good ? product : 0);
      fits = fits && good;
    }
  }
  return fits;
}

/// The channels of the components of a row. False where a value is out of range.
bool mix_channels(const PlaneTransform& t, std::span<const std::uint32_t> columns,
                  std::int32_t* row) {
  bool fits = true;
  for (const std::uint32_t c : columns) {
    std::int32_t* v = row + t.plane(c);
    std::array<std::int64_t, 3> mixed{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& m = t.colour[i];
      mixed[i] = (std::int64_t{m[0]} * v[0] + std::int64_t{m[1]} * v[1] +
                  std::int64_t{m[2]} * v[2] + (1 << (PlaneTransform::kColourBits - 1))) >>
                 PlaneTransform::kColourBits;
      fits = fits && mixed[i] < kCoefficientLimit && mixed[i] > -kCoefficientLimit;
    }
    for (std::size_t i = 0; i < 3; ++i) v[i] = static_cast<std::int32_t>(fits ? mixed[i] : 0);
  }
  return fits;
}

/// sum / 2^kFractionBits is within the limit, of all.
SLF_MULTIVERSION
bool sums_fit(const std::int64_t* sums, std::size_t rows) {
  constexpr std::int64_t kLeast = (1 - kCoefficientLimit) * (1 << PlaneTransform::kFractionBits);
  constexpr std::int64_t kMost = kCoefficientLimit * (1 << PlaneTransform::kFractionBits) - 1;
  std::int64_t bad = 0;  // negative: one is not
  for (std::size_t i = 0; i < rows; ++i) bad |= (sums[i] - kLeast) | (kMost - sums[i]);
  return bad >= 0;
}

/// The values of a row in one lane, before rounding down. False where one is out of range.
bool sum_lane(const PlaneTransform& t, std::span<const std::uint32_t> columns,
              const std::int32_t* row, std::size_t lane, std::span<std::int64_t> sums) {
  std::fill(sums.begin(), sums.end(), 1 << (PlaneTransform::kFractionBits - 1));
  for (const std::uint32_t c : columns)
    if (const std::int32_t component = row[t.plane(c) + lane]; component != 0)
      add_column(&t.matrix[c * sums.size()], component, sums.data(), sums.size());
  if (sums_fit(sums.data(), sums.size())) return true;
  std::fill(sums.begin(), sums.end(), 0);
  return false;
}

}  // namespace

bool expand_row(const PlaneTransform& t, std::span<const std::uint32_t> steps, std::int32_t* row,
                ExpansionScratch& scratch) {
  bool fits = dequantise_components(t, steps, row, scratch.columns);
  if (scratch.columns.empty()) return true;
  if (t.lanes == 3 && t.colour != PlaneTransform::kNoColour)
    fits = mix_channels(t, scratch.columns, row) && fits;
  const std::size_t rows = t.rows();
  auto& sums = scratch.sums;
  sums.resize(t.lanes * rows);
  for (std::size_t lane = 0; lane < t.lanes; ++lane)
    fits =
        sum_lane(t, scratch.columns, row, lane, std::span(sums).subspan(lane * rows, rows)) && fits;
  const auto value = [&](std::size_t i) {
    return static_cast<std::int32_t>(sums[i] >> PlaneTransform::kFractionBits);
  };
  if (t.lanes == 3) {
    for (std::size_t i = 0; i < rows; ++i) {
      std::int32_t* function = row + t.plane(i);
      function[0] = value(i);
      function[1] = value(rows + i);
      function[2] = value(2 * rows + i);
    }
  } else {
    for (std::size_t i = 0; i < rows; ++i) row[t.plane(i)] = value(i);
  }
  return fits;
}

Result<Done> expand_components(const PlaneTransform& transform,
                               std::span<const std::uint32_t> steps, std::span<std::int32_t> values,
                               int threads, std::span<const std::uint8_t> nonzero) {
  std::atomic<bool> fits{true};
  const std::size_t planes = steps.size();
  const auto is_zero = [&](std::size_t row) { return !nonzero.empty() && nonzero[row] == 0; };
  parallel_ranges(
      values.size() / planes, kRowGrain, threads, [&](std::size_t begin, std::size_t end) {
        ExpansionScratch scratch;
        for (std::size_t row = begin; row < end; ++row) {
          if (const std::size_t next = row + kAhead; next < end && !is_zero(next))
            prefetch_row(&values[next * planes], planes);
          if (!is_zero(row) && !expand_row(transform, steps, &values[row * planes], scratch))
            fits = false;
        }
      });
  if (!fits) return Error{Errc::kOutOfRange, "cu_magnitude", 0};
  return Done{};
}

}  // namespace slf
