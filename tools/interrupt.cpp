// SPDX-License-Identifier: Apache-2.0
#include "tools/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "slf/capture.h"
#include "tools/exit_codes.h"

namespace slf::tools {
namespace {

volatile std::sig_atomic_t deferred = 0;
volatile std::sig_atomic_t pending = 0;

constexpr std::size_t kMostName = 4096;
char temporary_file[kMostName], temporary_directory[kMostName];
volatile std::sig_atomic_t has_temporary = 0;

/// Makes only calls that a signal handler may make.
[[noreturn]] void leave() {
  if (has_temporary != 0) {
    ::unlink(temporary_file);
    ::rmdir(temporary_directory);
  }
  _exit(kCancelled);
}

extern "C" void on_interrupt(int) {
  pending = 1;
  const int before = errno;
  end_other_program();
  errno = before;
  if (deferred == 0) leave();
}

}  // namespace

void install_interrupt_handler() {
  struct sigaction action = {};
  action.sa_handler = on_interrupt;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // Beyond a file size limit write() then fails as on a full disk, and is reported as such.
  std::signal(SIGXFSZ, SIG_IGN);
}

DeferInterrupts::DeferInterrupts() { deferred = deferred + 1; }

DeferInterrupts::~DeferInterrupts() {
  deferred = deferred - 1;
  if (deferred == 0 && pending != 0) exit_cancelled();
}

bool interrupt_pending() { return pending != 0; }

void remove_at_interrupt(const char* file, const char* directory) {
  has_temporary = 0;
  if (*file == 0 || std::strlen(file) >= kMostName || std::strlen(directory) >= kMostName) return;
  std::strcpy(temporary_file, file);
  std::strcpy(temporary_directory, directory);
  has_temporary = 1;
}

void exit_cancelled() { leave(); }

}  // namespace slf::tools
