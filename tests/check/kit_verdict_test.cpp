// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/kit_verdict.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "check/kit_support.h"
#include "support/complaint.h"
#include "umbrick/core/error.h"
#include "umbrick/image/png.h"
#include "umbrick/sweep/ray_renderer.h"

using namespace umbrick;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

// The scene of a view, as a renderer of this library reads it from the kit.
Scene sceneOfKit(const KitFolder& kit, const std::string& name, const std::string& view) {
  return readScene(kit.caseFolder(name) / (view + ".scene.json"));
}

Image rendered(const Scene& scene, const RenderSample& sample = {}) {
  const Volume volume(scene.volume);
  return VolumeView(volume, scene).render(sample).colour;
}

const KitVerdict& only(const KitJudgement& judgement) {
  const KitVerdict* found = nullptr;
  for (const KitVerdict& verdict : judgement.verdicts) {
    if (verdict.outcome == KitOutcome::notAnswered) continue;
    REQUIRE(found == nullptr);
    found = &verdict;
  }
  REQUIRE(found != nullptr);
  return *found;
}

// What is said of one picture that is answered wrongly.
KitVerdict verdictOn(const KitFolder& kit, const std::string& name, const std::string& view, const Image& image) {
  kit.answerPicture(name, view + ".exr", image);
  KitVerdict verdict = only(kit.judge());
  fs::remove_all(kit.root() / "answers");
  return verdict;
}

template <class Change>
Image changed(Image image, const Change& change) {
  for (std::size_t i = 0; i < image.pixels.size(); i += 4) change(&image.pixels[i]);
  return image;
}

// Bricks of which one has an apron that repeats its own voxels.
class CarelessBricks : public Bricks {
 public:
  CarelessBricks(const Bricks& whole, std::size_t careless) : whole_(whole), careless_(whole.bricks[careless].origin) {
    static_cast<Bricks&>(*this) = whole;
  }
  void read(const glm::ivec3& origin, std::span<float> values, std::span<float> gradients = {}) const override {
    whole_.read(origin, values, gradients);
    if (origin != careless_) return;
    const std::vector<float> right(values.begin(), values.end());
    const glm::ivec3 edge = layout.edge();
    for (int n = 0; n < edge.x * edge.y * edge.z; ++n) {
      const glm::ivec3 at(n % edge.x, n / edge.x % edge.y, n / edge.x / edge.y);
      const glm::ivec3 own = glm::clamp(at, glm::ivec3(layout.apron), edge - 1 - layout.apron);
      values[static_cast<std::size_t>(n)] = right[static_cast<std::size_t>((own.z * edge.y + own.y) * edge.x + own.x)];
    }
  }

 private:
  const Bricks& whole_;
  glm::ivec3 careless_;
};

}  // namespace

TEST_CASE("Rays of this library pass a kit of all hard cases", "[check]") {
  const std::vector<KitCase> cases = hardCases();
  const KitFolder kit(cases);
  std::size_t pictures = 0;
  for (const KitCase& each : cases) {
    const KitInput input = kit.input(each.name);
    kit.answerSamples(each.name, [&](std::size_t, const glm::dvec3& index, double) { return input.value(index); });
    for (const KitView& view : each.views) {
      Scene scene = sceneOfKit(kit, each.name, view.name);
      scene.technique = Technique::rays;
      // Cases are hard: a value that is taken for linear between slices of voxels is off by 0.08 at a single voxel.
      scene.sampling.spacing /= 16;
      kit.answerPicture(each.name, view.name + ".exr", rendered(scene));
      scene.bricks.interior = 32;
      kit.answerPicture(each.name, view.name + ".unbricked.exr", rendered(scene));
      ++pictures;
    }
  }
  const KitJudgement judgement = kit.judge();
  INFO(failuresOf(judgement));
  CHECK(judgement.passed());
  CHECK(judgement.unknown.empty());
  // Three rows for samples where a case has all kinds, and two for each picture.
  CHECK(judgement.verdicts.size() >= 2 * cases.size() + 2 * pictures);
  for (const KitVerdict& verdict : judgement.verdicts) {
    CHECK(verdict.outcome == KitOutcome::passed);
    CHECK(verdict.compared > 0);
  }
}

TEST_CASE("Pictures with mistakes of geometry are caught, and the mistake is named", "[check]") {
  const KitFolder kit({hardCase("crooked")});
  const Image truth = kit.reference("crooked", "oblique");
  const int w = truth.width, h = truth.height;
  const auto moved = [&](const auto& source) {
    Image image(w, h);
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) std::copy_n(truth.at(source(x, y).first, source(x, y).second), 4, image.at(x, y));
    return image;
  };
  const auto hintOf = [&](const Image& image) {
    const KitVerdict verdict = verdictOn(kit, "crooked", "oblique", image);
    CHECK(verdict.outcome == KitOutcome::failed);
    CHECK(verdict.invariant == "the picture agrees with the reference");
    CHECK(verdict.worst > verdict.limit);
    CHECK_THAT(verdict.where, Contains("pixel (") && Contains("from the top left, channel "));
    return verdict.hint;
  };
  CHECK_THAT(hintOf(moved([&](int x, int y) { return std::pair(x, h - 1 - y); })), Contains("flipped vertically"));
  CHECK_THAT(hintOf(moved([&](int x, int y) { return std::pair(w - 1 - x, y); })), Contains("flipped horizontally"));
  CHECK_THAT(hintOf(moved([&](int x, int y) { return std::pair(w - 1 - x, h - 1 - y); })), Contains("180 degrees"));
  // Rays through the left lower corners of pixels show what lies half a pixel away: drawn, not resampled.
  RenderSample corner;
  corner.pixel = {0, 0};
  CHECK_THAT(hintOf(rendered(sceneOfKit(kit, "crooked", "oblique"), corner)),
             Contains("0.5 to the left and 0.5 down") && Contains("centres of pixels"));
  Image turned(h, w);
  for (int y = 0; y < w; ++y)
    for (int x = 0; x < h; ++x) std::copy_n(truth.at(y, x), 4, turned.at(x, y));
  kit.answerPicture("crooked", "oblique.exr", turned);
  const KitVerdict size = only(kit.judge());
  CHECK(size.invariant == "the answer can be read");
  CHECK_THAT(size.where, Contains("expected 64 x 48 pixels, found 48 x 64"));
  CHECK(size.hint == "width and height are exchanged");
}

TEST_CASE("Pictures with mistakes of colour and opacity are caught, and the mistake is named", "[check]") {
  const KitFolder kit({hardCase("crooked")});
  const Image truth = kit.reference("crooked", "oblique");
  const auto hintOf = [&](const Image& image) {
    const KitVerdict verdict = verdictOn(kit, "crooked", "oblique", image);
    CHECK(verdict.outcome == KitOutcome::failed);
    return verdict.hint;
  };
  // Opacity of a step of one voxel is taken for that of half a voxel: the medium seems twice as dense.
  Scene dense = sceneOfKit(kit, "crooked", "oblique");
  dense.transfer = dense.transfer->scaled(2);
  const std::string step = hintOf(rendered(dense));
  CHECK_THAT(step, Contains("times as dense: is opacity corrected for the length of a step"));
  CHECK_THAT(step,
             Contains("the medium is 2 times") || Contains("the medium is 1.99") || Contains("the medium is 2.0"));
  CHECK_THAT(hintOf(changed(truth, [](float* p) { std::swap(p[0], p[2]); })), Contains("red and blue are exchanged"));
  CHECK_THAT(hintOf(changed(truth,
                            [](float* p) {
                              for (int c = 0; c < 3 && p[3] > 0; ++c) p[c] /= p[3];
                            })),
             Contains("to be premultiplied"));
  CHECK_THAT(hintOf(changed(truth, [](float* p) { p[3] = 1; })), Contains("alpha is left out"));
  CHECK_THAT(hintOf(changed(truth,
                            [](float* p) {
                              for (int c = 0; c < 3; ++c) p[c] = p[c] > 0 ? std::pow(p[c], 1 / 2.2f) : 0;
                            })),
             Contains("taken for sRGB"));
  // What nothing explains has no hint.
  CHECK(hintOf(changed(truth, [](float* p) { p[1] *= 0.4f; })).empty());
}

TEST_CASE("Pictures of misread voxels are caught, and the mistake is named", "[check]") {
  const KitFolder kit({hardCase("background")});
  const Scene scene = sceneOfKit(kit, "background", "oblique");
  const auto hintOf = [&](const Image& image) {
    const KitVerdict verdict = verdictOn(kit, "background", "oblique", image);
    CHECK(verdict.outcome == KitOutcome::failed);
    return verdict.hint;
  };
  Scene before = scene;
  before.sampling.classification = Classification::pre;
  CHECK_THAT(hintOf(rendered(before)), Contains("voxels are classified before interpolation"));
  // Voxel centres at halves: the volume lies half a voxel further up each axis. The eye moves the other way instead.
  Scene corners = scene;
  corners.camera.eye -= 0.5;
  corners.camera.lookAt -= 0.5;
  CHECK_THAT(hintOf(rendered(corners)), Contains("moved by half a voxel up each axis"));
}

TEST_CASE("A brick whose apron is wrong is caught by samples and by pictures, and named", "[check]") {
  const KitFolder kit({hardCase("noise")});
  const Scene scene = sceneOfKit(kit, "noise", "front");
  const Volume volume(scene.volume);
  const ResolvedScene resolved = volume.resolve(scene);
  const std::unique_ptr<Bricks> bricks = volume.cutForCpu(resolved);
  // The brick in the middle of the lattice, all of whose neighbours hold noise.
  std::size_t careless = 0;
  for (std::size_t i = 0; i < bricks->bricks.size(); ++i)
    if (bricks->bricks[i].origin == glm::ivec3(0, 8, 8)) careless = i;
  REQUIRE(bricks->bricks[careless].origin == glm::ivec3(0, 8, 8));

  const KitInput input = kit.input("noise");
  const glm::dvec3 low(0, 8, 8), high(7, 15, 15);
  kit.answerSamples("noise", [&](std::size_t, const glm::dvec3& index, double exact) {
    const bool own = glm::all(glm::greaterThanEqual(index, low - 0.5)) && glm::all(glm::lessThan(index, high + 0.5));
    return own ? input.value(glm::clamp(index, low, high)) : exact;
  });
  const CarelessBricks wrong(*bricks, careless);
  RayRenderer careful(*bricks, resolved), renderer(wrong, resolved);
  kit.answerPicture("noise", "front.exr", renderer.render().colour);
  kit.answerPicture("noise", "front.unbricked.exr", careful.render().colour);

  const KitJudgement judgement = kit.judge();
  INFO(failuresOf(judgement));
  const auto failed = [&](const std::string& asked, const std::string& invariant) {
    const auto at = std::find_if(judgement.verdicts.begin(), judgement.verdicts.end(), [&](const auto& verdict) {
      return verdict.asked == asked && verdict.invariant == invariant;
    });
    REQUIRE(at != judgement.verdicts.end());
    CHECK(at->outcome == KitOutcome::failed);
    return *at;
  };
  const KitVerdict samples = failed("samples", "no seam at brick borders");
  CHECK(samples.wrong > 1);
  CHECK_THAT(samples.where, Contains("brick " + std::to_string(careless) + " at (0, 8, 8)") &&
                                Contains("all of the wrong ones are in this brick"));
  CHECK_THAT(samples.hint, Contains("aprons repeat the outermost voxels of their own brick"));
  failed("front", "bricked equals unbricked");
  for (const KitVerdict& verdict : judgement.verdicts)
    if (verdict.invariant == "samples inside bricks are exact") CHECK(verdict.outcome == KitOutcome::passed);
}

// A renderer whose aprons are all wrong shows stripes where bricks meet, which is called what it is.
TEST_CASE("Errors of a picture at brick borders are called a seam", "[check]") {
  const KitFolder kit({hardCase("noise")});
  Image image = kit.reference("noise", "front");
  const KitInput input = kit.input("noise");
  const auto& view = input.json["pictures"][0];
  REQUIRE(view["name"] == "front");
  const double pixel = view["view_height"].get<double>() / image.height;
  const double middle = view["eye"][0], low = middle - 0.5 * pixel * image.width;
  for (int x = 0; x < image.width; ++x) {
    // Seen along y with z up, x of the picture is the x of index space; bricks meet at ..., -8.5, -0.5, 7.5, ...
    const double index = low + (x + 0.5) * pixel, place = index + 0.5 - 8 * std::floor((index + 0.5) / 8);
    if (std::min(place, 8 - place) > 0.6) continue;
    for (int y = 0; y < image.height; ++y)
      for (int c = 0; c < 4; ++c) image.at(x, y)[c] *= 0.8f;
  }
  const KitVerdict verdict = verdictOn(kit, "noise", "front", image);
  CHECK(verdict.outcome == KitOutcome::failed);
  CHECK(verdict.invariant == "no seam at brick borders");
}

TEST_CASE("Samples with mistakes are caught, and the mistake is named", "[check]") {
  const KitFolder kit({hardCase("background")});
  const KitInput input = kit.input("background");
  const auto hintOf = [&](const auto& value, const std::string& failing) {
    kit.answerSamples("background", [&](std::size_t, const glm::dvec3& index, double) { return value(index); });
    const KitJudgement judgement = kit.judge();
    const auto at = std::find_if(judgement.verdicts.begin(), judgement.verdicts.end(), [&](const auto& verdict) {
      return verdict.outcome == KitOutcome::failed && verdict.invariant == failing;
    });
    INFO(failuresOf(judgement));
    REQUIRE(at != judgement.verdicts.end());
    CHECK_THAT(at->where, Contains("sample ") && Contains(", world (") && Contains("found ") && Contains("expected "));
    return at->hint;
  };
  const std::string inside = "samples inside bricks are exact";
  CHECK_THAT(hintOf([&](const glm::dvec3& p) { return input.value(glm::round(p)); }, inside),
             Contains("nearest voxel"));
  CHECK_THAT(hintOf([&](const glm::dvec3& p) { return input.value(p - 0.5); }, inside),
             Contains("half a voxel down each axis"));
  CHECK_THAT(hintOf(
                 [&](glm::dvec3 p) {
                   p.x = 2 * input.first.x + input.dims.x - 1 - p.x;
                   return input.value(p);
                 },
                 inside),
             Contains("mirrored along i"));
  // What is not said where values are right.
  CHECK(hintOf([&](const glm::dvec3& p) { return 0.9 * input.value(p); }, inside).empty());
  // The outside alone is wrong.
  CHECK_THAT(hintOf(
                 [&](const glm::dvec3& p) {
                   const double value = input.value(p);
                   return value == -1000 ? 0 : value;
                 },
                 "samples outside are background"),
             !Contains("mirrored"));
}

TEST_CASE("Coordinates of single precision far from the origin are recognised", "[check]") {
  const KitFolder kit({hardCase("far-index")});
  const KitInput input = kit.input("far-index");
  kit.answerSamples("far-index", [&](std::size_t, const glm::dvec3& index, double) {
    return input.value(glm::dvec3(glm::vec3(index)));
  });
  const KitJudgement judgement = kit.judge();
  INFO(failuresOf(judgement));
  CHECK_FALSE(judgement.passed());
  CHECK_THAT(failuresOf(judgement), Contains("index coordinates in single precision"));
}

TEST_CASE("Answers that are missing, broken or no numbers are said to be so", "[check]") {
  const KitFolder kit({hardCase("single-voxel")});
  const std::string name = "single-voxel";
  const KitJudgement none = kit.judge();
  CHECK_FALSE(none.passed());
  REQUIRE(none.verdicts.size() == 3);
  for (const KitVerdict& verdict : none.verdicts) CHECK(verdict.outcome == KitOutcome::notAnswered);

  const auto find = [&](const KitJudgement& judgement, const std::string& asked) {
    const auto at = std::find_if(judgement.verdicts.begin(), judgement.verdicts.end(),
                                 [&](const auto& verdict) { return verdict.asked == asked; });
    REQUIRE(at != judgement.verdicts.end());
    return *at;
  };
  const Image truth = kit.reference(name, "front");
  Image holes = truth;
  holes.at(5, 3)[1] = std::numeric_limits<float>::quiet_NaN();
  kit.answerPicture(name, "front.exr", holes);
  kit.answerPicture(name, "oblique.exr", kit.reference(name, "oblique"));
  const std::string whole = readBytes(kit.answer(name, "oblique.exr"));
  writeBytes(kit.answer(name, "oblique.exr"), whole.substr(0, whole.size() / 2));
  kit.answerSamples(name, [](std::size_t id, const glm::dvec3&, double exact) {
    return id == 17 ? std::numeric_limits<double>::infinity() : exact;
  });
  writeBytes(kit.answer(name, "oblqiue.exr"), "misspelt");
  const KitJudgement broken = kit.judge();
  CHECK_FALSE(broken.passed());
  CHECK(find(broken, "front").invariant == "all numbers are finite");
  CHECK_THAT(find(broken, "front").where, Contains("pixel (5, 44) from the top left, channel G"));
  CHECK(find(broken, "oblique").invariant == "the answer can be read");
  CHECK_THAT(find(broken, "oblique").where, Contains("oblique.exr"));
  CHECK(find(broken, "samples").invariant == "all numbers are finite");
  CHECK_THAT(find(broken, "samples").where, Contains("sample 17 "));
  CHECK(broken.unknown == std::vector<std::string>{"answers/single-voxel/oblqiue.exr"});

  // Samples that are left out, there twice, unknown, or no numbers.
  const auto refusal = [&](const std::string& text) {
    writeBytes(kit.answer(name, "samples.csv"), text);
    return find(kit.judge(), "samples").where;
  };
  CHECK_THAT(refusal("id,value\n0,1\n"), Contains("expected 600 samples, found 1; the first that is missing is 1"));
  CHECK_THAT(refusal("id,value\n0,1\n0,1\n"), Contains("id: 0 is there twice"));
  CHECK_THAT(refusal("id,value\n600,1\n"), Contains("id: expected 0 to 599, found 600"));
  CHECK_THAT(refusal("id,value\n0,one\n"), Contains(":2: value: expected a number, found \"one\""));
  CHECK_THAT(refusal("id,values\n0,1\n"), Contains("expected a column \"value\", found id, values"));
  CHECK_THAT(refusal("id,value\n0,1,2\n"), Contains(":2: expected 2 fields, found 3"));

  // Two files for one question.
  kit.answerPicture(name, "front.exr", truth);
  writePng(kit.answer(name, "front.png"), truth);
  CHECK_THAT(complaint<InvalidArgument>([&] { kit.judge(); }), Contains("front.png: answers the same as front.exr"));
  CHECK_THAT(complaint<IoError>([&] { judgeKit(kit.root() / "cases"); }), Contains("expected a kit with a kit.json"));
}

TEST_CASE("Pictures answer a kit as PNG, NumPy and plain numbers, too", "[check]") {
  const KitFolder kit({hardCase("slab")});
  const Image truth = kit.reference("slab", "oblique");
  std::vector<float> rows;
  for (int y = truth.height - 1; y >= 0; --y) rows.insert(rows.end(), truth.at(0, y), truth.at(0, y) + 4 * truth.width);
  const auto check = [&](const std::string& file, double most) {
    const KitVerdict verdict = only(kit.judge());
    CAPTURE(file, verdict.where);
    CHECK(verdict.outcome == KitOutcome::passed);
    CHECK(verdict.worst <= most);
    fs::remove_all(kit.root() / "answers");
  };
  writePng(kit.answer("slab", "oblique.png"), truth);
  check("png", 0);  // rounding to levels is allowed for
  writeBytes(kit.answer("slab", "oblique.raw"), bytesOf(rows));
  check("raw", 0);
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (48, 64, 4), }";
  header.resize(117, ' ');
  header += '\n';
  writeBytes(kit.answer("slab", "oblique.npy"),
             std::string("\x93NUMPY\x01\x00", 8) + static_cast<char>(header.size()) + '\0' + header + bytesOf(rows));
  check("npy", 0);
  writeBytes(kit.answer("slab", "oblique.raw"), bytesOf(rows).substr(4));
  CHECK_THAT(only(kit.judge()).where, Contains("12288 bytes") || Contains("49152 bytes, found 49148"));
}
