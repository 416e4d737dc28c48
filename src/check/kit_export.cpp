// SPDX-License-Identifier: Apache-2.0
#include "umbrick/check/kit_export.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/trigonometric.hpp>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "check/kit_files.h"
#include "check/kit_folder.h"
#include "check/kit_samples.h"
#include "check/kit_table.h"
#include "check/kit_voxels.h"
#include "check/steps.h"
#include "umbrick/brick/brick_grid.h"
#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/short_number.h"
#include "umbrick/image/exr.h"
#include "umbrick/reference/reference.h"
#include "umbrick/scene/resolve.h"
#include "umbrick/slice/proxy_slices.h"
#include "umbrick/vdb/write_volume.h"

namespace umbrick {
std::string_view kitText(std::string_view name);  // is made by the build, see umbrick_embed

namespace {
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "raw files are written as memory has them");

constexpr double kMostBricksAsGrids = 4096;  // grids of one .vdb

// --- numbers as JSON ---

template <class Vector>
Json vectorOf(const Vector& v) {
  return {v.x, v.y, v.z};
}

// Returns a matrix for column vectors, row by row.
Json rowsOf(const glm::dmat4& matrix) {
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) rows.push_back({matrix[0][row], matrix[1][row], matrix[2][row], matrix[3][row]});
  return rows;
}

// Adds a line to a table.
void addRow(std::string& table, const std::vector<std::string>& fields) {
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (i > 0) table += ',';
    table += fields[i];
  }
  table += '\n';
}

// --- the camera as OpenGL has it ---

glm::dmat4 worldToView(const Camera& camera) {
  const CameraFrame frame = cameraFrame(camera);
  glm::dmat4 matrix(1);
  const auto setRow = [&](int row, const glm::dvec3& axis) {
    for (int i = 0; i < 3; ++i) matrix[i][row] = axis[i];
    matrix[3][row] = -glm::dot(axis, camera.eye);
  };
  setRow(0, frame.right);
  setRow(1, frame.up);
  setRow(2, -frame.forward);
  return matrix;
}

struct DepthRange {
  double nearest = 0, farthest = 1;
};

// Returns between which depths all of the volume lies that is in front of the eye.
DepthRange depthsOf(const Camera& camera, const IndexBox& domain, const glm::dmat4& toWorld) {
  const glm::dvec3 forward = cameraFrame(camera).forward;
  DepthRange range{std::numeric_limits<double>::infinity(), 0};
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 index(corner & 1 ? domain.max.x : domain.min.x, corner & 2 ? domain.max.y : domain.min.y,
                           corner & 4 ? domain.max.z : domain.min.z, 1);
    const double depth = glm::dot(glm::dvec3(toWorld * index) - camera.eye, forward);
    range.nearest = std::min(range.nearest, depth);
    range.farthest = std::max(range.farthest, depth);
  }
  // A matrix of a perspective needs planes in front of the eye; they bound what is stored as depth, and nothing else.
  if (!(range.farthest > 0)) range.farthest = 1;
  // A plane on a face of the volume cuts it away in renderers that draw the faces.
  const double margin = 0.02 * (range.farthest - std::max(0.0, range.nearest));
  range.farthest += margin;
  range.nearest = std::clamp(range.nearest - margin, 1e-3 * range.farthest, 0.999 * range.farthest);
  return range;
}

glm::dmat4 viewToClip(const Camera& camera, const DepthRange& depths) {
  const glm::dvec2 half = screenPlane(camera).halfExtent;
  const double n = depths.nearest, f = depths.farthest;
  glm::dmat4 matrix(0);
  matrix[0][0] = 1 / half.x;
  matrix[1][1] = 1 / half.y;
  if (camera.projection == Projection::perspective) {
    matrix[2][2] = -(f + n) / (f - n);
    matrix[3][2] = -2 * f * n / (f - n);
    matrix[2][3] = -1;
  } else {
    matrix[2][2] = -2 / (f - n);
    matrix[3][2] = -(f + n) / (f - n);
    matrix[3][3] = 1;
  }
  return matrix;
}

// --- the reference and its error ---

struct KitPicture {
  Image colour, errorBar, depth;
  double largestErrorBar = 0;
};

// Integrates the picture twice. @throw CheckStopped
KitPicture referenceOf(const ScalarGrid& grid, const ResolvedScene& scene, const CheckSteps& steps) {
  double done = 0;
  const auto integrate = [&](double step) {
    ReferenceOptions options;
    options.tolerance = 1e-5;
    options.step = step;
    bool stopped = false;
    options.progress = [&](double share) {
      try {
        steps.within(done + 0.5 * share);
      } catch (const CheckStopped&) {
        stopped = true;
      }
      return !stopped;
    };
    ReferencePicture picture = renderReference(grid, scene, options);
    if (!picture.complete) throw CheckStopped{};
    done += 0.5;
    return picture;
  };
  ReferencePicture adaptive = integrate(0), even = integrate(0.25);
  KitPicture picture{std::move(adaptive.colour), Image(scene.camera.width, scene.camera.height),
                     std::move(adaptive.depth)};
  for (std::size_t i = 0; i < picture.colour.pixels.size(); ++i) {
    constexpr float kRest = 1e-6f;
    picture.errorBar.pixels[i] = 2 * std::abs(picture.colour.pixels[i] - even.colour.pixels[i]) + kRest;
    picture.largestErrorBar = std::max(picture.largestErrorBar, static_cast<double>(picture.errorBar.pixels[i]));
  }
  return picture;
}

// --- one case ---

class CaseWriter {
 public:
  CaseWriter(const KitFiles& files, const KitCase& kit, const KitOptions& options, CheckSteps& steps,
             KitSummary& summary)
      : files_(files), kit_(kit), options_(options), steps_(steps), summary_(summary) {
    const ResolvedScene& first = kit.views.front().scene;
    BrickOptions cut;
    if (first.bricks.interior > 0) cut.interior = first.bricks.interior;
    cut.apron = options.apron;
    grid_ = cleanGrid(*brickGrid(kit.grid, cut));
    bricks_ = brickGrid(grid_, cut);
    if (bricks_->bricks.empty())
      throw InvalidArgument("case " + kit.name + ": all voxels of the volume are background");
    for (const Brick& brick : bricks_->bricks) origins_.push_back(brick.origin);
  }

  void write() {
    makeFolder(files_.folder(kit_.name));
    Json json{{"format", kKitFormat}, {"name", kit_.name}, {"purpose", kit_.purpose}};
    steps_.begin(kit_.name + ": voxels", kVoxelWork);
    json["volume"] = writeVolume();
    json["bricks"] = writeBricks();
    json["samples"] = writeSamples();
    json["transfer"] = writeTransfer();
    json["medium_box"] = {vectorOf(bricks_->domain.min), vectorOf(bricks_->domain.max)};
    json["pictures"] = Json::array();
    for (const KitView& view : kit_.views) json["pictures"].push_back(writePicture(view));
    writeTextFile(files_.description(kit_.name), json.dump(1) + "\n");
    ++summary_.cases;
  }

  static constexpr double kVoxelWork = 1, kPictureWork = 2;

 private:
  fs::path file(const std::string& name) const { return files_.folder(kit_.name) / name; }
  void leaveOut(const std::string& what, const std::string& why) {
    summary_.notes.push_back("case " + kit_.name + ": " + what + " is left out: " + why);
  }

  void writeRaw(const std::string& name,
                const std::function<void(const std::function<void(std::span<const float>)>&)>& all) {
    PendingFile pending(file(name));
    all([&](std::span<const float> values) {
      pending.stream().write(reinterpret_cast<const char*>(values.data()),
                             static_cast<std::streamsize>(values.size_bytes()));
    });
    pending.commit();
  }

  Json writeVolume() {
    const IndexBox& box = bricks_->domain;
    const glm::dmat4& toWorld = bricks_->indexToWorld;
    writeGrids(file("volume.vdb"), {grid_.grid});
    const glm::dvec3 extent(box.extent());
    const double bytes = extent.x * extent.y * extent.z * sizeof(float);
    const bool dense = bytes <= static_cast<double>(options_.mostBytes);
    if (dense)
      writeRaw("volume.raw", [&](const auto& put) { put(denseVoxels(grid_, box)); });
    else
      leaveOut("volume.raw",
               "it would have " + shortNumber(bytes, 3) + " bytes, more than " + std::to_string(options_.mostBytes));
    return {{"vdb", "volume.vdb"},
            {"grid", grid_.name},
            {"raw", dense ? Json("volume.raw") : Json(nullptr)},
            {"first_voxel", vectorOf(box.min)},
            {"dims", vectorOf(box.extent())},
            {"background", bricks_->background},
            {"value_range", {bricks_->value.min, bricks_->value.max}},
            {"index_to_world", rowsOf(toWorld)},
            {"world_to_index", rowsOf(glm::inverse(toWorld))}};
  }

  Json writeBricks() {
    const BrickLayout& layout = bricks_->layout;
    const std::size_t count = origins_.size(), brickBytes = layout.voxels() * sizeof(float);
    if (count * brickBytes > options_.mostBytes)
      throw InvalidArgument("case " + kit_.name + ": bricks.raw would have " + std::to_string(count * brickBytes) +
                            " bytes, more than " + std::to_string(options_.mostBytes) +
                            ": take a part of the volume, or make it coarser");
    std::string table = "brick,origin_i,origin_j,origin_k,value_min,value_max,byte_offset\n";
    for (std::size_t i = 0; i < count; ++i) {
      const Brick& brick = bricks_->bricks[i];
      addRow(table, {std::to_string(i), std::to_string(brick.origin.x), std::to_string(brick.origin.y),
                     std::to_string(brick.origin.z), tableNumber(brick.value.min), tableNumber(brick.value.max),
                     std::to_string(i * brickBytes)});
    }
    writeTextFile(file("bricks.csv"), table);
    writeRaw("bricks.raw", [&](const auto& put) {
      std::vector<float> values(layout.voxels());
      for (std::size_t i = 0; i < count; ++i) {
        bricks_->read(origins_[i], values);
        put(values);
        steps_.within(static_cast<double>(i) / static_cast<double>(count));
      }
    });
    const bool asGrids = static_cast<double>(count) <= kMostBricksAsGrids;
    if (asGrids) {
      std::vector<std::shared_ptr<const openvdb::FloatGrid>> grids;
      for (std::size_t i = 0; i < count; ++i) grids.push_back(brickAsGrid(*bricks_, i).grid);
      writeGrids(file("bricks.vdb"), grids);
    } else {
      leaveOut("bricks.vdb",
               "it would have " + std::to_string(count) + " grids, more than " + shortNumber(kMostBricksAsGrids, 6));
    }
    summary_.bricks += count;
    return {{"raw", "bricks.raw"},
            {"vdb", asGrids ? Json("bricks.vdb") : Json(nullptr)},
            {"table", "bricks.csv"},
            {"count", count},
            {"interior", vectorOf(layout.interior)},
            {"apron", layout.apron},
            {"edge", vectorOf(layout.edge())}};
  }

  Json writeSamples() {
    const std::vector<KitSample> samples =
        chooseSamples(voxelsOf(grid_), BrickFinder(bricks_->layout.interior, origins_), origins_, bricks_->domain,
                      options_.samples, options_.seed);
    static constexpr const char* kPlaces[]{"inside", "border", "outside"};
    std::string table = "id,i,j,k,x,y,z,brick,place,value\n";
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const KitSample& sample = samples[i];
      const glm::dvec3 world(bricks_->indexToWorld * glm::dvec4(sample.index, 1));
      addRow(table,
             {std::to_string(i), tableNumber(sample.index.x), tableNumber(sample.index.y), tableNumber(sample.index.z),
              tableNumber(world.x), tableNumber(world.y), tableNumber(world.z), std::to_string(sample.brick),
              kPlaces[static_cast<std::size_t>(sample.place)], tableNumber(sample.value)});
    }
    writeTextFile(file("samples.csv"), table);
    summary_.samples += samples.size();
    return {{"table", "samples.csv"},
            {"count", samples.size()},
            {"seed", options_.seed},
            {"answer", "answers/" + kit_.name + "/samples.csv"}};
  }

  Json writeTransfer() {
    const TransferFunction& transfer = kit_.views.front().scene.transfer;
    std::string table = "value,albedo_r,albedo_g,albedo_b,sigma_t\n";
    for (std::size_t i = 0; i < transfer.values().size(); ++i) {
      const Medium& medium = transfer.media()[i];
      addRow(table, {tableNumber(transfer.values()[i]), tableNumber(medium.albedo.r), tableNumber(medium.albedo.g),
                     tableNumber(medium.albedo.b), tableNumber(medium.sigma_t)});
    }
    writeTextFile(file("transfer.csv"), table);
    return {{"table", "transfer.csv"}, {"interpolation", "linear, constant beyond the ends"}};
  }

  Json writePicture(const KitView& view) {
    const ResolvedScene& scene = view.scene;
    const Camera& camera = scene.camera;
    steps_.begin(kit_.name + ": picture " + view.name, kPictureWork);
    const KitPicture picture = referenceOf(grid_, scene, steps_);
    ExrOptions exr;
    exr.pixel = ExrPixel::float32;
    exr.metadata = {{"umbrick.scene", printScene(scene)}, {"umbrick.renderer", "reference"}};
    writeExr(file(view.name + ".exr"),
             {{"", picture.colour}, {kErrorBarLayer, picture.errorBar, true}, {kDepthLayer, picture.depth, true}}, exr);
    writeScene(view);
    const DepthRange depths = depthsOf(camera, bricks_->domain, bricks_->indexToWorld);
    writeSlices(view, depths);
    summary_.largestErrorBar = std::max(summary_.largestErrorBar, picture.largestErrorBar);
    ++summary_.pictures;
    const bool perspective = camera.projection == Projection::perspective;
    return {{"name", view.name},
            {"reference", view.name + ".exr"},
            {"largest_error_bar", picture.largestErrorBar},
            {"scene", view.name + ".scene.json"},
            {"slices", view.name + ".slices.json"},
            {"answer", "answers/" + kit_.name + "/" + view.name + ".exr"},
            {"width", camera.width},
            {"height", camera.height},
            {"projection", nameOf(kProjections, camera.projection)},
            {"eye", vectorOf(camera.eye)},
            {"look_at", vectorOf(camera.lookAt)},
            {"up", vectorOf(camera.up)},
            {"fov_y_degrees", perspective ? Json(glm::degrees(camera.fov)) : Json(nullptr)},
            {"view_height", perspective ? Json(nullptr) : Json(camera.viewHeight)},
            {"near", camera.nearDistance},
            {"world_to_view", rowsOf(worldToView(camera))},
            {"view_to_clip", rowsOf(viewToClip(camera, depths))},
            {"clip_near", depths.nearest},
            {"clip_far", depths.farthest},
            {"light", vectorOf(scene.ambient)},
            {"background", scene.background ? vectorOf(*scene.background) : Json(nullptr)}};
  }

  void writeScene(const KitView& view) {
    Scene scene = unresolved(view.scene);
    // The scene lies beside its volume.
    scene.volume = VolumeReference{"volume.vdb", grid_.name};
    writeTextFile(file(view.name + ".scene.json"), printScene(scene) + "\n");
  }

  void writeSlices(const KitView& view, const DepthRange& depths) {
    const double spacing = (depths.farthest - depths.nearest) / std::max(1, options_.slices);
    const ProxySlices cut =
        cutSlices(indexView(view.scene.camera, bricks_->indexToWorld), origins_, bricks_->layout.interior, {}, spacing);
    Json json{{"picture", view.name}, {"spacing", spacing}, {"slices", Json::array()}};
    for (std::int64_t i = 0; i < cut.count(); ++i) {
      Json polygons = Json::array();
      for (std::int32_t p = cut.start[static_cast<std::size_t>(i)]; p < cut.start[static_cast<std::size_t>(i) + 1];
           ++p) {
        const ProxyPolygon& polygon = cut.polygons[static_cast<std::size_t>(p)];
        Json vertices = Json::array();
        for (std::int32_t v = 0; v < polygon.vertices; ++v) {
          const glm::vec2& vertex = cut.vertices[static_cast<std::size_t>(polygon.firstVertex + v)];
          vertices.push_back({vertex.x, vertex.y});
        }
        polygons.push_back({{"brick", polygon.brick}, {"ndc", std::move(vertices)}});
      }
      json["slices"].push_back({{"depth", cut.depth(i)}, {"polygons", std::move(polygons)}});
    }
    writeTextFile(file(view.name + ".slices.json"), json.dump() + "\n");
  }

  const KitFiles& files_;
  const KitCase& kit_;
  const KitOptions& options_;
  CheckSteps& steps_;
  KitSummary& summary_;
  std::unique_ptr<Bricks> bricks_;
  std::vector<glm::ivec3> origins_;
  ScalarGrid grid_;
};

void checkKit(const std::vector<KitCase>& cases, const KitOptions& options) {
  if (cases.empty()) throw InvalidArgument("kit: there is no case");
  if (options.apron < 1 || options.apron > 8)
    throw InvalidArgument("apron: is " + std::to_string(options.apron) + ", must be in 1 to 8");
  if (options.samples < 12 || options.samples > 10'000'000)
    throw InvalidArgument("samples: are " + std::to_string(options.samples) + ", must be in 12 to 10000000");
  if (options.slices < 1 || options.slices > 10'000)
    throw InvalidArgument("slices: are " + std::to_string(options.slices) + ", must be in 1 to 10000");
  std::set<std::string> names;
  for (const KitCase& kit : cases) {
    if (kit.views.empty()) throw InvalidArgument("case " + kit.name + ": has no view");
    if (!names.insert(kit.name).second) throw InvalidArgument("case " + kit.name + ": there are two of this name");
    for (const KitView& view : kit.views)
      if (!(view.scene.transfer == kit.views.front().scene.transfer))
        throw InvalidArgument("case " + kit.name + ": view " + view.name + " has another transfer function than " +
                              kit.views.front().name);
  }
}

std::string readmeOf(const std::vector<KitCase>& cases) {
  std::string text(kitText("kit_readme.md"));
  text += "\n## The cases of this kit\n\n| case | pictures | why |\n| --- | --- | --- |\n";
  for (const KitCase& kit : cases) {
    std::string views;
    for (const KitView& view : kit.views) views.append(views.empty() ? "" : ", ").append(view.name);
    text.append("| ").append(kit.name).append(" | ").append(views).append(" | ").append(kit.purpose).append(" |\n");
  }
  return text;
}

}  // namespace

KitSummary exportKit(const fs::path& folder, const std::vector<KitCase>& cases, const KitOptions& options) {
  checkKit(cases, options);
  StagedFolder staged(folder);
  const KitFiles files{staged.path()};
  KitSummary summary;
  CheckSteps steps(options.progress);
  double work = 0;
  for (const KitCase& kit : cases)
    work += CaseWriter::kVoxelWork + CaseWriter::kPictureWork * static_cast<double>(kit.views.size());
  steps.expect(work);
  try {
    makeFolder(files.cases());
    Json manifest{{"format", kKitFormat}, {"kind", "umbrick kit for tests of renderers"}, {"cases", Json::array()}};
    for (const KitCase& kit : cases) {
      CaseWriter(files, kit, options, steps, summary).write();
      manifest["cases"].push_back(kit.name);
    }
    writeTextFile(files.readme(), readmeOf(cases));
    writeTextFile(files.manifest(), manifest.dump(1) + "\n");
  } catch (const CheckStopped&) {
    summary.complete = false;
    return summary;
  }
  staged.commit();
  return summary;
}

}  // namespace umbrick
