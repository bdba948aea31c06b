// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/base/temporary_folder.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "material/assets/build.h"

namespace weft::material {

/// What a channel of a made map holds at a pixel.
using PixelValue = std::function<double(int x, int y)>;

/// Numbers from 0 to 1 without a pattern.
double noise_at(int x, int y, int seed);

/// A folder as weft maps leaves one, of a tile of noise: albedo, normal, height, occlusion, roughness with
/// yarns.
struct MadeSet {
  Size size = {48, 32};
  double mm_per_pixel = 0.25;
  bool is_tile = true;
  int seed = 1;

  double albedo(int x, int y, int channel) const { return 0.1 + 0.8 * noise_at(x, y, seed + channel); }
  double slope(int x, int y, int axis) const { return noise_at(x, y, seed + 10 + axis) - 0.5; }
  double height(int x, int y) const { return 0.4 * noise_at(x, y, seed + 20) - 0.2; }
  double alpha(int x, int y) const { return 0.1 + 0.8 * noise_at(x, y, seed + 30); }
  void write(const std::filesystem::path& folder) const;
};

/// Materials in a folder of their own, and what is built of them.
class Bench {
 public:
  std::filesystem::path operator/(const std::string& name) const { return folder_.path() / name; }
  void put(const std::string& name, const std::string& text) const;
  /// With the line `schema` before the text.
  void material(const std::string& name, const std::string& text) const;
  Result<BuildReport> build(const std::vector<std::string>& names, const JobContext& context = {}) const;
  /// The same, which must do.
  BuildReport built(const std::vector<std::string>& names) const;
  /// The message with which it is refused; empty where it is not. Nothing may be built then.
  std::string refusal(const std::string& name, ErrorKind kind = ErrorKind::kBadData) const;

 private:
  TemporaryFolder folder_;

 public:
  bool draws = false;  ///< makes preview.png too
};

/// A map of a built material, by its name.
LoadedImage map_of(const BuiltMaterial& material, const std::string& name);

/// SHA-256 of every file below a folder, but for what only spares work.
std::map<std::string, std::string> digests_below(const std::filesystem::path& folder);

}  // namespace weft::material
