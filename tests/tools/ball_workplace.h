// A folder in which the program finds a small volume.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <string>

#include "support/test_grids.h"
#include "tools/program.h"
#include "umbrick/grid/build_grid.h"
#include "umbrick/image/exr.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {

/// Holds ball.vdb and ball.json, a transfer function for it.
struct BallWorkplace {
  TemporaryFolder folder;
  BallWorkplace() {
    const openvdb::FloatGrid::Ptr grid = makeSparse(glm::ivec3(0), 2, 6, 48).grid->deepCopy();
    grid->setName("density");
    writeGrids(folder.path() / "ball.vdb", {grid});
    writeBytes(folder.path() / "ball.json",
               R"({"points": [{"value": 0.05, "albedo": [1, 0.6, 0.2], "sigma_t": 0},
                              {"value": 1, "albedo": [0.9, 0.8, 0.7], "sigma_t": 2}]})");
  }
  ProgramResult run(const std::string& arguments) const { return runProgram(folder, arguments); }
  ExrFile exr(const std::string& name) const { return readExr(folder.path() / name); }
  nlohmann::json json(const std::string& name) const { return nlohmann::json::parse(readBytes(folder.path() / name)); }
  /// Returns the scene in the header of a picture that is made with these arguments.
  nlohmann::json sceneOf(const std::string& arguments) const {
    const ProgramResult result = run(arguments + " -o scene.exr");
    INFO(arguments << ": " << result.err);
    REQUIRE(result.status == 0);
    return nlohmann::json::parse(exr("scene.exr").metadata.at("umbrick.scene"));
  }
};

}  // namespace umbrick
