// Files of meshes.
// SPDX-License-Identifier: Apache-2.0
#include "umbrick/mesh/mesh_file.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <glm/geometric.hpp>
#include <string>

#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_meshes.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Contains;

namespace {

std::string complaintOf(const std::filesystem::path& file) {
  try {
    readMesh(file);
  } catch (const IoError& error) {
    return error.what();
  }
  return "no complaint";
}

}  // namespace

TEST_CASE("PLY, OBJ and STL give the same triangles", "[mesh]") {
  const TemporaryFolder folder;
  const auto ply = folder.path() / "a.ply", obj = folder.path() / "a.OBJ", stl = folder.path() / "a.stl";
  TriangleMesh mesh = sphereMesh({10, 20, -30}, 4, 12);
  writeBytes(ply, plyOf(mesh));
  writeBytes(obj, objOf(mesh));
  std::string text = "solid a\n";
  for (const glm::uvec3& t : mesh.triangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const unsigned i : {t.x, t.y, t.z}) {
      const glm::dvec3& v = mesh.vertices[i];
      text += "vertex " + std::to_string(v.x) + ' ' + std::to_string(v.y) + ' ' + std::to_string(v.z) + '\n';
    }
    text += "endloop\nendfacet\n";
  }
  writeBytes(stl, text + "endsolid a\n");
  const Mesh direct(mesh);
  for (const auto& file : {ply, obj, stl}) {
    const auto read = readMesh(file);
    CAPTURE(file.string());
    CHECK(read->triangles() == direct.triangles());
    for (const glm::dvec3& from : {glm::dvec3(11, 20.5, 0), glm::dvec3(9, 18.3, 0), glm::dvec3(10.2, 22.9, 0)}) {
      const auto hit = read->first(from, {0, 0, -1}, 0), expected = direct.first(from, {0, 0, -1}, 0);
      REQUIRE(hit);
      CHECK(hit->t == Approx(expected->t).margin(1e-5));
      // Normals are made where the file has none: on a smooth mesh they are nearly those of the sphere. A file may turn
      // its triangles either way.
      if (file != stl) CHECK(std::abs(glm::dot(hit->normal, expected->normal)) > 0.97);
    }
  }
}

TEST_CASE("Polygons become triangles, and points and lines are left out", "[mesh]") {
  const TemporaryFolder folder;
  const auto file = folder.path() / "square.obj";
  writeBytes(file, "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 9 9 9\nf 1 2 3 4\nl 1 5\np 5\n");
  const auto mesh = readMesh(file);
  CHECK(mesh->triangles() == 2);
  CHECK(mesh->first({1.7, 0.1, 3}, {0, 0, -1}, 0)->t == 3);
  CHECK(mesh->first({0.1, 1.7, 3}, {0, 0, -1}, 0)->t == 3);
}

TEST_CASE("Files that are no mesh are named in one line", "[mesh]") {
  const TemporaryFolder folder;
  const auto refused = [&](const std::string& name, const std::string& bytes) {
    const auto file = folder.path() / name;
    writeBytes(file, bytes);
    const std::string complaint = complaintOf(file);
    CAPTURE(complaint);
    CHECK(complaint.starts_with(file.string() + ": "));
    CHECK(std::count(complaint.begin(), complaint.end(), '\n') == 0);
    return complaint;
  };
  CHECK_THAT(refused("a.ply", ""), Contains("found an empty file"));
  CHECK_THAT(refused("b.ply", "this is not a mesh at all, is it?\n"), Contains("is no mesh that can be read"));
  CHECK_THAT(refused("c.obj", std::string(4096, '\0')), Contains("is no mesh that can be read"));
  CHECK_THAT(refused("d.png", "x"), Contains("expected a mesh as .ply, .obj or .stl"));
  const TriangleMesh sphere = sphereMesh({0, 0, 0}, 1, 4);
  TriangleMesh points = sphere;
  points.triangles.clear();
  refused("points.ply", plyOf(points));
  CHECK_THAT(refused("lines.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2\nl 2 3\n"), Contains("no mesh"));
  std::string text = plyOf(sphere);
  const std::size_t first = text.find("end_header\n") + 11;
  text.replace(first, text.find(' ', first) - first, "nan");
  CHECK_THAT(refused("nan.ply", text), Contains("is not finite"));
  // One that ends too early is refused or has triangles of what it holds, but never of vertices that it lacks.
  for (const double share : {0.3, 0.6, 0.9}) {
    const auto file = folder.path() / "cut.ply";
    const std::string whole = plyOf(sphere);
    writeBytes(file, whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    const std::string complaint = complaintOf(file);
    CHECK((complaint == "no complaint" || complaint.starts_with(file.string() + ": ")));
  }
  CHECK_THAT(complaintOf(folder.path() / "none.ply"), Contains("none.ply"));
}
