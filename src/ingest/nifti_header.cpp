// SPDX-License-Identifier: Apache-2.0
#include "ingest/nifti_header.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <string_view>

#include "ingest/header_text.h"
#include "ingest/streams/packed_stream.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

constexpr std::size_t kBytes1 = 348, kBytes2 = 540;

// Numbers at byte offsets of the header.
class Fields {
 public:
  Fields(std::span<const std::byte> bytes, bool swap) : bytes_(bytes), swap_(swap) {}
  template <class T>
  T get(std::size_t at) const {
    std::array<std::byte, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + at, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  template <class T, class To, std::size_t count>
  void get(std::size_t at, std::array<To, count>& out) const {
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<To>(get<T>(at + i * sizeof(T)));
  }
  std::string text(std::size_t at, std::size_t size) const {
    const std::string_view all(reinterpret_cast<const char*>(bytes_.data()) + at, size);
    return std::string(all.substr(0, std::min(all.find('\0'), size)));
  }

 private:
  std::span<const std::byte> bytes_;
  bool swap_;
};

NiftiHeader version1(const Fields& fields) {
  NiftiHeader header;
  fields.get<std::int16_t>(40, header.dim);
  header.datatype = fields.get<std::int16_t>(70);
  fields.get<float>(76, header.pixdim);
  const float offset = fields.get<float>(108);
  header.voxOffset = offset >= 0 && offset < 0x1p62f ? static_cast<std::int64_t>(offset) : -1;
  header.description = fields.text(148, 80);
  const std::string magic = fields.text(344, 4);
  if (magic != "n+1" && magic != "ni1") return header;  // Analyze, which has other fields from here on
  header.kind = magic == "n+1" ? NiftiHeader::Kind::single : NiftiHeader::Kind::pair;
  header.intent = fields.get<std::int16_t>(68);
  header.slope = fields.get<float>(112);
  header.inter = fields.get<float>(116);
  header.spaceUnit = fields.get<std::uint8_t>(123) & 7;
  header.timeUnit = fields.get<std::uint8_t>(123) & 56;
  header.timeOffset = fields.get<float>(136);
  header.qformCode = fields.get<std::int16_t>(252);
  header.sformCode = fields.get<std::int16_t>(254);
  fields.get<float>(256, header.quatern);
  fields.get<float>(268, header.qoffset);
  fields.get<float>(280, header.srow);
  return header;
}

NiftiHeader version2(const Fields& fields) {
  NiftiHeader header;
  header.kind = fields.text(4, 4) == "n+2" ? NiftiHeader::Kind::single : NiftiHeader::Kind::pair;
  header.datatype = fields.get<std::int16_t>(12);
  fields.get<std::int64_t>(16, header.dim);
  fields.get<double>(104, header.pixdim);
  header.voxOffset = fields.get<std::int64_t>(168);
  header.intent = fields.get<std::int32_t>(504);
  header.slope = fields.get<double>(176);
  header.inter = fields.get<double>(184);
  header.description = fields.text(240, 80);
  header.qformCode = fields.get<std::int32_t>(344);
  header.sformCode = fields.get<std::int32_t>(348);
  fields.get<double>(352, header.quatern);
  fields.get<double>(376, header.qoffset);
  fields.get<double>(400, header.srow);
  header.spaceUnit = fields.get<std::int32_t>(500) & 7;
  header.timeUnit = fields.get<std::int32_t>(500) & 56;
  header.timeOffset = fields.get<double>(216);
  return header;
}

}  // namespace

NiftiHeader readNiftiHeader(const std::filesystem::path& path) {
  std::array<std::byte, kBytes2> bytes{};
  const std::size_t got = openPacked(path, packingOf(path))->read(bytes);
  for (const bool swap : {false, true}) {
    const Fields fields(bytes, swap);
    const auto size = got >= 4 ? static_cast<std::size_t>(fields.get<std::uint32_t>(0)) : 0;
    if (size != kBytes1 && size != kBytes2) continue;
    if (got < size)
      throw IoError(path.string() + ": header: expected " + std::to_string(size) + " bytes, found " +
                    std::to_string(got));
    const std::string magic = fields.text(4, 4);
    if (size == kBytes2 && magic != "n+2" && magic != "ni2") failField(path, "magic", "\"n+2\" or \"ni2\"", magic);
    NiftiHeader header = size == kBytes1 ? version1(fields) : version2(fields);
    const bool little = (std::endian::native == std::endian::little) != swap;
    header.endian = little ? std::endian::little : std::endian::big;
    return header;
  }
  throw IoError(path.string() +
                ": header: expected one of NIfTI-1, NIfTI-2 or Analyze 7.5, which begins with its size, "
                "348 or 540, found none");
}

}  // namespace umbrick
