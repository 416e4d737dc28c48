// Media with closed forms, as grids, and what the reference makes of them.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "support/closed_forms.h"
#include "support/test_grids.h"
#include "support/test_scenes.h"
#include "umbrick/reference/reference.h"
