// SPDX-License-Identifier: Apache-2.0
#include "view/view_sequence.h"

#include <algorithm>

namespace umbrick::view {

std::optional<std::size_t> frameOf(const ViewSequence& sequence, std::int64_t number) {
  const auto found = std::ranges::lower_bound(sequence.frames, number, {}, &ViewSequence::Frame::number);
  if (found == sequence.frames.end() || found->number != number) return std::nullopt;
  return static_cast<std::size_t>(found - sequence.frames.begin());
}

VolumeReference sourceOf(const ViewSequence& sequence, std::size_t index, const Volume* volume) {
  VolumeReference source = volume ? volume->source() : sequence.frames[index].volume;
  if (sequence.inside) source.file = sequence.whole.file;
  return source;
}

std::string frameOptions(const ViewSequence& sequence) {
  const std::int64_t first = sequence.frames.front().number, last = sequence.frames.back().number;
  std::string text = "--frames " + std::to_string(first);
  if (last > first) text += "-" + std::to_string(last);
  if (last > first && sequence.step > 1) text += ":" + std::to_string(sequence.step);
  const std::int64_t wanted = (last - first) / sequence.step + 1;
  if (wanted > static_cast<std::int64_t>(sequence.frames.size())) text += " --skip-missing";
  return text;
}

}  // namespace umbrick::view
