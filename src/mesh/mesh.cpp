// SPDX-License-Identifier: Apache-2.0
#include "umbrick/mesh/mesh.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "umbrick/core/error.h"

namespace umbrick {
namespace {

struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<std::remove_pointer_t<RTCDevice>, DeviceRelease>;
using TriangleScene = std::unique_ptr<std::remove_pointer_t<RTCScene>, SceneRelease>;

// Embree's own limit of coordinates is 1.8e18.
constexpr double kLargest = 1e18;

bool isFinite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void check(const TriangleMesh& mesh, const std::string& name) {
  if (mesh.triangles.empty()) throw InvalidArgument(name + ": expected triangles, found none");
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i)
    if (!isFinite(mesh.vertices[i]))
      throw InvalidArgument(name + ": vertex " + std::to_string(i) + " of " + std::to_string(mesh.vertices.size()) +
                            " is not finite");
  for (const glm::uvec3& triangle : mesh.triangles) {
    const std::size_t last = std::max({triangle.x, triangle.y, triangle.z});
    if (last >= mesh.vertices.size())
      throw InvalidArgument(name + ": a triangle has the vertex " + std::to_string(last) + ", there are " +
                            std::to_string(mesh.vertices.size()));
  }
}

}  // namespace

class Mesh::Implementation {
 public:
  Implementation(const TriangleMesh& mesh, const std::string& name) : triangles_(mesh.triangles) {
    check(mesh, name);
    for (const glm::dvec3& vertex : mesh.vertices) bounds_.include(vertex);
    centre_ = bounds_.centre();
    const glm::dvec3 extent = bounds_.extent();
    if (!(std::max({extent.x, extent.y, extent.z}) < kLargest))
      throw InvalidArgument(name + ": expected a mesh smaller than 1e18 world units");
    // Single precision counts from the middle of the mesh.
    for (const glm::dvec3& vertex : mesh.vertices) vertices_.emplace_back(vertex - centre_);
    if (mesh.normals.size() == mesh.vertices.size())
      for (const glm::dvec3& normal : mesh.normals) normals_.emplace_back(normal);
    device_.reset(rtcNewDevice(nullptr));
    if (!device_) throw Error(name + ": Embree cannot begin, error " + std::to_string(rtcGetDeviceError(nullptr)));
    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);  // no ray slips through between two triangles
    addTriangles();
    rtcCommitScene(scene_.get());
    if (const RTCError error = rtcGetDeviceError(device_.get()); error != RTC_ERROR_NONE)
      throw Error(name + ": Embree cannot sort " + std::to_string(triangles_.size()) + " triangles, error " +
                  std::to_string(error));
  }

  std::optional<Hit> first(const glm::dvec3& origin, const glm::dvec3& direction, double from) const {
    double enter = from, leave = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const double low = bounds_.min[axis] - origin[axis], high = bounds_.max[axis] - origin[axis];
      if (direction[axis] == 0) {
        if (low > 0 || high < 0) return std::nullopt;
        continue;
      }
      const double a = low / direction[axis], b = high / direction[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    // A flat mesh lies in a face of its own box, which rounding may put on either side.
    const double margin = 1e-6 * glm::length(bounds_.extent()) / glm::length(direction);
    if (!(enter <= leave + margin)) return std::nullopt;
    enter = std::max(from, enter - margin);
    // Embree's ray begins where the box does: the eye may be far away.
    const double length = glm::length(direction);
    const glm::dvec3 begin = origin + enter * direction - centre_, along = direction / length;
    RTCRayHit query{};
    query.ray.org_x = static_cast<float>(begin.x);
    query.ray.org_y = static_cast<float>(begin.y);
    query.ray.org_z = static_cast<float>(begin.z);
    query.ray.dir_x = static_cast<float>(along.x);
    query.ray.dir_y = static_cast<float>(along.y);
    query.ray.dir_z = static_cast<float>(along.z);
    query.ray.tfar = std::numeric_limits<float>::infinity();
    query.ray.mask = ~0u;
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene_.get(), &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return hitOf(query, origin - centre_, direction, enter, length);
  }

  std::vector<glm::dvec3> vertices() const {
    std::vector<glm::dvec3> world;
    world.reserve(vertices_.size());
    for (const glm::vec3& vertex : vertices_) world.push_back(centre_ + glm::dvec3(vertex));
    return world;
  }
  const std::vector<glm::uvec3>& corners() const { return triangles_; }
  const Box& bounds() const { return bounds_; }
  bool equals(const Implementation& other) const {
    return centre_ == other.centre_ && vertices_ == other.vertices_ && normals_ == other.normals_ &&
           triangles_ == other.triangles_;
  }

 private:
  void addTriangles() {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* const vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), vertices_.size()));
    auto* const triangles = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), triangles_.size()));
    if (vertices && triangles) {
      std::ranges::copy(vertices_, vertices);
      std::ranges::copy(triangles_, triangles);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_.get(), geometry);
    }
    rtcReleaseGeometry(geometry);
  }

  Hit hitOf(const RTCRayHit& query, const glm::dvec3& origin, const glm::dvec3& direction, double enter,
            double length) const {
    const glm::uvec3 corners = triangles_[query.hit.primID];
    const glm::dvec3 a(vertices_[corners.x]), b(vertices_[corners.y]), c(vertices_[corners.z]);
    const glm::dvec3 across = glm::cross(b - a, c - a);
    Hit hit;
    const double rate = glm::dot(across, direction);
    hit.t = rate != 0 ? glm::dot(across, a - origin) / rate : enter + static_cast<double>(query.ray.tfar) / length;
    hit.normal = glm::normalize(across);
    if (normals_.empty()) return hit;
    const auto u = static_cast<double>(query.hit.u), v = static_cast<double>(query.hit.v);
    const glm::dvec3 smooth = (1 - u - v) * glm::dvec3(normals_[corners.x]) + u * glm::dvec3(normals_[corners.y]) +
                              v * glm::dvec3(normals_[corners.z]);
    const double size = glm::length(smooth);
    if (std::isfinite(size) && size > 0) hit.normal = smooth / size;
    return hit;
  }

  glm::dvec3 centre_{0};
  Box bounds_;
  std::vector<glm::vec3> vertices_, normals_;  // vertices from the centre
  std::vector<glm::uvec3> triangles_;
  Device device_;
  TriangleScene scene_;  // leaves before its device
};

Mesh::Mesh(const TriangleMesh& triangles, const std::string& name)
    : implementation_(std::make_unique<Implementation>(triangles, name)) {}
Mesh::~Mesh() = default;
std::optional<Mesh::Hit> Mesh::first(const glm::dvec3& origin, const glm::dvec3& direction, double from) const {
  return implementation_->first(origin, direction, from);
}
std::size_t Mesh::triangles() const { return implementation_->corners().size(); }
std::vector<glm::dvec3> Mesh::vertices() const { return implementation_->vertices(); }
const std::vector<glm::uvec3>& Mesh::corners() const { return implementation_->corners(); }
const Box& Mesh::bounds() const { return implementation_->bounds(); }
bool Mesh::operator==(const Mesh& other) const { return implementation_->equals(*other.implementation_); }

}  // namespace umbrick
