// SPDX-License-Identifier: Apache-2.0
#include "solve/photographs/cut.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

namespace weft::solve {
namespace {

template <typename T>
Image<T> cut_image(const Image<T>& image, Rect area) {
  Image<T> out({area.width(), area.height()}, image.planes());
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < out.height(); ++y) {
      std::copy_n(image.plane(p).row(area.y0 + y) + area.x0, out.width(), out.plane(p).row(y));
    }
  }
  return out;
}

RawFrame cut_frame(const RawFrame& frame, Rect area) {
  return {cut_image(frame.counts, area), frame.cfa, frame.black, frame.white, frame.shot, frame.full};
}

FrameMend cut_mend(const FrameMend& mend, Rect area) {
  FrameMend part;
  if (!mend.row_gain.empty())
    part.row_gain.assign(mend.row_gain.begin() + area.y0, mend.row_gain.begin() + area.y1);
  for (const Rect& m : mend.missing)
    part.missing.push_back({m.x0 - area.x0, m.y0 - area.y0, m.x1 - area.x0, m.y1 - area.y0});
  return part;
}

Frames cut_frames(const Developed& whole, Rect area) {
  Developed part;
  for (const Image<float>& image : whole.rgb) part.rgb.push_back(cut_image(image, area));
  return part;
}

Frames cut_frames(const Mosaics& whole, Rect area) {
  std::vector<RawFrame> frames;
  for (const RawFrame& frame : whole.frames) frames.push_back(cut_frame(frame, area));
  std::optional<RawFrame> dark;
  if (whole.dark) dark = cut_frame(*whole.dark, area);
  Mosaics part(std::move(frames), std::move(dark), whole.response, whole.exposure);
  part.noise = whole.noise;
  for (const FrameMend& mend : whole.mends) part.mends.push_back(cut_mend(mend, area));
  if (whole.beside) {
    part.beside = BesideLight{whole.beside->share, {}};
    for (const SpreadLight& light : whole.beside->frames) part.beside->frames.push_back(light.part(area));
  }
  return part;
}

}  // namespace

Result<Photographs> cut(const Photographs& whole, Rect area) {
  Photographs part;
  part.size = {area.width(), area.height()};
  part.leds = whole.leds;
  part.light_covariance = whole.light_covariance;
  part.albedo_scale = whole.albedo_scale;
  part.color = whole.color;
  part.plane_weights = whole.plane_weights;
  part.sigma_slope = whole.sigma_slope;
  part.spread = whole.spread;
  part.lateral = whole.lateral;
  part.camera = whole.camera;
  if (part.camera) {
    part.camera->size = part.size;
    part.camera->cx -= area.x0;
    part.camera->cy -= area.y0;
  }
  const auto cut_kind = [&](const auto& frames) { return cut_frames(frames, area); };
  part.frames = std::visit(cut_kind, whole.frames);
  part.lobe_share = whole.lobe_share;
  if (whole.parallel) part.parallel = std::visit(cut_kind, *whole.parallel);

  Lights lights = whole.field->lights();
  if (auto* near = std::get_if<NearLights>(&lights)) {
    near->log_gain_rgb = {};
    for (NearLight& led : near->leds) led.log_gain_quadratic = {};
  }
  Result<LightField> field =
      LightField::make(std::move(lights), part.camera, part.size, whole.field->cloth_height_mm());
  if (!field) return std::move(field).error();
  part.field = std::move(*field);
  return part;
}

}  // namespace weft::solve
