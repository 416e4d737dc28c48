// Ranks by MPI.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "dist/ranks.h"

namespace umbrick::tools {

/// Initialises MPI, and ends it when the object goes. Ranks other than the first are silent from then on.
/// @param messages  the descriptor that the program's messages go to
/// @return null where MPI knows of one rank alone
/// @throw Error
std::unique_ptr<Ranks> joinMpiRanks(int messages);

}  // namespace umbrick::tools
