// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/photographs.h"

#include <algorithm>
#include <limits>
#include <ranges>
#include <utility>

#include "core/image/page_out.h"
#include "core/solve/solve_record.h"

namespace weft::solve {

namespace {
// So much of photographs on disk lies in memory, however many there are.
constexpr std::size_t kMostShown = std::size_t{256} << 20;
constexpr std::size_t kMappedAround = std::size_t{64} << 10;  // what Linux maps beside a page that is read

void mend(const FrameMend& mend, Rect part, View<float> out) {
  for (int y = part.y0; y < part.y1; ++y) {
    float* row = out.row(y - part.y0);
    if (!mend.row_gain.empty()) {
      const float scale = 1 / mend.row_gain[static_cast<std::size_t>(y)];
      for (int x = 0; x < part.width(); ++x) row[x] *= scale;
    }
    for (const Rect& missing : mend.missing) {
      if (y < missing.y0 || y >= missing.y1) continue;
      const int from = std::max(part.x0, missing.x0), to = std::min(part.x1, missing.x1);
      if (from < to)
        std::fill(row + (from - part.x0), row + (to - part.x0), std::numeric_limits<float>::quiet_NaN());
    }
  }
}

CfaPattern all_of(int channel) {
  const auto site = static_cast<std::uint8_t>(channel);
  return {{{{site, site}, {site, site}}}};
}

void scale(double factor, View<float> readings) {
  for (int y = 0; y < readings.height(); ++y) {
    float* row = readings.row(y);
    for (int x = 0; x < readings.width(); ++x) row[x] *= static_cast<float>(factor);
  }
}

}  // namespace

std::vector<View<const float>> Developed::readings(std::size_t k, Rect part, View<float> /*scratch*/) const {
  if (are_on_disk_) {
    const auto row = static_cast<std::size_t>(rgb[k].plane(0).stride()) * sizeof(float);
    const std::size_t shown = 3 * (row * static_cast<std::size_t>(part.height()) + kMappedAround);
    if (shown_->fetch_add(shown) > kMostShown) {
      *shown_ = 0;
      for (const Image<float>& photograph : rgb) weft::page_out(photograph);
    }
  }
  return {rgb[k].plane(0).crop(part), rgb[k].plane(1).crop(part), rgb[k].plane(2).crop(part)};
}

void Developed::page_out(std::size_t k) const {
  if (are_on_disk_) weft::page_out(rgb[k]);
}

void Developed::erase(std::size_t k) {
  rgb.erase(rgb.begin() + static_cast<std::ptrdiff_t>(k));
}

Mosaics::Mosaics(std::vector<RawFrame> mosaics, std::optional<RawFrame> dark_shot,
                 const Response& response_of_camera, Radiometry::Exposure exposure_of_all)
    : frames(std::move(mosaics)),
      dark(std::move(dark_shot)),
      response(response_of_camera),
      exposure(exposure_of_all),
      radiometry(frames.front(), dark ? &*dark : nullptr, response, exposure),
      noise(radiometry.noise()) {
  measure_veils();
}

Mosaics::Mosaics(std::vector<RawFrame> others, const Mosaics& like)
    : frames(std::move(others)),
      response(like.response),
      exposure(like.exposure),
      radiometry(like.radiometry),
      noise(like.radiometry.noise()) {
  measure_veils();
}

Mosaics Mosaics::alike(std::vector<RawFrame> others) const {
  return {std::move(others), *this};
}

void Mosaics::set_dark(RawFrame dark_shot) {
  dark = std::move(dark_shot);
  radiometry = Radiometry(frames.front(), &*dark, response, exposure);
  noise = radiometry.noise();
  measure_veils();
}

void Mosaics::lend_dark(const Mosaics& like) {
  radiometry = like.radiometry;
  noise = radiometry.noise();
  measure_veils();
}

void Mosaics::measure_veils() {
  veils.clear();
  if (!response.veil) return;
  for (const RawFrame& frame : frames) {
    veils.emplace_back(*response.veil, frame.counts.size(), radiometry.cfa(),
                       [&](Rect rows, View<float> out) { radiometry.read(frame.counts.plane(), rows, out); });
  }
}

std::vector<View<const float>> Mosaics::readings(std::size_t k, Rect part, View<float> scratch) const {
  const View<float> out = scratch.crop({0, 0, part.width(), part.height()});
  radiometry.read(frames[k].counts.plane(), part, out);
  if (!mends.empty()) mend(mends[k], part, out);
  if (!brackets.empty() && !brackets[k].empty()) add_brackets(k, part, out);
  if (!veils.empty()) veils[k].take_off(part, out);
  if (beside) {
    beside->frames[k].take_off(1, part, radiometry.cfa(), out);
    scale(1 / (1 - beside->share), out);
  }
  for (int y = part.y0; inside && y < part.y1; ++y) {
    for (int x = part.x0; x < part.x1; ++x) {
      if ((*inside)(x, y) == 0) out(x - part.x0, y - part.y0) = std::numeric_limits<float>::quiet_NaN();
    }
  }
  return {out};
}

// The veil is as bright in all of them.
void Mosaics::add_brackets(std::size_t k, Rect part, View<float> out) const {
  Image<float> others({part.width(), 1}, static_cast<int>(brackets[k].size()));
  std::vector<NoiseModel> noise_of = {radiometry.noise()};
  for (const Bracket& bracket : brackets[k]) noise_of.push_back(bracket.radiometry.noise());
  for (int y = part.y0; y < part.y1; ++y) {
    const View<float> here = out.crop({0, y - part.y0, part.width(), y - part.y0 + 1});
    std::vector<View<const float>> exposures = {here};
    for (std::size_t i = 0; i < brackets[k].size(); ++i) {
      const View<float> other = others.plane(static_cast<int>(i));
      brackets[k][i].radiometry.read(brackets[k][i].frame.counts.plane(), {part.x0, y, part.x1, y + 1},
                                     other);
      exposures.emplace_back(other);
    }
    merge_exposures(exposures, noise_of, here);
  }
}

void Mosaics::erase(std::size_t k) {
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(k));
  if (!brackets.empty()) brackets.erase(brackets.begin() + static_cast<std::ptrdiff_t>(k));
  if (!veils.empty()) veils.erase(veils.begin() + static_cast<std::ptrdiff_t>(k));
  if (!mends.empty()) mends.erase(mends.begin() + static_cast<std::ptrdiff_t>(k));
  if (beside) beside->frames.erase(beside->frames.begin() + static_cast<std::ptrdiff_t>(k));
}

void mend_frames(std::vector<FrameMend> mends, Frames& frames) {
  if (auto* mosaics = std::get_if<Mosaics>(&frames)) {
    mosaics->mends = std::move(mends);
    return;
  }
  auto& developed = std::get<Developed>(frames);
  for (std::size_t k = 0; k < mends.size(); ++k) {
    const Size size = developed.rgb[k].size();
    if (mends[k].row_gain.empty() && mends[k].missing.empty()) continue;
    for (int c = 0; c < 3; ++c) mend(mends[k], {0, 0, size.width, size.height}, developed.rgb[k].plane(c));
    developed.page_out(k);
  }
}

void take_off_beside(BesideLight beside, Frames& frames) {
  const double left = 1 / (1 - beside.share);
  if (auto* mosaics = std::get_if<Mosaics>(&frames)) {
    NoiseModel& noise = mosaics->noise;
    for (double* variance : {&noise.per_reading, &noise.floor, &noise.shared}) *variance *= left * left;
    mosaics->beside = std::move(beside);
    return;
  }
  auto& developed = std::get<Developed>(frames);
  for (std::size_t k = 0; k < beside.frames.size(); ++k) {
    const Size size = developed.rgb[k].size();
    for (int c = 0; c < 3; ++c) {
      const View<float> plane = developed.rgb[k].plane(c);
      beside.frames[k].take_off(1, {0, 0, size.width, size.height}, all_of(c), plane);
      scale(left, plane);
    }
    developed.page_out(k);
  }
}

std::vector<View<const float>> readings_of(const Frames& frames, std::size_t k, Rect part,
                                           View<float> scratch) {
  return std::visit([&](const auto& kind) { return kind.readings(k, part, scratch); }, frames);
}

std::size_t Photographs::count() const {
  return std::visit([](const auto& kind) { return kind.count(); }, frames);
}

Planes Photographs::planes() const {
  return std::visit([](const auto& kind) { return kind.planes(); }, frames);
}

std::optional<NoiseModel> Photographs::noise() const {
  return std::visit([](const auto& kind) { return kind.noise_model(); }, frames);
}

std::size_t Photographs::light_of(int led) const {
  return static_cast<std::size_t>(std::ranges::find(leds, led) - leds.begin());
}

Result<void> leave_out(std::span<const std::size_t> lights, Photographs& photographs) {
  if (lights.empty()) return {};
  std::vector<int> kept;  // from 1
  for (std::size_t k = 0; k < photographs.count(); ++k) {
    if (!std::ranges::binary_search(lights, k)) kept.push_back(static_cast<int>(k) + 1);
  }
  Result<Lights> rest = select_lights(photographs.field->lights(), kept);
  if (!rest) return std::move(rest).error();
  Result<LightField> field = LightField::make(std::move(*rest), photographs.camera, photographs.size,
                                              photographs.field->cloth_height_mm());
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  for (const std::size_t k : std::views::reverse(lights)) {
    std::visit([&](auto& frames) { frames.erase(k); }, photographs.frames);
    if (photographs.parallel) std::visit([&](auto& frames) { frames.erase(k); }, *photographs.parallel);
    if (k < photographs.leds.size())
      photographs.leds.erase(photographs.leds.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return {};
}

void mark_replaced(const std::vector<Photosite>& replaced, Rect band, View<std::uint16_t> status) {
  auto site = std::lower_bound(replaced.begin(), replaced.end(), Photosite{band.y0, 0});
  for (; site != replaced.end() && site->y < band.y1; ++site) {
    if (site->x < band.x0 || site->x >= band.x1) continue;
    status(site->x - band.x0, site->y - band.y0) |= kInvalidReading;
  }
}

}  // namespace weft::solve
