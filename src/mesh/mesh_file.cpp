// SPDX-License-Identifier: Apache-2.0
#include "umbrick/mesh/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <string>

#include "core/text_file.h"
#include "umbrick/core/error.h"
#include "umbrick/core/printable.h"

namespace umbrick {
namespace {

constexpr float kCreaseDegrees = 40;

// Other files that a mesh names, such as materials, are not looked for.
class NoOtherFiles : public Assimp::IOSystem {
 public:
  bool Exists(const char*) const override { return false; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char*, const char*) override { return nullptr; }
  void Close(Assimp::IOStream*) override {}
};

std::string extensionOf(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return std::tolower(c); });
  return extension.empty() ? extension : extension.substr(1);
}

glm::dvec3 vectorOf(const aiVector3D& v) { return {v.x, v.y, v.z}; }

// Puts the parts of a file together.
TriangleMesh joined(const aiScene& scene) {
  TriangleMesh mesh;
  bool normals = true;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) normals = normals && scene.mMeshes[m]->HasNormals();
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    const auto before = static_cast<unsigned>(mesh.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      mesh.vertices.push_back(vectorOf(part.mVertices[i]));
      if (normals) mesh.normals.push_back(vectorOf(part.mNormals[i]));
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i)
      if (const aiFace& face = part.mFaces[i]; face.mNumIndices == 3)
        mesh.triangles.emplace_back(before + face.mIndices[0], before + face.mIndices[1], before + face.mIndices[2]);
  }
  return mesh;
}

}  // namespace

std::shared_ptr<const Mesh> readMesh(const std::filesystem::path& file) {
  const std::string extension = extensionOf(file), name = file.string();
  if (extension != "ply" && extension != "obj" && extension != "stl")
    throw IoError(name + ": expected a mesh as .ply, .obj or .stl");
  const std::string bytes = readTextFile(file);
  if (bytes.empty()) throw IoError(name + ": expected a mesh, found an empty file");
  Assimp::Importer importer;
  importer.SetIOHandler(new NoOtherFiles);  // the importer owns it
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kCreaseDegrees);
  const aiScene* const scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_Triangulate | aiProcess_PreTransformVertices | aiProcess_SortByPType | aiProcess_GenSmoothNormals,
      extension.c_str());
  if (!scene || scene->mNumMeshes == 0) {
    const std::string reason = printable(importer.GetErrorString());
    throw IoError(name + ": is no mesh that can be read" + (reason.empty() ? ": it holds no triangle" : ": " + reason));
  }
  try {
    return std::make_shared<Mesh>(joined(*scene), name);
  } catch (const InvalidArgument& error) {
    throw IoError(error.what());
  }
}

}  // namespace umbrick
