// SPDX-License-Identifier: Apache-2.0
#include "view/page_message.h"

#include <string>

#include "umbrick/core/error.h"

namespace umbrick::view {

using Json = nlohmann::ordered_json;

Json parseMessage(std::string_view text) {
  if (text.size() > kMostMessageBytes)
    throw InvalidArgument("message: longer than " + std::to_string(kMostMessageBytes));
  const auto shallow = [](int depth, nlohmann::detail::parse_event_t, const Json&) {
    if (depth > kDeepest) throw InvalidArgument("message: nested more than " + std::to_string(kDeepest) + " deep");
    return true;
  };
  Json message;
  try {
    message = Json::parse(text, shallow);
  } catch (const nlohmann::json::exception&) {
    throw InvalidArgument("message: is no JSON");
  }
  if (!message.is_object() || !message.contains("type") || !message["type"].is_string())
    throw InvalidArgument("message: has no type");
  return message;
}

}  // namespace umbrick::view
