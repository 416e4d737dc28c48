// The laws that a check measures: a result for each, which is filled view by view.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "umbrick/check/invariants.h"

namespace umbrick {

/// The laws about pictures of one model.
struct ModelLaws {
  ModelLaws(Model model, Method method);
  InvariantResult edges, pool, textures, culling, saturated, seam, skipped, jumps, order, techniques;
};

/// All laws. None is complete until it is said to be.
struct Laws {
  explicit Laws(Method method);
  ModelLaws& of(Model model) { return model == Model::cone ? cone : emission; }

  InvariantResult aprons, ranges;            // voxels of bricks
  InvariantResult gaps, doubleHits, values;  // single slices
  InvariantResult border;                    // pieces of the volume
  InvariantResult modes;                     // pictures of values and surfaces
  ModelLaws emission, cone;                  // pictures
};

/// Says that laws have been measured everywhere.
void finish(ModelLaws& laws);
inline void finish(InvariantResult& law) { law.complete = true; }

/// Returns the results in the order of their numbers.
/// @param referenceNote  what pictures were compared with where it was not one texture; or empty
std::vector<InvariantResult> collect(Laws laws, const std::string& referenceNote);

}  // namespace umbrick
