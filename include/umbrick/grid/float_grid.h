// OpenVDB, whose grid of floats is compiled once: by the library, in src/grid/float_grid.cpp. Without these lines each
// file that makes a grid compiles all of its virtual functions again, which takes longer than all else in the file.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <openvdb/openvdb.h>

extern template class openvdb::Grid<openvdb::FloatTree>;
extern template class openvdb::tree::Tree<openvdb::FloatTree::RootNodeType>;
