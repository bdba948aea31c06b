// SPDX-License-Identifier: Apache-2.0
// Reading scenes with their pictures: the one file of simulator/scene that reads images.
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "simulator/scene/scene_reader.h"

namespace weft::simulator {
namespace {

Result<Image<float>> planes_of(const std::filesystem::path& file) {
  Result<LoadedImage> image = read_image(file);
  if (!image) return std::move(image).error();
  return std::move(image->planes);
}

}  // namespace

Result<Scene> read_scene(const std::filesystem::path& file) {
  const Result<std::string> text = read_text(file, std::size_t{1} << 20);
  if (!text) return text.error();
  return parse_scene_and_pictures(*text, file.string(), planes_of);
}

}  // namespace weft::simulator
