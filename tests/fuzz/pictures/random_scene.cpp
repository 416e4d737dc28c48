// SPDX-License-Identifier: Apache-2.0
#include "fuzz/pictures/random_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>
#include <vector>

#include "fuzz/pictures/dice.h"
#include "fuzz/pictures/random_grid.h"
#include "fuzz/pictures/short_number.h"
#include "fuzz/pictures/slab_picture.h"
#include "support/test_scenes.h"
#include "umbrick/core/error.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/shade/prepare.h"

namespace umbrick {
namespace {

// A function of the distance from the background, as a share of the way to the content's full value: 0 to 1.
struct Profile {
  std::vector<std::pair<double, double>> points;  // share, extinction as a share of the largest; two equal make a step
  double thickness = 0;                           // of what is seen, voxels, where the function tells it
  std::string name;
};

// A peak of a value that runs from 0 to 1 over `thickness` voxels is seen for its part of them.
Profile peak(Dice& dice, double thickness) {
  const double half = dice.scaleBetween(5e-4, 0.1), centre = dice.between(0.15, 0.9);
  Profile profile;
  profile.points = {{centre - half, 0}, {centre, 1}, {centre + half, 0}};
  profile.thickness = std::max(2e-3, half * 0.5 * std::max(2.0, thickness));
  profile.name = "peak " + shortNumber(half);
  return profile;
}

Profile bands(Dice& dice) {
  Profile profile;
  double at = dice.between(0.05, 0.3);
  const int count = dice.whole(1, 3);
  for (int i = 0; i < count; ++i) {
    const double width = dice.between(0.05, 0.25), edge = dice.chance(0.5) ? 0 : dice.between(0.005, 0.05);
    const double height = i == 0 ? 1 : dice.between(0.2, 1);
    profile.points.emplace_back(at, 0);
    profile.points.emplace_back(at + edge, height);
    profile.points.emplace_back(at + edge + width, height);
    profile.points.emplace_back(at + 2 * edge + width, 0);
    at += 2 * edge + width + dice.between(0.02, 0.2);
  }
  profile.name = std::to_string(count) + " bands";
  return profile;
}

// Steps at the labels, which is where they are hardest, or between them.
Profile labelSteps(Dice& dice, double levels) {
  Profile profile;
  const bool between = dice.chance(0.4);
  double height = 0;
  for (int label = 1; label <= levels; ++label) {
    const double at = (label - (between ? 0.5 : 0)) / levels;
    profile.points.emplace_back(at, height);
    height = dice.chance(0.3) ? 0 : dice.between(0.1, 1);
    if (label == levels) height = 1;
    profile.points.emplace_back(at, height);
  }
  profile.name = between ? "steps between labels" : "steps at labels";
  return profile;
}

Profile pieces(Dice& dice) {
  Profile profile;
  std::vector<double> at;
  for (int i = dice.whole(2, 6); i > 0; --i) at.push_back(dice.between(0.02, 1.2));
  std::sort(at.begin(), at.end());
  profile.points.emplace_back(at.front(), 0);
  for (std::size_t i = 1; i < at.size(); ++i) {
    if (dice.chance(0.25)) profile.points.emplace_back(at[i], dice.uniform());
    profile.points.emplace_back(at[i], dice.chance(0.3) ? 0 : dice.uniform());
  }
  profile.points.back().second = 1;
  profile.name = "pieces";
  return profile;
}

Profile randomProfile(Dice& dice, const RandomGrid& grid) {
  if (grid.levels > 0 && dice.chance(0.7)) return labelSteps(dice, grid.levels);
  switch (dice.below(6)) {
    case 0: {
      const double at = dice.between(0.1, 0.9);
      return {{{at, 0}, {at, 1}}, 0, "step " + shortNumber(at)};
    }
    case 1:
      return peak(dice, grid.thickness);
    case 2:
      return bands(dice);
    case 3:
      return pieces(dice);
    default: {
      const double low = dice.chance(0.5) ? 0 : dice.between(0, 0.5), high = dice.between(low + 0.05, 1);
      return {{{low, 0}, {high, 1}}, 0, "ramp " + shortNumber(low) + " " + shortNumber(high)};
    }
  }
}

glm::dvec3 randomColour(Dice& dice) { return dice.point(glm::dvec3(0), glm::dvec3(1)); }

// Extinction per voxel edge, so that what is seen is neither nothing nor solid; one in eight is.
double randomExtinction(Dice& dice, double thickness, std::string& name) {
  if (dice.chance(0.12)) {
    name += ", solid";
    return dice.scaleBetween(30, 1e5);
  }
  return dice.scaleBetween(0.3, 5) / thickness;
}

TransferFunction randomFunction1d(Dice& dice, const RandomGrid& grid, double edge, std::string& name) {
  const Profile profile = randomProfile(dice, grid);
  name += profile.name;
  const double sigma_t =
      randomExtinction(dice, profile.thickness > 0 ? profile.thickness : grid.thickness, name) / edge;
  double haze = 0;  // of the background, which is then seen throughout the domain
  if (dice.chance(0.08)) {
    haze = dice.scaleBetween(0.003, 0.05) / edge;
    name += ", background seen";
  }
  std::vector<TransferFunction::Point> points;
  for (const auto& [share, height] : profile.points)
    points.push_back(
        {grid.background + share * (grid.full - grid.background), {randomColour(dice), haze + height * sigma_t}});
  if (grid.full < grid.background) std::reverse(points.begin(), points.end());
  return TransferFunction(points);
}

// A lattice that is no finer than a twentieth of the range: tables of two axes hold what lies at their nodes.
TransferFunction randomFunction2d(Dice& dice, const RandomGrid& grid, double edge, std::string& name) {
  name += "2D";
  const double range = std::abs(grid.full - grid.background);
  const double sigma_t = randomExtinction(dice, std::max(2.0, 0.5 * grid.thickness), name) / edge;
  // That sees the gradient outside of the content, too, where the value is the background's.
  const bool gradientAlone = dice.chance(0.3);
  if (gradientAlone) name += " by gradient alone";
  std::vector<double> shares{0}, gradients{0};
  if (!gradientAlone)
    for (int i = dice.whole(1, 3); i > 0; --i) shares.push_back(shares.back() + dice.between(0.1, 0.4));
  for (int i = dice.whole(1, 3); i > 0; --i)
    gradients.push_back(gradients.back() + dice.between(0.05, 0.3) * range / edge);
  const bool turned = grid.full < grid.background;
  if (turned) std::reverse(shares.begin(), shares.end());
  std::vector<double> values;
  for (const double share : shares) values.push_back(grid.background + share * (grid.full - grid.background));
  std::vector<Medium> media;
  for (const double gradient : gradients)
    for (const double share : shares) {
      const bool nothing = gradientAlone ? gradient == 0 : share == 0;
      media.push_back({randomColour(dice), nothing || dice.chance(0.3) ? 0 : dice.uniform() * sigma_t});
    }
  media[turned ? media.size() - shares.size() : media.size() - 1].sigma_t = sigma_t;
  if (dice.chance(0.08)) {
    const double haze = dice.scaleBetween(0.003, 0.05) / edge;
    for (Medium& medium : media) medium.sigma_t += haze;
    name += ", background seen";
  }
  return {values, gradients, media};
}

Camera randomCamera(Dice& dice, const ScalarGrid& grid, int largest, std::string& name) {
  const Box bounds = grid.worldBounds();
  const glm::dmat4 toWorld = grid.indexToWorld();
  const double edge = shortestVoxelEdge(toWorld);
  const double radius = 0.5 * glm::length(bounds.extent()) + edge;
  Camera camera;
  camera.width = dice.whole(largest / 2, largest);
  camera.height = dice.chance(0.7) ? camera.width : dice.whole(largest / 2, largest);
  camera.lookAt = bounds.centre() + 0.2 * radius * dice.point(glm::dvec3(-1), glm::dvec3(1));
  glm::dvec3 direction = dice.direction();
  bool along = false;
  camera.up = dice.direction();
  if (dice.chance(0.25)) {
    // Straight at faces of the grid, also where slices coincide with voxels.
    const auto axis = static_cast<glm::length_t>(dice.below(3));
    const auto other = static_cast<glm::length_t>((axis + 1) % 3);
    const glm::dvec3 a(toWorld[axis]), b(toWorld[other]), c(toWorld[(other + 1) % 3]);
    direction = glm::normalize(glm::cross(b, c)) * (dice.chance(0.5) ? 1.0 : -1.0);
    camera.up = b + 0.1 * c;
    along = true;
    name += "along an axis, ";
  }
  if (glm::length(glm::cross(camera.up, direction)) < 0.1)
    camera.up = glm::cross(direction, glm::dvec3(0.3, 0.5, 0.8)) + 0.1 * dice.direction();
  double distance = radius * dice.between(1.2, 3);
  if (dice.chance(0.35)) {
    camera.projection = Projection::orthographic;
    camera.viewHeight = 2 * radius * dice.between(0.5, 1.2);
    name += "parallel";
  } else if (dice.chance(0.25)) {
    camera.fov = dice.between(0.8, 2.6);
    distance = radius * dice.between(0.05, 0.8);
    name += "inside, fov " + shortNumber(camera.fov);
  } else {
    camera.fov = dice.chance(0.15) ? dice.between(1.2, 2.4) : dice.between(0.1, 1.2);
    distance = radius * dice.between(0.7, 1.2) / std::sin(0.5 * std::min(camera.fov, 1.6));
    name += "fov " + shortNumber(camera.fov);
  }
  if (dice.chance(0.06)) {
    // From far away, through a telescope.
    const double factor = dice.scaleBetween(10, 1e4);
    if (camera.projection == Projection::perspective)
      camera.fov = 2 * std::atan(std::tan(0.5 * std::min(camera.fov, 1.2)) / factor);
    distance *= factor;
    name += ", " + shortNumber(factor) + " times as far";
  }
  camera.eye = camera.lookAt + distance * direction;
  if (along && dice.chance(0.5)) {
    // A whole or half number of voxels from the origin, as slices often are apart.
    const glm::dvec3 index(glm::inverse(toWorld) * glm::dvec4(camera.eye, 1));
    const glm::dvec3 shift(toWorld * glm::dvec4(0.5 * glm::round(2.0 * index) - index, 0));
    camera.eye += shift;
    camera.lookAt += shift;
    name += ", on the lattice";
  }
  if (dice.chance(0.15)) {
    camera.nearDistance = std::max(0.0, distance + radius * dice.between(-1, 0.5));
    name += ", near plane";
  }
  return camera;
}

void clipAtRandom(Dice& dice, const ScalarGrid& grid, Scene& scene, std::string& name) {
  const Box bounds = grid.worldBounds();
  const double edge = shortestVoxelEdge(grid.indexToWorld());
  const glm::dvec3 extent = bounds.extent() + 2 * edge;
  const auto inside = [&] { return bounds.centre() + 0.35 * extent * dice.point(glm::dvec3(-1), glm::dvec3(1)); };
  if (dice.chance(0.25)) {
    const int count = dice.whole(1, 3);
    for (int i = 0; i < count; ++i) {
      const glm::dvec3 normal = dice.scaleBetween(1e-3, 1e3) * dice.direction();
      scene.clipPlanes.emplace_back(normal, -glm::dot(normal, inside()) + 0.15 * glm::length(normal * extent));
    }
    name += ", " + std::to_string(count) + " planes";
  }
  if (dice.chance(0.15)) {
    Box box;
    box.include(inside() - 0.2 * extent);
    box.include(inside() + 0.2 * extent);
    scene.clipBox = box;
    name += ", box";
  }
}

void sampleAtRandom(Dice& dice, Scene& scene, std::string& name) {
  SamplingOptions& sampling = scene.sampling;
  sampling.spacing = dice.chance(0.4) ? dice.of({0.25, 0.5, 1.0, 2.0}) : dice.scaleBetween(0.25, 6);
  sampling.quadrature = dice.chance(0.7) ? Quadrature::preintegrated : Quadrature::midpoint;
  sampling.segments = dice.chance(0.4) ? 1 : dice.whole(2, 8);
  sampling.bits = dice.chance(0.88) ? 32 : 16;
  sampling.saturation = dice.chance(0.5) ? 0 : 1e-3;
  name += std::string(sampling.quadrature == Quadrature::midpoint ? "midpoint " : "") + shortNumber(sampling.spacing) +
          " x " + std::to_string(sampling.segments);
  if (sampling.bits == 16) name += ", 16 bits";
}

void lightAtRandom(Dice& dice, Scene& scene, std::string& name) {
  const auto radiance = [&] { return dice.scaleBetween(0.2, 5) * randomColour(dice); };
  const int count = dice.whole(1, 3);
  for (int i = 0; i < count; ++i) {
    LightSource source;
    source.frame = dice.chance(0.7) ? LightFrame::view : LightFrame::world;
    glm::dvec3 towards = dice.direction();
    // Within the hemisphere of the viewer, with the whole of the cone.
    towards.z = 0.3 + std::abs(towards.z);
    const double most = std::atan2(towards.z, glm::length(glm::dvec2(towards)));
    if (source.frame == LightFrame::world) {
      const CameraFrame view = cameraFrame(scene.camera);
      towards = towards.x * view.right + towards.y * view.up - towards.z * view.forward;
    }
    if (dice.chance(0.75)) {
      source.light = ConeLight{towards, dice.chance(0.3) ? 0 : dice.between(0.05, 0.95) * most, radiance()};
    } else {
      source.light = ListedLight{{{towards, dice.between(0.2, 2), radiance()}}};
    }
    scene.lights.push_back(source);
  }
  scene.model = Model::lights;
  name += std::to_string(count) + " lights";
}

void illuminateAtRandom(Dice& dice, SceneKind kind, Scene& scene, std::string& name) {
  if (kind == SceneKind::any)
    kind = dice.of({SceneKind::emission, SceneKind::emission, SceneKind::occlusion, SceneKind::lights});
  if (dice.chance(0.3)) scene.ambient = dice.scaleBetween(0.3, 3) * (0.2 + 0.8 * randomColour(dice));
  if (dice.chance(0.2)) scene.background = randomColour(dice);
  OcclusionOptions& occlusion = scene.occlusion;
  occlusion.ordinates.directions = dice.of({4, 8, 16, 32});
  occlusion.bits = dice.chance(0.8) ? 32 : 16;
  if (dice.chance(0.2)) occlusion.ordinates.scale = dice.between(0.5, 3);
  switch (kind) {
    case SceneKind::occlusion:
      scene.model = Model::cone;
      scene.method = dice.chance(0.7) ? Method::ordinates : Method::dos;
      occlusion.aperture = dice.chance(0.1) ? 0 : dice.between(0.1, 1.45);
      occlusion.dos.footprint = dice.whole(1, 5);
      occlusion.dos.passes = dice.whole(1, 2);
      occlusion.dos.algorithm = dice.whole(2, 3);
      occlusion.dos.perspectiveCorrection = dice.chance(0.7);
      name += methodName(scene.method) + " " + shortNumber(occlusion.aperture);
      break;
    case SceneKind::lights:
      lightAtRandom(dice, scene, name);
      break;
    default:
      name += "emission";
  }
}

// By a picture of a few pixels and thick slabs.
bool showsSomething(const ScalarGrid& grid, const Scene& drawn) {
  ResolvedScene scene = resolveScene(drawn, grid.worldBounds(), grid.indexToWorld());
  scene.camera.width = scene.camera.height = 10;
  scene.sampling.spacing = shortestVoxelEdge(grid.indexToWorld());
  scene.sampling.segments = 2;
  const IndexBox active = grid.activeBox();
  const Image image = slabPicture(grid, scene, {active.min - 1, active.max + 1});
  double alpha = 0;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) alpha += image.pixels[i];
  return alpha > 2;  // of 100 pixels
}

}  // namespace

SceneKind parseSceneKind(std::string_view name) {
  for (const auto& [known, kind] :
       {std::pair("emission", SceneKind::emission), std::pair("occlusion", SceneKind::occlusion),
        std::pair("lights", SceneKind::lights), std::pair("any", SceneKind::any)})
    if (name == known) return kind;
  throw InvalidArgument("kind: " + std::string(name) + " is none of emission, occlusion, lights and any");
}

RandomScene randomScene(std::uint64_t seed, SceneKind kind, int largest) {
  // A stream for each part: a change to one leaves the others of a seed as they were.
  Dice volume(seed, 1), function(seed, 2), view(seed, 3), clipping(seed, 4), rest(seed, 5), light(seed, 6);
  RandomGrid grid = randomGrid(volume);
  const glm::dmat4 toWorld = grid.grid.indexToWorld();
  const double edge = shortestVoxelEdge(toWorld);
  std::string functionName, viewName, clipName, restName, lightName;
  Scene drawn;
  drawn.transfer = function.chance(0.2) ? randomFunction2d(function, grid, edge, functionName)
                                        : randomFunction1d(function, grid, edge, functionName);
  drawn.orbit.reset();
  // Views that show nothing teach little: another one is drawn, some times.
  for (int i = 0; i < 8; ++i) {
    viewName.clear();
    clipName.clear();
    drawn.clipPlanes.clear();
    drawn.clipBox.reset();
    drawn.camera = randomCamera(view, grid.grid, largest, viewName);
    clipAtRandom(clipping, grid.grid, drawn, clipName);
    if (showsSomething(grid.grid, drawn)) break;
  }
  sampleAtRandom(rest, drawn, restName);
  illuminateAtRandom(light, kind, drawn, lightName);
  drawn.bricks.interior = rest.chance(0.4) ? 0 : rest.of({8, 16, 24, 32, 48});
  if (rest.chance(0.15)) drawn.bricks.culling = false;
  ResolvedScene scene = resolveScene(drawn, grid.grid.worldBounds(), toWorld);
  // Slabs must not reach beyond the neighbours of a brick.
  ResolvedScene wide = scene;
  wide.bricks.interior = kMostInterior;
  const int apron = requiredApron(wide, toWorld);
  if (scene.bricks.interior > 0) scene.bricks.interior = std::max(scene.bricks.interior, 8 * ((apron + 7) / 8));
  validateScene(scene);
  const std::string bricks = scene.bricks.interior > 0 ? ", bricks of " + std::to_string(scene.bricks.interior) : "";
  return {std::move(grid.grid), std::move(scene),
          grid.description + "; " + functionName + "; " + viewName + clipName + "; " + restName + bricks + "; " +
              lightName};
}

}  // namespace umbrick
