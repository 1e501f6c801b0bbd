// SPDX-License-Identifier: Apache-2.0
#include "tools/rd/igc/igc_parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "bitstream/encoder/deflate.h"
#include "bitstream/inflate.h"
#include "encoder/check_settings.h"
#include "encoder/fit_capture.h"
#include "encoder/setting_rows.h"

namespace slf {
namespace {

constexpr std::size_t kLengthBytes = 4;
constexpr std::size_t kMostText = std::size_t{1} << 24;
constexpr int kMostSize = 8192, kMostCameras = 65536;

/// What the decoder observes, fits and chooses from the images that it decoded, as the encoder of
/// .slf would.
constexpr std::initializer_list<SettingPart> kParts = {SettingPart::kObservation, SettingPart::kFit,
                                                       SettingPart::kSearch};

/// Writes lines.
class LineWriter {
 public:
  void whole(const char* key, int value, int, int) { line(key, std::to_string(value)); }
  void rows(const EncoderSettings& settings) {
    for (const auto& [name, value] : kept_settings(settings, kParts)) line(name.c_str(), value);
  }
  void text(const char* key, std::string_view value) {
    if (value.find('\n') != std::string_view::npos) broken_ = key;
    line(key, value);
  }

  const std::string& lines() const { return lines_; }
  const char* broken() const { return broken_; }  ///< a key whose value has a line end, or null

 private:
  void line(const char* key, std::string_view value) {
    lines_.append(key).append("=").append(value).append("\n");
  }
  std::string lines_;
  const char* broken_ = nullptr;
};

/// Reads the same lines in the same order. The first failure sticks.
class LineReader {
 public:
  explicit LineReader(std::string_view lines) : rest_(lines) {}

  void whole(const char* key, int& value, int low, int high) {
    const std::string_view given = line(key);
    const auto [stop, error] = std::from_chars(given.data(), given.data() + given.size(), value);
    if (error != std::errc() || stop != given.data() + given.size() || value < low || value > high)
      fail(key);
  }
  void rows(EncoderSettings& settings) {
    GivenSettings kept = kept_settings(settings, kParts);
    for (auto& [name, value] : kept) value = line(name.c_str());
    if (const auto put = put_settings(kept, kParts, settings); !put && ok()) fail("settings");
  }
  void text(const char* key, std::string& value) { value = line(key); }

  bool ok() const { return failed_ == nullptr; }
  const char* failed() const { return failed_; }
  bool at_end() const { return rest_.empty(); }
  Metadata take_read() { return std::move(read_); }

 private:
  std::string_view line(const char* key) {
    const std::string_view name(key);
    const std::size_t end = rest_.find('\n');
    if (failed_ != nullptr || end == std::string_view::npos || !rest_.starts_with(name) ||
        end <= name.size() || rest_[name.size()] != '=') {
      fail(key);
      return {};
    }
    const std::string_view value = rest_.substr(name.size() + 1, end - name.size() - 1);
    rest_ = rest_.substr(end + 1);
    const bool of_a_list = name == "camera" || name == "key" || name == "value";
    if (!of_a_list) read_.emplace_back(name, value);
    return value;
  }
  void fail(const char* key) {
    if (failed_ == nullptr) failed_ = key;
  }
  std::string_view rest_;
  Metadata read_;
  const char* failed_ = nullptr;
};

template <class V, class E>
void choice(V& v, const char* key, E& chosen, int most) {
  int value = static_cast<int>(chosen);
  v.whole(key, value, 0, most);
  if constexpr (!std::is_const_v<E>) chosen = static_cast<E>(value);
}

/// Written once for reading and writing. P is const when V writes.
template <class V, class P>
void settings_lines(V& v, P& s) {
  choice(v, "codec", s.codec, 2);
  v.whole("qp", s.qp, 0, 63);
  choice(v, "chroma", s.chroma, 1);
  v.text("speed", s.speed);
  choice(v, "transfer", s.slf.observe.transfer, 1);
  choice(v, "colour", s.slf.colour, 1);
  v.rows(s.slf);
}

/// The list's length, then one line each.
template <class V, class List, class Each>
void list_lines(V& v, const char* count_key, List& list, int most, const Each& each) {
  int count = static_cast<int>(list.size());
  v.whole(count_key, count, 0, most);
  if constexpr (!std::is_const_v<List>) {
    for (int i = 0; i < count && v.ok(); ++i) each(list.emplace_back());
  } else {
    for (const auto& entry : list) each(entry);
  }
}

template <class V, class P>
void parameter_lines(V& v, P& p) {
  v.whole("width", p.width, 1, kMostSize);
  v.whole("height", p.height, 1, kMostSize);
  settings_lines(v, p.settings);
  list_lines(v, "metadata", p.settings.slf.metadata, kMostCameras, [&](auto& pair) {
    v.text("key", pair.first);
    v.text("value", pair.second);
  });
  list_lines(v, "cameras", p.cameras, kMostCameras, [&](auto& name) { v.text("camera", name); });
}

InputError damaged(const std::string& what) {
  return {Errc::kInvalidInput, "parameters of the IGC file: " + what};
}

}  // namespace

Result<std::vector<std::uint8_t>, InputError> write_igc_parameters(
    const IgcParameters& parameters) {
  LineWriter writer;
  parameter_lines(writer, parameters);
  if (writer.broken() != nullptr)
    return InputError{Errc::kInvalidArgument, std::string(writer.broken()) + ": holds a line end"};
  const std::string& text = writer.lines();
  if (text.size() > kMostText)
    return InputError{Errc::kInvalidArgument, "names and metadata: more than 16 MiB"};
  const auto packed = deflate({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::vector<std::uint8_t> out(kLengthBytes + packed.size());
  for (std::size_t i = 0; i < kLengthBytes; ++i)
    out[i] = static_cast<std::uint8_t>(text.size() >> 8 * i);
  std::copy(packed.begin(), packed.end(), out.begin() + kLengthBytes);
  return out;
}

Result<IgcParameters, InputError> read_igc_parameters(std::span<const std::uint8_t> section,
                                                      Metadata& lines) {
  if (section.size() < kLengthBytes) return damaged("cut short");
  std::size_t size = 0;
  for (std::size_t i = 0; i < kLengthBytes; ++i) size |= std::size_t{section[i]} << 8 * i;
  if (size > kMostText) return damaged("too long");
  const auto text = inflate(section.subspan(kLengthBytes), size, "igc_parameters");
  if (!text) return damaged("do not inflate");
  LineReader reader({reinterpret_cast<const char*>(text->data()), text->size()});
  IgcParameters parameters;
  parameter_lines(reader, parameters);
  if (!reader.ok()) return damaged(reader.failed());
  if (!reader.at_end()) return damaged("more lines than known");
  if (parameters.cameras.empty()) return damaged("no cameras");
  SLF_CHECK(check_settings(parameters.settings.slf));
  lines = reader.take_read();
  const Metadata& metadata = parameters.settings.slf.metadata;
  lines.insert(lines.end(), metadata.begin(), metadata.end());
  return parameters;
}

}  // namespace slf
