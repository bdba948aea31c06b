// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "solver/reflectance/lobe_by_lights.h"
#include "solver/reflectance/lobe_fit.h"
#include "solver/reflectance/lobe_parts.h"

namespace weft::solver {

/// Why a lobe is not called measured.
enum class LobeRefusal {
  kNone,
  kTooFewPixels,  ///< fewer than kLeastLobePixels with kLeastLobeReadings
  kLambertFits,   ///< nothing is left to explain by a lobe
  kNothingFits,   ///< no family explains the readings
  kStrength,      ///< f0 is none that a cloth has (has_strength_of_cloth)
  kTooBroad,      ///< as broad as shading itself
  kBentDiffuse,   ///< a diffuse part that departs from Lambert's law explains them as well
  kTooNarrow,     ///< narrower than what is fitted
  kUncertain,     ///< lobes of other roughness or strength explain the readings as well
};
const char* name_of(LobeRefusal refusal);

/// One family as it was fitted.
struct LobeCandidate {
  Lobe lobe;  ///< with its bend, where that was fitted
  double chi2 = 0;
};

/// One reading against the lobe: its diffuse part, Fresnel's share and shadowing are taken off.
struct LobePoint {
  double half_deg = 0;  ///< equal_angle()
  double reading = 0;   ///< over the lobe's peak
  double lobe = 0;      ///< relative_facets()
};

/// What the channels say of f0, each for itself.
struct LobeTint {
  std::array<double, 3> f0 = {}, sigma = {};            ///< of red, green and blue
  std::array<double, 3> tint = {}, sigma_of_tint = {};  ///< over their weighted mean, as Lobe::tint
};

struct MeasuredLobe {
  LobeRefusal refusal = LobeRefusal::kTooFewPixels;
  Lobe lobe;    ///< Lambert's where it is refused
  LobeFit fit;  ///< of `lobe`; empty where it is refused
  double sigma_alpha = 0, sigma_f0 = 0, sigma_along = 0, sigma_axis = 0;  ///< alpha: relative; axis: radians
  double sigma_broad = 0, sigma_share = 0;  ///< of two lobes: relative, and of the share
  /// Covariance of all of the parameters: the sigmas are the roots of its diagonal.
  LobeCovariance covariance = {};
  double correlation = 0;  ///< of log alpha and f0
  LobeByLights by_lights;  ///< what errors of the lights make of `lobe`
  /// Another family passes too and costs at most 5 percent more. Its values are in the sigmas.
  bool is_family_undecided = false;
  std::vector<LobeCandidate> candidates;
  std::vector<LobePoint> points;        ///< at most kMostLobePoints, where they tell more than noise
  double weft_share = 0;                ///< pixels whose yarn lies across the axis
  double median_albedo = 0;             ///< of the pixels, as `lobe` leaves it
  std::vector<LobePart> parts;          ///< of a frame of one material (solve::measure_gloss)
  std::array<double, 2> half_deg = {};  ///< angles of normals to half-vectors: 2nd and 98th percentile
  std::optional<LobeTint> tint;         ///< where `lobe` has one (solver/reflectance/lobe_tint.h)

  bool is_measured() const { return refusal == LobeRefusal::kNone; }
};

/// Below it a lobe is refused as kTooFewPixels.
inline constexpr std::size_t kLeastLobePixels = 300;
/// Fewer say little of a lobe once normal and albedo are taken from them.
inline constexpr int kLeastLobeReadings = 6;
/// What a plot of a lobe shows.
inline constexpr std::size_t kMostLobePoints = 400;
/// A Lambert fit up to this chi2 leaves nothing for a lobe.
inline constexpr double kLambertFitsTo = 1.5;
/// A lobe's chi2 is at most this, or at most kLeastWon of Lambert's.
inline constexpr double kLobeFitsTo = 1.5, kLeastWon = 0.15;
/// What the lobe of a cloth may be; one outside is refused.
inline constexpr double kLeastF0 = 0.015, kMostF0 = 0.15, kLeastAlpha = 0.025, kMostAlpha = 0.85;
/// Where the scale of the albedo is relative f0 is held against the albedo: some cloth from this dark to this
/// bright has both.
inline constexpr double kDarkestCloth = 0.02, kBrightestCloth = 0.8;
bool has_strength_of_cloth(double f0, double median_albedo, AlbedoScale scale);
/// Sigmas of a measured lobe, as shares of alpha and f0, before those of the lights are added.
inline constexpr double kMostSigmaAlpha = 0.2, kMostSigmaF0 = 0.25;
/// With and without a bend of the diffuse part, alpha and f0 agree to this (f0: share of itself).
inline constexpr double kAlphaAgrees = 0.05, kF0Agrees = 0.25;
/// How much brighter or darker a LED may be than calibrated, a share: it counts in every sigma.
inline constexpr double kLightDrift = 0.005;
/// A yarn's lobe that is rounder than this is GGX.
inline constexpr double kMostAlong = 0.9;
/// What another family must cost less to be preferred to GGX: it has more to turn, or is rarer. Two lobes:
/// less than the cheapest of one.
inline constexpr double kOtherWins = 0.10, kYarnWins = 0.15, kBendWins = 0.10, kTwoWin = 0.04;
/// Two lobes are two where each has so many of the facets and the broad one is so many times as rough; sigma
/// of the share is at most such a part of the lesser one.
inline constexpr double kLeastShare = 0.1, kLeastBroader = 1.5, kMostSigmaShare = 0.25;

/// The lobe that the pixels share, if they tell one. `start`: b by pixel, as a solve by Lambert's law left
/// it. All families are fitted in turn, each from several roughnesses, each pixel from several normals:
/// of dark cloth a pixel has two valleys, dark and mirroring or bright and tilted. Where Lambert's law fits
/// no other is tried.
/// `tint` is held: Lobe::tint.
MeasuredLobe measure_lobe(const LobeSamples& samples, const std::vector<Vec3>& start, int threads,
                          const std::array<double, 3>& tint = {1, 1, 1});

/// Whether nothing explains the readings, and a family that was tried mirrors as no fibre does: metal is
/// among them, of which a lobe over a diffuse part tells nothing.
bool is_like_metal(const MeasuredLobe& measured);
inline constexpr double kLeastF0OfMetal = 0.15;

/// Two lobes in every point, where they save clearly more than what `one` has tried and both are told; `one`
/// is what measure_lobe() made of the same pixels.
std::optional<MeasuredLobe> measure_two_lobes(const LobeSamples& samples, const std::vector<Vec3>& start,
                                              const MeasuredLobe& one, int threads);

/// Sigmas with those that errors of the lights make, whose covariance is in the order of LobeByLights.
void add_light_errors(std::span<const double> covariance, MeasuredLobe& measured);

/// Where else a pixel may begin, most promising first: facing where its brightest light is mirrored, level
/// with the median albedo and with its darkest reading, and facing where its two and its three brightest
/// lights are mirrored.
inline constexpr std::size_t kOtherStarts = 5;
std::array<Vec3, kOtherStarts> other_starts(std::span<const LobeReading> readings, double median_albedo);

/// Fits every pixel from its other starts too, with both yarns where the family has them; what costs less
/// takes its place. `fit` has a cost by pixel.
void try_other_starts(const LobeSamples& samples, int threads, LobeFit& fit);
/// Every pixel with both yarns where the family has them, from where it is: the cheaper.
LobeFit with_better_yarns(const LobeSamples& samples, LobeFit fit, int threads);

}  // namespace weft::solver
