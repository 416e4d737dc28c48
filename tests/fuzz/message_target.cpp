// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>

#include "fuzz/readers.h"
#include "view/page_message.h"

namespace umbrick::fuzz {
namespace {

// What is read is an object with a type, and can be written again: others send it on. Requests that are read by a
// function of their own are refused, or what that function says of them holds.
void message(const std::filesystem::path&, std::string_view text) {
  const nlohmann::ordered_json read = view::parseMessage(text);
  if (!read.is_object() || !read["type"].is_string()) std::abort();
  if (view::parseMessage(read.dump()) != read) std::abort();
  if (read["type"] == "sequence") {
    if (view::parseFrameRequest(read).number != read["number"]) std::abort();
  } else if (read["type"] == "play") {
    const view::PlayRequest play = view::parsePlayRequest(read);
    if (play.fps && !(*play.fps >= view::kLeastPlayRate && *play.fps <= view::kMostPlayRate)) std::abort();
  }
}

}  // namespace

std::map<std::string, NamedTarget> messageTargets() { return {{"message", {".json", message}}}; }

}  // namespace umbrick::fuzz
