// SPDX-License-Identifier: Apache-2.0
#include "tools/output_directory.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

#include "tools/interrupt.h"

namespace slf::tools {
namespace {

namespace fs = std::filesystem;

Failure unwritable(const fs::path& directory, const std::error_code& error) {
  return {kWriteFailed, directory.string() + ": cannot be written: " + error.message()};
}

/// What is not there is none, and no error.
bool is_link(const fs::path& path, std::error_code& error) {
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found) error.clear();
  return fs::is_symlink(status);
}

/// A temporary name tells nobody anything.
Failure named_as(const std::string& directory, const std::string& temporary, Failure failure) {
  if (const auto at = failure.message.find(temporary); at != std::string::npos)
    failure.message.replace(at, temporary.size(), directory);
  return failure;
}

/// A directory of its own, gone with this unless it was put in place.
class Temporary {
 public:
  explicit Temporary(const fs::path& beside) {
    for (int n = 0; n < 1000; ++n) {
      path_ = beside.string() + ".tmp" + std::to_string(::getpid()) + "-" + std::to_string(n);
      error_.clear();
      if (fs::create_directory(path_, error_) || error_) return;
    }
    error_ = std::make_error_code(std::errc::file_exists);
  }
  ~Temporary() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  const fs::path& path() const { return path_; }
  const std::error_code& error() const { return error_; }
  void keep() { path_.clear(); }

 private:
  fs::path path_;
  std::error_code error_;
};

bool holds_only(const fs::path& directory, const std::vector<std::string>& names,
                std::error_code& error) {
  for (const fs::directory_entry& entry : fs::directory_iterator(directory, error))
    if (std::find(names.begin(), names.end(), entry.path().filename().string()) == names.end())
      return false;
  return !error;
}

/// @return false where the system cannot exchange two names at once.
bool exchange(const fs::path& a, const fs::path& b) {
#if defined(RENAME_EXCHANGE)
  return ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
#else
  static_cast<void>(a), static_cast<void>(b);
  return false;
#endif
}

void move_files(const fs::path& from, const fs::path& to, const std::vector<std::string>& names,
                std::error_code& error) {
  fs::remove(to / names.back(), error);
  for (const std::string& name : names) {
    if (error) return;
    if (fs::exists(from / name, error)) {
      fs::rename(from / name, to / name, error);
    } else {
      fs::remove(to / name, error);  // of an older one
    }
  }
}

void put_in_place(Temporary& made, const fs::path& directory, const std::vector<std::string>& names,
                  std::error_code& error) {
  if (!fs::exists(directory, error)) {
    fs::rename(made.path(), directory, error);
    if (!error) made.keep();
    return;
  }
  if (holds_only(directory, names, error) && exchange(made.path(), directory)) return;
  if (!error) move_files(made.path(), directory, names, error);
}

}  // namespace

Outcome save_directory(const std::string& directory, const std::vector<std::string>& names,
                       const std::function<Outcome(const std::string& directory)>& write) {
  const DeferInterrupts defer;
  std::error_code error;
  fs::path target = fs::absolute(directory, error).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();  // "dump/"
  if (!error && is_link(target, error)) target = fs::canonical(target, error);
  if (!error) fs::create_directories(target.parent_path(), error);
  if (error) return unwritable(directory, error);
  if (fs::exists(target, error) && !fs::is_directory(target, error))
    return Failure{kWriteFailed, directory + ": is not a directory"};
  Temporary made(target);
  if (made.error()) return unwritable(directory, made.error());
  if (auto written = write(made.path().string()); !written)
    return named_as(directory, made.path().string(), written.error());
  put_in_place(made, target, names, error);
  if (error) return unwritable(directory, error);
  return Done{};
}

}  // namespace slf::tools
