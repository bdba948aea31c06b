// SPDX-License-Identifier: Apache-2.0
#include "solve/bands/realign.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>

#include "core/base/parallel.h"
#include "solver/kernels/demosaic.h"

namespace weft::solve {
namespace {

using solver::kDemosaicReach;

constexpr int kAlignedStrip = 32;

enum Aligned : int {
  kAlignedNormal = 0,
  kRho = 3,
  kSigmaRho = 4,
  kAlignedSigmaNormal = 5,
  kAlignedResidual = 6,
  kAligned = 7
};

// Calls for strips of `rows`, several at once.
void for_each_strip(Rect rows, int threads, const std::function<void(Rect)>& strip) {
  const auto count = static_cast<std::size_t>((rows.height() + kAlignedStrip - 1) / kAlignedStrip);
  parallel_for(count, threads, [&](std::size_t i, int) {
    const int y0 = rows.y0 + static_cast<int>(i) * kAlignedStrip;
    strip({rows.x0, y0, rows.x1, std::min(y0 + kAlignedStrip, rows.y1)});
  });
}

}  // namespace

Realign::Realign(Size size, const CfaPattern& cfa, const LateralColor& lateral, const CameraModel& camera,
                 int threads, const BandSink& next)
    : size_(size),
      cfa_(cfa),
      alignment_(lateral, camera),
      threads_(threads),
      next_(next),
      held_(size.width) {}

Result<void> Realign::put(const MapBand& band) {
  held_.append(band);
  const bool is_last = held_.end() == size_.height;
  const int ready = is_last ? size_.height : held_.end() - alignment_.reach() - kDemosaicReach;
  if (ready <= handed_on_) return {};
  Result<void> taken = hand_on(ready);
  // One row more: demosaicing begins with the filter phase of the image.
  held_.forget_above(std::max(handed_on_ - alignment_.reach() - kDemosaicReach - 1, held_.first()));
  return taken;
}

// Aligns rows of the image, the first of them even.
void Realign::align(Rect rows) {
  if (aligned_.height() < rows.height()) {
    aligned_ = Image<float>({size_.width, rows.height()}, kAligned);
    status_ = Image<std::uint16_t>({size_.width, rows.height()});
  }
  const MapBand held = held_.all();
  const solver::MosaicRows from = {
      size_,         held.rows.y0, cfa_, held.normal, held.albedo, held.sigma_albedo, held.sigma_normal_deg,
      held.residual, held.status};
  const auto plane = [&](int p) { return aligned_.plane(p); };
  const solver::AlignedRows out = {
      rows.y0,
      {plane(kAlignedNormal), plane(kAlignedNormal + 1), plane(kAlignedNormal + 2)},
      plane(kRho),
      plane(kSigmaRho),
      plane(kAlignedSigmaNormal),
      plane(kAlignedResidual),
      status_.plane()};
  for_each_strip(rows, threads_, [&](Rect strip) { alignment_.align(from, strip, out); });
}

Result<void> Realign::hand_on(int end_row) {
  const Rect area = {0, handed_on_, size_.width, end_row};
  // What demosaicing looks at; it begins with the filter phase of the image.
  const Rect seen = {0, std::max(area.y0 - kDemosaicReach, 0) & ~1, size_.width,
                     std::min(area.y1 + kDemosaicReach, size_.height)};
  align(seen);
  if (demosaiced_.height() < area.height()) demosaiced_ = Image<float>({size_.width, area.height()}, 6);
  const Rect sites = {0, 0, size_.width, seen.height()};
  const View<const float> rho = aligned_.plane(kRho).crop(sites),
                          sigma = aligned_.plane(kSigmaRho).crop(sites);
  const auto three = [](Image<float>& image, int first, Rect part) {
    return std::array<View<float>, 3>{image.plane(first).crop(part), image.plane(first + 1).crop(part),
                                      image.plane(first + 2).crop(part)};
  };
  for_each_strip(area, threads_, [&](Rect strip) {
    const Rect from = {0, strip.y0 - seen.y0, size_.width, strip.y1 - seen.y0};
    const Rect to = {0, strip.y0 - area.y0, size_.width, strip.y1 - area.y0};
    solver::demosaic(rho, sigma, cfa_, from, three(demosaiced_, 0, to), three(demosaiced_, 3, to));
  });
  handed_on_ = end_row;

  MapBand band = held_.of(area);
  const Rect same = {0, area.y0 - seen.y0, size_.width, area.y1 - seen.y0};
  const Rect made = {0, 0, size_.width, area.height()};
  for (std::size_t c = 0; c < 3; ++c) {
    const int plane = static_cast<int>(c);
    band.normal[c] = aligned_.plane(kAlignedNormal + plane).crop(same);
    band.albedo[c] = demosaiced_.plane(plane).crop(made);
    band.sigma_albedo[c] = demosaiced_.plane(3 + plane).crop(made);
  }
  band.sigma_normal_deg = aligned_.plane(kAlignedSigmaNormal).crop(same);
  band.residual = aligned_.plane(kAlignedResidual).crop(same);
  band.status = status_.plane().crop(same);
  return next_(band);
}

}  // namespace weft::solve
