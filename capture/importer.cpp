#include "capture/importer.h"

namespace slf {

Result<std::filesystem::path, InputError> path_inside(const std::filesystem::path& root,
                                                      const std::string& relative,
                                                      const std::string& label) {
  const auto invalid = [&](const char* cause) {
    return InputError{Errc::kInvalidInput, label + ": path '" + relative + "' " + cause};
  };
  if (relative.empty()) return invalid("is empty");
  if (relative.find('\0') != std::string::npos) return invalid("holds a zero byte");
  std::error_code error;
  const auto base = std::filesystem::absolute(root, error).lexically_normal();
  if (error) return invalid("cannot be made absolute");
  const auto whole = (base / relative).lexically_normal();  // an absolute `relative` replaces base
  const auto inside = whole.lexically_relative(base);
  if (inside.empty() || *inside.begin() == ".." || inside == ".")
    return invalid("leads out of the capture");
  return whole;
}

}  // namespace slf
