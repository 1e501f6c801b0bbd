// SPDX-License-Identifier: Apache-2.0
#include "lightfield/splats/zip_bundle.h"

#if SLF_WITH_WEBP
#include <zip.h>
#endif

namespace slf {

#if SLF_WITH_WEBP
void ZipBundle::Close::operator()(zip* archive) const { zip_discard(archive); }

std::optional<ZipBundle> ZipBundle::open(std::span<const std::uint8_t> file) {
  zip_source_t* source = zip_source_buffer_create(file.data(), file.size(), 0, nullptr);
  if (source == nullptr) return std::nullopt;
  zip_t* archive = zip_open_from_source(source, ZIP_RDONLY, nullptr);
  if (archive != nullptr) return ZipBundle(archive);
  zip_source_free(source);
  return std::nullopt;
}

std::string ZipBundle::find(const std::string& ending) const {
  zip_t* archive = archive_.get();
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* name = zip_get_name(archive, static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr && std::string(name).ends_with(ending)) return name;
  }
  return {};
}

std::optional<std::vector<std::uint8_t>> ZipBundle::read(const std::string& name,
                                                         std::size_t most) const {
  zip_t* archive = archive_.get();
  zip_stat_t stat;
  if (zip_stat(archive, name.c_str(), 0, &stat) != 0 || (stat.valid & ZIP_STAT_SIZE) == 0 ||
      stat.size > most)
    return std::nullopt;
  const std::unique_ptr<zip_file_t, int (*)(zip_file_t*)> file(zip_fopen(archive, name.c_str(), 0),
                                                               zip_fclose);
  if (!file) return std::nullopt;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(stat.size));
  if (zip_fread(file.get(), bytes.data(), bytes.size()) != static_cast<zip_int64_t>(bytes.size()))
    return std::nullopt;
  return bytes;
}
#else
void ZipBundle::Close::operator()(zip*) const {}
std::optional<ZipBundle> ZipBundle::open(std::span<const std::uint8_t>) { return std::nullopt; }
std::string ZipBundle::find(const std::string&) const { return {}; }
std::optional<std::vector<std::uint8_t>> ZipBundle::read(const std::string&, std::size_t) const {
  return std::nullopt;
}
#endif

}  // namespace slf
