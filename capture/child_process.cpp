// SPDX-License-Identifier: Apache-2.0
#include "capture/child_process.h"

#include <fcntl.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <cerrno>
#include <cstring>

extern char** environ;

namespace slf {
namespace {

/// What a program that is started finds open.
class Streams {
 public:
  Streams(int output, int errors) {
    posix_spawn_file_actions_init(&actions_);
    posix_spawn_file_actions_addopen(&actions_, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions_, output, STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
  }
  ~Streams() { posix_spawn_file_actions_destroy(&actions_); }
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;

  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

}  // namespace

Result<UnnamedFile, InputError> UnnamedFile::create() {
  std::error_code failed;
  const auto directory = std::filesystem::temp_directory_path(failed);
  std::string name = ((failed ? "/tmp" : directory) / "slf-XXXXXX").string();
  Descriptor file(mkstemp(name.data()));
  if (!file.ok() || unlink(name.c_str()) != 0)
    return InputError{Errc::kUnwritable, name + ": " + std::strerror(errno)};
  return UnnamedFile(std::move(file));
}

Result<int, InputError> run_program(const std::vector<std::string>& words,
                                    const UnnamedFile& output, const UnnamedFile& errors) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const Streams streams(output.descriptor(), errors.descriptor());
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, arguments[0], streams.get(), nullptr, arguments.data(), environ);
  if (failed != 0)
    return InputError{failed == ENOENT ? Errc::kUnsupported : Errc::kUnreadable,
                      words[0] + ": " + std::strerror(failed)};
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace slf
