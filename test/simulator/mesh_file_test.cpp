#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "geometry_oracle.h"

namespace fiimap::sim {
namespace {

/// A tetrahedron with the corners 0 and the ends of the axes, 1000 units long.
const char* const kObj =
    "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 0 0 1000\n"
    "f 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n";
const char* const kPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nelement face 4\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1000 0 0\n0 1000 0\n0 0 1000\n3 0 1 2\n3 0 1 3\n3 0 2 3\n3 1 2 3\n";
const char* const kStl =
    "solid s\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1000 0 0\nvertex 0 1000 0\n"
    "endloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1000 0 0\nvertex 0 0 1000\n"
    "endloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1000 0\nvertex 0 0 1000\n"
    "endloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 1000 0 0\nvertex 0 1000 0\nvertex 0 0 1000\n"
    "endloop\nendfacet\nendsolid s\n";

class MeshFileTest : public testing::Test {
 protected:
  ~MeshFileTest() override { std::remove(file_.c_str()); }

  WorldConfig configOf(const std::string& extension, const std::string& content) {
    file_ = testing::TempDir() + "fiimap_mesh_file_test." + extension;
    std::ofstream(file_) << content;
    WorldConfig config;
    config.world = WorldKind::kMesh;
    config.mesh_file = file_;
    config.mesh_scale = 0.002;
    config.start_x = 5.0;
    config.start_yaw = 1.0;
    return config;
  }

  std::string file_;
};

TEST_F(MeshFileTest, TheSameSurfaceFromEveryFormat) {
  for (const auto& [extension, content] :
       {std::pair("obj", kObj), std::pair("ply", kPly), std::pair("stl", kStl)}) {
    const World world = makeWorld(configOf(extension, content));
    EXPECT_EQ(world.still.triangles.size(), 4u) << extension;
    EXPECT_NEAR(test::toMesh({5, 0, 0}, world.still), 3.0, 1e-6) << extension;
    EXPECT_NEAR(test::toMesh({2, 2, 2}, world.still), 4.0 / std::sqrt(3.0), 1e-6) << extension;
    EXPECT_EQ(world.start_W, Eigen::Vector3d(5, 0, 1.5));
    EXPECT_EQ(world.start_yaw, 1.0);
  }
}

TEST_F(MeshFileTest, WhatCannotBeReadIsNamed) {
  for (const char* content : {"", "rubbish", "v 0 0 0\n"}) {
    const WorldConfig config = configOf("obj", content);
    try {
      makeWorld(config);
      FAIL() << "accepted: " << content;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("mesh_file = '" + file_), std::string::npos)
          << error.what();
    }
  }
  WorldConfig config = configOf("obj", kObj);
  config.mesh_file += ".missing";
  EXPECT_THROW(makeWorld(config), std::invalid_argument);
}

}  // namespace
}  // namespace fiimap::sim
