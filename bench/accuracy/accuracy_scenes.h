// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/camera.h"
#include "simulator/scene/scene.h"
#include "solve/photographs/photographs.h"

// The cloths that accuracy is measured on: three families of plain weave in six materials, under the ten
// default LEDs, with near light, relief, cast shadows, two bounces of interreflection, sheen and the noise of
// the sensor at an exposure for white. Cast shadows are traced to points, so a LED is seen or not.

namespace weft::bench {

/// Methods may be tuned on the one, and are shown on the other. The sets share families and materials; seeds
/// differ, and so do the weaves: pitch 0.70 to 0.78 mm to tune on, 0.82 to 0.90 mm held out, with their own
/// crimp, flanks and twist.
enum class SceneSet { kTuning, kHeldOut };
const char* name_of(SceneSet set);

struct AccuracyScene {
  std::string name;      ///< "deep satin"
  std::string family;    ///< smooth, plain, deep
  std::string material;  ///< lambert, white, cotton, satin, velvet, dark-satin
  simulator::Scene scene;
  std::vector<Rect> patches;  ///< of the frame: one at the centre and, unless quick, one near a corner
};

/// All families in all materials. Each seed from 1 draws other weaves and other noise; those of the two sets
/// never meet. `quick` makes one small patch a scene.
std::vector<AccuracyScene> accuracy_scenes(SceneSet set, std::uint32_t seed, bool quick);

/// One patch of a scene as a picture of its own: what the product would hold of it, and the truth.
struct ClothPatch {
  solve::Photographs photographs;  ///< mosaics of counts and the dark shot, with the exact light field
  Image<float> readings;           ///< plane k: light k as the product reads it
  Image<float> visible;            ///< plane k: 1 where the point faces light k and sees it, else 0
  Image<float> normal;             ///< planes X, Y, Z
  Image<float> albedo;             ///< planes R, G, B: the diffuse part
  Image<float> openness;           ///< share of an even sky that the point sees; 1 without interreflection

  const LightField& field() const { return *photographs.field; }
  Size size() const { return photographs.size; }
  Rect area() const { return {0, 0, size().width, size().height}; }
  /// What is measured. Nearer to the patch's edge than kEdge a method that looks around sees no cloth where a
  /// whole picture has some.
  Rect measured() const { return {kEdge, kEdge, size().width - kEdge, size().height - kEdge}; }
  static constexpr int kEdge = 16;
};

Result<ClothPatch> render_patch(const simulator::Scene& scene, Rect area, int threads);

/// The same patch from fewer lights, numbered from 1; `patch` must outlive it, as it lends its dark shot.
Result<ClothPatch> with_lights(const ClothPatch& patch, const std::vector<int>& numbers);

/// The patches of a scene, several at once.
Result<std::vector<ClothPatch>> render_patches(const AccuracyScene& scene, int threads);

/// A rig and the cloth on it, with what is not as it should be.
struct ChainCase {
  std::string name;  ///< "plain, blur 0.4 px"
  simulator::Scene scene;
  /// Else its reflectance is unknown when lights are calibrated: albedo is relative.
  bool knows_paper = true;
};

/// The cases: weaves of the accuracy set, 12.5 pixels a yarn, over the rig of `rig` with its lens, its dark
/// corners and its uneven, bent sensor, and one thing more in each. `rig` is testdata/scenes/rig.toml, made
/// smaller: 0.8 megapixels of 200 mm. Other seeds draw other weaves and other noise. Errors: as read_scene.
Result<std::vector<ChainCase>> chain_cases(const std::filesystem::path& rig, std::uint32_t seed);

}  // namespace weft::bench
