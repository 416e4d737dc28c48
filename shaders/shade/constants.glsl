// Numbers that shaders and C++ share. Also compiled as C++ by src/shade/constants.h.

// Texels along the edge of a tile of the light's lattice; a compute shader's group takes one tile.
const int kLatticeTile = 8;
// A tile is stored as column + (row << kTileRowShift).
const int kTileRowShift = 16;
