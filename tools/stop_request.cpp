// SPDX-License-Identifier: Apache-2.0
#include "stop_request.h"

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <system_error>

#include "foreign_messages.h"
#include "umbrick/core/pending_file.h"

namespace umbrick::tools {
namespace {

// How long a job may take to end by itself.
#ifdef __SANITIZE_ADDRESS__
constexpr long kGraceMs = 10000;  // all takes many times as long with sanitizers
#else
constexpr long kGraceMs = 800;
#endif

// A signal handler can only reach static variables.
std::atomic<int> lastSignal = 0;      // 0: there was none
std::atomic<bool> stopKnown = false;  // the job has found out about it
std::atomic<bool> partsToKeep = false, programLeaves = false;
sem_t signalled;
static_assert(std::atomic<int>::is_always_lock_free);

void onSignal(int number) {
  const int before = errno;
  lastSignal = number;
  sem_post(&signalled);
  errno = before;
}

// Waits for a signal, or for the end of the program. @param ms  at most so long; negative: for ever
// @return false when time is over
bool waitForSignal(long ms) {
  timespec end{};
  clock_gettime(CLOCK_REALTIME, &end);
  end.tv_sec += ms / 1000;
  end.tv_nsec += ms % 1000 * 1'000'000;
  if (end.tv_nsec >= 1'000'000'000) {
    end.tv_nsec -= 1'000'000'000;
    ++end.tv_sec;
  }
  int result = 0;
  do {
    result = ms < 0 ? sem_wait(&signalled) : sem_timedwait(&signalled, &end);
  } while (result != 0 && errno == EINTR);
  return result == 0;
}

// Ends the program by a signal, so that whoever has started it sees that.
[[noreturn]] void endBy(int number) {
  abandonPendingFiles();
  constexpr char kTerminal[] = "\r\033[Kumbrick: interrupted\n", kPlain[] = "umbrick: interrupted\n";
  const char* said = isatty(messageDescriptor()) == 1 ? kTerminal : kPlain;
  if (write(messageDescriptor(), said, std::strlen(said)) < 0) errno = 0;  // there is nobody to tell
  std::signal(number, SIG_DFL);
  sigset_t unblocked;
  sigemptyset(&unblocked);
  sigaddset(&unblocked, number);
  pthread_sigmask(SIG_UNBLOCK, &unblocked, nullptr);
  kill(getpid(), number);
  for (;;) pause();
}

void watchSignals() {
  waitForSignal(-1);
  if (programLeaves) return;
  const bool again = waitForSignal(kGraceMs);
  if (!again && stopKnown && partsToKeep) waitForSignal(-1);
  if (!programLeaves) endBy(lastSignal);
}

}  // namespace

SignalWatch::SignalWatch() {
  sem_init(&signalled, 0, 0);
  try {
    watcher_ = std::thread(watchSignals);
  } catch (const std::system_error&) {
    return;  // without a thread to watch them, signals end the program as they always do
  }
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGUSR1}) {
    struct sigaction action {};
    sigaction(number, nullptr, &action);
    if (action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

SignalWatch::~SignalWatch() {
  programLeaves = true;
  sem_post(&signalled);
  if (watcher_.joinable()) watcher_.join();
}

StopRequest::~StopRequest() { partsToKeep = false; }

void StopRequest::keepParts() { partsToKeep = true; }

bool StopRequest::requested() const {
  if (lastSignal == 0) return false;
  stopKnown = true;
  return true;
}

bool stopRequested() { return lastSignal != 0; }

void endsByItself() { programLeaves = true; }

void leaveIfStopped(int status) {
  if (!stopRequested()) return;
  programLeaves = true;
  _exit(status);
}

}  // namespace umbrick::tools
