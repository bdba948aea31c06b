// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec.h"
#include "core/image/image.h"

// Cloths and things by plain formulas, drawn at random, and what a camera far above sees of them: a truth for
// what is said of photographs. It shares no code with the simulator's cloths and lights.

namespace weft::bench {

/// Numbers of a seed, one after another.
class Draws {
 public:
  explicit Draws(std::uint32_t seed) : seed_(seed) {}
  double between(double least, double most);
  /// Every ratio alike.
  double of_ratio(double least, double most);
  int below(int count);  ///< 0 to count - 1
  bool with(double chance) { return between(0, 1) < chance; }
  double normal();  ///< standard

 private:
  std::uint32_t seed_, drawn_ = 0;
};

enum class Shape { kWeave, kBumps, kFolds, kBall };

struct DrawnCloth {
  Shape shape = Shape::kWeave;
  Image<float> height_px, albedo;  ///< towards the camera; planes R, G, B
  Image<float> normal;             ///< x right, y up, z to the camera
  Image<float> inside;             ///< 1 where the thing is; 0 beside a ball
  double shine = 0, hardness = 1;  ///< a lobe after Phong: strength over the albedo, exponent
};

/// A relief with slopes of 0.1 to 0.5 rms, or a ball, and a pattern of colours, a quarter of them shining.
DrawnCloth draw_cloth(Size size, Draws& draws);

/// How a photograph is lit and taken.
struct DrawnLight {
  Vec3 direction;          ///< to the lamp, of unit length
  double strength = 1;     ///< of a white surface that faces it
  double distance_px = 0;  ///< from the middle of the picture; 0: far away
  double room = 0;         ///< light from all over the sky beside it
};

/// Linear light, R, G and B: Lambert's law with lobe, attached and cast shadows.
Image<float> seen(const DrawnCloth& cloth, const DrawnLight& light);

}  // namespace weft::bench
