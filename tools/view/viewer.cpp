// SPDX-License-Identifier: Apache-2.0
#include "view/viewer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "umbrick/core/error.h"
#include "umbrick/core/pending_file.h"
#include "umbrick/core/printable.h"
#include "umbrick/grid/value_survey.h"
#include "umbrick/image/exr.h"
#include "umbrick/image/png.h"
#include "umbrick/render/suggest_transfer.h"
#include "view/field_list.h"
#include "view/gradient_histogram.h"
#include "view/sample_grid.h"

namespace umbrick::view {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json vectorOf(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json numberOrNull(double number) { return std::isfinite(number) ? Json(number) : Json(); }

// A line on what went wrong, for one page.
std::string errorText(const std::string& message) { return Json{{"type", "error"}, {"message", message}}.dump(); }

Json aboutVolume(const Volume& volume) {
  const ValueSurvey survey = surveyValues(volume.grid());
  const IndexBox box = volume.grid().activeBox();
  const Box bounds = volume.worldBounds();
  return {{"file", asUtf8(volume.source().file.filename().string())},
          {"grid", asUtf8(volume.source().grid)},
          {"unit", asUtf8(volume.valueUnit())},
          {"dims", {box.max.x - box.min.x + 1, box.max.y - box.min.y + 1, box.max.z - box.min.z + 1}},
          {"voxels", survey.voxels},
          {"min", survey.value.min},
          {"max", survey.value.max},
          {"low", survey.low},
          {"high", survey.high},
          {"histogram", survey.histogram},
          {"bounds", {vectorOf(bounds.min), vectorOf(bounds.max)}}};
}

Json probed(const ViewProbe& probe, const Volume& volume) {
  const auto value = probe.world ? sampleAt(volume.grid(), *probe.world) : std::nullopt;
  return {{"type", "probe"},
          {"x", probe.x},
          {"y", probe.y},
          {"value", value ? numberOrNull(*value) : Json()},
          {"world", probe.world ? vectorOf(*probe.world) : Json()},
          {"depth", probe.world ? Json(probe.depth) : Json()}};
}

template <class Value>
Value field(const Json& message, const char* name) {
  try {
    return message.at(name).get<Value>();
  } catch (const nlohmann::json::exception&) {
    throw InvalidArgument(std::string("message: ") + name + " is missing or of another kind");
  }
}

}  // namespace

Viewer::Viewer(Scene scene, std::shared_ptr<const Volume> volume, EngineKind engine, const ViewGoals& goals,
               fs::path folder, OpenVolume open)
    : state_(std::move(scene), volume), folder_(std::move(folder)), about_(aboutVolume(*volume)) {
  renderer_ = std::make_unique<ViewRenderer>(std::move(volume), engine, goals, sink());
  comparison_ = std::make_unique<ReferenceComparison>([this](std::uint64_t number, const Json& news) {
    const std::lock_guard lock(mutex_);
    if (!comparison_->isCurrent(number)) return;  // was dropped meanwhile
    compared_ = news;
    compared_["type"] = "comparison";
    toAll(compared_);
  });
  if (open) startOpening(std::move(open));
}

// The jobs end first: they use what is declared before them.
Viewer::~Viewer() = default;

ViewSink Viewer::sink() {
  const auto each = [this](const auto& call) {
    std::vector<std::shared_ptr<ViewClient>> clients;
    {
      const std::lock_guard lock(mutex_);
      clients = clients_;
    }
    for (const auto& client : clients) call(*client);
  };
  ViewSink sink;
  sink.frame = [each](const std::shared_ptr<const ViewFrame>& frame) {
    each([&](ViewClient& client) { client.frame(frame); });
  };
  sink.status = [each](const ViewStatus& status) {
    const bool known = status.error.has_value();
    const std::string text = Json{
        {"type", "status"},
        {"samples", status.samples},
        {"standardError", known ? numberOrNull(status.error->statistical) : Json()},
        {"systematicError", known ? numberOrNull(status.error->systematic) : Json()},
        {"error", known ? numberOrNull(status.error->total()) : Json()},
        {"targetError", status.targetError},
        {"ms", status.ms},
        {"draft", status.draft},
        {"done", status.done},
        {"paused", status.paused},
        {"text", status.text}}.dump();
    each([&](ViewClient& client) { client.text(text); });
  };
  sink.error = [each](const std::string& line) {
    const std::string text = errorText(asUtf8(line));
    each([&](ViewClient& client) { client.text(text); });
  };
  sink.engine = [this, each](const std::string& engine) {
    {
      const std::lock_guard lock(mutex_);
      engine_ = engine;
    }
    const std::string text = Json{{"type", "engine"}, {"text", engine}}.dump();
    each([&](ViewClient& client) { client.text(text); });
  };
  return sink;
}

Json Viewer::hello() const {
  return {{"type", "hello"},
          {"version", UMBRICK_VERSION},
          {"engine", engine_},
          {"volume", about_},
          {"presets", transferPresets()},
          {"fields", fieldList()},
          {"folder", opening_ ? Json(asUtf8(opening_->folder().string())) : Json()},
          {"mostUpload", kMostUploadBytes}};
}

// A scene of the state, and how to make its picture without this program's window.
Json Viewer::sceneMessage() const {
  const Camera& camera = state_.resolved().camera;
  const std::string command =
      "cat > scene.json <<'END'\n" + printScene(state_.placed()) + "\nEND\numbrick render scene.json -o picture.png";
  return {{"type", "scene"},
          {"scene", state_.json()},
          {"canUndo", state_.canUndo()},
          {"canRedo", state_.canRedo()},
          {"command", command},
          {"camera",
           {{"eye", vectorOf(camera.eye)},
            {"lookAt", vectorOf(camera.lookAt)},
            {"up", vectorOf(camera.up)},
            {"viewHeight", camera.viewHeight}}}};
}

void Viewer::toAll(const Json& message) {
  const std::string text = message.dump();
  for (const auto& client : clients_) client->text(text);
}

void Viewer::join(const std::shared_ptr<ViewClient>& client) {
  const std::lock_guard lock(mutex_);
  const bool first = clients_.empty();
  clients_.push_back(client);
  client->text(hello().dump());
  client->text(sceneMessage().dump());
  if (first) {
    renderer_->pause(false);
    renderer_->show(state_.resolved(), false);
  }
  if (!compared_.is_null()) client->text(compared_.dump());
  renderer_->repeat();
}

void Viewer::leave(const ViewClient& client) {
  const std::lock_guard lock(mutex_);
  std::erase_if(clients_, [&](const auto& one) { return one.get() == &client; });
  // Nobody looks: what is drawn now would be for nothing.
  renderer_->pause(clients_.empty());
  if (clients_.empty()) dropComparison({});
}

void Viewer::show(bool moving) {
  dropComparison("the scene has changed");
  toAll(sceneMessage());
  renderer_->show(state_.resolved(), moving);
}

void Viewer::message(std::string_view text, const std::shared_ptr<ViewClient>& from) {
  try {
    const Json message = parseMessage(text);
    const auto type = message["type"].get<std::string>();
    const std::lock_guard lock(mutex_);
    if (type == "edit") {
      const auto step = message.contains("step") ? field<std::string>(message, "step") : std::string();
      const bool moving = message.contains("moving") && field<bool>(message, "moving");
      state_.edit(field<Json>(message, "patch"), step);
      show(moving);
    } else if (type == "undo") {
      state_.undo();
      show(false);
    } else if (type == "redo") {
      state_.redo();
      show(false);
    } else if (type == "reset") {
      state_.reset();
      show(false);
    } else if (type == "rest") {
      renderer_->rest();
    } else if (type == "pause" || type == "resume") {
      renderer_->pause(type == "pause");
    } else if (type == "probe") {
      probe(message, from);
    } else if (type == "save") {
      save(message, from);
    } else if (type == "gradients") {
      sendGradients(from);
    } else if (type == "compare") {
      compare();
    } else if (type == "stopCompare") {
      dropComparison("stopped");
    } else if (type == "files") {
      Json listing = opening().list(field<std::string>(message, "path"));
      listing["type"] = "files";
      from->text(listing.dump());
    } else if (type == "open") {
      opening().open(field<std::string>(message, "path"));
    } else {
      throw InvalidArgument("message: no type '" + printable(type.substr(0, 40)) + "'");
    }
  } catch (const Error& error) {
    from->text(errorText(asUtf8(error.what())));
  }
}

void Viewer::compare() {
  comparison_->start(state_.share(), state_.resolved(), *renderer_);
  const Camera& camera = comparedScene(state_.resolved()).camera;
  compared_ = {{"type", "comparison"}, {"state", "running"}, {"share", 0}, {"size", {camera.width, camera.height}}};
  toAll(compared_);
}

void Viewer::dropComparison(const std::string& why) {
  if (compared_.is_null()) return;
  comparison_->drop();
  compared_ = Json();
  toAll({{"type", "comparison"}, {"state", "none"}, {"text", why}});
}

void Viewer::probe(const Json& message, const std::shared_ptr<ViewClient>& from) {
  const std::weak_ptr<ViewClient> waiting = from;
  const int x = field<int>(message, "x"), y = field<int>(message, "y");
  renderer_->probe(x, y, [volume = state_.share(), waiting](const ViewProbe& probe) {
    if (const auto client = waiting.lock()) client->text(probed(probe, *volume).dump());
  });
}

void Viewer::sendGradients(const std::shared_ptr<ViewClient>& from) {
  if (!gradients_.is_null()) return from->text(gradients_.dump());
  surveying_->start([this, volume = state_.share(), low = about_["low"].get<double>(),
                     high = about_["high"].get<double>()](std::uint64_t number) {
    const GradientHistogram found = surveyGradients(volume->grid(), low, high);
    const std::lock_guard lock(mutex_);
    if (!surveying_->isCurrent(number)) return;
    gradients_ = {{"type", "gradients"}, {"values", found.values}, {"gradients", found.gradients}, {"low", found.low},
                  {"high", found.high},  {"most", found.most},     {"counts", found.counts}};
    toAll(gradients_);
  });
}

// --- other volumes ---

FileOpening& Viewer::opening() const {
  if (!opening_) throw InvalidArgument("open: this viewer shows one volume alone");
  return *opening_;
}

void Viewer::upload(std::shared_ptr<UploadedFile> file) { opening().open(std::move(file)); }

void Viewer::startOpening(OpenVolume open) {
  FileOpening::Sink sink;
  sink.news = [this](std::uint64_t number, Json news) {
    const std::lock_guard lock(mutex_);
    if (!opening_ || !opening_->isCurrent(number)) return;  // was dropped meanwhile
    news["type"] = "opening";
    toAll(news);
  };
  sink.opened = [this](std::uint64_t number, OpenedVolume opened, const std::string& name) {
    take(number, std::move(opened), name);
  };
  opening_ = std::make_unique<FileOpening>(folder_, std::move(open), std::move(sink));
}

void Viewer::take(std::uint64_t number, OpenedVolume opened, const std::string& name) {
  // What looks at all voxels is done while pages still look at the volume before.
  ViewState state(std::move(opened.scene), opened.volume);
  Json about = aboutVolume(*opened.volume);
  about["file"] = asUtf8(name);
  const std::lock_guard lock(mutex_);
  if (!opening_ || !opening_->isCurrent(number)) return;
  dropComparison("another volume is shown");
  state_ = std::move(state);
  about_ = std::move(about);
  surveying_->drop();
  gradients_ = Json();
  renderer_->open(opened.volume, state_.resolved());
  toAll(hello());
  toAll(sceneMessage());
  toAll({{"type", "opening"}, {"state", "done"}, {"name", asUtf8(name)}, {"text", asUtf8(opened.chosen)}});
}

// A page names a file in the folder and nothing else: no other folder, nothing hidden, nothing that is there already.
fs::path Viewer::place(const std::string& name, const std::vector<std::string>& endings) const {
  constexpr std::size_t kLongest = 100;
  const auto allowed = [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.' || c == ' '; };
  const std::string ending = fs::path(name).extension().string();
  if (name.empty() || name.size() > kLongest || name.front() == '.' ||
      !std::all_of(name.begin(), name.end(), allowed) ||
      std::find(endings.begin(), endings.end(), ending) == endings.end()) {
    std::string list;
    for (const std::string& one : endings) list += (list.empty() ? "" : " or ") + one;
    throw InvalidArgument("save: '" + printable(name.substr(0, kLongest)) +
                          "' is no name of letters, digits, -, _ and . that ends in " + list);
  }
  const fs::path path = folder_ / name;
  if (fs::symlink_status(path).type() != fs::file_type::not_found)
    throw InvalidArgument("save: " + name + " is there already");
  return path;
}

void Viewer::save(const Json& message, const std::shared_ptr<ViewClient>& from) {
  const auto what = field<std::string>(message, "what"), name = field<std::string>(message, "name");
  const auto saved = [](const fs::path& path) {
    return Json{{"type", "saved"}, {"path", asUtf8(path.string())}}.dump();
  };
  if (what == "scene") {
    const fs::path path = place(name, {".json"});
    writeTextFile(path, printScene(state_.placed()) + "\n");
    from->text(saved(path));
    return;
  }
  if (what != "picture") throw InvalidArgument("save: what is a picture or a scene");
  const fs::path path = place(name, {".png", ".exr"});
  Json patch = Json::object();
  if (message.contains("size")) patch["camera"]["size"] = message["size"];
  if (message.contains("samples")) patch["sampling"]["pixelSamples"] = message["samples"];
  // The picture may have another size than the page's.
  ViewState other(state_.placed(), state_.share());
  other.edit(patch);
  const Scene scene = other.scene();
  const std::weak_ptr<ViewClient> waiting = from;
  const auto tell = [waiting](const std::string& text) {
    if (const auto client = waiting.lock()) client->text(text);
  };
  renderer_->drawWhole(
      other.resolved(),
      [path, scene, tell, saved](const Picture& picture, const std::string& engine) {
        const std::map<std::string, std::string> metadata{
            {"umbrick.scene", printScene(scene)}, {"umbrick.renderer", engine}, {"umbrick.version", UMBRICK_VERSION}};
        if (path.extension() == ".png")
          writePng(path, picture.colour, {.metadata = metadata});
        else
          writeExr(path, {{"", picture.colour}}, {.pixel = ExrPixel::half, .metadata = metadata});
        tell(saved(path));
      },
      [tell](const std::string& line) { tell(errorText(asUtf8(line))); });
}

}  // namespace umbrick::view
