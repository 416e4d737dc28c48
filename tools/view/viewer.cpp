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

// The numbers of frames as ranges, of which each is [first, last], and what is between numbers.
Json numbersOf(const ViewSequence& sequence) {
  Json ranges = Json::array();
  for (const ViewSequence::Frame& frame : sequence.frames)
    if (!ranges.empty() && ranges.back()[1].get<std::int64_t>() + sequence.step == frame.number)
      ranges.back()[1] = frame.number;
    else
      ranges.push_back({frame.number, frame.number});
  return {{"ranges", ranges}, {"step", sequence.step}};
}

// A line on what went wrong, for one page.
std::string errorText(const std::string& message) { return Json{{"type", "error"}, {"message", message}}.dump(); }

std::optional<Box> seenIn(const ViewSequence* sequence) { return sequence ? sequence->seen : std::nullopt; }

// What hello says of a volume. Of a sequence it is the frame that was opened, in a box that all are seen in.
Json aboutVolume(const Volume& volume, const ViewSequence* sequence) {
  const ValueSurvey survey = surveyValues(volume.grid());
  const IndexBox box = volume.grid().activeBox();
  Box bounds = volume.worldBounds();
  if (const std::optional<Box> seen = seenIn(sequence)) {
    bounds.include(seen->min);
    bounds.include(seen->max);
  }
  const fs::path& file = sequence ? sequence->whole.file : volume.source().file;
  return {{"file", asUtf8(file.filename().string())},
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

}  // namespace

Viewer::Viewer(Scene scene, std::shared_ptr<const Volume> volume, EngineKind engine, const ViewGoals& goals,
               fs::path folder, OpenVolume open, std::shared_ptr<const ViewSequence> sequence)
    : state_(std::move(scene), volume, seenIn(sequence.get())),
      folder_(std::move(folder)),
      about_(aboutVolume(*volume, sequence.get())),
      sequence_(std::move(sequence)),
      frame_(sequence_ ? sequence_->first : 0),
      player_(std::make_unique<SequencePlayer>(playerSink())) {
  renderer_ = std::make_unique<ViewRenderer>(std::move(volume), engine, goals, sink(), frameNumber());
  player_->open(sequence_);
  comparison_ = std::make_unique<ReferenceComparison>([this](std::uint64_t number, const Json& news) {
    const std::lock_guard lock(mutex_);
    if (!comparison_->isCurrent(number)) return;  // was dropped meanwhile
    compared_ = news;
    compared_["type"] = "comparison";
    toAll(compared_);
  });
  if (open) startOpening(std::move(open));
}

// The jobs end first: they use what is declared before them. What reads frames and what draws them use each other.
Viewer::~Viewer() { player_->end(); }

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
  sink.frame = [this, each](const std::shared_ptr<const ViewFrame>& frame) {
    each([&](ViewClient& client) { client.frame(frame); });
    player_->drawn();
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
  sink.error = [this, each](const std::string& line) {
    const std::string text = errorText(asUtf8(line));
    each([&](ViewClient& client) { client.text(text); });
    player_->drawn();  // the next frame may do better
  };
  sink.taken = [this] { player_->taken(); };
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
          {"sequence", sequence_ ? numbersOf(*sequence_) : Json()},
          {"folder", opening_ ? Json(asUtf8(opening_->folder().string())) : Json()},
          {"mostUpload", kMostUploadBytes}};
}

// A scene of the state, and how to make its picture, and those of all frames, without this program's window.
Json Viewer::sceneMessage() const {
  const Camera& camera = state_.resolved().camera;
  const auto command = [](const Scene& scene, const std::string& options) {
    return "cat > scene.json <<'END'\n" + printScene(scene) + "\nEND\numbrick render scene.json " + options;
  };
  Json all;
  if (sequence_) all = command(state_.placedIn(sequence_->whole), frameOptions(*sequence_) + " -o 'frame_%04d.png'");
  return {{"type", "scene"},
          {"scene", state_.json()},
          {"canUndo", state_.canUndo()},
          {"canRedo", state_.canRedo()},
          {"command", command(state_.placed(), "-o picture.png")},
          {"commandOfAll", all},
          {"number", frameNumber() ? Json(*frameNumber()) : Json()},
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
  if (sequence_) client->text(sequenceMessage().dump());
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
  if (clients_.empty()) {
    dropComparison({});
    player_->play(false);
  }
  // The page may have gone in the middle of a drag.
  player_->rest();
  if (!player_->state().moves()) renderer_->rest();
}

void Viewer::show(bool moving) {
  dropComparison("the scene has changed");
  toAll(sceneMessage());
  renderer_->show(state_.resolved(), moving || player_->state().moves());
}

void Viewer::message(std::string_view text, const std::shared_ptr<ViewClient>& from) {
  try {
    const Json message = parseMessage(text);
    const auto type = message["type"].get<std::string>();
    const std::lock_guard lock(mutex_);
    if (type == "edit") {
      const auto step = message.contains("step") ? messageField<std::string>(message, "step") : std::string();
      const bool moving = message.contains("moving") && messageField<bool>(message, "moving");
      state_.edit(messageField<Json>(message, "patch"), step);
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
      if (!player_->state().moves()) renderer_->rest();
    } else if (type == "sequence") {
      askFrame(parseFrameRequest(message));
    } else if (type == "play") {
      play(parsePlayRequest(message));
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
      Json listing = opening().list(messageField<std::string>(message, "path"));
      listing["type"] = "files";
      from->text(listing.dump());
    } else if (type == "open") {
      opening().open(messageField<std::string>(message, "path"));
    } else {
      throw InvalidArgument("message: no type '" + printable(type.substr(0, 40)) + "'");
    }
  } catch (const Error& error) {
    from->text(errorText(asUtf8(error.what())));
  }
}

void Viewer::compare() {
  if (blank_) throw InvalidArgument("compare: this frame holds nothing");
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
  const int x = messageField<int>(message, "x"), y = messageField<int>(message, "y");
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

// --- frames of a sequence ---

const ViewSequence& Viewer::sequence() const {
  if (!sequence_) throw InvalidArgument("sequence: the volume is no frame of a sequence");
  return *sequence_;
}

std::optional<std::int64_t> Viewer::frameNumber() const {
  return sequence_ ? std::optional(sequence_->frames[frame_].number) : std::nullopt;
}

Json Viewer::sequenceMessage() const {
  const PlayState state = player_->state();
  return {{"type", "sequence"},
          {"number", sequence_->frames[frame_].number},
          {"asked", state.asked ? Json(sequence_->frames[*state.asked].number) : Json()},
          {"empty", blank_},
          {"playing", state.playing},
          {"loop", state.loop},
          {"fps", state.fps}};
}

void Viewer::askFrame(const FrameRequest& request) {
  const std::optional<std::size_t> index = frameOf(sequence(), request.number);
  if (!index) throw InvalidArgument("sequence: there is no frame " + std::to_string(request.number));
  player_->ask(*index, request.moving);
  toAll(sequenceMessage());
  if (*index == frame_ && !request.moving) settle();
}

void Viewer::play(const PlayRequest& request) {
  sequence();
  if (request.loop) player_->setLoop(*request.loop);
  if (request.fps) player_->setRate(*request.fps);
  if (request.on) player_->play(*request.on);
  toAll(sequenceMessage());
  if (request.on == false) settle();
}

// Nothing moves any more: the frame at hand gets its picture, and pages its commands.
void Viewer::settle() {
  if (player_->state().moves()) return;
  renderer_->rest();
  toAll(sceneMessage());
}

SequencePlayer::Sink Viewer::playerSink() {
  SequencePlayer::Sink sink;
  sink.show = [this](std::uint64_t number, const ReadFrame& frame) { showFrame(number, frame); };
  sink.failed = [this](std::uint64_t number, const std::string& line) {
    const std::lock_guard lock(mutex_);
    if (!player_->isCurrent(number)) return;
    toAll({{"type", "error"}, {"message", asUtf8(line)}});
    toAll(sequenceMessage());
  };
  sink.ended = [this](std::uint64_t number) {
    const std::lock_guard lock(mutex_);
    if (!player_->isCurrent(number)) return;
    toAll(sequenceMessage());
    settle();
  };
  return sink;
}

void Viewer::showFrame(std::uint64_t number, const ReadFrame& frame) {
  const std::lock_guard lock(mutex_);
  if (!player_->isCurrent(number)) return;
  try {
    state_.show(frame.volume, sourceOf(*sequence_, frame.index, frame.volume.get()));
  } catch (const Error& error) {
    toAll({{"type", "error"}, {"message", asUtf8(error.what())}});
    player_->taken();
    player_->drawn();
    return;
  }
  dropComparison("another frame is shown");
  frame_ = frame.index;
  blank_ = !frame.volume;
  const bool moves = player_->state().moves();
  renderer_->showVolume(frame.volume, state_.resolved(), sequence_->frames[frame_].number, moves);
  toAll(sequenceMessage());
  // While frames follow one another the scene is the one that pages have.
  if (!moves) toAll(sceneMessage());
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
  ViewState state(std::move(opened.scene), opened.volume, seenIn(opened.sequence.get()));
  Json about = aboutVolume(*opened.volume, opened.sequence.get());
  about["file"] = asUtf8(name);
  const std::lock_guard lock(mutex_);
  if (!opening_ || !opening_->isCurrent(number)) return;
  dropComparison("another volume is shown");
  state_ = std::move(state);
  about_ = std::move(about);
  surveying_->drop();
  gradients_ = Json();
  sequence_ = std::move(opened.sequence);
  frame_ = sequence_ ? sequence_->first : 0;
  blank_ = false;
  player_->open(sequence_);
  renderer_->open(opened.volume, state_.resolved(), frameNumber());
  toAll(hello());
  toAll(sceneMessage());
  if (sequence_) toAll(sequenceMessage());
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
  const auto what = messageField<std::string>(message, "what"), name = messageField<std::string>(message, "name");
  const auto saved = [](const fs::path& path) {
    return Json{{"type", "saved"}, {"path", asUtf8(path.string())}}.dump();
  };
  if (what == "scene" || what == "sequence") {
    const fs::path path = place(name, {".json"});
    const Scene scene = what == "scene" ? state_.placed() : state_.placedIn(sequence().whole);
    writeTextFile(path, printScene(scene) + "\n");
    from->text(saved(path));
    return;
  }
  if (what != "picture") throw InvalidArgument("save: what is a picture or a scene, or a scene of a sequence");
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
