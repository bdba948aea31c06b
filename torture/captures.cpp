// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>
#include <cstdint>

#include "bench/oracles/oracle_rig.h"
#include "capture/scan/histogram.h"
#include "core/rig/radiometry.h"
#include "torture/hard_case.h"

namespace weft::torture {
namespace {

constexpr float kBlack = 600, kWhite = 15800;
constexpr std::array<double, 3> kBrackets_us = {1000, 4000, 16000};

RawFrame even_frame(Size size, double count) {
  RawFrame frame = {Image<std::uint16_t>(size), {}, {{{kBlack, kBlack}, {kBlack, kBlack}}}, kWhite, {}};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) frame.counts(x, y) = static_cast<std::uint16_t>(std::lround(count));
  }
  return frame;
}

/// What a sensor counts of so much light a second.
double counted(double light, double exposure_us) {
  return std::min<double>(kWhite, kBlack + light * exposure_us * 1e-6 * (kWhite - kBlack));
}

Image<float> readings_of(const RawFrame& frame, const RawFrame* dark, double exposure_us) {
  Image<float> out(frame.counts.size());
  Radiometry(frame, dark, {}, {exposure_us, 100})
      .read(frame.counts.plane(), {0, 0, out.width(), out.height()}, out.plane());
  return out;
}

HardCase brackets(const char* what, double light) {
  double plain = 0;
  std::vector<Image<float>> images;
  std::vector<View<const float>> views;
  for (const double exposure_us : kBrackets_us) {
    const double count = std::round(counted(light, exposure_us));
    plain += (count - kBlack) / (kWhite - kBlack) / (exposure_us * 1e-6) / kBrackets_us.size();
    images.push_back(readings_of(even_frame({2, 2}, count), nullptr, exposure_us));
  }
  for (const Image<float>& image : images) views.emplace_back(image.plane());
  Image<float> merged({2, 2});
  merge_exposures(views, std::vector<NoiseModel>(views.size(), {1e-3, 1e-6, 0}), merged.plane());
  HardCase hard = {.stage = "capture",
                   .what = what,
                   .unit = "% of the light",
                   .plain = 100 * std::abs(plain / light - 1),
                   .ours = 100 * std::abs(merged(0, 0) / light - 1),
                   .within = 0.01};  // half a count of 1824
  if (std::isinf(merged(0, 0))) {
    hard.ours.reset();
    hard.flag = "SATURATED";
  }
  return hard;
}

HardCase all_full() {
  HardCase hard = brackets("all of three exposures full", 2000);
  hard.must_say = "SATURATED";
  return hard;
}

HardCase darker_than_dark() {
  const RawFrame lit = even_frame({2, 2}, 598), dark = even_frame({2, 2}, 603);
  const double truth = -5 / (kWhite - kBlack);
  const auto plain = static_cast<std::uint16_t>(lit.counts(0, 0) - dark.counts(0, 0));
  return {.stage = "capture",
          .what = "a dark shot brighter than the lit one",
          .unit = "% of white",
          .plain = 100 * std::abs(plain / double{kWhite - kBlack} - truth),
          .ours = 100 * std::abs(readings_of(lit, &dark, 1e6)(0, 0) - truth),
          .within = 1e-5};
}

HardCase dim_light() {
  constexpr int kSites = 20000, kShots = 4;
  constexpr double kElectrons = 4;
  const NoiseModel noise = {1, 1, 0};  // of electrons: photon noise and one electron of the sensor
  test::Random random(7);
  Image<float> shots({kSites, 1}, kShots);
  std::vector<View<const float>> views;
  for (int p = 0; p < kShots; ++p) {
    for (int x = 0; x < kSites; ++x)
      shots(x, 0, p) =
          static_cast<float>(kElectrons + std::sqrt(noise.variance(kElectrons)) * random.normal());
    views.emplace_back(shots.plane(p));
  }
  Image<float> merged({kSites, 1});
  merge_exposures(views, std::vector<NoiseModel>(kShots, noise), merged.plane());
  double plain = 0, ours = 0;
  for (int x = 0; x < kSites; ++x) {
    double sum = 0, weights = 0;
    for (int p = 0; p < kShots; ++p) {
      const double weight = 1 / noise.variance(shots(x, 0, p));
      sum += weight * shots(x, 0, p);
      weights += weight;
    }
    plain += sum / weights / kSites;
    ours += double{merged(x, 0)} / kSites;
  }
  return {.stage = "capture",
          .what = "shots of four electrons, joined by their noise",
          .unit = "% of the light",
          .plain = 100 * std::abs(plain / kElectrons - 1),
          .ours = 100 * std::abs(ours / kElectrons - 1),
          .within = 1};  // five sigma of the mean
}

HardCase hot_photosite() {
  constexpr double kShare = 0.4;
  RawFrame frame = even_frame({64, 48}, kBlack + kShare * (kWhite - kBlack));
  frame.full.fill(kWhite);
  frame.counts(11, 11) = 16383;
  double plain = 0;
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 64; ++x)
      plain = std::max(plain, (frame.counts(x, y) - kBlack) / double{kWhite - kBlack});
  }
  return {.stage = "capture",
          .what = "metering a frame with a hot photosite",
          .unit = "% of white",
          .plain = 100 * std::abs(std::min(plain, 1.0) - kShare),
          .ours = 100 * std::abs(capture::brightness_of(frame).brightest - kShare),
          .within = 0.1};
}

}  // namespace

std::vector<HardCase> hard_captures() {
  return {brackets("one of three exposures full", 120), all_full(), darker_than_dark(), dim_light(),
          hot_photosite()};
}

}  // namespace weft::torture
