// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/json_document.h"
#include "exchange/image_kind.h"
#include "tests/exchange/export_checks.h"

namespace weft::exchange {

namespace {

Error unlike_glb(const std::string& where, const std::string& why) {
  return {ErrorKind::kBadData, "the .glb is not as glTF 2.0 asks", where, why,
          "write it again with weft export"};
}

std::uint64_t word_at(std::string_view bytes, std::size_t at) {
  std::uint64_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// A whole number that is not negative, or `otherwise`.
std::size_t count_in(const Json& object, const char* key, std::size_t otherwise) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number_unsigned()) return otherwise;
  return found->get<std::size_t>();
}

constexpr std::size_t kNone = ~std::size_t{0};

/// The objects of the list under `key`; none where it is no list.
std::vector<Json> objects_of(const Json& asset, const char* key) {
  std::vector<Json> objects;
  if (const auto found = asset.find(key); found != asset.end() && found->is_array()) {
    for (const Json& each : *found) objects.push_back(each.is_object() ? each : Json::object());
  }
  return objects;
}

std::size_t components_of(const std::string& type) {
  if (type == "SCALAR") return 1;
  if (type.size() == 4 && type.starts_with("VEC") && type[3] >= '2' && type[3] <= '4') {
    return static_cast<std::size_t>(type[3] - '0');
  }
  return 0;
}

std::size_t bytes_of_component(std::size_t type) {
  if (type == 5120 || type == 5121) return 1;
  if (type == 5122 || type == 5123) return 2;
  return type == 5125 || type == 5126 ? 4 : 0;
}

struct Range {
  std::size_t begin = 0, length = 0;
};

class GlbChecker {
 public:
  GlbChecker(const Json& asset, std::string_view binary) : asset_(asset), binary_(binary) {}

  Result<void> check() {
    const auto meta = asset_.find("asset");
    if (meta == asset_.end() || !meta->is_object() || meta->value("version", Json()) != "2.0") {
      return unlike_glb("/asset/version", "it is not 2.0");
    }
    if (auto views = check_views(); !views) return views;
    for (const auto part :
         {&GlbChecker::check_accessors, &GlbChecker::check_images, &GlbChecker::check_textures}) {
      if (auto done = (this->*part)(); !done) return done;
    }
    return check_references(asset_, "");
  }

 private:
  Result<void> check_views() {
    const auto buffers = objects_of(asset_, "buffers");
    if (buffers.size() != 1) return unlike_glb("/buffers", "there is not one");
    const std::size_t length = count_in(buffers[0], "byteLength", kNone);
    if (length > binary_.size() || binary_.size() - length > 3) {
      return unlike_glb("/buffers/0/byteLength", "it is not that of the binary chunk");
    }
    std::size_t index = 0;
    for (const Json& view : objects_of(asset_, "bufferViews")) {
      const std::string where = "/bufferViews/" + std::to_string(index++);
      const Range range = {count_in(view, "byteOffset", 0), count_in(view, "byteLength", kNone)};
      if (range.begin > length || range.length > length - range.begin || range.length == 0) {
        return unlike_glb(where, "it reaches out of the buffer");
      }
      const std::size_t before = views_.empty() ? 0 : views_.back().begin + views_.back().length;
      if (range.begin < before || range.begin % 4 != 0) {
        return unlike_glb(where, "it overlaps the one before, or does not begin at a multiple of 4");
      }
      views_.push_back(range);
    }
    return {};
  }

  Result<void> check_accessors() const {
    std::size_t index = 0;
    for (const Json& accessor : objects_of(asset_, "accessors")) {
      const std::string where = "/accessors/" + std::to_string(index++);
      const std::size_t view = count_in(accessor, "bufferView", kNone);
      if (view >= views_.size()) return unlike_glb(where, "its bufferView is not there");
      const std::size_t component = bytes_of_component(count_in(accessor, "componentType", 0));
      const Json type = accessor.value("type", Json());
      const std::size_t each = component * (type.is_string() ? components_of(type.get<std::string>()) : 0);
      const std::size_t offset = count_in(accessor, "byteOffset", 0);
      const std::size_t room = views_[view].length - std::min(offset, views_[view].length);
      const std::size_t count = count_in(accessor, "count", 0);
      if (each == 0 || count == 0) return unlike_glb(where, "its type, componentType or count is none");
      if (offset % component != 0 || count > room / each) {
        return unlike_glb(where, "it is not aligned, or reaches out of its view");
      }
    }
    return {};
  }

  Result<void> check_images() const {
    std::size_t index = 0;
    for (const Json& image : objects_of(asset_, "images")) {
      const std::string where = "/images/" + std::to_string(index++);
      const std::size_t view = count_in(image, "bufferView", kNone);
      if (view >= views_.size()) return unlike_glb(where, "its bufferView is not there");
      const auto kind = kind_of_image(binary_.substr(views_[view].begin, views_[view].length));
      const Json type = image.value("mimeType", Json());
      const bool fits = (kind == ImageKind::kPng && type == "image/png") ||
                        (kind == ImageKind::kJpeg && type == "image/jpeg");
      if (!fits) return unlike_glb(where, "its bytes are not of its mimeType");
    }
    return {};
  }

  Result<void> check_textures() const {
    const std::size_t images = objects_of(asset_, "images").size();
    std::size_t index = 0;
    for (const Json& texture : objects_of(asset_, "textures")) {
      if (count_in(texture, "source", kNone) < images) {
        ++index;
        continue;
      }
      return unlike_glb("/textures/" + std::to_string(index), "its source is not there");
    }
    return {};
  }

  /// Everything named ...Texture points at a texture.
  Result<void> check_references(const Json& part, const std::string& where) const {
    if (!part.is_structured()) return {};
    if (where.size() > 1000) return unlike_glb(where.substr(0, 60), "it is nested too deeply");
    for (const auto& [key, value] : part.items()) {
      const std::string here = where + "/" + key;
      if (key.ends_with("Texture") && value.is_object() &&
          count_in(value, "index", kNone) >= objects_of(asset_, "textures").size()) {
        return unlike_glb(here, "its texture is not there");
      }
      if (auto below = check_references(value, here); !below) return below;
    }
    return {};
  }

  const Json& asset_;
  std::string_view binary_;
  std::vector<Range> views_;
};

}  // namespace

Result<void> check_glb(std::string_view bytes) {
  if (bytes.size() < 28 || !bytes.starts_with("glTF") || word_at(bytes, 4) != 2) {
    return unlike_glb("header", "it does not begin as binary glTF 2");
  }
  if (word_at(bytes, 8) != bytes.size()) return unlike_glb("header", "its length is not that of the file");
  const std::size_t text_bytes = word_at(bytes, 12);
  if (text_bytes % 4 != 0 || text_bytes > bytes.size() - 28 || bytes.substr(16, 4) != "JSON") {
    return unlike_glb("first chunk", "it is no JSON whose length is a multiple of 4");
  }
  const std::size_t second = 20 + text_bytes;
  const std::size_t binary_bytes = word_at(bytes, second);
  if (binary_bytes % 4 != 0 || binary_bytes != bytes.size() - second - 8 ||
      bytes.substr(second + 4, 4) != std::string_view("BIN\0", 4)) {
    return unlike_glb("second chunk", "it is no BIN that ends with the file at a multiple of 4");
  }
  const Json asset = Json::parse(bytes.substr(20, text_bytes), nullptr, false);
  if (!asset.is_object()) return unlike_glb("first chunk", "it is no JSON object");
  return GlbChecker(asset, bytes.substr(second + 8)).check();
}

}  // namespace weft::exchange
