// SPDX-License-Identifier: Apache-2.0
#include "view/page_message.h"

#include "umbrick/core/short_number.h"

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

FrameRequest parseFrameRequest(const Json& message) {
  const bool moving = message.contains("moving") && messageField<bool>(message, "moving");
  return {messageField<std::int64_t>(message, "number"), moving};
}

PlayRequest parsePlayRequest(const Json& message) {
  PlayRequest request;
  if (message.contains("on")) request.on = messageField<bool>(message, "on");
  if (message.contains("loop")) request.loop = messageField<bool>(message, "loop");
  if (message.contains("fps")) request.fps = messageField<double>(message, "fps");
  if (request.fps && !(*request.fps >= kLeastPlayRate && *request.fps <= kMostPlayRate))
    throw InvalidArgument("play: fps is " + shortNumber(*request.fps, 6) + ", expected " +
                          shortNumber(kLeastPlayRate, 6) + " to " + shortNumber(kMostPlayRate, 6));
  return request;
}

}  // namespace umbrick::view
