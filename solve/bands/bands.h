// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/job_context.h"
#include "core/base/result.h"
#include "core/image/image.h"
#include "core/image/tiles.h"
#include "solve/photographs/photographs.h"
#include "solver/left_out/block_choice.h"
#include "solver/method.h"
#include "solver/uncertainty/block_facts.h"
#include "solver/uncertainty/model_sigma.h"

namespace weft::solve {

class LightCorrection;

/// Rows of maps as they leave the solver, top to bottom. Where mosaics are solved, albedo and sigma lag
/// behind the rest by the rows that demosaicing looks ahead; all end at the last row.
struct MapBand {
  Rect rows;  ///< of normal, residual, status: full width
  std::array<View<const float>, 3> normal;
  View<const float> residual;
  View<const std::uint16_t> status;

  Rect albedo_rows;  ///< of all that follows; may be empty
  std::array<View<const float>, 3> albedo;
  std::array<View<const float>, 3> sigma_albedo;  ///< by noise
  View<const float> sigma_normal_deg;             ///< by noise
  std::array<View<const float>, 3> model_albedo;  ///< sigma by the model, where it was asked for
  View<const float> model_normal_deg;
};

/// Whole rows, as few of them as leave the readings of ten lights in a core's second cache: frames are then
/// read from memory in long runs.
inline constexpr TileOptions kSolveTile = {.width = 8192, .height = 4};

/// Called in order, from one thread at a time, while the next band is being solved.
using BandSink = std::function<Result<void>(const MapBand&)>;

struct BandOptions {
  LightCorrection* correction = nullptr;              ///< readings go through it, if there is one
  solver::SolveTally* tally = nullptr;                ///< added to, if there is one
  std::optional<solver::ModelTraits> model = {};      ///< of a solve whose sigma has the model's part
  const solver::BlockChoice* robust = nullptr;        ///< where the method is the level robust, for that part
  std::vector<solver::BlockFacts>* blocks = nullptr;  ///< gets what blocks of 64 x 64 show of it, row by row
};

/// Solves photographs band by band: memory stays at a few hundred rows of maps whatever the size of the
/// image. The bytes that reach the sink depend on neither `tile` nor threads. Returns seconds that solving
/// had to wait for the sink.
Result<double> solve_bands(const Photographs& photographs, const solver::Method& method,
                           const TileOptions& tile, const JobContext& context, const BandSink& sink,
                           const BandOptions& options = {});

}  // namespace weft::solve
