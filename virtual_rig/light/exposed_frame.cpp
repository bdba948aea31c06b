// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/light/exposed_frame.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "core/image/tiles.h"
#include "simulator/camera/defects.h"
#include "simulator/camera/dng_writer.h"
#include "simulator/camera/saturation.h"
#include "simulator/camera/sensor.h"
#include "simulator/effects/random_key.h"
#include "simulator/sampling/random.h"

namespace weft::virtual_rig {
namespace {

using simulator::PhotositeDefect;

constexpr double kThroughCloth = 0.05;
constexpr double kFilm = 0.5;             // of unpolarised light, through a film
constexpr double kTwoFilms = 0.25;        // of light that loses its polarisation between them
constexpr double kLeak = 0.01;            // of gloss, through crossed ones over parallel ones
constexpr double kThroughout = 1 - 1e-9;  // a sum of several pieces may fall short by rounding

struct WeightedPlane {
  View<const float> plane;
  double weight;
  std::span<const double> by_row = {};

  double weight_of(int y) const {
    return by_row.empty() ? weight : weight * by_row[static_cast<std::size_t>(y)];
  }
};

/// The planes that shine, by what a sample of them adds to the signal.
std::vector<WeightedPlane> lit_planes(const LightFrames& frames, const GatheredLight& light) {
  const double gain = light.aperture_gain * light.iso / 100;
  std::vector<WeightedPlane> planes;
  for (int led = 1; led <= frames.leds(); ++led) {
    const double seconds = light.leds_s[static_cast<std::size_t>(led - 1)];
    if (seconds <= 0) continue;
    const LightFrames& matt = light.matt != nullptr ? *light.matt : frames;
    if (light.leds_share != 0)
      planes.push_back({frames.led(led), seconds * gain * light.leds_share, light.leds_by_row});
    if (light.matt_share != 0)
      planes.push_back({matt.led(led), seconds * gain * light.matt_share, light.leds_by_row});
  }
  if (light.below_s > 0) planes.push_back({frames.ambient(), kThroughCloth * light.below_s * gain});
  if (light.ambient_s > 0) planes.push_back({frames.ambient(), light.ambient_s * gain, light.ambient_by_row});
  return planes;
}

/// Where in 0 to `length` a picture that moved by `by` is read: at its border the last filter cell goes on.
int moved_from(int at, int by, int length) {
  const int from = at - by;
  if (from < 0) return from & 1;
  return from < length ? from : length - 2 + (from & 1);
}

simulator::Sensor sensor_at(const LightFrames& frames, double iso) {
  simulator::CameraSettings camera = frames.scene().camera;
  camera.iso = iso;
  return sensor_of(camera);
}

/// One exposure's way from light to counts, rows of a tile at a time.
class ReadOut {
 public:
  ReadOut(const LightFrames& frames, const GatheredLight& light)
      : frames_(frames),
        light_(light),
        planes_(lit_planes(frames, light)),
        sensor_(sensor_at(frames, light.iso)),
        effects_(frames.scene().effects),
        key_(random_key(frames.scene())) {
    if (effects_.bloom) bloom_ = bloom_kernel(frames.scene().camera.bloom);
    if (effects_.nonlinearity) {
      bend_ = *simulator::NonLinearity::of(frames.scene().camera.linearity);  // plan_of() has proved it
    }
    for (int x = 0; x < frames.size().width; ++x) {
      column_.push_back(static_cast<std::size_t>(moved_from(x, light.move_x, frames.size().width)));
    }
  }

  /// The signal of a row, or of one beyond the frame, where nothing is.
  void fill_signal(int y, int x0, std::span<double> signal) const {
    std::fill(signal.begin(), signal.end(), 0.0);
    const Size size = frames_.size();
    if (y < 0 || y >= size.height) return;
    const int from_y = moved_from(y, light_.move_y, size.height);
    const std::size_t* column = &column_[static_cast<std::size_t>(x0)];
    for (const WeightedPlane& lit : planes_) {
      const float* row = lit.plane.row(from_y);
      const double weight = lit.weight_of(y);
      for (std::size_t i = 0; i < signal.size(); ++i) {
        signal[i] += weight * static_cast<double>(row[column[i]]);
      }
    }
  }

  void read(Rect tile, View<std::uint16_t> counts) const {
    const Rect rect = grown_in_rows_by_bloom(tile);
    const auto width = static_cast<std::size_t>(tile.width());
    std::vector<double> samples(static_cast<std::size_t>(rect.pixels()));
    std::vector<PhotositeDefect> photosites(frames_.has_photosites() ? width : 0);
    for (int y = rect.y0; y < rect.y1; ++y) {
      const std::span row = row_of(samples, rect, y);
      fill_signal(y, tile.x0, row);
      if (photosites.empty() || y < 0 || y >= frames_.size().height) continue;
      fill_photosites(y, tile.x0, photosites);
      expose(photosites, light_.dark_s, sensor_.electrons_at_white, row);
    }
    if (effects_.bloom) {
      std::vector<double> kept(static_cast<std::size_t>(tile.pixels()));
      bloom(bloom_, 1, samples, tile, kept);
      samples = std::move(kept);
    }
    for (int y = tile.y0; y < tile.y1; ++y) {
      const std::span row = row_of(samples, tile, y);
      if (effects_.noise) add_noise(y, tile.x0, row);
      if (bend_) {
        for (double& sample : row) sample = bend_->distorted(sample);
      }
      if (effects_.uneven_response) {
        fill_photosites(y, tile.x0, photosites);
        add_black_pattern(photosites, sensor_.white - sensor_.black, row);
      }
      std::transform(row.begin(), row.end(), counts.row(y) + tile.x0,
                     [&](double sample) { return count_of(sensor_, sample); });
      stop({counts.row(y) + tile.x0, row.size()}, tile.x0, y);
    }
  }

 private:
  Rect grown_in_rows_by_bloom(Rect r) const {
    return {r.x0, r.y0 - bloom_.radius(), r.x1, r.y1 + bloom_.radius()};
  }

  static std::span<double> row_of(std::vector<double>& samples, Rect rect, int y) {
    const auto width = static_cast<std::size_t>(rect.width());
    return std::span(samples).subspan(static_cast<std::size_t>(y - rect.y0) * width, width);
  }

  void fill_photosites(int y, int x0, std::span<PhotositeDefect> photosites) const {
    const float* response = frames_.response().row(y) + x0;
    const float* dark_per_s = frames_.dark_per_s().row(y) + x0;
    const float* offset_counts = frames_.offset_counts().row(y) + x0;
    for (std::size_t i = 0; i < photosites.size(); ++i) {
      photosites[i] = {static_cast<double>(response[i]), static_cast<double>(dark_per_s[i]),
                       static_cast<double>(offset_counts[i])};
    }
  }

  void stop(std::span<std::uint16_t> counts, int x0, int y) const {
    if (light_.stops == StopCounts{}) return;
    constexpr CfaPattern kCfa;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const auto channel = static_cast<std::size_t>(kCfa.channel_at(x0 + static_cast<int>(i), y));
      if (light_.stops[channel] > 0) counts[i] = std::min(counts[i], light_.stops[channel]);
    }
  }

  void add_noise(int y, int x0, std::span<double> row) const {
    for (std::size_t i = 0; i < row.size(); ++i) {
      const auto x = static_cast<std::uint32_t>(x0) + static_cast<std::uint32_t>(i);
      row[i] = noisy(sensor_, row[i],
                     simulator::philox({x, static_cast<std::uint32_t>(y), light_.noise_key, 0}, key_));
    }
  }

  const LightFrames& frames_;
  const GatheredLight& light_;
  std::vector<WeightedPlane> planes_;
  simulator::Sensor sensor_;
  simulator::EffectSettings effects_;
  std::array<std::uint32_t, 2> key_;
  simulator::BloomKernel bloom_;
  std::optional<simulator::NonLinearity> bend_;
  std::vector<std::size_t> column_;  ///< of the planes, by column of the picture
};

/// The picture that a body takes behind its closed shutter after one.
GatheredLight dark_after(const LightFrames& frames, const GatheredLight& light) {
  GatheredLight dark;
  dark.leds_s.assign(static_cast<std::size_t>(frames.leds()), 0.0);
  dark.dark_s = light.dark_s;
  dark.iso = light.iso;
  dark.noise_key = ~light.noise_key;
  return dark;
}

/// A body keeps the black level, and counts from 0 to white.
void subtract_dark(const Image<std::uint16_t>& dark, const RawFrame& head, Image<std::uint16_t>& counts) {
  for (int y = 0; y < counts.height(); ++y) {
    for (int x = 0; x < counts.width(); ++x) {
      const auto black =
          static_cast<int>(head.black[static_cast<std::size_t>(y & 1)][static_cast<std::size_t>(x & 1)]);
      counts(x, y) = static_cast<std::uint16_t>(
          std::clamp(counts(x, y) - dark(x, y) + black, 0, static_cast<int>(head.white)));
    }
  }
}

RawFrame frame_head(const LightFrames& frames, const CameraExposure& exposure, const std::string& serial) {
  RawFrame frame;
  const simulator::Sensor& sensor = frames.rig().sensor;
  const simulator::DefectSettings defects = defects_of(frames.scene());
  for (std::size_t y = 0; y < 2; ++y) {
    for (std::size_t x = 0; x < 2; ++x) {
      frame.black[y][x] = static_cast<float>(sensor.black + defects.cell_counts[y][x]);
    }
  }
  frame.white = static_cast<float>(sensor.white);
  frame.shot = {sensor.make,
                sensor.model,
                serial,
                exposure.exposure_us,
                exposure.iso,
                exposure.f_number,
                simulator::kFocalLength_mm};
  return frame;
}

}  // namespace

std::vector<double> lit_shares(const LitLog& pins, RigClock::time_point from, RigClock::time_point to,
                               int leds) {
  const double open_s = std::chrono::duration<double>(to - from).count();
  std::vector<double> shares = pins.lit_seconds(from, to, leds);
  for (double& share : shares) {
    share = open_s > 0 ? share / open_s : 0;
    if (share > kThroughout) share = 1;
  }
  return shares;
}

GatheredLight gathered_light(const LightFrames& frames, const std::vector<double>& pin_shares,
                             const LightFaults& faults, const CameraExposure& exposure) {
  const simulator::Scene& scene = frames.scene();
  // Another time than the scene's gathers what its shutter makes of it, as in simulate_photograph().
  const bool is_nominal = exposure.exposure_us == frames.rig().exposure_us;
  const double exposure_s =
      exposure.exposure_us * 1e-6 * (is_nominal ? 1 : 1 + scene.camera.retakes.shutter_error);
  const double flicker = std::hypot(faults.flicker, scene.effects.led_drift ? scene.lights.flicker : 0);
  GatheredLight light;
  light.leds_s = with_faults(faults, pin_shares);
  for (std::size_t k = 0; k < light.leds_s.size(); ++k) {
    light.leds_s[k] *= exposure_s;
    if (flicker == 0) continue;
    const auto led = static_cast<std::uint32_t>(k);
    const simulator::NormalPair normal = simulator::normal_pair(
        simulator::philox({exposure.image_number, led, simulator::kFlickerStream, 1}, random_key(scene)));
    light.leds_s[k] *= std::max(1 + flicker * normal.first, 0.0);
  }
  light.ambient_s = exposure_s * ((scene.effects.ambient ? scene.lights.ambient : 0) + faults.ambient);
  light.dark_s = exposure_s;
  light.iso = exposure.iso;
  const double stops = exposure.f_number > 0 ? scene.camera.f_number / exposure.f_number : 1;
  light.aperture_gain = stops * stops;
  light.noise_key = exposure.image_number;
  light.move_x = faults.move_x;
  light.move_y = faults.move_y;
  const int rows = frames.size().height;
  if (faults.pulses) light.leds_by_row = light_by_row(*faults.pulses, exposure, rows);
  if (faults.lamp) light.ambient_by_row = light_by_row(*faults.lamp, exposure, rows);
  light.loses_its_dark = exposure.loses_its_dark;
  return light;
}

void add_light_below(GatheredLight& light, double pin_share, const CameraExposure& exposure) {
  light.below_s = pin_share * exposure.exposure_us * 1e-6;
}

void add_films(GatheredLight& light, double crossed_share, const LightFrames* matt) {
  const auto between = [&](double parallel, double crossed) {
    return parallel + crossed_share * (crossed - parallel);
  };
  light.matt = matt;
  // All light is scattered and mirrored, and `matt` is what is scattered behind both films: what is mirrored
  // is the first less four times the second.
  light.leds_share = matt == nullptr ? kTwoFilms : between(kFilm, kFilm * kLeak);
  light.matt_share = matt == nullptr ? 0 : between(-1, 1 - 2 * kLeak);
  light.ambient_s *= kFilm;
  light.below_s *= kFilm;
}

Image<std::uint16_t> read_out(const LightFrames& frames, const GatheredLight& light, int threads) {
  const ReadOut sensor(frames, light);
  Image<std::uint16_t> counts(frames.size());
  const Rect whole = {0, 0, frames.size().width, frames.size().height};
  // Nothing stops it: an exposure is under a second.
  const Result<void> done = for_each_tile(whole, {.threads = threads}, {},
                                          [&](Rect tile, int) { sensor.read(tile, counts.plane()); });
  static_cast<void>(done);
  return counts;
}

Image<double> signal_of(const LightFrames& frames, const GatheredLight& light) {
  const ReadOut sensor(frames, light);
  Image<double> signal(frames.size());
  for (int y = 0; y < signal.height(); ++y) {
    sensor.fill_signal(y, 0, {signal.plane().row(y), static_cast<std::size_t>(signal.width())});
  }
  return signal;
}

Result<std::vector<std::uint8_t>> develop(const LightFrames& frames, const GatheredLight& light,
                                          const CameraExposure& exposure, const std::string& serial,
                                          int threads) {
  RawFrame frame = frame_head(frames, exposure, serial);
  frame.counts = read_out(frames, light, threads);
  if (light.loses_its_dark)
    subtract_dark(read_out(frames, dark_after(frames, light), threads), frame, frame.counts);
  simulator::DngTags tags;
  for (std::size_t c = 0; c < 3; ++c) {
    const Rgb& balance = frames.scene().lights.white_balance;
    tags.as_shot_neutral[c] = balance[c] / balance[1];
  }
  tags.date_time_original = exposure.date_time;
  tags.milliseconds = exposure.milliseconds;
  tags.image_number = exposure.image_number;
  return dng_bytes(frame, tags);
}

}  // namespace weft::virtual_rig
