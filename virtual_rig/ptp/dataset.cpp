// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/dataset.h"

#include <cstddef>

#include "virtual_rig/ptp/codes.h"

namespace weft::virtual_rig::ptp {
namespace {

constexpr std::size_t kLongestString = 254;

}  // namespace

void put_string(ByteWriter& writer, std::string_view text) {
  text = text.substr(0, kLongestString);
  writer.put(static_cast<std::uint8_t>(text.empty() ? 0 : text.size() + 1));
  if (text.empty()) return;
  for (const char c : text) writer.put(static_cast<std::uint16_t>(static_cast<unsigned char>(c)));
  writer.put(std::uint16_t{0});
}

std::optional<std::string> get_string(ByteReader& reader) {
  const auto count = reader.get<std::uint8_t>();
  if (!count) return std::nullopt;
  std::string text;
  for (int i = 0; i < *count; ++i) {
    const auto character = reader.get<std::uint16_t>();
    const bool last = i + 1 == *count;
    if (!character || *character > 0x7f || (*character == 0) != last) return std::nullopt;
    if (!last) text.push_back(static_cast<char>(*character));
  }
  return text;
}

Bytes device_info(const DeviceFacts& facts) {
  ByteWriter writer;
  writer.put(std::uint16_t{100}).put(std::uint32_t{kNikonVendor}).put(std::uint16_t{100});
  put_string(writer, "microsoft.com: 1.0");
  writer.put(std::uint16_t{0});  // functional mode: standard
  writer.put_array(facts.operations).put_array(facts.events).put_array(facts.properties);
  writer.put_array(std::vector<std::uint16_t>{kExifJpeg, kUndefinedFormat});           // that it takes
  writer.put_array(std::vector<std::uint16_t>{kExifJpeg, kUndefinedFormat, kFolder});  // that it shows
  put_string(writer, "Nikon Corporation");
  put_string(writer, facts.model);
  put_string(writer, "V1.01");
  put_string(writer, facts.serial);
  return writer.take();
}

Bytes object_info(const ObjectFacts& facts) {
  const bool picture = facts.format != kFolder;
  const auto of_picture = [picture](int number) { return static_cast<std::uint32_t>(picture ? number : 0); };
  ByteWriter writer;
  writer.put(facts.storage).put(facts.format).put(std::uint16_t{0}).put(facts.bytes);
  // A picture without a thumbnail is one that libgphoto2 refuses to fetch from a card.
  writer.put(static_cast<std::uint16_t>(picture ? kJfif : 0));
  writer.put(of_picture(1000)).put(of_picture(160)).put(of_picture(120));
  writer.put(of_picture(facts.size.width)).put(of_picture(facts.size.height)).put(of_picture(16));
  writer.put(facts.parent).put(static_cast<std::uint16_t>(picture ? 0 : 1));
  writer.put(std::uint32_t{0}).put(std::uint32_t{0});  // association, sequence number
  for (const std::string_view text : {facts.name, facts.date, facts.date, std::string()})
    put_string(writer, text);
  return writer.take();
}

Bytes storage_info() {
  constexpr std::uint16_t kRemovableRam = 4, kCameraFolders = 3, kReadWrite = 0;
  ByteWriter writer;
  writer.put(kRemovableRam).put(kCameraFolders).put(kReadWrite);
  writer.put(std::uint64_t{16} << 30).put(std::uint64_t{8} << 30).put(std::uint32_t{900});
  put_string(writer, "");
  put_string(writer, "CARD");
  return writer.take();
}

}  // namespace weft::virtual_rig::ptp
