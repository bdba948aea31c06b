// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/image.h"
#include "core/result.h"
#include "core/tiles.h"
#include "simulator/rig.h"
#include "simulator/scene.h"
#include "simulator/weave.h"

// A frame is the product of a list of passes built from the scene. A pass fills or changes the samples of one
// tile; an effect is a pass, or another pass in the place of the plain one, and costs nothing where it is not
// named.

namespace weft::simulator {

/// What the passes of one tile hand on, pixel by pixel in rows of `rect`. Every value depends on the pixel's
/// place in the frame and on the shot, never on the tile.
struct Tile {
  Rect rect;    ///< pixels of the frame
  int led = 0;  ///< LED of the shot, from 1; 0 is the dark shot

  std::vector<Vec3> point_mm;  ///< rig frame
  std::vector<SurfacePoint> surface;
  std::vector<Rgb> albedo;
  std::vector<Rgb> signal;      ///< light by channel, 1 is full scale
  std::vector<double> samples;  ///< what photosites see: one a pixel, or three (R, G, B)
  std::vector<std::uint16_t> counts;

  void resize(Rect tile);
  /// body(i, x, y) for every pixel: its index here and its place in the frame.
  template <typename Body>
  void for_each_pixel(const Body& body) const {
    std::size_t i = 0;
    for (int y = rect.y0; y < rect.y1; ++y) {
      for (int x = rect.x0; x < rect.x1; ++x) body(i++, x, y);
    }
  }
};

/// What a pass works on: once a tile, whatever the light, or again for each shot.
enum class Stage { kSurface, kShot };

struct Pass {
  std::string name;
  std::string does;  ///< one sentence for `weft simulate --explain`
  Stage stage = Stage::kSurface;
  std::function<void(Tile&)> run;
};

/// An effect that has no pass.
struct LeftOut {
  std::string name;
  std::string why;
};

struct PassList {
  std::vector<Pass> passes;  ///< in the order they run; all of kSurface before those of kShot
  std::vector<LeftOut> left_out;
};

/// What comes out of the sensor: counts of a mosaic, or the linear RGB that a camera without mosaic and
/// converter would see.
enum class Output { kCounts, kRgb };

/// `scene` and `rig` are copied into the passes.
PassList build_passes(const Scene& scene, const Rig& rig, Output output);

/// What a pass cost, summed over threads.
struct PassCost {
  std::string name;
  std::string does;
  double seconds = 0;
  std::int64_t pixels = 0;
};

/// Runs a list of passes over tiles and keeps account of the time of each.
class PassRunner {
 public:
  PassRunner(PassList list, const TileOptions& options);

  /// For every tile of `area`, several at once: the surface passes, `with_surface`, and then for each LED
  /// number of `leds` (0: dark) the shot passes and `with_shot`.
  Result<void> run(Rect area, std::span<const int> leds, std::stop_token stop,
                   const std::function<void(const Tile&)>& with_surface,
                   const std::function<void(const Tile&)>& with_shot);

  std::vector<PassCost> costs() const;
  const std::vector<LeftOut>& left_out() const { return list_.left_out; }

 private:
  struct Worker {
    Tile tile;
    std::vector<std::chrono::nanoseconds> spent;  ///< by pass
    std::vector<std::int64_t> pixels;
  };
  void run_stage(Stage stage, Worker& worker) const;

  PassList list_;
  TileOptions options_;
  std::vector<Worker> workers_;
};

}  // namespace weft::simulator
