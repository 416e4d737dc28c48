// SPDX-License-Identifier: Apache-2.0
#include "dist/work_ledger.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace umbrick::tools {

WorkLedger::WorkLedger(int ranks) : shares_(static_cast<std::size_t>(ranks)), rests_(static_cast<std::size_t>(ranks)) {}

void WorkLedger::begin(std::size_t items, std::size_t window) {
  items_ = items;
  window_ = window;
}

WorkLedger::Answer WorkLedger::take(bool ahead) {
  if (stopped_) return {Kind::none};
  if (!items_) return {Kind::later};
  if (next_ == *items_) return {Kind::none};
  if (ahead && *items_ - next_ < shares_.size()) return {Kind::later};
  if (next_ >= collected_ + window_) return {Kind::later};
  return {Kind::item, next_++};
}

void WorkLedger::put(ItemResult result) {
  ++results_;
  const std::size_t item = result.item;
  kept_.insert_or_assign(item, std::move(result));
}

void WorkLedger::rest(int rank) {
  show(rank, 0);
  rests_[static_cast<std::size_t>(rank)] = true;
}

void WorkLedger::show(int rank, double share) { shares_[static_cast<std::size_t>(rank)] = share; }

void WorkLedger::fail(std::string message) {
  stop();
  if (!failure_) failure_ = std::move(message);
}

std::optional<ItemResult> WorkLedger::collect() {
  if (kept_.empty()) return {};
  const auto first = kept_.begin();
  if (first->first != collected_ && !allRest()) return {};
  ItemResult result = std::move(first->second);
  collected_ = result.item + 1;
  kept_.erase(first);
  return result;
}

bool WorkLedger::allRest() const {
  return std::ranges::all_of(rests_, [](bool rests) { return rests; });
}

WorkDone WorkLedger::done() const { return {results_, std::accumulate(shares_.begin(), shares_.end(), 0.0)}; }

}  // namespace umbrick::tools
