// The transfer function as the texture that shaders look it up in, and what can be seen through that texture.
#pragma once
#include "umbrick/atlas/brick_atlas.h"
#include "umbrick/brick/bricks.h"
#include "umbrick/gl/objects.h"
#include "umbrick/gl/program.h"
#include "umbrick/scene/scene.h"

namespace umbrick {

class TransferLookup {
 public:
  /// Nodes stand at equal distances over the volume's values, one of them exactly at the background, so that empty
  /// space stays as transparent as the function says. There are sampling.tableSize along an axis or more, a power of
  /// two: then a node's texture coordinate is a number that single precision has. @throw GlError
  TransferLookup(const GlFunctions& gl, const TransferFunction& transfer, const SamplingOptions& sampling,
                 const Bricks& volume);

  /// False when no lookup with values (and gradient magnitudes) in these ranges can give anything but 0.
  bool isVisible(const Range& value, const Range& gradient) const;
  /// kQuadrature of shade/medium.glsl.
  int shaderMode() const { return mode_; }
  /// Sets what medium.glsl needs to look up the atlas's texels.
  void setUniforms(GlProgram& program, const BrickAtlas& atlas) const;
  GLuint texture() const { return texture_.name(); }

 private:
  // Node i stands at anchor + (i - anchorNode) step: counted from the anchor, which rounding then cannot move.
  struct Axis {
    double anchor = 0, step = 1;
    int anchorNode = 0, nodes = 1;
    double node(int i) const { return anchor + (i - anchorNode) * step; }
    Range around(const Range& values) const;  // from the node at or below to the node at or above
  };
  static Axis makeAxis(const Range& values, double anchor, int nodes);

  TransferFunction transfer_;
  int mode_;
  Axis value_, gradient_;
  GlTexture texture_;
};

}  // namespace umbrick
