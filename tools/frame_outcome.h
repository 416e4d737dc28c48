// What has come of a frame, which the rank that drew it hands to the one that keeps the books.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace umbrick::tools {

struct FrameOutcome {
  bool drawn = false;                 // else it was left out
  bool shows = true;                  // false: the picture is empty, where that fails the job
  std::string film = {};              // its picture for a film, see filmPixels(); empty: there is no film
  nlohmann::ordered_json stats = {};  // null: none are asked for
  std::string beyond = {};            // the frame that shows more than the camera was placed for, once one is known
};

std::string bytesOf(const FrameOutcome& outcome);
/// @throw nlohmann::json::exception  bytes of something else
FrameOutcome outcomeOf(const std::string& bytes);

}  // namespace umbrick::tools
