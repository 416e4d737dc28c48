// SPDX-License-Identifier: Apache-2.0
#include "foreign_messages.h"

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <string_view>

#include "umbrick/core/memory.h"
#include "umbrick/core/printable.h"

namespace umbrick::tools {
namespace {

// Signal handlers reach static variables alone.
int ownDescriptor = STDERR_FILENO;
int caughtDescriptor = -1;
std::array<char, 512> job{"starting"};
std::array<char, 1 << 16> handlerStack{};

constexpr std::array kDeaths{SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL};

void writeAll(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t done = ::write(file, text.data(), text.size());
    if (done <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(done));
  }
}

// Tells whether a library may have been refused memory: the process has a limit and is close to it. What it was refused
// may be hundreds of mebibytes.
bool isAddressSpaceUsedUp() {
  constexpr std::uint64_t kClose = std::uint64_t(512) << 20;
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return false;
  // A page that cannot be had, or little that is left.
  void* const more = mmap(nullptr, kClose, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (more == MAP_FAILED) return true;
  munmap(more, kClose);
  return false;
}

void sayOutOfMemory() {
  writeAll(ownDescriptor, "umbrick: ");
  writeAll(ownDescriptor, job.data());
  writeAll(ownDescriptor, ": out of memory in a library, within the address space that ulimit -v allows\n");
}

void copyCaught() {
  if (caughtDescriptor < 0) return;
  std::array<char, 1024> piece{};
  for (off_t at = 0;;) {
    const ssize_t got = pread(caughtDescriptor, piece.data(), piece.size(), at);
    if (got <= 0) return;
    writeAll(ownDescriptor, {piece.data(), static_cast<std::size_t>(got)});
    at += got;
  }
}

// Says why the program ends, and lets it end as it would have.
void onDeath(int number) {
  if (isAddressSpaceUsedUp()) {
    sayOutOfMemory();
    _exit(1);
  }
  copyCaught();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

// Is called where an exception leaves a destructor or a thread of a library. Memory or threads that are refused there
// end the program in one line, too.
[[noreturn]] void onTerminate() {
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::exception& error) {
    try {
      if (const auto refusal = refusalOf(error, job.data())) {
        writeAll(ownDescriptor, "umbrick: " + std::string(refusal->what()) + "\n");
        _exit(1);
      }
    } catch (const std::exception&) {  // there is not even enough for the message
    }
  } catch (...) {
  }
  if (isAddressSpaceUsedUp()) {
    sayOutOfMemory();
    _exit(1);
  }
  std::abort();
}

// Some libraries begin threads of their own before main; this is called before they do.
#if !defined(__SANITIZE_ADDRESS__)
[[gnu::section(".preinit_array"), gnu::used]] void (*const beforeLibraries)() = [] { std::set_terminate(onTerminate); };
#endif

// Passes text on to the user's stderr, as lines that no terminal obeys.
class MessageBuffer : public std::streambuf {
 protected:
  int overflow(int c) override {
    if (c != traits_type::eof()) {
      const char one = static_cast<char>(c);
      writeAll(ownDescriptor, one == '\n' ? std::string(1, one) : printableLines({&one, 1}));
    }
    return traits_type::not_eof(c);
  }
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    writeAll(ownDescriptor, printableLines({text, static_cast<std::size_t>(count)}));
    return count;
  }
};

void watchDeaths() {
  std::set_terminate(onTerminate);
  stack_t stack{};
  stack.ss_sp = handlerStack.data();
  stack.ss_size = handlerStack.size();
  sigaltstack(&stack, nullptr);
  for (const int number : kDeaths) {
    struct sigaction action {};
    action.sa_handler = onDeath;
    action.sa_flags = SA_ONSTACK | SA_RESETHAND;
    sigaction(number, &action, nullptr);
  }
}

// The C library reserves 64 MiB of address space for each thread that allocates. Where address space is scarce threads
// share what there is.
void shareArenas() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) mallopt(M_ARENA_MAX, 1);
}

#if defined(__SANITIZE_ADDRESS__)
constexpr bool kSanitized = true;  // the sanitizer watches signals itself, and writes its report to stderr
#else
constexpr bool kSanitized = false;
#endif

}  // namespace

int messageDescriptor() { return ownDescriptor; }

ForeignMessages::ForeignMessages() {
  buffer_ = std::make_unique<MessageBuffer>();
  before_ = std::cerr.rdbuf(buffer_.get());
  if (kSanitized) return;
  shareArenas();
  watchDeaths();
  const int own = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  const int caught = memfd_create("umbrick-stderr", MFD_CLOEXEC);
  if (own < 0 || caught < 0 || dup2(caught, STDERR_FILENO) < 0) {
    if (own >= 0) close(own);
    if (caught >= 0) close(caught);
    return;
  }
  ownDescriptor = own;
  caughtDescriptor = caught;
}

ForeignMessages::~ForeignMessages() {
  const std::string caught = take();
  if (!caught.empty()) std::cerr << "umbrick: " << caught.substr(2) << '\n';
  std::cerr.rdbuf(before_);
  // The descriptors stay as they are: libhdf5, for one, prints as the process ends, when all has been said.
}

std::string ForeignMessages::take() {
  if (caughtDescriptor < 0) return {};
  constexpr std::size_t kLongest = 120;
  std::string text(1 << 16, '\0');
  const ssize_t got = pread(caughtDescriptor, text.data(), text.size(), 0);
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  // What is written next begins at the start again.
  if (ftruncate(caughtDescriptor, 0) == 0) lseek(caughtDescriptor, 0, SEEK_SET);
  const std::size_t begin = text.find_first_not_of("\r\n ");
  if (begin == text.npos) return {};
  const auto more = std::count(text.begin() + static_cast<std::ptrdiff_t>(begin), text.end(), '\n') - 1;
  std::string line = text.substr(begin, std::min(text.find('\n', begin), text.size()) - begin);
  if (line.size() > kLongest) line = line.substr(0, kLongest) + "...";
  return "; libraries say: \"" + printable(line) + '"' +
         (more > 0 ? " and " + std::to_string(more) + (more == 1 ? " more line" : " more lines") : std::string());
}

void nameJob(const std::string& name) {
  const std::string text = printable(name).substr(0, job.size() - 1);
  job.fill('\0');
  std::copy(text.begin(), text.end(), job.begin());
}

std::string jobName() { return job.data(); }

}  // namespace umbrick::tools
