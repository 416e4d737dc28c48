// SPDX-License-Identifier: Apache-2.0
#include "dist/ranks.h"

#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <utility>

#include "umbrick/core/error.h"
#ifndef UMBRICK_MPI_MISSING
#include "dist/mpi_ranks.h"
#endif

namespace umbrick::tools {
namespace {

// One process that does all by itself.
class LoneRank : public Ranks {
 public:
  int rank() const override { return 0; }
  int count() const override { return 1; }
  std::string agree(const std::string& text) override { return text; }
  void begin(std::size_t items, std::size_t) override { ledger_.begin(items, items + 1); }
  std::optional<std::size_t> take(When, const std::function<void()>&) override {
    const WorkLedger::Answer answer = ledger_.take(false);
    return answer.kind == WorkLedger::Kind::item ? std::optional(answer.item) : std::nullopt;
  }
  void put(std::size_t item, std::string bytes) override { ledger_.put({item, std::move(bytes), {}}); }
  void rest() override { ledger_.rest(0); }
  std::optional<ItemResult> collect() override { return ledger_.collect(); }
  bool allRest() override { return ledger_.allRest(); }
  WorkDone show(double share) override {
    ledger_.show(0, share);
    return ledger_.done();
  }
  void stop() override { ledger_.stop(); }
  bool stopped() override { return ledger_.stopped(); }
  void fail(const std::string&) override { stop(); }

 private:
  WorkLedger ledger_{1};
};

// Returns what mpirun tells of the number of ranks; 0 where nothing does.
int toldRanks() {
  for (const char* name : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"})
    if (const char* count = std::getenv(name)) return std::atoi(count);
  return 0;
}

#ifndef UMBRICK_MPI_MISSING
// Tells whether several ranks may have been started. PMIx, by which srun starts them, tells each its number alone.
bool mayBeSeveral() {
  const int told = toldRanks();
  return told > 1 || (told == 0 && std::getenv("PMIX_RANK"));
}
#endif

}  // namespace

std::unique_ptr<Ranks> joinRanks([[maybe_unused]] int messages) {
#ifdef UMBRICK_MPI_MISSING
  if (const int told = toldRanks(); told > 1)
    throw Error("this program is built without MPI (" UMBRICK_MPI_MISSING "), by which the " + std::to_string(told) +
                " ranks of mpirun would share the work; each would do all of it");
#else
  if (mayBeSeveral())
    if (std::unique_ptr<Ranks> ranks = joinMpiRanks(messages)) return ranks;
#endif
  return std::make_unique<LoneRank>();
}

std::optional<std::string> idleCoresNote() {
  const char* const told = std::getenv("OMPI_COMM_WORLD_LOCAL_SIZE");
  cpu_set_t bound;
  if (!told || sched_getaffinity(0, sizeof bound, &bound) != 0) return {};
  const long ranks = std::atoi(told), each = CPU_COUNT(&bound), all = sysconf(_SC_NPROCESSORS_ONLN);
  if (2 * ranks * each > all) return {};
  return "mpirun binds each of the " + std::to_string(ranks) + " ranks on this machine to " + std::to_string(each) +
         " of its " + std::to_string(all) + " cores: mpirun --bind-to none lets them use all";
}

}  // namespace umbrick::tools
