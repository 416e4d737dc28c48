// OME-XML in the description of a TIFF: expat parses it. The own code is the meaning of a few elements, for which no
// library of C or C++ is packaged.
// Source: https://docs.openmicroscopy.org/ome-model/latest/ome-tiff/specification.html
// SPDX-License-Identifier: Apache-2.0
#include <expat.h>

#include <map>
#include <memory>
#include <type_traits>
#include <utility>

#include "ingest/header_text.h"
#include "ingest/stack_place.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace fs = std::filesystem;
namespace {

using Attributes = std::map<std::string, std::string>;
constexpr std::int64_t kMostPlanes = 1 << 20;

std::string get(const Attributes& attributes, const std::string& key, const std::string& otherwise = {}) {
  const auto found = attributes.find(key);
  return found == attributes.end() ? otherwise : found->second;
}

struct OmeXml {
  int images = 0;
  Attributes pixels;  // of the first image
  std::vector<std::string> channels;
  struct TiffData {
    Attributes attributes;
    std::string file;
  };
  std::vector<TiffData> data;
  bool metadataOnly = false;  // the voxels lie elsewhere
};

class OmeReader {
 public:
  OmeReader(const fs::path& path, const std::string& text) : path_(path) {
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(parser_.get(), onStart, nullptr);
    XML_SetStartDoctypeDeclHandler(parser_.get(), onDoctype);
    if (XML_Parse(parser_.get(), text.data(), static_cast<int>(text.size()), XML_TRUE) != XML_STATUS_OK)
      throw IoError(path_.string() + ": OME-XML: line " + std::to_string(XML_GetCurrentLineNumber(parser_.get())) +
                    ": expected XML, found: " + XML_ErrorString(XML_GetErrorCode(parser_.get())));
  }
  OmeXml take() { return std::move(xml_); }

 private:
  static void onStart(void* self, const XML_Char* name, const XML_Char** pairs) {
    Attributes attributes;
    for (; pairs[0]; pairs += 2) attributes[pairs[0]] = pairs[1];
    std::string local = name;  // "ome:Pixels" is the same element
    if (const std::size_t colon = local.find(':'); colon != local.npos) local.erase(0, colon + 1);
    static_cast<OmeReader*>(self)->start(local, std::move(attributes));
  }
  // OME-XML has none, and what it could declare may grow without bound.
  static void onDoctype(void* self, const XML_Char*, const XML_Char*, const XML_Char*, int) {
    XML_StopParser(static_cast<OmeReader*>(self)->parser_.get(), XML_FALSE);
  }

  void start(const std::string& name, Attributes attributes) {
    if (name == "Image") ++xml_.images;
    if (xml_.images > 1) return;
    if (name == "Pixels") xml_.pixels = std::move(attributes);
    if (name == "Channel") xml_.channels.push_back(get(attributes, "Name", get(attributes, "ID")));
    if (name == "TiffData" && std::ssize(xml_.data) < kMostPlanes) xml_.data.push_back({std::move(attributes), {}});
    if (name == "UUID" && !xml_.data.empty()) xml_.data.back().file = get(attributes, "FileName");
    if (name == "MetadataOnly" || name == "BinaryOnly") xml_.metadataOnly = true;
  }

  struct Free {
    void operator()(XML_Parser parser) const { XML_ParserFree(parser); }
  };
  fs::path path_;
  std::unique_ptr<std::remove_pointer_t<XML_Parser>, Free> parser_{XML_ParserCreate(nullptr)};
  OmeXml xml_;
};

class OmePlace {
 public:
  OmePlace(const fs::path& path, const SliceImages& images)
      : path_(path), images_(images), xml_(OmeReader(path, images.description).take()) {}

  StackPlace find() {
    place_.writer = "OME-XML";
    if (xml_.metadataOnly)
      failField(path_, "OME-XML", "the elements of the image", "a reference to another file (BinaryOnly)");
    if (xml_.images != 1) failField(path_, "OME-XML images", "1", std::to_string(xml_.images));
    sizeZ_ = size("SizeZ");
    refuseOthers();
    for (const auto& [key, found] : {std::pair{"SizeX", images_.width}, std::pair{"SizeY", images_.height}})
      if (size(key) != found)
        failField(path_, std::string("OME-XML ") + key, std::to_string(found) + " as the pages have",
                  get(xml_.pixels, key));
    findSlices();
    for (std::size_t axis = 0; axis < 3; ++axis) findSpacing(axis);
    return std::move(place_);
  }

 private:
  std::int64_t size(const std::string& key) const {
    const std::string text = get(xml_.pixels, key);
    const auto value = integer(trimmed(text));
    if (!value || *value < 1 || *value > 2147483647)
      failField(path_, "OME-XML " + key, "a number from 1 to 2147483647", text);
    return *value;
  }

  // Channels and times are no slices.
  void refuseOthers() const {
    if (const std::int64_t channels = size("SizeC"); channels > 1) {
      std::string names;
      for (const std::string& name : xml_.channels) names += (names.empty() ? "" : ", ") + name;
      failField(path_, "OME-XML SizeC, the number of channels", "1, a file for each channel",
                std::to_string(channels) + (names.empty() ? "" : ": " + names));
    }
    if (const std::int64_t times = size("SizeT"); times > 1)
      failField(path_, "OME-XML SizeT, the number of times", "1, a file for each time", std::to_string(times));
  }

  std::int64_t first(const Attributes& of, const std::string& key, std::int64_t otherwise) const {
    if (!of.contains(key)) return otherwise;
    const auto value = integer(trimmed(get(of, key)));
    if (!value || *value < 0 || *value > 2147483647)
      failField(path_, "OME-XML TiffData " + key, "a number from 0 to 2147483647", get(of, key));
    return *value;
  }

  void findSlices() {
    if (xml_.data.empty()) {
      if (sizeZ_ != images_.pages)
        failField(path_, "OME-XML SizeZ", std::to_string(images_.pages) + ", one for each page",
                  std::to_string(sizeZ_));
      return;
    }
    if (sizeZ_ > kMostPlanes) failField(path_, "OME-XML SizeZ", "at most a million", std::to_string(sizeZ_));
    std::vector<std::optional<SlicePage>> slices(static_cast<std::size_t>(sizeZ_));
    for (const OmeXml::TiffData& data : xml_.data) {
      const bool here = data.file.empty() || data.file == path_.filename().string();
      const std::int64_t z = first(data.attributes, "FirstZ", 0), page = first(data.attributes, "IFD", 0);
      const std::int64_t all = data.attributes.contains("IFD") ? 1 : here ? images_.pages : 1;
      const std::int64_t count = first(data.attributes, "PlaneCount", all);
      for (std::int64_t i = 0; i < count && z + i < sizeZ_; ++i)
        slices[static_cast<std::size_t>(z + i)] = SlicePage{here ? "" : data.file, page + i};
    }
    for (std::int64_t z = 0; z < sizeZ_; ++z) {
      const auto& slice = slices[static_cast<std::size_t>(z)];
      if (!slice) failField(path_, "OME-XML TiffData", "a page for each z", "none for z = " + std::to_string(z));
      if (slice->file.empty() && slice->page >= images_.pages)
        failField(path_, "OME-XML TiffData", "pages up to " + std::to_string(images_.pages),
                  std::to_string(slice->page + 1) + " for z = " + std::to_string(z));
      if (slice->file.find('/') != std::string::npos)
        failField(path_, "OME-XML FileName", "a file beside this one", slice->file);
      place_.slices.push_back(*slice);
    }
  }

  void findSpacing(std::size_t axis) {
    const std::string key = std::string("PhysicalSize") + "XYZ"[axis];
    if (!xml_.pixels.contains(key)) return;
    const std::string text = get(xml_.pixels, key);
    const auto value = number(trimmed(text));
    if (!value || !(*value > 0)) failField(path_, "OME-XML " + key, "a positive number", text);
    place_.spacing[axis] = *value;
    place_.unit[axis] = get(xml_.pixels, key + "Unit", "\u00b5m");
  }

  fs::path path_;
  const SliceImages& images_;
  OmeXml xml_;
  std::int64_t sizeZ_ = 1;
  StackPlace place_;
};

}  // namespace

StackPlace placeByOme(const fs::path& path, const SliceImages& images) { return OmePlace(path, images).find(); }

}  // namespace umbrick
