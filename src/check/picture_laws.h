// The laws about pictures, view by view: bricks, pools, textures, culling and the order of bricks change nothing.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <string>

#include "check/cut_volume.h"
#include "check/laws.h"
#include "check/picture_check.h"
#include "check/renderers.h"
#include "check/steps.h"
#include "check/technique_law.h"

namespace umbrick {

class PictureLaws {
 public:
  /// How much work a picture of a model is, where a picture of emission is 1.
  static double workOf(Model model) { return model == Model::emission ? 1 : 3; }
  /// About how many pictures check() makes of a volume.
  static double picturesOf(const CutVolume& volume) {
    return static_cast<double>(volume.bricks.size()) + 9 + TechniqueLaw::kWork;
  }

  /// @param samplerPrecision  voxels
  /// Everything outlives this.
  PictureLaws(const GlContext& context, const CutVolume& volume, const CheckScenes& scenes, double samplerPrecision,
              CheckSteps& steps, LightSweep lightSweep);

  /// Chooses what pictures are compared with: the whole volume as one texture or, where that is too large, the largest
  /// bricks of which one fits.
  /// @return what is to be said of the choice; empty for one texture  @throw InvalidArgument  nothing fits
  std::string chooseReference(const CheckView& view);

  /// Measures the laws in one view, by one model. @throw CheckStopped
  void check(const CheckView& view, Model model, ModelLaws& laws);

 private:
  struct Drawn {
    Picture picture;
    double farthest = 0;
  };
  // A picture without bricks, and how much it changes when all samples move a little.
  struct Reference {
    Drawn drawn;
    PictureDifference perVoxel;  // for a displacement along each axis
  };
  Drawn draw(SliceRenderer& renderer);
  Drawn draw(const Bricks& bricks, const ResolvedScene& scene, bool reverseBricks = false);
  double displacement(const ResolvedScene& scene, double farthest, int textureEdge) const;
  Reference drawReference(const ResolvedScene& scene);
  PictureLimit limitFor(const Reference& reference, const ResolvedScene& scene, const Picture& picture) const;
  void compare(const Drawn& a, const Drawn& b, const Reference& reference, const ResolvedScene& scene, double extra,
               const std::string& where, InvariantResult& all, InvariantResult* visibility) const;
  void checkCulling(const Drawn& whole, const Reference& reference, ResolvedScene scene, double saturation,
                    const std::string& where, ModelLaws& laws);
  void checkTechniques(ResolvedScene scene, const std::string& view, InvariantResult& result);
  void checkPool(const Drawn& whole, const Reference& reference, const ResolvedScene& scene, const std::string& view,
                 InvariantResult& result);
  void checkTextures(const Drawn& whole, const Reference& reference, const ResolvedScene& scene,
                     const std::string& where, InvariantResult& result);
  void checkJumps(const Drawn& drawn, const Reference& reference, const ResolvedScene& scene, const Bricks& bricks,
                  const std::string& where, InvariantResult& result) const;

  const GlContext& context_;
  const CutVolume& volume_;
  const CheckScenes& scenes_;
  const glm::dmat4 toWorld_;
  double precision_;  // of the sampler, voxels
  CheckSteps& steps_;
  RenderOptions options_;
  CheckRenderers renderers_;
  TechniqueLaw techniques_;
  std::unique_ptr<Bricks> reference_;
  std::map<std::string, double> poolShare_;  // by view: size of the pool of slots over what all bricks take
  std::string drawing_;                      // what the present step draws
  double work_ = 1;                          // of one picture
};

}  // namespace umbrick
