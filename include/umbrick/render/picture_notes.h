// What people should know of a picture that was made: what was rounded or left to chance, and why nothing is seen.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "umbrick/draw/renderer.h"
#include "umbrick/render/asked_scene.h"
#include "umbrick/render/volume.h"

namespace umbrick {

/// Returns a line about a picture whose alpha is nowhere above 1/255, or everywhere 1: what the values of the volume
/// are, where the transfer function shows something, and what to try. Nothing for other pictures. Before a background
/// (where all pixels are opaque) a picture is empty when it is the background everywhere.
/// @param words  of the user, for the options to try
std::optional<std::string> describeEmptyPicture(const Image& colour, const ResolvedScene& scene, const Volume& volume,
                                                const AskedScene& words);

/// Returns what a user should know of how a picture was made: a line each. @param words  of the user
std::vector<std::string> notesOn(const Picture& picture, const ResolvedScene& scene, const AskedScene& words);

}  // namespace umbrick
