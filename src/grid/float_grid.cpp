#include "umbrick/grid/float_grid.h"

template class openvdb::Grid<openvdb::FloatTree>;
template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
