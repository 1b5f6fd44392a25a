#include <stdexcept>

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include "worlds/world.h"

namespace fiimap::sim {
namespace {

Mesh readMesh(const std::string& file, double scale) {
  Assimp::Importer importer;
  const unsigned steps = aiProcess_Triangulate | aiProcess_PreTransformVertices |
                         aiProcess_JoinIdenticalVertices | aiProcess_SortByPType;
  const aiScene* scene = importer.ReadFile(file, steps);
  if (!scene) {
    throw std::invalid_argument("parameter mesh_file = '" + file +
                                "': cannot be read: " + importer.GetErrorString());
  }
  Mesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    const aiMesh& part = *scene->mMeshes[i];
    Mesh triangles;
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D& p = part.mVertices[v];
      triangles.vertices.push_back((scale * Eigen::Vector3d(p.x, p.y, p.z)).cast<float>());
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines have no surface
      triangles.triangles.emplace_back(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
    }
    mesh.append(triangles);
  }
  if (mesh.triangles.empty()) {
    throw std::invalid_argument("parameter mesh_file = '" + file + "': has no triangles");
  }
  return mesh;
}

}  // namespace

World makeMeshWorld(const WorldConfig& config) {
  World world;
  world.still = readMesh(config.mesh_file, config.mesh_scale);
  world.start_W = {config.start_x, config.start_y, config.start_z};
  world.start_yaw = config.start_yaw;
  world.goal_W = world.start_W;
  return world;
}

}  // namespace fiimap::sim
