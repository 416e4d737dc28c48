// SPDX-License-Identifier: Apache-2.0
#include "frame_outcome.h"

#include <cstdint>
#include <vector>

namespace umbrick::tools {

std::string bytesOf(const FrameOutcome& outcome) {
  nlohmann::ordered_json json{
      {"drawn", outcome.drawn}, {"shows", outcome.shows}, {"stats", outcome.stats}, {"beyond", outcome.beyond}};
  json["film"] = nlohmann::ordered_json::binary({outcome.film.begin(), outcome.film.end()});
  const std::vector<std::uint8_t> bytes = nlohmann::ordered_json::to_cbor(json);
  return {bytes.begin(), bytes.end()};
}

FrameOutcome outcomeOf(const std::string& bytes) {
  const auto json = nlohmann::ordered_json::from_cbor(bytes);
  const auto& film = json.at("film").get_binary();
  return {json.at("drawn").get<bool>(),
          json.at("shows").get<bool>(),
          {film.begin(), film.end()},
          json.at("stats"),
          json.at("beyond").get<std::string>()};
}

}  // namespace umbrick::tools
