// Who does which item of a job, and what has come of it: the book that the first rank keeps.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace umbrick::tools {

/// What has come of an item.
struct ItemResult {
  std::size_t item = 0;
  std::string bytes;  // what the rank hands in
  std::string said;   // lines that it would have written to stderr
};

/// How far a job is.
struct WorkDone {
  std::size_t items = 0;  // that are done
  double shares = 0;      // of those at hand, in items
};

/// Items are handed out in their order to whichever rank asks, and results are given in the same order, so that what
/// is made of them does not depend on who was how fast. Not for several threads.
class WorkLedger {
 public:
  /// @param ranks  1 or more
  explicit WorkLedger(int ranks);

  /// Begins the job; before that, who asks is told to ask again.
  /// @param window  that many items, at least 1, may be handed out beyond the first whose result has not been
  ///   collected: it bounds the results that are kept
  void begin(std::size_t items, std::size_t window);

  enum class Kind {
    item,   // this one
    later,  // nothing now: ask again
    none,   // nothing any more
  };
  struct Answer {
    Kind kind = Kind::none;
    std::size_t item = 0;
  };
  /// Hands out the next item. @param ahead  the rank is not done with the one before: it gets another one only where
  /// enough are left for all other ranks
  Answer take(bool ahead);
  void put(ItemResult result);
  /// The rank takes no more. @pre it has put the results of all items that it is going to
  void rest(int rank);
  /// @param share  of the item at hand that is done, in [0, 1]
  void show(int rank, double share);
  /// Hands out nothing any more.
  void stop() { stopped_ = true; }
  /// Hands out nothing any more, since a rank met an error; the first one is kept.
  void fail(std::string message);

  /// Returns the result of the next item, once it is there. When all ranks rest, items without a result are passed
  /// over.
  std::optional<ItemResult> collect();
  bool allRest() const;
  bool stopped() const { return stopped_; }
  const std::optional<std::string>& failure() const { return failure_; }
  WorkDone done() const;

 private:
  std::optional<std::size_t> items_;  // none: has not begun
  std::size_t window_ = 1, next_ = 0, collected_ = 0, results_ = 0;
  std::map<std::size_t, ItemResult> kept_;  // results that have not been collected
  std::vector<double> shares_;              // of each rank's item at hand
  std::vector<bool> rests_;
  bool stopped_ = false;
  std::optional<std::string> failure_;
};

}  // namespace umbrick::tools
