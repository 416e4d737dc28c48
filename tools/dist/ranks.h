// The processes that share a job: one by itself, or the ranks that mpirun has started. Nothing here sees MPI.
//
//   first rank            any other rank
//   agree("frames")  -->  agree(...) == "frames"      what all must see alike
//   begin(items)
//   take() --> 0          take() --> 1                 whichever rank is free gets the next item
//   put(0, ...)           put(1, ...)                  what has come of it goes to the first rank,
//   collect() --> 0, 1    rest()                       which gets it in the order of the items
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "dist/work_ledger.h"

namespace umbrick::tools {

/// One of the processes that share a job. Only the first one has a stdout and a stderr of its own: what others write
/// there is kept, and goes with their results.
class Ranks {
 public:
  virtual ~Ranks() = default;

  virtual int rank() const = 0;   // from 0
  virtual int count() const = 0;  // of all
  bool isFirst() const { return rank() == 0; }
  bool isAlone() const { return count() == 1; }

  /// Returns the text of the first rank, for which others wait.
  virtual std::string agree(const std::string& text) = 0;

  /// Begins the job; ranks other than the first forget what they have said so far, which the first one says, too.
  /// @param window  see WorkLedger
  virtual void begin(std::size_t items, std::size_t window) = 0;
  enum class When { now, ahead };
  /// Returns an item that no other rank has; none where there are no more.
  /// @param when     now: waits where it must. ahead: of the item that is done after the one at hand; none where
  ///   others are to get it
  /// @param waiting  is called now and then while it waits. On the first rank it collects, or the wait may never end
  /// @throw Error    on the first rank: another one met an error. What `waiting` throws
  virtual std::optional<std::size_t> take(When when, const std::function<void()>& waiting) = 0;
  virtual void put(std::size_t item, std::string bytes) = 0;
  /// Says that this rank takes no more.
  virtual void rest() = 0;
  /// Returns the next result, in the order of items. On the first rank; others get none.
  virtual std::optional<ItemResult> collect() = 0;
  /// Tells on the first rank whether all ranks rest. @throw Error  another rank met an error
  virtual bool allRest() = 0;
  /// Says how much of the item at hand is done. @return on the first rank, what all have done
  virtual WorkDone show(double share) = 0;

  /// Ends the job on all ranks, after the items at hand.
  virtual void stop() = 0;
  virtual bool stopped() = 0;
  /// Tells the first rank of an error that ends the job; on the first one it does the same as stop().
  virtual void fail(const std::string& message) = 0;
};

/// Returns the ranks that mpirun, or srun with PMIx, has started together with this process, or else one that is
/// alone. MPI is used, and takes its time to start, only where there are several.
/// @param messages  the descriptor that the program's messages go to, which is closed on ranks other than the first
/// @throw Error     several were started, and the program is built without MPI
std::unique_ptr<Ranks> joinRanks(int messages);

/// Returns a line on cores that are idle, since mpirun binds its ranks to few of them; nothing where that is not so.
std::optional<std::string> idleCoresNote();

}  // namespace umbrick::tools
