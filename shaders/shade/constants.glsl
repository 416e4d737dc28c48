// Numbers that shaders and C++ share. Also compiled as C++ by src/shade/constants.h.

// Texels along the edge of a tile of the light's lattice; a compute shader's group takes one tile.
const int kLatticeTile = 8;
// A tile is stored as column + (row << kTileRowShift).
const int kTileRowShift = 16;

// Layers of the texture of windows: the first belongs to the view axis, the others to the directions of the light.
const int kViewLayer = 0;
const int kFirstLightLayer = 1;

// Units that textures are bound to.
const int kExtinctionUnit = 5;
const int kVisibilityUnit = 8;
const int kVisibilityWeightUnit = 9;

// Units that images, which compute shaders read and write, are bound to.
const int kWindowsImage = 0;
const int kVisibilityImage = 1;
const int kVisibilityWeightImage = 2;

// Buffers.
const int kTilesBuffer = 0;
