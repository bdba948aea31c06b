// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/image/image.h"
#include "core/image_io/image_io.h"
#include "core/rig/lights.h"
#include "simulator/scene/scene.h"

namespace weft::test {

/// A file of the repository.
std::filesystem::path source_file(const std::string& path);

/// One of testdata/scenes at another size.
simulator::Scene scene_named(const std::string& name, Size size);

/// Simulates a scene into `folder`; throws where it cannot. In the folder that WEFT_SAMPLES names each scene
/// is made once, for all programs of a run; a picture is known by its name there.
void simulate(const simulator::Scene& scene, const std::filesystem::path& folder);

/// The same session with linear RGB images (".exr", ".tif") instead of raw frames: each a lit shot without
/// noise, quantised as `type` says; no dark shot.
void simulate_developed(const simulator::Scene& scene, const std::filesystem::path& folder,
                        const std::string& ending, SampleType type);

/// A twill on which a chrome ball lies, seen from so far; 160 x 120 mm.
simulator::Scene twill_with_ball(double distance_mm);

/// Photographs of a scene as somebody develops them, without a light file: shot02.exr and on as floats, or
/// shot02.png and on of 8 bits. The file `truth` gets the true normals (X, Y, Z).
void write_photographs(const simulator::Scene& scene, const std::filesystem::path& folder, SampleType type,
                       const std::filesystem::path& truth = {});

/// Photographs of waves of cloth, tilted up to 22 degrees, under distant lights.
struct PhotographSample {
  Size size = {40, 30};
  std::vector<DistantLight> lights = six_lights();
  std::string ending = ".exr";
  SampleType type = SampleType::kFloat;

  /// At 40 degrees from the zenith, each of another colour.
  static std::vector<DistantLight> six_lights();
  Vec3 normal_at(int x, int y) const;
  std::array<double, 3> albedo_at(int x, int y) const;

  /// Writes a folder in the layout of the DiLiGenT benchmark, with normal_gt.exr and albedo_gt.exr.
  void write(const std::filesystem::path& folder) const;
  /// "01.exr" for the first light.
  std::string name_of(std::size_t light) const;
};

/// Files a solve leaves whose bytes depend on nothing but its inputs and options.
inline const std::array<const char*, 5> kMaps = {"normal.exr", "albedo.exr", "sigma.exr", "residual.exr",
                                                 "status.png"};

}  // namespace weft::test
