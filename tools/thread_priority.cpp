// Keeps all threads of the program at its priority, those of Mesa, too.
//
// Mesa has a thread for its cache of shaders, which lowers its own priority as far as it goes. When the program ends,
// the thread that runs last gives the memory of all back to the system: where other programs keep all cores busy, that
// is this one, and it took 10 to 60 seconds for 300 MiB. Nobody may raise a priority again, so it is not lowered. As
// with operator new in refused_memory.cpp, the program has a function in place of the C library's.
// SPDX-License-Identifier: Apache-2.0
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>

// @param who  a process, or a thread, as Mesa has it; 0: the thread that calls
extern "C" [[gnu::visibility("default")]] int setpriority(__priority_which_t which, id_t who, int priority) noexcept {
  const bool ownThread = which == PRIO_PROCESS && (who == 0 || static_cast<long>(who) == syscall(SYS_gettid));
  if (ownThread) return 0;
  return static_cast<int>(syscall(SYS_setpriority, which, who, priority));
}
