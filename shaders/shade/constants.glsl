// Numbers that shaders and C++ share. Also compiled as C++ by src/shade/constants.h.
// SPDX-License-Identifier: Apache-2.0

// Attributes of the vertices of polygons, see polygon_buffer.h.
const int kPositionAttribute = 0;
const int kSlabAttribute = 1;
const int kLayerAttribute = 2;

// Textures are bound to these units. Passes that follow each other may bind other textures to the same unit.
const int kAtlasUnit = 0;
const int kTransferUnit = 1;
const int kOcclusionUnit = 2;          // the occlusion buffer of the slice before
const int kEyeUnit = 3;                // the eye buffer so far
const int kTileStateUnit = 3;          // tiles of the image, see tile_state.frag
const int kCoveredByUnit = 4;          // also one texel for each tile of the image
const int kExtinctionUnit = 5;         // optical depth of slabs on the light's lattice
const int kLightUnit = 6;              // light at voxels, beside the atlas
const int kSlotsUnit = 7;              // slots of bricks by cell, see brick_walk.glsl
const int kVisibilityUnit = 8;         // the light that arrives
const int kVisibilityWeightUnit = 9;   // how much of that counts, see window_step.comp
const int kEmissionUnit = 16;          // what a second grid emits, see glow.glsl
const int kMoreAtlasUnit = 10;         // of rays: the second texture of the atlas, and those that follow
const int kMoreLightUnit = 13;         // the same for light
const int kBoundsUnit = 5;             // of projections: what values a cell may have
const int kStartUnit = 2;              // of rays: the depth from which each sees the medium
const int kEndUnit = 8;                // of rays: the depth at which each ends
const int kConeLightsUnit = 9;         // of rays: directions of the light, see cone_light.glsl

// Rays read up to so many textures of the atlas in one draw.
const int kRayTextures = 4;
// Added to the w of the table of slots where a brick is walked through as a whole.
const int kWholeBrick = 256;

// Images, which compute shaders read and write, are bound to these units.
const int kWindowsImage = 0;
const int kVisibilityImage = 1;
const int kVisibilityWeightImage = 2;
const int kLightImage = 0;             // of sweeps: light beside the textures of the atlas, one image for each

// Buffers are bound to these units.
const int kTilesBuffer = 0;
// Those of sweeps through light volumes, beside kTilesBuffer.
const int kExtinctionBuffer = 1;       // the transfer function as paths integrate it
const int kDepthsBuffer = 2;           // optical depths of paths
const int kThroughBuffer = 3;          // their transmittances on the slices of a slab
const int kPlacesBuffer = 4;           // where paths lie on each slice
const int kDirectionsBuffer = 5;
const int kBlocksBuffer = 6;           // blocks of voxels that get light
const int kLitBricksBuffer = 7;

// A tile of the light's lattice has so many texels along its edge; a compute shader's group takes one tile.
const int kLatticeTile = 8;
// A tile is stored as column + (row << kTileRowShift).
const int kTileRowShift = 16;

// Layers of the texture of windows: the first belongs to the view axis, the others to the directions of the light.
const int kViewLayer = 0;
const int kFirstLightLayer = 1;

// A sweep of light volumes takes paths through so many slices at once; the voxels of blocks of such an edge get light
// together, and a group takes a tile of so many paths along each edge. Tiles count from -kFirstPathTile on, since paths
// come into the plane within a slab. They are stored as column, row << kPathTileBits and direction << 2 kPathTileBits.
const int kSlabSlices = 8;
const int kLitBlock = 4;
const int kPathTile = 8;
const int kFirstPathTile = 2;
const int kPathTileBits = 13;
const int kMostPathTiles = 8192;       // along an edge
const int kMostSweptTogether = 16;     // directions
