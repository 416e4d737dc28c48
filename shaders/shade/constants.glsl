// Numbers that shaders and C++ share. Also compiled as C++ by src/shade/constants.h.
// SPDX-License-Identifier: Apache-2.0

// Attributes of the vertices of polygons, see polygon_buffer.h.
const int kPositionAttribute = 0;
const int kSlabAttribute = 1;
const int kLayerAttribute = 2;

// Units that textures are bound to. Passes that follow each other may bind other textures to the same unit.
const int kAtlasUnit = 0;
const int kTransferUnit = 1;
const int kOcclusionUnit = 2;          // the occlusion buffer of the slice before
const int kEyeUnit = 3;                // the eye buffer so far
const int kTileStateUnit = 3;          // tiles of the image, see tile_state.frag
const int kCoveredByUnit = 4;          // likewise
const int kExtinctionUnit = 5;         // of slabs on the light's lattice
const int kVisibilityUnit = 8;         // what arrives of the light, and
const int kVisibilityWeightUnit = 9;   // how much of it counts, see window_step.comp

// Units that images, which compute shaders read and write, are bound to.
const int kWindowsImage = 0;
const int kVisibilityImage = 1;
const int kVisibilityWeightImage = 2;

// Units that buffers are bound to.
const int kTilesBuffer = 0;

// Texels along the edge of a tile of the light's lattice; a compute shader's group takes one tile.
const int kLatticeTile = 8;
// A tile is stored as column + (row << kTileRowShift).
const int kTileRowShift = 16;

// Layers of the texture of windows: the first belongs to the view axis, the others to the directions of the light.
const int kViewLayer = 0;
const int kFirstLightLayer = 1;
