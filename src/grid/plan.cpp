// SPDX-License-Identifier: Apache-2.0
#include "umbrick/grid/plan.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <ostream>
#include <set>
#include <streambuf>
#include <vector>

#include "grid/layer_sample.h"
#include "grid/slab_builder.h"
#include "grid/sparse_rule.h"
#include "umbrick/core/error.h"
#include "umbrick/grid/float_grid.h"
#include "umbrick/grid/vdb_codec.h"

namespace umbrick {
namespace {

using Node = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType;  // 128^3 voxels
using UpperNode = openvdb::FloatTree::RootNodeType::ChildNodeType;            // 4096^3 voxels

constexpr std::int64_t kNodeLayers = Node::DIM / kLeafEdge;  // a layer of leaves has as many slices as a leaf is high
constexpr std::int64_t kFewestLayers = 5;
constexpr std::size_t kLeavesPacked = 128;  // at most, of one layer
constexpr double kHeadBytes = 2000;         // of a .vdb file: names, metadata and transform

// Counts the bytes that are written to it, and drops them.
class CountingBuffer : public std::streambuf {
 public:
  std::int64_t bytes = 0;

 protected:
  int overflow(int c) override {
    ++bytes;
    return c == traits_type::eof() ? 0 : c;
  }
  std::streamsize xsputn(const char*, std::streamsize count) override {
    bytes += count;
    return count;
  }
};

// What was seen in one layer.
struct Layer {
  std::int64_t slices = 0;
  double activeVoxels = 0, leaves = 0, packedBytes = 0;  // packedBytes: of all its leaves in a .vdb file
  std::vector<Leaf> kept;                                // some of its leaves
};

// Which nodes there are above the leaves, and in how many layers each was met.
class NodeCensus {
 public:
  void add(const openvdb::FloatTree& tree, std::int64_t layer) {
    ++layersOf_[layer / kNodeLayers];
    for (auto node = tree.cbeginNode(); node; ++node) {
      if (node.getLevel() == 1) ++nodes_[node.getCoord()];
      if (node.getLevel() == 2) uppers_.insert(node.getCoord());
    }
  }
  double uppers() const { return static_cast<double>(uppers_.size()); }
  /// Estimates the number of nodes. Of the nodes in which several layers were read, some were met in only one of these.
  /// The share of such nodes is taken as the share of nodes that no layer has met.
  Estimate nodes(bool all) const {
    double once = 0, looked = 0;
    for (const auto& [origin, layers] : nodes_) {
      if (layersOf_.at(origin.z() / Node::DIM) < 2) continue;
      ++looked;
      once += layers == 1;
    }
    const auto count = static_cast<double>(nodes_.size());
    const double share = looked > 0 ? once / looked : 0.5;
    return {count, all ? 0 : count * share};
  }

 private:
  std::map<std::int64_t, int> layersOf_;  // layers read, by layer of nodes
  std::map<openvdb::Coord, int> nodes_;
  std::set<openvdb::Coord> uppers_;
};

std::int64_t layersToRead(const VolumeInfo& info, std::int64_t layers, const PlanOptions& plan) {
  if (!(plan.share > 0) || plan.share > 1)
    throw InvalidArgument(info.name + ": plan: expected a share in (0, 1], found " + std::to_string(plan.share));
  const double voxels = double(info.dims.x) * double(info.dims.y) * double(info.dims.z);
  if (voxels <= double(plan.wholeVoxels)) return layers;
  return std::min(layers, std::max(std::int64_t{std::lround(plan.share * double(layers))}, kFewestLayers));
}

Layer surveyLayer(const openvdb::FloatTree& tree, std::int64_t slices) {
  Layer layer;
  layer.slices = slices;
  layer.activeVoxels = static_cast<double>(tree.activeVoxelCount());
  const std::size_t leaves = tree.leafCount();
  layer.leaves = static_cast<double>(leaves);
  const std::size_t stride = std::max<std::size_t>((leaves + kLeavesPacked - 1) / kLeavesPacked, 1);
  std::size_t i = 0;
  for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf)
    if (i++ % stride == stride / 2) layer.kept.push_back(*leaf);
  return layer;
}

// Chooses how values are stored. With a maximum error this depends on all of the values.
BuildOptions storageOf(const std::vector<Layer>& layers, const BuildOptions& options, float background) {
  if (!options.maxError) return options;
  openvdb::FloatTree tree(background);
  for (const Layer& layer : layers)
    for (const Leaf& leaf : layer.kept) tree.addLeaf(new Leaf(leaf));
  return storageWithin(tree, options);
}

// Packs the leaves that were kept of a layer. Those that become tiles in the process do not count as leaves.
void packLayer(Layer& layer, const SparseRule& rule, bool again, std::uint32_t compression) {
  if (layer.kept.empty()) return;
  const float background = rule.background();
  CountingBuffer buffer;
  std::ostream out(&buffer);
  openvdb::io::setDataCompression(out, compression);
  openvdb::io::setGridBackgroundValuePtr(out, &background);
  double leaves = 0;
  for (Leaf& leaf : layer.kept) {
    if (again) {
      LeafVoxels voxels;
      std::copy_n(leaf.buffer().data(), Leaf::SIZE, voxels.value);
      voxels.active = leaf.valueMask();
      SparseTally ignored;
      if (rule.apply(voxels, ignored)) continue;
      std::copy_n(voxels.value, Leaf::SIZE, leaf.buffer().data());
      leaf.setValueMask(voxels.active);
    }
    ++leaves;
    leaf.writeTopology(out, rule.half());
    leaf.writeBuffers(out, rule.half());
  }
  const double scale = layer.leaves / static_cast<double>(layer.kept.size());
  layer.leaves = scale * leaves;
  layer.packedBytes = scale * static_cast<double>(buffer.bytes);
}

std::vector<double> column(const std::vector<Layer>& layers, double Layer::*field) {
  std::vector<double> out;
  for (const Layer& layer : layers) out.push_back(layer.*field);
  return out;
}

Estimate sum(const Estimate& a, double scaleA, const Estimate& b, double scaleB, double more) {
  return {scaleA * a.value + scaleB * b.value + more, std::hypot(scaleA * a.uncertainty, scaleB * b.uncertainty)};
}

// Returns the memory of the voxel slabs that the grid is built from: one at hand, one being read, and a third where
// values are converted.
double slabBytes(const VoxelSource& source) {
  const VolumeInfo& info = source.info();
  const double voxels = double(info.dims.x * info.dims.y) * double(std::min(slabSlices(info.dims), info.dims.z));
  if (const auto stored = source.storedType()) return voxels * 2 * voxelBytes(*stored);
  return voxels * (2 * sizeof(float) + static_cast<std::size_t>(voxelBytes(info.type)));
}

}  // namespace

GridPlan planGrid(VoxelSource& source, const BuildOptions& options, const PlanOptions& plan) {
  openvdb::initialize();
  const VolumeInfo info = source.info();
  checkSlabFits(info, std::min(kLeafEdge, info.dims.z));
  const SparseRule rule(info.name, options, 0);
  GridPlan out;
  out.voxels = static_cast<std::uint64_t>(info.dims.x * info.dims.y) * static_cast<std::uint64_t>(info.dims.z);
  out.layers = (info.dims.z + kLeafEdge - 1) / kLeafEdge;
  out.layersRead = layersToRead(info, out.layers, plan);
  out.peakBytes.value = slabBytes(source);

  SlabBuilder builder(info.dims, rule);
  SparseTally tally;
  VoxelSlab slab(source);
  NodeCensus census;
  std::vector<Layer> layers;
  std::int64_t position = 0;
  for (std::int64_t k = 0; k < out.layersRead; ++k) {
    const std::int64_t layer = (2 * k + 1) * out.layers / (2 * out.layersRead);
    if (layer * kLeafEdge > position) source.skipSlices(layer * kLeafEdge - position);
    slab.read(layer * kLeafEdge, kLeafEdge);
    position = layer * kLeafEdge + slab.slices();
    openvdb::FloatTree tree(rule.background());
    tally.add(builder.addTo(tree, slab));
    census.add(tree, layer);
    layers.push_back(surveyLayer(tree, slab.slices()));
    out.voxelsRead += static_cast<std::uint64_t>(slab.slices() * info.dims.x * info.dims.y);
    if (options.progress) options.progress(double(position) / double(info.dims.z));
  }
  checkTally(info.name, tally);
  const BuildOptions stored = storageOf(layers, options, rule.background());
  const SparseRule finalRule(info.name, stored, rule.background());
  for (Layer& layer : layers) packLayer(layer, finalRule, options.maxError.has_value(), compressionOf(plan.codec));

  const auto layerLeaves =
      static_cast<double>(((info.dims.x + kLeafEdge - 1) / kLeafEdge) * ((info.dims.y + kLeafEdge - 1) / kLeafEdge));
  const double layerVoxels = double(info.dims.x) * double(info.dims.y) * kLeafEdge;
  const auto totalOfLayers = [&](double Layer::*field, double most) {
    return totalOf(column(layers, field), static_cast<double>(out.layers), most);
  };
  out.storage = storageText(stored);
  out.activeVoxels = totalOfLayers(&Layer::activeVoxels, layerVoxels);
  // The last layer may have fewer slices. So active voxels are counted per slice, and leaves per layer.
  std::int64_t slices = 0;
  for (const Layer& layer : layers) slices += layer.slices;
  out.activeVoxels.value *= double(info.dims.z) / double(out.layers) * double(out.layersRead) / double(slices);
  // Where no layer has a leaf, leaves may lie between the layers; but not if there are active voxels, since then
  // all is constant.
  const double hidden = out.activeVoxels.value > 0 ? 0 : layerLeaves;
  out.leaves = totalOfLayers(&Layer::leaves, hidden);
  const auto leafBytes = static_cast<double>(Leaf().memUsage());
  const Estimate nodes = census.nodes(out.layersRead == out.layers);
  const Estimate packed = totalOfLayers(&Layer::packedBytes, hidden * leafBytes);
  out.gridBytes = sum(out.leaves, leafBytes, nodes, sizeof(Node), census.uppers() * sizeof(UpperNode));
  // A node in a file is two masks and a byte; its tiles pack to almost nothing.
  out.fileBytes = sum(packed, 1, nodes, 2 * Node::NUM_VALUES / 8 + 1,
                      census.uppers() * (2 * UpperNode::NUM_VALUES / 8 + 1) + kHeadBytes);
  out.peakBytes.value += out.gridBytes.value;
  out.peakBytes.uncertainty = out.gridBytes.uncertainty;
  return out;
}

}  // namespace umbrick
