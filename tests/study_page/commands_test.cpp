// SPDX-License-Identifier: Apache-2.0
#include "study_page/commands.h"

#include <catch2/catch.hpp>
#include <set>
#include <string>

#include "study/invented_study.h"

using namespace umbrick;
using namespace umbrick::tools;
using Catch::Contains;

namespace {

std::string commandOf(const StudyRecord& record, const std::string& method, int detail) {
  StudyCase what;
  what.method = method;
  what.slices = 8;
  what.detail = detail;
  what.size = 16;
  what.theta = 60 * kDegree;
  return renderCommand(what, record.scene, record.geometry);
}

}  // namespace

TEST_CASE("A command says what its method sets", "[study_page]") {
  const StudyRecord record = inventedStudy();
  CHECK_THAT(commandOf(record, "emission", 0), Contains("--model emission --eye-bits"));
  CHECK_THAT(commandOf(record, "emission-full", 0), Contains("--model emission --saturation 0 --eye-bits"));
  CHECK_THAT(commandOf(record, "dos", 3),
             Contains("--model cone --method dos --algorithm 3 --passes 1 --footprint 3 --theta 60 --occlusion-bits"));
  CHECK_THAT(commandOf(record, "dos-2", 5), Contains("--method dos --algorithm 2 --passes 1 --footprint 5 --theta"));
  CHECK_THAT(commandOf(record, "dos-two-pass", 3), Contains("--method dos --algorithm 3 --passes 2 --footprint 3"));
  CHECK_THAT(commandOf(record, "rays", 0), Contains("--model emission --technique rays --backend cpu --spacing"));
  CHECK_THAT(commandOf(record, "rays-gl", 0), Contains("--model emission --technique rays --backend osmesa --spacing"));
  CHECK_THAT(commandOf(record, "rays-gl-box", 0),
             Contains("--technique rays --backend osmesa --unbricked --no-culling --spacing"));
  CHECK_THAT(commandOf(record, "mip-rays-gl", 0), Contains("--mode mip --technique rays --backend osmesa --spacing"));
  CHECK_THAT(commandOf(record, "phong-shear-warp", 0),
             Contains("--shading phong --technique shear-warp --backend cpu"));
  CHECK(referenceCommand({Model::emission, 16, 0, StudyLook::average}, record.scene, record.plan.settings)
            .find("--model emission --mode average") != std::string::npos);
  CHECK_THAT(commandOf(record, "ordinates", 8), Contains("--model cone --method ordinates --directions 8 --theta 60"));
}

TEST_CASE("The command of a case has every option that its method depends on", "[study_page]") {
  StudySettings settings;
  settings.methods = {"ordinates"};
  settings.slices = {16, 4, 8};
  settings.segments = {2, 1};
  settings.sizes = {32, 16};
  settings.thetas = {80 * kDegree, 60 * kDegree};
  settings.details = {{"directions", {8}}};
  settings.scales = {0.5};
  const ResolvedScene scene = smokeScene();
  const StudyGeometry geometry{16, 0.5};
  StudyCase what = planStudy(settings, 60 * kDegree).bases.at("ordinates");  // slabs of 2 = 4 voxels
  CHECK(renderCommand(what, scene, geometry) ==
        "umbrick render scene.json --model cone --method ordinates --directions 8 --theta 60 --occlusion-bits 32 "
        "--eye-bits 32 --spacing 2 --spacing-unit world --segments 7 --size 32x32 --exr-pixel float -o "
        "ordinates-K8-N8-ka-e32o32-s32-t60.exr");
  what.scale = 0.5;
  what.segments = 2;
  const std::string command = renderCommand(what, scene, geometry);
  CHECK(command.find(" --occlusion-scale 0.5 ") != std::string::npos);
  CHECK(command.find(" --segments 2 ") != std::string::npos);
  const ResolvedScene made = caseScene(scene, what, geometry);
  CHECK(made.method == Method::ordinates);
  CHECK(made.occlusion.ordinates.directions == 8);
  CHECK(made.occlusion.ordinates.scale == 0.5);
  CHECK(made.sampling.segments == 2);
}

TEST_CASE("The commands of two methods differ", "[study_page]") {
  const StudyRecord record = inventedStudy();
  std::set<std::string> commands;
  for (const StudyMethod& method : studyMethods()) {
    std::string command = commandOf(record, method.name, 4);
    commands.insert(command.substr(0, command.find(" -o ")));  // the file's name has the method's anyway
  }
  CHECK(commands.size() == studyMethods().size());
}
