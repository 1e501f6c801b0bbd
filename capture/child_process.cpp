// SPDX-License-Identifier: Apache-2.0
#include "capture/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "slf/capture.h"

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

std::atomic<pid_t> running{0};  // 0: none
static_assert(std::atomic<pid_t>::is_always_lock_free);

/// While it lives no signal comes that would end this process and leave the other.
class NoInterrupts {
 public:
  NoInterrupts() {
    sigset_t these;
    sigemptyset(&these);
    for (const int signal : {SIGINT, SIGTERM}) sigaddset(&these, signal);
    pthread_sigmask(SIG_BLOCK, &these, &before_);
  }
  ~NoInterrupts() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  NoInterrupts(const NoInterrupts&) = delete;
  NoInterrupts& operator=(const NoInterrupts&) = delete;

  const sigset_t& before() const { return before_; }

 private:
  sigset_t before_;
};

/// Starts a program, which `running` then names. @return as posix_spawnp
int start(const std::vector<std::string>& words, const Streams& streams) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const NoInterrupts meanwhile;
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setsigmask(&attributes, &meanwhile.before());
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int failed =
      posix_spawnp(&child, arguments[0], streams.get(), &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (failed == 0) running = child;
  return failed;
}

}  // namespace

void end_other_program() noexcept {
  if (const pid_t child = running; child != 0) kill(child, SIGTERM);
}

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
  const int failed = start(words, Streams(output.descriptor(), errors.descriptor()));
  if (failed != 0)
    return InputError{failed == ENOENT ? Errc::kUnsupported : Errc::kUnreadable,
                      words[0] + ": " + std::strerror(failed)};
  // Until it is waited for, its number is of no other process.
  siginfo_t ended;
  while (waitid(P_PID, static_cast<id_t>(running), &ended, WEXITED | WNOWAIT) < 0 &&
         errno == EINTR) {
  }
  const pid_t child = running.exchange(0);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace slf
