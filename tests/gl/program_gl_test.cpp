// SPDX-License-Identifier: Apache-2.0
#include "umbrick/gl/program.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "support/gl_fixture.h"
#include "umbrick/core/error.h"
#include "umbrick/gl/objects.h"

namespace umbrick {
std::vector<std::string> shaderTextNames();  // made by the build, which embeds the shaders
}

using namespace umbrick;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

template <class Action>
std::string complaint(const Action& action) {
  try {
    action();
  } catch (const GlError& error) {
    return error.what();
  }
  return "no complaint";
}

}  // namespace

TEST_CASE("A shader holds every file it includes once, in the place of the first include", "[gl]") {
  const std::string source = shaderSource("shade/occlusion_slice.frag", {{"kTaps", 9}});
  CHECK_THAT(source, StartsWith("#version 450 core\nconst int kTaps = 9;\n#line 1\n"));
  CHECK(count(source, "#include") == 0);
  // slab.glsl and occlusion_slice.frag both need what optics/slab.glsl defines.
  CHECK(count(source, "float slabFactor(float x)") == 1);
  CHECK(source.find("float slabFactor(float x)") < source.find("Slab evaluateSlab("));
}

// What a driver is told is line 10 000 i + n is line n of the i-th file, in the order of first use.
TEST_CASE("Every line of a shader keeps its number and its file", "[gl]") {
  const std::string source = shaderSource("shade/occlusion_slice.frag");
  const std::string own = shaderSource("shade/clip.glsl");
  // The lines of a file without includes follow their mark as they are in the file.
  const std::string mark = "#line 1\n";
  const std::string body = own.substr(own.find(mark) + mark.size());
  int found = 0;
  for (int file = 1; file < 9; ++file)
    found += static_cast<int>(count(source, "#line " + std::to_string(10'000 * file + 1) + "\n" + body));
  CHECK(found == 1);
  // After an include in line 3 the file goes on at its line 4.
  CHECK_THAT(shaderSource("shade/slab.glsl"), Contains("#line 4\n#line 20001\n"));
}

TEST_CASE("A shader that does not exist is named", "[gl]") {
  CHECK(complaint([] { shaderSource("shade/none.frag"); }) == "no shader shade/none.frag");
}

TEST_CASE("Every shader that is not an include compiles by itself, or says where it fails", "[gl]") {
  const auto context = testContext();
  if (!context) return;
  const std::vector<std::string> names = shaderTextNames();
  CHECK(std::find(names.begin(), names.end(), "shade/emission.frag") != names.end());
  int compiled = 0;
  for (const std::string& name : names) {
    if (!name.ends_with(".frag") && !name.ends_with(".comp")) continue;
    // Shaders of slices say where their polygons lie in the atlas.
    const bool isSlice = shaderSource(name).find("flat in vec4 slab_centre") != std::string::npos;
    INFO(name);
    for (const int perspective : {0, 1})
      for (const int planes : {0, 7})
        for (const int quadrature : {0, 1, 2, 3}) {
          const ShaderConstants constants{{"kPerspective", perspective},
                                          {"kClipPlanes", planes},
                                          {"kQuadrature", quadrature},
                                          {"kUniformStretches", planes == 0       ? 0
                                                                : quadrature == 0 ? 9
                                                                                  : 100},
                                          {"kValueSteps", 4},
                                          {"kGradientSteps", 2},
                                          {"kSegments", 1},
                                          {"kAux", planes > 0},
                                          {"kStack", perspective + (planes > 0)},
                                          {"kTaps", 9},
                                          {"kTextures", 1 + perspective},
                                          {"kLit", perspective},
                                          {"kConeRays", planes > 0 && !perspective},
                                          {"kAlgorithm", 2 + perspective},
                                          {"kTileEdge", 8},
                                          {"kDirections", 16},
                                          {"kWindows", 17},
                                          {"kColoured", perspective},
                                          {"kShaded", perspective},
                                          {"kBspline", planes > 0},
                                          {"kStarts", perspective},
                                          {"kEnds", perspective},
                                          {"kShadingLights", planes > 0 ? 2 : 0},
                                          {"kProjection", quadrature},
                                          {"kPerVoxel", 1 + perspective},
                                          {"kSurfaces", 1 + quadrature},
                                          {"kLossy", planes > 0},
                                          {"kEmission", perspective},
                                          {"kPlanes", planes},
                                          {"kContinued", perspective},
                                          {"kTableSteps", 4096},
                                          {"kTableEnds", 4},
                                          {"kCodes", planes > 0 ? 65535 : 0},
                                          {"kFixedPoint", planes > 0}};
          if (name.ends_with(".comp")) {
            const GlProgram program = GlProgram::compute(context->gl(), name, constants);
            ++compiled;
            continue;
          }
          const GlProgram program(context->gl(),
                                  name == "shade/ordinates.frag" ? "shade/ordinates.vert"
                                  : isSlice                      ? "shade/slice.vert"
                                                                 : "shade/full_screen.vert",
                                  name, constants);
          ++compiled;
        }
  }
  CHECK(compiled >= 12 * 9);
}

TEST_CASE("A driver's complaint names our file and line", "[gl]") {
  const auto context = testContext();
  if (!context) return;
  // Without its constants footprint.glsl fails where it declares the taps.
  const std::string message =
      complaint([&] { GlProgram(context->gl(), "shade/full_screen.vert", "shade/occlusion_spread.frag"); });
  CHECK_THAT(message, StartsWith("shader shade/occlusion_spread.frag: ") && Contains("kTaps"));
  // The mark after the last include of the file says where the file goes on.
  const std::string text = shaderSource("shade/footprint.glsl");
  const std::size_t taps = text.find("uniform vec4 taps["), mark = text.rfind("#line ", taps);
  const std::size_t start = text.find('\n', mark) + 1;
  const std::size_t line = std::stoul(text.substr(mark + 6)) + count(text.substr(start, taps - start), "\n");
  CHECK_THAT(message, Contains("shade/footprint.glsl:" + std::to_string(line)));
  CHECK(complaint([&] { GlProgram(context->gl(), "shade/none.vert", "shade/emission.frag"); }) ==
        "no shader shade/none.vert");
}

TEST_CASE("A program moves without being deleted twice", "[gl]") {
  const auto context = testContext();
  if (!context) return;
  const GlFunctions& gl = context->gl();
  GlProgram first(gl, "shade/full_screen.vert", "shade/saturated.frag");
  GlProgram second = std::move(first);
  second.set("saturation", 0.5f);
  second.set("not there", 1);  // an unknown name is ignored
  GlProgram third(gl, "shade/full_screen.vert", "shade/saturated.frag");
  third = std::move(second);
  third.use();
  checkGl(gl, "use of a moved program");
}
