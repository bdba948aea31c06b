// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include "capture/scan/light_fit.h"

// Which LED explains which frame, where nobody wrote it down.

namespace weft::capture {

/// Frames from which on an assignment is sought: four of one ring may be its mirror image as well.
inline constexpr std::size_t kFewestToAssign = 5;

/// The rows' columns, each at most once, of the least sum of costs (Kuhn 1955, Munkres 1957, by shortest
/// augmenting paths). `cost` has as many columns in every row, not fewer than rows; all of it is finite.
std::vector<std::size_t> least_cost_columns(const std::vector<std::vector<double>>& cost);

/// LEDs by frame, and how well they explain the frames.
struct LightAssignment {
  std::vector<int> leds;    ///< by frame, from 1, each at most once
  double misfit = 0;        ///< as PatchFit has it
  std::vector<int> second;  ///< the next best of those that were tried; empty: there is no other
  double second_misfit = 0;
  /// By frame: the least misfit of an assignment that gives it another LED, over `misfit`.
  std::vector<double> sure;

  /// Whether the second fits so much worse that this one can be believed.
  bool is_alone() const;
};

/// Whether `misfit` is so much less than `other` that the other can be left aside.
bool is_far_better(double misfit, double other);

/// How many times less than `other` a misfit is; misfits as small as rounding and noise count as one.
double times_better(double misfit, double other);

/// What the frames leave of their light under these LEDs.
double misfit_under(const std::vector<int>& leds, const std::vector<std::vector<double>>& light,
                    const PatchLights& model);

/// Seeks the LEDs of frames. `light` is glance_at() of each without its dark frame, `starts` are assignments
/// worth a look. It begins with them and with the assignment of least cost for a level cloth (each frame over
/// the mean of all, whose albedo cancels), and goes downhill by exchanges of two frames, by LEDs that no
/// frame has, and by turns and mirror images of the lights. Nothing where there are fewer than
/// kFewestToAssign frames, more frames than LEDs, or no light in them, and where it is stopped. A step down
/// takes about n^2 / 2 fits of n frames.
std::optional<LightAssignment> assign_by_light(const std::vector<std::vector<double>>& light,
                                               const PatchLights& model,
                                               const std::vector<std::vector<int>>& starts,
                                               const std::stop_token& stop = {});

}  // namespace weft::capture
