// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/image/color_spaces.h"
#include "core/image/image.h"
#include "core/image/tiles.h"
#include "simulator/camera/defects.h"
#include "simulator/geometry/surface_point.h"
#include "simulator/light/incidence.h"

// A frame is the product of a list of passes built from the scene. A pass fills or changes the samples of one
// tile; an effect is a pass, or another pass in the place of the plain one, and costs nothing where it is not
// named.

namespace weft::simulator {

struct Transport;

/// What Tile::target says of the cloth.
inline constexpr int kCloth = -1;
/// And of the blade.
inline constexpr int kBlade = -2;

/// What the passes of one tile hand on. Every value depends on the pixel's place in the frame and on the
/// shot, never on the tile. Each array covers one rectangle of the frame, row by row.
struct PassTile {
  Rect rect;     ///< the pixels that are asked for
  Rect area;     ///< `rect` and the halo that shadows, bounces and blur look into
  int shot = 0;  ///< number of the shot (PassRunner::run)
  int take = 0;  ///< the same counted on from session to session: all that is drawn by chance depends on it
  int led = 0;   ///< LED of the shot, from 1; 0 is the dark shot
  std::vector<int> lit_together;  ///< PassList::lit_together

  // On `area`, once a tile.
  std::vector<Vec3> point_mm;            ///< rig frame
  std::vector<SurfacePoint> surface;     ///< geometry of the cloth
  std::vector<Rgb> albedo;               ///< as the camera's filters see it
  std::vector<int> target;               ///< number of the target that covers the cloth there, from 0, kCloth
                                         ///< or kBlade; empty where nothing covers any
  std::shared_ptr<Transport> transport;  ///< the mesh and what passes keep with it; none where nothing asks
  std::vector<double> openness;  ///< share of an even sky that each point sees; empty where nothing asks

  // On `area`, each shot.
  std::vector<Incidence> light;    ///< from the LED of the shot
  std::vector<double> irradiance;  ///< strength times cosine, what shadows leave of it
  std::vector<float> visibility;   ///< share of the LED that each point sees; empty where nothing asks
  std::vector<Rgb> indirect;       ///< irradiance by way of the cloth; empty where nothing asks
  std::vector<Rgb> signal;         ///< light by channel, 1 is full scale
  Rect signal_rect;                ///< of `signal`: blur shrinks it

  std::vector<double> samples;              ///< what photosites see: one a pixel, or three (R, G, B)
  Rect sample_rect;                         ///< of `samples`
  std::vector<PhotositeDefect> photosites;  ///< what they are, on `sample_rect`; empty where all are alike
  std::vector<std::uint16_t> counts;        ///< on `rect`

  std::optional<Error> failure;  ///< of a pass that could not do its work; the run ends with it

  void resize(Rect tile, int halo);
};

inline Rect grown(Rect r, int by) {
  return {r.x0 - by, r.y0 - by, r.x1 + by, r.y1 + by};
}

/// Index in an array over `rect` of a pixel of the frame.
inline std::size_t index_in(Rect rect, int x, int y) {
  return static_cast<std::size_t>(y - rect.y0) * static_cast<std::size_t>(rect.width()) +
         static_cast<std::size_t>(x - rect.x0);
}

/// body(i, x, y) for every pixel of `rect`: its index in an array over `rect` and its place in the frame.
template <typename Body>
void for_each_pixel(Rect rect, const Body& body) {
  std::size_t i = 0;
  for (int y = rect.y0; y < rect.y1; ++y) {
    for (int x = rect.x0; x < rect.x1; ++x) body(i++, x, y);
  }
}

/// When a pass runs: once a tile, whatever the light; for each LED of each shot, to where its light leaves
/// the cloth, which is then summed; once a shot.
enum class PassStage { kSurface, kLight, kShot };

/// One step of rendering.
struct Pass {
  std::string name;
  std::string does;  ///< one sentence for `weft simulate --explain`
  PassStage stage = PassStage::kSurface;
  std::function<void(PassTile&)> run;
  std::string effect = {};  ///< key of the effect that called for it; empty for what every scene needs
};

/// An effect that has no pass.
struct LeftOutEffect {
  std::string name;
  std::string why;
  double bound_sigma = 0;  ///< what it would change at most, in sigma of the noise; 0 where nobody asked
};

/// All steps of a frame, and what they need around it.
struct PassList {
  std::vector<Pass> passes;       ///< in the order they run and of PassStage
  int halo = 0;                   ///< pixels around a tile that the passes need
  int leds = 0;                   ///< of the rig
  bool cloth_moves = false;       ///< the surface is another one for each shot
  std::vector<int> lit_together;  ///< LEDs of every shot, whatever its number; empty: the one of its number
  int takes_before = 0;           ///< Tile::take of shot 0
};

/// What a pass cost, summed over threads.
struct PassCost {
  std::string name;
  std::string does;
  std::string effect;
  double seconds = 0;
  std::int64_t pixels = 0;
};

/// Rows of a session's frames that are run at a time; the taller where tiles have a halo, which costs less
/// the larger they are.
inline constexpr int kBandRows = 128, kTallBandRows = 256;

/// Runs a list of passes over tiles and keeps account of the time of each.
class PassRunner {
 public:
  /// Tiles are made as high as the halo asks for, so that it costs less than the tile: `options` change no
  /// byte.
  PassRunner(PassList list, TileOptions options);

  /// For every tile of `area`, several at once: the surface passes, `with_surface`, and then for each number
  /// of `shots` the shot passes and `with_shot`. Shot 0 is dark, shots 1 to n are those of the n LEDs, n + 1
  /// to 2 n light the LEDs again, and so on.
  Result<void> run(Rect area, std::span<const int> shots, std::stop_token stop,
                   const std::function<void(const PassTile&)>& with_surface,
                   const std::function<void(const PassTile&)>& with_shot);

  std::vector<PassCost> costs() const;

  /// Pixels of `area` as run() works on them, each tile with its halo.
  std::int64_t pixels_with_halos(Rect area) const;

 private:
  struct Worker {
    PassTile tile;
    std::vector<std::chrono::nanoseconds> spent;  ///< by pass
    std::vector<std::int64_t> pixels;
    std::vector<Rgb> sum;  ///< signal of the LEDs so far, where several are lit
  };
  void run_stage(PassStage stage, Worker& worker) const;
  void light(Worker& worker) const;

  PassList list_;
  TileOptions options_;
  std::vector<Worker> workers_;
};

}  // namespace weft::simulator
