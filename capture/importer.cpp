// SPDX-License-Identifier: Apache-2.0
#include "capture/importer.h"

namespace slf {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kShownName = 120;  // of a name in a message

/// The name as a message shows it.
std::string shortened(const std::string& name) {
  return name.size() <= kShownName ? name : name.substr(0, kShownName) + "...";
}

bool is_inside(const fs::path& path, const fs::path& base) {
  const fs::path inside = path.lexically_relative(base);
  return !inside.empty() && *inside.begin() != ".." && inside != ".";
}

/// Where the path leads when links are followed, as far as there is anything.
bool leads_outside(const fs::path& path, const fs::path& base) {
  std::error_code error;
  const fs::path real_base = fs::weakly_canonical(base, error);
  const fs::path real_path = error ? fs::path() : fs::weakly_canonical(path, error);
  return error || !is_inside(real_path, real_base);
}

}  // namespace

void warn_of_left_out(const std::string& file, std::size_t left_out, std::size_t of,
                      Import& import) {
  if (left_out == 0) return;
  import.capture.warnings.push_back(file + ": " + std::to_string(left_out) + " of " +
                                    std::to_string(of) +
                                    " cameras have no pose, or no lens: left out");
}

Result<std::filesystem::path, InputError> path_inside(const std::filesystem::path& root,
                                                      const std::string& relative,
                                                      const std::string& label) {
  const auto invalid = [&](const char* cause) {
    return InputError{Errc::kInvalidInput, label + ": path '" + shortened(relative) + "' " + cause};
  };
  if (relative.empty()) return invalid("is empty");
  if (relative.find('\0') != std::string::npos) return invalid("holds a zero byte");
  std::error_code error;
  const auto base = std::filesystem::absolute(root, error).lexically_normal();
  if (error) return invalid("cannot be made absolute");
  const auto whole = (base / relative).lexically_normal();  // an absolute `relative` replaces base
  if (!is_inside(whole, base)) return invalid("leads out of the capture");
  if (leads_outside(whole, base)) return invalid("leads out of the capture through a link");
  return whole;
}

}  // namespace slf
