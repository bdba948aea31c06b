// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "app/server/view/pyramid.h"
#include "core/base/result.h"
#include "core/image/image.h"

// A solved cloth as a wall of many shows it: a square of nothing but cloth, all under one light and at one
// scale.

namespace weft::app {

inline constexpr double kSwatchMm = 60;  ///< a side, where the cloth has as much
inline constexpr int kSwatchSide = 320;  ///< pixels at most

/// Maps, and what is known to lie in them beside the cloth.
struct SeenCloth {
  Size size;
  std::vector<Rect> beside = {};  ///< tags and white patches, pixels of the maps
  double mm_per_pixel = 0;        ///< 0: nobody knows, and the square is as large as the cloth
};

/// The square about the middle of what is solved that is as large as can be without a piece of what lies
/// beside, with at most a twentieth of it unsolved, and at most kSwatchMm a side; never below an eighth of
/// the smaller side of the maps. `sigma_deg` is their map of that name, or samples of it that are as far
/// apart everywhere: 180 and what is not a number is unsolved. Empty: all is solved.
Rect swatch_part(const SeenCloth& cloth, View<const float> sigma_deg);

/// Samples of a layer of one value, at most 256 a side, read by their rows alone. Errors of Pyramid::read().
Result<Image<float>> samples_of(Pyramid& layer);

/// That part of the maps as report::relit_picture() lights it, averaged to kSwatchSide or less. An albedo of
/// relative scale is brightened by report::display_scale() of the part. Errors of Pyramid::read().
Result<Image<float>> swatch_picture(Pyramid& normal, Pyramid& albedo, Rect part, bool is_relative);

/// The bytes of swatches, kept in a folder under a name of their content. The folder may be emptied at any
/// time. Safe from any thread.
class Swatches {
 public:
  /// Keeps the newest `most`, and at times a tenth more.
  explicit Swatches(std::filesystem::path folder, std::size_t most = 5000);

  /// JPEG; drawn now where it is not there. Errors of `draw`; one that cannot be kept is drawn again.
  Result<std::string> find_or(const std::string& content, const std::function<Result<Image<float>>()>& draw);

 private:
  void prune();

  const std::filesystem::path folder_;
  const std::size_t most_;
  std::size_t made_ = 0;  ///< since it was pruned
  std::mutex mutex_;
};

}  // namespace weft::app
