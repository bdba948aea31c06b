// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/base/study.h"
#include "core/base/result.h"
#include "core/base/vec.h"

namespace weft::bench {

struct PhotosOptions {
  std::filesystem::path folder;      ///< DiLiGenT layout (solve/input/photo_input.h) with normal_gt.exr
  int pick = 10;                     ///< lights a subset; 0: all
  int subsets = 20;                  ///< of so many lights each
  std::uint32_t seed = 1;            ///< of the subsets
  std::vector<std::string> methods;  ///< empty: all
  int threads = 0;
};

/// Real photographs, solved from subsets of their lights: for each method the mean angle to the true normal
/// inside the mask, as mean, standard deviation, least and most over the subsets, and the time. kBadData
/// where the truth has another size or more lights are asked for than there are; kNoInput without truth.
Result<Rows> photos_table(const PhotosOptions& options);

/// `count` well-spread lights, numbered from 1: a first one, and then always the one farthest, in angle, from
/// all that are chosen (Gonzalez 1985); of equals the lower number.
std::vector<int> spread_lights(std::span<const Vec3> directions, int count, int first);

/// First lights of subsets: the numbers from 1 to `lights` in random order, over and over.
std::vector<int> first_lights(int lights, int subsets, std::uint32_t seed);

}  // namespace weft::bench
