// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ.
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <unordered_map>

#include "capture/exact_positions.h"
#include "capture/mesh_formats.h"

namespace slf {

namespace {

using Floats = std::array<float, 3>;

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The next word of a line, taken off it; empty at the end.
std::string_view next_word(std::string_view& line) {
  while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
  std::size_t end = 0;
  while (end < line.size() && !is_space(line[end])) ++end;
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

template <class T>
std::optional<T> number_in(std::string_view word) {
  if (word.size() > 1 && word[0] == '+') word.remove_prefix(1);  // from_chars does not know it
  T value{};
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

/// A corner of a face: position and normal, from 0; no normal: -1.
struct Corner {
  std::int64_t position = -1, normal = -1;
};

class ObjParser {
 public:
  explicit ObjParser(const std::string& name) : name_(name) {}

  Result<Mesh, InputError> parse(std::string_view text) {
    for (std::size_t at = 0; at < text.size(); ++line_) {
      const std::size_t end = std::min(text.find('\n', at), text.size());
      SLF_CHECK(line(text.substr(at, end - at)));
      at = end + 1;
    }
    return with_normals();
  }

 private:
  Result<Done, InputError> line(std::string_view rest) {
    const std::string_view keyword = next_word(rest);
    if (keyword == "v") return triple(rest, positions_);
    if (keyword == "vn") return triple(rest, normals_);
    if (keyword == "f") return face(rest);
    return Done{};
  }

  // What follows the three numbers, a weight or a colour, is not read.
  template <class T>
  Result<Done, InputError> triple(std::string_view rest, std::vector<std::array<T, 3>>& values) {
    std::array<T, 3> triple{};
    for (T& x : triple) {
      const auto value = number_in<T>(next_word(rest));
      if (!value || (std::isfinite(*value) && !std::isfinite(static_cast<float>(*value))))
        return invalid("three numbers are expected");
      x = *value;
    }
    values.push_back(triple);
    return Done{};
  }

  Result<Done, InputError> face(std::string_view rest) {
    std::array<Corner, 3> fan{};
    std::size_t corners = 0;
    for (auto word = next_word(rest); !word.empty() && word[0] != '#'; word = next_word(rest)) {
      SLF_TRY(const Corner corner, corner_of(word));
      fan[std::min<std::size_t>(corners, 2)] = corner;
      if (++corners < 3) continue;
      for (const Corner& c : fan) corners_.push_back(c);
      fan[1] = fan[2];
    }
    if (corners < 3) return invalid("a face of fewer than three corners");
    return Done{};
  }

  /// "p", "p/t", "p//n" or "p/t/n".
  Result<Corner, InputError> corner_of(std::string_view word) const {
    Corner corner;
    const std::size_t first = word.find('/');
    SLF_TRY(corner.position, index_in(word.substr(0, first), positions_.size()));
    if (first == std::string_view::npos) return corner;
    const std::size_t second = word.find('/', first + 1);
    if (second == std::string_view::npos) return corner;
    SLF_TRY(corner.normal, index_in(word.substr(second + 1), normals_.size()));
    return corner;
  }

  /// Counted from 1, or back from the last so far where negative.
  Result<std::int64_t, InputError> index_in(std::string_view word, std::size_t so_far) const {
    const auto given = number_in<std::int64_t>(word);
    const auto count = static_cast<std::int64_t>(so_far);
    if (!given) return invalid("a face's index is no whole number");
    if (*given < -count || *given == 0 || *given > INT32_MAX)
      return invalid("the index " + std::to_string(*given) + " is out of range");
    return *given > 0 ? *given - 1 : count + *given;
  }

  // Positions and normals have indices of their own in the file: a vertex is a pair of them.
  Result<Mesh, InputError> with_normals() {
    Mesh mesh;
    std::vector<Vec3> positions;  // of pairs
    bool normals = !normals_.empty();
    for (const Corner& c : corners_) normals = normals && c.normal >= 0;
    std::unordered_map<std::uint64_t, std::uint32_t> vertex_of;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const auto [position, normal] = corners_[i];
      const auto p = static_cast<std::size_t>(position), n = static_cast<std::size_t>(normal);
      if (p >= positions_.size() || (normals && n >= normals_.size()))
        return InputError{Errc::kInvalidInput, name_ + ": triangle " + std::to_string(i / 3) +
                                                   " has an index that is out of range"};
      auto vertex = static_cast<std::uint32_t>(p);
      if (normals) {
        const auto next = static_cast<std::uint32_t>(positions.size());
        const auto [found, is_new] = vertex_of.emplace(std::uint64_t{p} << 32 | n, next);
        vertex = found->second;
        if (is_new) {
          positions.push_back(positions_[p]);
          mesh.vertices.normals.push_back(normals_[n]);
        }
      }
      if (i % 3 == 0) mesh.triangles.emplace_back();
      mesh.triangles.back()[i % 3] = vertex;
    }
    set_positions(positions.empty() ? positions_ : positions, mesh.vertices);
    return mesh;
  }

  InputError invalid(const std::string& cause) const {
    return {Errc::kInvalidInput, name_ + ": line " + std::to_string(line_) + ": " + cause};
  }

  const std::string& name_;
  std::size_t line_ = 1;
  std::vector<Vec3> positions_;
  std::vector<Floats> normals_;
  std::vector<Corner> corners_;  // three a triangle
};

}  // namespace

Result<Mesh, InputError> parse_obj(const std::string& name, std::span<const std::uint8_t> text) {
  return ObjParser(name).parse({reinterpret_cast<const char*>(text.data()), text.size()});
}

}  // namespace slf
