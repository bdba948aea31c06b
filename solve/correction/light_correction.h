// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "core/base/result.h"
#include "core/image/image.h"
#include "solve/correction/light_strengths.h"
#include "solve/photographs/photographs.h"
#include "solve/photographs/tile_reader.h"
#include "solver/transport/light_directions.h"
#include "solver/transport/relief.h"

namespace weft::solve {

/// A solved frame as far as light over it depends on it.
struct SolvedFrame {
  Image<float> normal;  ///< X, Y, Z by the axes of the picture (solve/photographs/picture_axes.h)
  Image<float> albedo;  ///< of a mosaic each photosite's own colour, else R, G, B
};

/// Which effects of the cloth on its own light are taken out of readings.
struct LightStages {
  bool shadows = false;
  bool interreflection = false;
  double albedo_scale = 1;  ///< absolute albedo over the solved one: a bounce goes with both

  bool any() const { return shadows || interreflection; }
};

struct LightCorrectionOptions {
  LightStages stages;
  int directions = 12;  ///< in which a pixel looks for light from the cloth
  int steps = 16;       ///< as of solver::SliceSettings
  int reach_px = 64;    ///< how far it looks
};

/// Readings as a convex cloth without shadows would give them. With the relief of a frame that is solved
/// already, light that the cloth hides from a pixel is marked as shadow (-infinity), and the light that
/// reaches the pixel from the cloth, absolute albedo times gather_by_slices() (solver/transport/slices.h),
/// is subtracted.
///
/// Works in slabs of rows, so that memory does not grow with the height of the frame: about (K P + 1) * 4
/// bytes for each of kSlabRows * width pixels, and heights around a block a thread. Bytes depend on neither
/// threads nor tiles.
class LightCorrection {
 public:
  static constexpr int kSlabRows = 256;

  /// All arguments must outlive this. `relief` is the height of the frame.
  LightCorrection(const Photographs& photographs, const SolvedFrame& solved, const solver::Relief& relief,
                  const LightCorrectionOptions& options, int threads);

  /// Traces light for these rows, and for those of the slab that follow. Rows of the last slab are there.
  Result<void> prepare(Rect rows);
  /// Traces light for these tiles alone, all inside `rows`: what samples take of a frame. They begin on
  /// multiples of kRowGroup.
  Result<void> prepare_only(Rect rows, std::span<const Rect> tiles);
  /// From now on only these of the stages that are traced correct readings.
  void apply_only(const LightStages& stages) { applied_ = stages; }
  /// Corrects readings [k * planes + p] of a tile inside the prepared rows: subtract_bounces(), then
  /// mark_shadows(). From many threads.
  void apply(Rect tile, std::span<const View<float>> readings) const;
  void subtract_bounces(Rect tile, std::span<const View<float>> readings) const;
  void mark_shadows(Rect tile, std::span<const View<float>> readings) const;

  bool shadow_reach_is_capped() const { return shadow_reach_.is_capped; }
  double seconds() const { return seconds_; }  ///< wall time of tracing

 private:
  struct Worker;
  Result<void> trace();
  Result<void> trace_block(Rect block, Worker& worker);
  std::vector<Rect> tiles_in(Rect block) const;
  Result<void> find_shadows(Rect tile, const solver::Normals& normals);
  Result<void> gather_bounces(Rect tile, const solver::Normals& normals, Worker& worker);
  void read_radiosity(Rect area, Worker& worker) const;
  void read_radiosity_row(Rect tile, int y, std::span<const View<const float>> readings,
                          Worker& worker) const;
  template <typename Use>
  void for_each_color(int plane, int y, int x0, int x1, const Use& use) const;
  Rect in_slab(Rect tile) const { return {tile.x0, tile.y0 - slab_.y0, tile.x1, tile.y1 - slab_.y0}; }
  bool sees(int x, int y, std::size_t k) const;

  const Photographs* photographs_;
  const SolvedFrame* solved_;
  const solver::Relief* relief_;
  Planes planes_;
  LightCorrectionOptions options_;
  LightStages applied_;
  int threads_;
  LightStrengths strengths_;
  solver::LightDirections directions_;
  solver::ShadowReach shadow_reach_;
  double seconds_ = 0;
  Rect slab_;
  std::vector<Rect> tiles_;       ///< of the slab that are traced; empty: all of it
  Image<float> arriving_;         ///< [k * planes + p] of the slab
  Image<std::uint32_t> visible_;  ///< words of bits, of the slab
};

}  // namespace weft::solve
