// SPDX-License-Identifier: Apache-2.0
#include "umbrick/mesh/mesh_file.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
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

// Checks what a reader made of a file before Assimp works on it, which takes it for right: Debian builds it with its
// assertions, which end the program. A mesh says which kinds of faces it has, as it has them.
void checkRead(const aiScene& scene, const std::string& name) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
      const aiVector3D& v = mesh.mVertices[i];
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        throw IoError(name + ": vertex " + std::to_string(i) + " of " + std::to_string(mesh.mNumVertices) +
                      " is not finite");
    }
    mesh.mPrimitiveTypes = 0;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      for (unsigned k = 0; k < face.mNumIndices; ++k)
        if (face.mIndices[k] >= mesh.mNumVertices)
          throw IoError(name + ": face " + std::to_string(i) + " has the vertex " + std::to_string(face.mIndices[k]) +
                        ", there are " + std::to_string(mesh.mNumVertices));
      mesh.mPrimitiveTypes |= face.mNumIndices == 1   ? aiPrimitiveType_POINT
                              : face.mNumIndices == 2 ? aiPrimitiveType_LINE
                              : face.mNumIndices == 3 ? aiPrimitiveType_TRIANGLE
                                                      : aiPrimitiveType_POLYGON;
      if (face.mNumIndices == 0) throw IoError(name + ": face " + std::to_string(i) + " has no vertex");
    }
  }
}

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
  const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, extension.c_str());
  if (scene && scene->mNumMeshes > 0) {
    checkRead(*scene, name);
    scene = importer.ApplyPostProcessing(aiProcess_Triangulate | aiProcess_PreTransformVertices |
                                         aiProcess_SortByPType | aiProcess_GenSmoothNormals);
  }
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
