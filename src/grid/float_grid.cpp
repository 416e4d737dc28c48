// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/float_grid.h"

template class openvdb::Grid<openvdb::FloatTree>;
template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
