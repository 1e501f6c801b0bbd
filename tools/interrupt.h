// SPDX-License-Identifier: Apache-2.0
// SIGINT and SIGTERM end the program at once with exit code 130, but never between the creation
// of a temporary file and its renaming.
#pragma once

namespace slf::tools {

/// Called once, before any thread is started.
void install_interrupt_handler();

/// While one lives, an interrupt is only noted; it takes effect when the last one is gone.
class DeferInterrupts {
 public:
  DeferInterrupts();
  ~DeferInterrupts();
  DeferInterrupts(const DeferInterrupts&) = delete;
  DeferInterrupts& operator=(const DeferInterrupts&) = delete;
};

/// An interrupt has been noted and waits.
bool interrupt_pending();

/// An interrupt removes this file and this directory, of names shorter than 4096 bytes. Empty:
/// none.
void remove_at_interrupt(const char* file, const char* directory);

/// Ends the program as an interrupt does, without running destructors.
[[noreturn]] void exit_cancelled();

}  // namespace slf::tools
