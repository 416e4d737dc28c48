// Tests the formulas of shaders/optics as a driver computes them. Tested elsewhere: the same lines compiled as C++
// (optics: medium_test).
// SPDX-License-Identifier: Apache-2.0
#include <catch2/catch.hpp>
#include <cmath>
#include <glm/vec4.hpp>
#include <limits>
#include <string>
#include <vector>

#include "support/gl_fixture.h"
#include "umbrick/gl/objects.h"
#include "umbrick/gl/program.h"
#include "umbrick/image/image.h"

using namespace umbrick;

namespace {

GLuint compileText(const GlFunctions& gl, GLenum stage, const std::string& source) {
  const char* text = source.c_str();
  const GLuint shader = gl.CreateShader(stage);
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint compiled = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  REQUIRE(compiled);
  return shader;
}

// Returns for every x: oneMinusExp(x), slabFactor(x), exp(-x) and x itself.
std::vector<glm::vec4> evaluate(const GlFunctions& gl, std::vector<float> x) {
  const int width = 512, height = static_cast<int>((x.size() + width - 1) / width);
  const std::size_t count = x.size();
  x.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 1.0f);
  const GlTexture input = makeTexture2d(gl, GL_R32F, width, height, GL_NEAREST);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
  gl.TextureSubImage2D(input.name(), 0, 0, 0, width, height, GL_RED, GL_FLOAT, x.data());
  const GlTexture output = makeTexture2d(gl, GL_RGBA32F, width, height, GL_NEAREST);
  const GlFramebuffer target = makeFramebuffer(gl, {output.name()});
  const GLuint program = gl.CreateProgram();
  for (const GLuint shader : {compileText(gl, GL_VERTEX_SHADER, shaderSource("shade/full_screen.vert")),
                              compileText(gl, GL_FRAGMENT_SHADER, shaderSource("optics/slab.glsl") + R"(
layout(binding = 0) uniform sampler2D numbers;
layout(location = 0) out vec4 result;
void main() {
  float x = texelFetch(numbers, ivec2(gl_FragCoord.xy), 0).r;
  result = vec4(oneMinusExp(x), slabFactor(x), exp(-x), x);
})")}) {
    gl.AttachShader(program, shader);
    gl.DeleteShader(shader);  // kept alive by the program
  }
  gl.LinkProgram(program);
  const GlVertexArray nothing(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.name());
  gl.Viewport(0, 0, width, height);
  gl.BindTextureUnit(0, input.name());
  gl.UseProgram(program);
  gl.BindVertexArray(nothing.name());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  std::vector<glm::vec4> results(x.size());
  gl.GetTextureImage(output.name(), 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(results.size() * sizeof(glm::vec4)),
                     results.data());
  gl.UseProgram(0);
  gl.DeleteProgram(program);
  checkGl(gl, "formulas");
  results.resize(count);
  return results;
}

}  // namespace

// The formulas promise 1e-6 from 1e-8 to 1e4. The truth is computed in double precision.
TEST_CASE("A driver's 1 - exp(-x) and slab factor are accurate from 1e-8 to 1e4", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  std::vector<float> x;
  for (int i = 0; i <= 240'000; ++i) x.push_back(static_cast<float>(std::pow(10.0, -8 + i * 5e-5)));
  const std::vector<glm::vec4> results = evaluate(context->gl(), x);
  double opacity = 0, factor = 0, transmittance = 0, atOpacity = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    REQUIRE(results[i].w == x[i]);
    const double depth = x[i], exact = -std::expm1(-depth);
    if (std::abs(results[i].x / exact - 1) > opacity) {
      opacity = std::abs(results[i].x / exact - 1);
      atOpacity = depth;
    }
    factor = std::max(factor, std::abs(results[i].y * depth / exact - 1));
    // GLSL 4.50, section 4.7.1: exp may be off by 3 + 2 |x| units in the last place. A result below the least normal
    // number may be 0.
    const double unit = 0x1p-23 * std::exp(-depth) + 0x1p-126;
    transmittance = std::max(transmittance, std::abs(results[i].z - std::exp(-depth)) / ((3 + 2 * depth) * unit));
  }
  INFO("worst at x = " << atOpacity << "; slab factor " << factor);
  CHECK(opacity < 1e-6);
  CHECK(factor < 1e-6);
  CHECK(transmittance < 1);
}

TEST_CASE("A driver's formulas have the right limits", "[shade][gl]") {
  const auto context = testContext();
  if (!context) return;
  const float infinity = std::numeric_limits<float>::infinity();
  const auto results =
      evaluate(context->gl(), {0.0f, std::numeric_limits<float>::denorm_min(), 1e-30f, 1e30f, 3e38f, infinity});
  for (const std::size_t i : {0u, 1u, 2u}) {
    CHECK(results[i].x <= 1e-30f);
    CHECK(results[i].y == 1);
    CHECK(results[i].z >= 1 - 1.2e-7f);
  }
  CHECK(results[0].z == 1);  // empty slabs take nothing away, however many there are
  for (const std::size_t i : {3u, 4u, 5u}) {
    CHECK(results[i].x == 1);
    CHECK(results[i].y <= 1.0001e-30f);
    CHECK(results[i].z == 0);
  }
}
