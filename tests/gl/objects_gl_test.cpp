// SPDX-License-Identifier: Apache-2.0
#include "umbrick/gl/objects.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>
#include <utility>
#include <vector>

#include "support/gl_fixture.h"
#include "umbrick/core/error.h"

using namespace umbrick;
using Catch::Matchers::Contains;

namespace {

// A driver that makes nothing and keeps a ledger of its calls.
struct Ledger : GlFunctions {
  mutable std::vector<GLuint> made, deleted;
};
struct LedgerKind {
  static GLuint create(const GlFunctions& gl) {
    std::vector<GLuint>& made = static_cast<const Ledger&>(gl).made;
    made.push_back(static_cast<GLuint>(made.size()) + 1);
    return made.back();
  }
  static void destroy(const GlFunctions& gl, GLuint name) { static_cast<const Ledger&>(gl).deleted.push_back(name); }
};
using LedgerObject = GlObject<LedgerKind>;

}  // namespace

TEST_CASE("An object is deleted once, wherever it moves", "[gl]") {
  const Ledger ledger;
  {
    LedgerObject a(ledger), b(ledger), empty;
    CHECK(a.name() == 1);
    CHECK_FALSE(empty);
    LedgerObject c = std::move(a);
    CHECK_FALSE(a);
    CHECK(c.name() == 1);
    b = std::move(c);
    CHECK(b.name() == 1);
    empty = std::move(b);
    CHECK(empty.name() == 1);
    LedgerObject& same = empty;
    empty = std::move(same);
    CHECK(empty.name() == 1);
    std::vector<LedgerObject> many;
    for (int i = 0; i < 10; ++i) many.emplace_back(ledger);
    many.erase(many.begin() + 3);
    std::swap(many[0], many[5]);
  }
  std::sort(ledger.deleted.begin(), ledger.deleted.end());
  CHECK(ledger.deleted == ledger.made);
}

TEST_CASE("Objects of a driver are of their own kind, and gone when deleted", "[gl]") {
  const auto context = testContext();
  if (!context) return;
  const GlFunctions& gl = context->gl();
  GLuint name = 0;
  {
    const GlTexture texture = makeTexture2d(gl, GL_R32F, 4, 3, GL_NEAREST);
    name = texture.name();
    const GlFramebuffer target = makeFramebuffer(gl, {name});
    const float value = 0.625f;
    const float colour[4] = {value, 0, 0, 0};
    gl.ClearNamedFramebufferfv(target.name(), GL_COLOR, 0, colour);
    float back[12] = {};
    gl.GetTextureImage(name, 0, GL_RED, GL_FLOAT, sizeof(back), back);
    CHECK(std::all_of(std::begin(back), std::end(back), [&](float texel) { return texel == value; }));
    checkGl(gl, "a cleared texture");
  }
  float back[12];
  gl.GetTextureImage(name, 0, GL_RED, GL_FLOAT, sizeof(back), back);
  CHECK_THROWS_WITH(checkGl(gl, "a deleted texture"), Contains("a deleted texture") && Contains("0x05"));
  checkGl(gl, "after the error was taken");
}

TEST_CASE("A texture or target that the driver refuses is an error that names it", "[gl]") {
  const auto context = testContext();
  if (!context) return;
  const GlFunctions& gl = context->gl();
  const int tooLarge = context->maxTextureEdge2d() + 1;
  CHECK_THROWS_WITH(makeTexture2d(gl, GL_RGBA8, tooLarge, 2, GL_LINEAR),
                    Contains(std::to_string(tooLarge) + " x 2 x 1") && Contains("0x8058"));
  CHECK_THROWS_WITH(makeTexture3d(gl, GL_R8, 2, context->maxTextureEdge3d() + 1, 2),
                    Contains("2 x " + std::to_string(context->maxTextureEdge3d() + 1)));
  const GlTexture notForDrawing = makeTexture2d(gl, GL_RGB9_E5, 2, 2, GL_NEAREST);
  CHECK_THROWS_WITH(makeFramebuffer(gl, {notForDrawing.name()}), Contains("1 colour buffers"));
  CHECK(gl.GetError() == GL_NO_ERROR);
}
