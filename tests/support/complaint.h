// What an action is refused with.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace umbrick {

/// The message of the `Expected` error that the action throws; other errors pass through.
template <class Expected, class Action>
std::string complaint(const Action& action) {
  try {
    action();
  } catch (const Expected& error) {
    return error.what();
  }
  return "no complaint";
}

}  // namespace umbrick
