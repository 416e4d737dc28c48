// A small volume and a page of it, without a browser.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "support/test_grids.h"
#include "umbrick/render/suggest_transfer.h"
#include "view/viewer.h"

namespace umbrick::view {

inline std::shared_ptr<const Volume> testVolume() {
  return std::make_shared<const Volume>(makeDense({20, 18, 16}, {3, -7, 1}), "dense");
}

inline Scene testScene() {
  Scene scene;
  scene.transfer = TransferFunction({{0.3, {{0.9, 0.5, 0.2}, 0}}, {1, {{0.2, 0.6, 0.9}, 0.4}}});
  scene.orbit = Orbit{0.4, 0.3};
  scene.camera.width = 40;
  scene.camera.height = 30;
  scene.model = Model::cone;
  scene.method = Method::lightVolume;
  scene.occlusion.ordinates.directions = 6;
  return scene;
}

/// Writes a volume of ascending bytes, of 9 x 8 x 7 voxels, as a MetaImage of one file.
inline std::string metaImage() {
  std::string file =
      "ObjectType = Image\nNDims = 3\nDimSize = 9 8 7\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
  for (int i = 0; i < 9 * 8 * 7; ++i) file += static_cast<char>(1 + i % 250);
  return file;
}

/// Opens what pages ask for, without the options of the program.
inline OpenedVolume openForTest(const std::filesystem::path& file, const std::function<void(double)>& progress) {
  Scene scene = testScene();
  if (file.extension() == ".json") scene = readScene(file, true);
  if (scene.volume.file.empty()) scene.volume.file = file;
  scene.volume.besideOnly = true;
  const auto volume = std::make_shared<const Volume>(scene.volume, progress);
  scene.volume = volume->source();
  if (file.extension() != ".json") scene.transfer = suggestTransfer(*volume).transfer;
  return {scene, volume, "chosen for " + file.filename().string()};
}

/// A page that notes down what it is sent.
class NotingClient final : public ViewClient {
 public:
  void text(const std::string& message) override {
    const std::lock_guard lock(mutex_);
    texts_.push_back(nlohmann::ordered_json::parse(message));
    changed_.notify_all();
  }
  void frame(const std::shared_ptr<const ViewFrame>& frame) override {
    const std::lock_guard lock(mutex_);
    frames_.push_back(frame);
    changed_.notify_all();
  }
  /// Waits for a message that a test accepts and takes it and all before it away; null where none comes.
  nlohmann::ordered_json take(const std::function<bool(const nlohmann::ordered_json&)>& accepts) {
    std::unique_lock lock(mutex_);
    nlohmann::ordered_json found;
    changed_.wait_for(lock, std::chrono::minutes(2), [&] {
      while (!texts_.empty()) {
        nlohmann::ordered_json text = std::move(texts_.front());
        texts_.erase(texts_.begin());
        if (!accepts(text)) continue;
        found = std::move(text);
        return true;
      }
      return false;
    });
    return found;
  }
  nlohmann::ordered_json take(const std::string& type) {
    return take([&](const auto& text) { return text["type"] == type; });
  }
  /// Waits until the picture is done.
  nlohmann::ordered_json takeDone() {
    return take([](const auto& text) { return text["type"] == "status" && text["done"] == true; });
  }
  /// Waits for a frame that a test accepts, of those that came before, too; null where none comes.
  std::shared_ptr<const ViewFrame> awaitFrame(const std::function<bool(const ViewFrame&)>& accepts) {
    std::unique_lock lock(mutex_);
    std::shared_ptr<const ViewFrame> found;
    changed_.wait_for(lock, std::chrono::minutes(2), [&] {
      const auto frame = std::find_if(frames_.begin(), frames_.end(), [&](const auto& each) { return accepts(*each); });
      if (frame != frames_.end()) found = *frame;
      return found != nullptr;
    });
    return found;
  }
  std::vector<std::shared_ptr<const ViewFrame>> frames() {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<nlohmann::ordered_json> texts_;
  std::vector<std::shared_ptr<const ViewFrame>> frames_;
};

}  // namespace umbrick::view
