// The volume of a random scene.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "fuzz/pictures/dice.h"
#include "umbrick/core/range.h"
#include "umbrick/grid/scalar_grid.h"

namespace umbrick {

struct RandomGrid {
  ScalarGrid grid;
  std::string description;
  float background = 0;
  double full = 1;       // value that the content reaches, away from the background; outliers aside
  double thickness = 8;  // voxels of content along a typical ray that meets it
  double levels = 0;     // labels: so many equal steps lie between background and `full`; 0: values vary continuously
  Range value;           // of finite voxels, background included
};

RandomGrid randomGrid(Dice& dice);

}  // namespace umbrick
