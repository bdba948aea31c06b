// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/describe/fields.h"
#include "core/rig/albedo_scale.h"

// What reflectance.json says of a cloth's lobes (weft.reflectance/1.2).

namespace weft::solve {

/// A lobe as it was fitted; the numbers that its family has.
struct FittedLobe {
  std::string family = {};  ///< empty: none
  std::optional<double> alpha = {}, alpha_along = {}, axis_deg = {}, alpha_broad = {}, broad_share = {};
  std::optional<double> f0 = {}, bend = {};
};

struct LobeCandidateFacts {
  double chi2 = 0;
  FittedLobe lobe = {};
};

/// Standard deviations of what is measured.
struct LobeSigma {
  std::optional<double> alpha = {}, f0 = {}, alpha_along = {}, axis_deg = {}, alpha_broad = {},
                        broad_share = {}, f0_over_albedo = {};
  std::vector<double> tint = {}, f0_rgb = {};
};

/// What a quarter of the frame says of the roughness.
struct LobePartFacts {
  std::string part;  ///< "upper left"
  double alpha = 0, sigma = 0;
  std::int64_t pixels = 0;
};

struct TypedLobe {
  double alpha = 0, f0 = 0;
};

/// One material.
struct LobeCluster {
  bool is_observable = false;

  FittedLobe lobe = {};
  std::optional<double> weft_share = {}, f0_over_albedo = {};
  std::vector<double> tint = {}, f0_rgb = {};  ///< empty: highlights have no colour of their own
  LobeSigma sigma = {};
  double correlation = 0;  ///< of alpha and f0
  bool is_family_undecided = false;
  std::array<double, 2> half_deg = {};
  std::int64_t pixels = 0;
  double chi2 = 0;
  std::vector<std::array<double, 3>> points = {};  ///< degrees, reading, lobe
  std::vector<LobePartFacts> parts = {};
  std::string warning = {};

  std::string why = {}, remedy = {};  ///< of one that is not observable
  TypedLobe typed = {};

  std::string said = {};
  std::vector<LobeCandidateFacts> candidates = {};
};

struct ReflectanceFacts {
  std::string schema = "weft.reflectance/1.2";  ///< as a report quotes it
  AlbedoScale albedo_scale = AlbedoScale::kRelative;
  double share = 0;  ///< of the blocks that are solved with a lobe
  std::vector<LobeCluster> clusters = {};
  bool has_second_pose = false;
};
void describe(Fields& fields, ReflectanceFacts& facts);

/// What a report says of them in words.
struct GlossSaid {
  bool is_used = false;
  std::string says;
};
void describe(Fields& fields, GlossSaid& said);

}  // namespace weft::solve
