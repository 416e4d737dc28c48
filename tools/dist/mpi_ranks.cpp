// SPDX-License-Identifier: Apache-2.0
#include "dist/mpi_ranks.h"

#include <fcntl.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <mutex>
#include <sstream>
#include <thread>
#include <utility>

#include "umbrick/core/error.h"

namespace umbrick::tools {
namespace {

// What a message to the first rank is about; its tag. Those above `lastAsked` are not answered.
enum Tag : int { askTogether, askItem, askItemAhead, lastAsked, result, piece, share, rests, stops, fails, leaves };
constexpr int kAnswer = 100;  // tag of what the first rank answers
// MPI counts bytes by int: longer messages come in pieces.
constexpr std::size_t kPiece = std::size_t(1) << 28;
// How long a thread sleeps between two looks at what has arrived. MPI itself would wait without a pause and take a core
// away from those who draw.
constexpr std::chrono::milliseconds kLook{1};
// How long a rank waits before it asks again, where it was told to.
constexpr std::chrono::milliseconds kAgain{10};
// A rank says no more often how far its item is.
constexpr std::chrono::milliseconds kShares{200};

void check(int status, const char* what) {
  if (status != MPI_SUCCESS) throw Error(std::string("MPI: cannot ") + what);
}

void sendBytes(int to, int tag, const std::string& bytes) {
  check(MPI_Send(bytes.data(), static_cast<int>(bytes.size()), MPI_BYTE, to, tag, MPI_COMM_WORLD), "send");
}

// Receives the message that a probe has found.
std::string receiveBytes(const MPI_Status& found) {
  int size = 0;
  MPI_Get_count(&found, MPI_BYTE, &size);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  check(MPI_Recv(bytes.data(), size, MPI_BYTE, found.MPI_SOURCE, found.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE),
        "receive");
  return bytes;
}

// Waits for a message.
MPI_Status nextMessage(int from, int tag) {
  for (;;) {
    int there = 0;
    MPI_Status status;
    check(MPI_Iprobe(from, tag, MPI_COMM_WORLD, &there, &status), "look for messages");
    if (there) return status;
    std::this_thread::sleep_for(kLook);
  }
}

// Numbers as the bytes that they are in memory: all ranks run the same program.
template <class Number>
std::string bytesOf(const Number& number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}
template <class Number>
Number numberOf(const std::string& bytes) {
  Number number{};
  std::memcpy(&number, bytes.data(), std::min(bytes.size(), sizeof number));
  return number;
}

// What announces a result: its pieces follow, first what was said and then what has come of the item.
struct ResultHead {
  std::uint64_t item, said, bytes;  // number; lengths
};

// While an object of this class lives, stdout and stderr of the process go nowhere, and what std::cerr is given is
// kept.
class Silence {
 public:
  explicit Silence(int messages) {
    std::cout.flush();
    before_ = std::cerr.rdbuf(kept_.rdbuf());
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, messages);
    close(nowhere);
  }
  ~Silence() { std::cerr.rdbuf(before_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  std::string take() {
    const std::string said = kept_.str();
    kept_.str({});
    return said;
  }

 private:
  std::ostringstream kept_;
  std::streambuf* before_ = nullptr;
};

// Begins and ends MPI.
class MpiSession {
 public:
  MpiSession() {
    int given = 0;
    check(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &given), "begin");
    if (given < MPI_THREAD_SERIALIZED) throw Error("MPI: expected one that lets several threads take turns");
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
  }
  ~MpiSession() { MPI_Finalize(); }
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;

  int rank = 0, count = 1;
};

// The first rank: keeps the ledger, and answers the others in a thread of its own, which alone uses MPI.
class FirstRank : public Ranks {
 public:
  explicit FirstRank(std::unique_ptr<MpiSession> session)
      : session_(std::move(session)), ledger_(session_->count), answers_([this] { answerAll(); }) {}
  ~FirstRank() override {
    stop();
    answers_.join();
  }

  int rank() const override { return 0; }
  int count() const override { return session_->count; }
  std::string agree(const std::string& text) override {
    const std::lock_guard lock(mutex_);
    together_ = text;
    return text;
  }
  void begin(std::size_t items, std::size_t window) override {
    const std::lock_guard lock(mutex_);
    ledger_.begin(items, window);
  }
  std::optional<std::size_t> take(When when, const std::function<void()>& waiting) override {
    for (;;) {
      const WorkLedger::Answer answer = [&] {
        const std::lock_guard lock(mutex_);
        throwFailure();
        return ledger_.take(when == When::ahead);
      }();
      if (answer.kind == WorkLedger::Kind::item) return answer.item;
      if (answer.kind == WorkLedger::Kind::none || when == When::ahead) return {};
      waiting();
      std::this_thread::sleep_for(kAgain);
    }
  }
  void put(std::size_t item, std::string bytes) override {
    const std::lock_guard lock(mutex_);
    ledger_.put({item, std::move(bytes), {}});
    ledger_.show(0, 0);
  }
  void rest() override {
    const std::lock_guard lock(mutex_);
    ledger_.rest(0);
  }
  std::optional<ItemResult> collect() override {
    const std::lock_guard lock(mutex_);
    return ledger_.collect();
  }
  bool allRest() override {
    const std::lock_guard lock(mutex_);
    throwFailure();
    return ledger_.allRest();
  }
  WorkDone show(double share) override {
    const std::lock_guard lock(mutex_);
    ledger_.show(0, share);
    return ledger_.done();
  }
  void stop() override {
    const std::lock_guard lock(mutex_);
    ledger_.stop();
  }
  bool stopped() override {
    const std::lock_guard lock(mutex_);
    return ledger_.stopped();
  }
  void fail(const std::string&) override { stop(); }

 private:
  void throwFailure() const {
    if (ledger_.failure()) throw Error(*ledger_.failure());
  }

  void answerAll() {
    int there = session_->count - 1;  // ranks that have not left
    while (there > 0) {
      const MPI_Status found = nextMessage(MPI_ANY_SOURCE, MPI_ANY_TAG);
      const int from = found.MPI_SOURCE, tag = found.MPI_TAG;
      const std::string bytes = receiveBytes(found);
      if (tag < lastAsked)
        sendBytes(from, kAnswer, answerTo(tag));
      else if (tag == result)
        keepResult(from, numberOf<ResultHead>(bytes));
      else if (tag == leaves)
        --there;
      else
        note(from, tag, bytes);
    }
  }

  // What all must see alike goes with its length, since it may be empty or not known yet.
  std::string answerTo(int tag) {
    const std::lock_guard lock(mutex_);
    if (tag == askTogether) return together_ ? "=" + *together_ : ledger_.stopped() ? "!" : "";
    return bytesOf(ledger_.take(tag == askItemAhead));
  }

  std::string receivePieces(int from, std::size_t size) {
    std::string bytes;
    while (bytes.size() < size) bytes += receiveBytes(nextMessage(from, piece));
    return bytes;
  }

  void keepResult(int from, const ResultHead& head) {
    std::string said = receivePieces(from, head.said), bytes = receivePieces(from, head.bytes);
    const std::lock_guard lock(mutex_);
    ledger_.put({head.item, std::move(bytes), std::move(said)});
    ledger_.show(from, 0);
  }

  void note(int from, int tag, const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    if (tag == share) ledger_.show(from, numberOf<double>(bytes));
    if (tag == rests) ledger_.rest(from);
    if (tag == stops) ledger_.stop();
    if (tag != fails) return;
    ledger_.fail(bytes);
    ledger_.rest(from);
  }

  std::unique_ptr<MpiSession> session_;
  std::mutex mutex_;
  WorkLedger ledger_;
  std::optional<std::string> together_;
  std::thread answers_;
};

// Any other rank: asks the first one.
class OtherRank : public Ranks {
 public:
  OtherRank(std::unique_ptr<MpiSession> session, int messages) : session_(std::move(session)), silence_(messages) {}
  ~OtherRank() override { tell(leaves, {}); }

  int rank() const override { return session_->rank; }
  int count() const override { return session_->count; }
  std::string agree(const std::string&) override {
    for (;;) {
      const std::string answer = ask(askTogether);
      if (answer.starts_with('=')) return answer.substr(1);
      if (!answer.empty()) throw Error("the first rank has ended");
      std::this_thread::sleep_for(kAgain);
    }
  }
  void begin(std::size_t, std::size_t) override { silence_.take(); }
  std::optional<std::size_t> take(When when, const std::function<void()>& waiting) override {
    for (;;) {
      const auto answer = numberOf<WorkLedger::Answer>(ask(when == When::ahead ? askItemAhead : askItem));
      if (answer.kind == WorkLedger::Kind::item) return answer.item;
      if (answer.kind == WorkLedger::Kind::none || when == When::ahead) return {};
      waiting();
      std::this_thread::sleep_for(kAgain);
    }
  }
  void put(std::size_t item, std::string bytes) override {
    const std::string said = silence_.take();
    tell(result, bytesOf(ResultHead{item, said.size(), bytes.size()}));
    for (const std::string* text : {&said, &std::as_const(bytes)})
      for (std::size_t at = 0; at < text->size(); at += kPiece) tell(piece, text->substr(at, kPiece));
  }
  void rest() override { tell(rests, {}); }
  std::optional<ItemResult> collect() override { return {}; }
  bool allRest() override { return true; }
  WorkDone show(double done) override {
    const auto now = std::chrono::steady_clock::now();
    if (now - shown_ < kShares) return {};
    shown_ = now;
    tell(share, bytesOf(done));
    return {};
  }
  void stop() override { tell(stops, {}); }
  bool stopped() override { return false; }  // no item is left then
  void fail(const std::string& message) override {
    std::array<char, MPI_MAX_PROCESSOR_NAME + 1> host{};
    int length = 0;
    MPI_Get_processor_name(host.data(), &length);
    tell(fails, message + " (rank " + std::to_string(rank()) + " on " + host.data() + ")");
  }

 private:
  void tell(int tag, const std::string& bytes) {
    const std::lock_guard lock(mutex_);
    sendBytes(0, tag, bytes);
  }
  std::string ask(int tag) {
    const std::lock_guard lock(mutex_);
    sendBytes(0, tag, {});
    return receiveBytes(nextMessage(0, kAnswer));
  }

  std::unique_ptr<MpiSession> session_;
  Silence silence_;
  std::mutex mutex_;  // pictures may say how far they are in other threads
  std::chrono::steady_clock::time_point shown_{};
};

}  // namespace

std::unique_ptr<Ranks> joinMpiRanks(int messages) {
  auto session = std::make_unique<MpiSession>();
  if (session->count == 1) return nullptr;
  if (session->rank == 0) return std::make_unique<FirstRank>(std::move(session));
  return std::make_unique<OtherRank>(std::move(session), messages);
}

}  // namespace umbrick::tools
