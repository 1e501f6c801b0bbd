// SPDX-License-Identifier: Apache-2.0
#include "tools/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>

#include "slf/capture.h"
#include "tools/exit_codes.h"

namespace slf::tools {
namespace {

volatile std::sig_atomic_t deferred = 0;
volatile std::sig_atomic_t pending = 0;

extern "C" void on_interrupt(int) {
  pending = 1;
  const int before = errno;
  end_other_program();
  errno = before;
  if (deferred == 0) _exit(kCancelled);
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

void exit_cancelled() { _exit(kCancelled); }

}  // namespace slf::tools
