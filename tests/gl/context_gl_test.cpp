// SPDX-License-Identifier: Apache-2.0
#include "umbrick/gl/context.h"

#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <string>

#include "gl/shared_library.h"
#include "support/field_bricks.h"
#include "support/gl_fixture.h"
#include "umbrick/gl/functions.h"
#include "umbrick/gl/objects.h"
#include "umbrick/shade/slice_renderer.h"

using namespace umbrick;
using Catch::Matchers::Contains;
using Catch::Matchers::StartsWith;

namespace {

// Returns what a hidden test of this program says in a process of its own, since drivers read their environment once.
std::string inEnvironment(const std::string& environment, const std::string& test) {
  char program[4096];
  const ssize_t length = readlink("/proc/self/exe", program, sizeof(program));
  REQUIRE(length > 0);
  const std::string command =
      environment + " '" + std::string(program, static_cast<std::size_t>(length)) + "' '" + test + "' 2>/dev/null";
  FILE* output = popen(command.c_str(), "r");
  REQUIRE(output != nullptr);
  std::string text;
  std::array<char, 4096> buffer;
  while (const std::size_t got = fread(buffer.data(), 1, buffer.size(), output)) text.append(buffer.data(), got);
  pclose(output);
  const std::size_t begin = text.find("SAYS <");
  REQUIRE(begin != std::string::npos);
  return text.substr(begin + 6, text.find("> SAID") - begin - 6);
}

std::string failureOf(Backend backend) {
  try {
    return "works: " + createGlContext(backend)->description();
  } catch (const GlError& error) {
    return error.what();
  }
}

Image samplePicture(const GlContext& context) {
  const auto field = [](const glm::ivec3& i) {
    return 0.5 + 0.5 * std::sin(0.5 * i.x) * std::cos(0.4 * i.y - 0.3 * i.z);
  };
  const FieldBricks volume(field, {glm::ivec3(0), glm::ivec3(23)});
  Scene scene;
  scene.transfer = TransferFunction({{0, {{1, 0.5, 0.2}, 0}}, {1, {{0.2, 0.4, 1}, 0.4}}});
  scene.orbit.reset();
  scene.camera.eye = {40, 25, 50};
  scene.camera.lookAt = {12, 12, 12};
  scene.camera.width = scene.camera.height = 48;
  scene.sampling.spacing = 0.5;
  scene.spacingUnit = SpacingUnit::world;
  return SliceRenderer(context, volume, resolveScene(scene, {}, glm::dmat4(1))).render().colour;
}

double maxDifference(const Image& a, const Image& b) {
  REQUIRE(a.pixels.size() == b.pixels.size());
  double worst = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    worst = std::max(worst, std::abs(static_cast<double>(a.pixels[i]) - b.pixels[i]));
  return worst;
}

void clearAndCheck(const GlContext& context, float value) {
  const GlFunctions& gl = context.gl();
  const GlTexture texture = makeTexture2d(gl, GL_R32F, 2, 2, GL_NEAREST);
  const GlFramebuffer target = makeFramebuffer(gl, {texture.name()});
  const float colour[4] = {value, 0, 0, 0};
  gl.ClearNamedFramebufferfv(target.name(), GL_COLOR, 0, colour);
  float back[4] = {};
  gl.GetTextureImage(texture.name(), 0, GL_RED, GL_FLOAT, sizeof(back), back);
  checkGl(gl, "clear");
  CHECK(back[3] == value);
}

}  // namespace

TEST_CASE("A context says what it is, and has OpenGL 4.5", "[gl]") {
  for (const auto& [backend, prefix] : {std::pair(Backend::osmesa, "OSMesa: "), std::pair(Backend::egl, "EGL: ")}) {
    const auto context = testContext(backend);
    if (!context) continue;
    CHECK(context->backend() == backend);
    CHECK_THAT(context->description(), StartsWith(prefix + context->renderer()) && Contains("OpenGL 4."));
    CHECK_FALSE(context->renderer().empty());
    CHECK(context->maxTextureEdge2d() >= 16384);
    CHECK(context->maxTextureEdge3d() >= 2048);
    clearAndCheck(*context, 0.25f);
  }
}

// Another library made the context and keeps it: here it is one of ours, taken for a foreign one.
TEST_CASE("A foreign context is adopted, draws the same picture and is left alive", "[gl]") {
  const auto made = testContext(Backend::osmesa);
  if (!made) return;
  const Image expected = samplePicture(*made);
  const SharedLibrary library({"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"});
  const auto find = library.function<GlProcedure (*)(const char*)>("OSMesaGetProcAddress");
  int madeCurrent = 0;
  {
    const auto foreign = adoptGlContext(find, [&] { ++madeCurrent; });
    CHECK(foreign->backend() == Backend::foreign);
    CHECK(foreign->renderer() == made->renderer());
    CHECK(foreign->maxTextureEdge3d() == made->maxTextureEdge3d());
    CHECK(maxDifference(samplePicture(*foreign), expected) == 0);
    // Whatever state its owner left behind.
    const GlFunctions& gl = foreign->gl();
    gl.Enable(GL_CULL_FACE);
    gl.Enable(GL_RASTERIZER_DISCARD);
    gl.PixelStorei(GL_UNPACK_ROW_LENGTH, 7);
    gl.PixelStorei(GL_UNPACK_SKIP_PIXELS, 3);
    gl.PixelStorei(GL_PACK_ROW_LENGTH, 99);
    gl.PolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    gl.BlendEquation(GL_MAX);
    const GlBuffer pixels(gl);
    gl.NamedBufferData(pixels.name(), 64, nullptr, GL_STREAM_DRAW);
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, pixels.name());
    gl.BindBuffer(GL_PIXEL_PACK_BUFFER, pixels.name());
    CHECK(maxDifference(samplePicture(*foreign), expected) == 0);
    foreign->makeCurrent();
    CHECK(madeCurrent == 1);
  }
  CHECK(maxDifference(samplePicture(*made), expected) == 0);
  CHECK_THROWS_WITH(adoptGlContext([](const char*) -> GlProcedure { return nullptr; }), Contains("has no gl"));
  CHECK_THROWS_WITH(createGlContext(Backend::foreign), Contains("adopted"));
}

TEST_CASE("OSMesa and EGL draw the same picture", "[gl]") {
  const auto osmesa = testContext(Backend::osmesa);
  if (!osmesa) return;
  const Image first = samplePicture(*osmesa);
  const auto egl = testContext(Backend::egl);
  if (!egl) return;
  const Image second = samplePicture(*egl);
  double brightest = 0;
  for (const float value : second.pixels) brightest = std::max(brightest, static_cast<double>(value));
  CHECK(brightest > 0.3);
  // Another driver rounds formulas and filters differently. A GPU filters with weights of 1/256 of a voxel's step of
  // 0.3; over 40 voxels of sigma_t 0.4 that averages out to below a thousandth of alpha.
  const bool isSoftware = egl->renderer().find("llvmpipe") != std::string::npos;
  CHECK(maxDifference(first, second) < (isSoftware ? 1e-5 : 2e-3));
}

TEST_CASE("Contexts live side by side and end in any order", "[gl]") {
  for (const auto& [one, other] :
       {std::pair(Backend::osmesa, Backend::osmesa), std::pair(Backend::egl, Backend::egl),
        std::pair(Backend::osmesa, Backend::egl), std::pair(Backend::egl, Backend::osmesa)}) {
    INFO(static_cast<int>(one) << " and " << static_cast<int>(other));
    const auto first = testContext(one);
    auto second = testContext(other);
    if (!first || !second) continue;
    for (int round = 0; round < 3; ++round) {
      first->makeCurrent();
      clearAndCheck(*first, 0.5f);
      second->makeCurrent();
      clearAndCheck(*second, 0.75f);
    }
    // Objects belong to one context: the texture of one is no texture of the other.
    first->makeCurrent();
    const GlTexture texture = makeTexture2d(first->gl(), GL_R32F, 2, 2, GL_NEAREST);
    GLint size[4] = {};
    first->gl().GetTextureImage(texture.name(), 0, GL_RED, GL_FLOAT, sizeof(size), size);
    CHECK(first->gl().GetError() == GL_NO_ERROR);
    // When the other context ends, this one stays current, if both are of one library.
    second.reset();
    if (one != other) first->makeCurrent();
    clearAndCheck(*first, 0.125f);
  }
}

TEST_CASE("Pictures do not depend on what the context drew before", "[gl]") {
  const auto context = testContext();
  if (!context) return;
  const Image first = samplePicture(*context);
  clearAndCheck(*context, 1);
  CHECK(maxDifference(first, samplePicture(*context)) == 0);
}

// The test below calls this program to run these two.
TEST_CASE("say what EGL says", "[.]") { std::cout << "SAYS <" << failureOf(Backend::egl) << "> SAID\n"; }
TEST_CASE("say what any backend says", "[.]") { std::cout << "SAYS <" << failureOf(Backend::automatic) << "> SAID\n"; }

// Mesa's softpipe has no OpenGL 4.5, and for EGL no vendor is left at all.
TEST_CASE("Without a driver one line says what was tried", "[gl]") {
  const std::string environment = "GALLIUM_DRIVER=softpipe __EGL_VENDOR_LIBRARY_FILENAMES=/nonexistent.json";
  const std::string egl = inEnvironment(environment, "say what EGL says");
  const std::string any = inEnvironment(environment, "say what any backend says");
  if (egl.starts_with("works") || any.starts_with("works")) {
    std::cout << "SKIPPED: this driver cannot be turned off: " << any << '\n';
    return;
  }
  CHECK_THAT(egl, StartsWith("no OpenGL context: tried EGL ("));
  CHECK_THAT(any, StartsWith("no OpenGL context: tried OSMesa (") && Contains("; EGL ("));
  CHECK(egl.find('\n') == std::string::npos);
  CHECK(any.find('\n') == std::string::npos);
}

TEST_CASE("Backends have names, and an unknown name is refused", "[gl]") {
  CHECK(parseName(kBackends, "auto", "backend") == Backend::automatic);
  CHECK(parseName(kBackends, "osmesa", "backend") == Backend::osmesa);
  CHECK(parseName(kBackends, "egl", "backend") == Backend::egl);
  CHECK_THROWS_WITH(parseName(kBackends, "glx", "backend"), Contains("glx") && Contains("osmesa"));
}
