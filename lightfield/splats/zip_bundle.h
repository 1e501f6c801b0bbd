// SPDX-License-Identifier: Apache-2.0
// The one place that includes libzip: the bundle of a SOG.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

struct zip;  // of libzip

namespace slf {

class ZipBundle {
 public:
  /// @param file  kept by reference
  /// @return nothing: damaged, or a build without libzip
  static std::optional<ZipBundle> open(std::span<const std::uint8_t> file);

  /// The first name that ends with `ending`; empty: there is none.
  std::string find(const std::string& ending) const;
  /// Nothing where there is no such file, it is damaged, or has more than `most` bytes.
  std::optional<std::vector<std::uint8_t>> read(const std::string& name, std::size_t most) const;

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  explicit ZipBundle(zip* archive) : archive_(archive) {}

  std::unique_ptr<zip, Close> archive_;
};

}  // namespace slf
