// SPDX-License-Identifier: Apache-2.0
#include "simulator/effects/bounds.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simulator/camera/field_curvature.h"
#include "simulator/camera/optics.h"
#include "simulator/camera/saturation.h"
#include "simulator/effects/halos.h"
#include "simulator/geometry/scene_surface.h"
#include "simulator/light/incidence.h"
#include "simulator/spectra/observer.h"
#include "simulator/targets/target.h"

namespace weft::simulator {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kMostDeviation = 8.6;  // of a normal variate
constexpr double kRayDeviations = 6;
constexpr int kBetweenPixels = 2;  // pixels that lateral colour looks at beside where it looks
constexpr double kNearest_mm = 1;  // of a LED: see incidence()

struct Box {
  Vec3 low = {kInfinite, kInfinite, kInfinite};
  Vec3 high = {-kInfinite, -kInfinite, -kInfinite};

  void add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  Vec3 nearest(Vec3 p) const {
    return {std::clamp(p.x, low.x, high.x), std::clamp(p.y, low.y, high.y), std::clamp(p.z, low.z, high.z)};
  }
  Vec3 farthest(Vec3 p) const {
    const auto far = [](double x, double a, double b) { return std::abs(x - a) > std::abs(x - b) ? a : b; };
    return {far(p.x, low.x, high.x), far(p.y, low.y, high.y), far(p.z, low.z, high.z)};
  }
};

Area grown_by(Area a, double mm) {
  return {a.x0_mm - mm, a.y0_mm - mm, a.x1_mm + mm, a.y1_mm + mm};
}

/// Part of the table, and the longest step from pixel to pixel there.
struct Seen {
  Area area = {kInfinite, kInfinite, -kInfinite, -kInfinite};
  double pixel_mm = 0;
};

/// Adds what the frame and `margin_px` around it show of the plane. The border is looked at here and there:
/// no border that a lens leaves unfolded strays from its chords by more than one of them, by which the area
/// grows.
void add_seen(const Lens& lens, Size size, int margin_px, double height_mm, Seen& seen) {
  constexpr int kSteps = 32;
  constexpr double kLevel = 0.01;  // a ray that is as good as level may see anything
  const double x0 = -margin_px, x1 = size.width - 1 + margin_px;
  const double y0 = -margin_px, y1 = size.height - 1 + margin_px;
  const double corners[5][2] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}, {x0, y0}};
  Area area = seen.area;
  Vec3 before;
  double chord_mm = 0;
  for (int i = 0; i <= 4 * kSteps; ++i) {
    const int side = std::min(i / kSteps, 3);
    const double t = static_cast<double>(i) / kSteps - side;
    const double x = corners[side][0] + t * (corners[side + 1][0] - corners[side][0]);
    const double y = corners[side][1] + t * (corners[side + 1][1] - corners[side][1]);
    if (lens.ray(x, y).direction.z > -kLevel) {
      seen = {{-1e6, -1e6, 1e6, 1e6}, 1e6};
      return;
    }
    const Vec3 p = lens.point_on_plane(x, y, height_mm);
    area = {std::min(area.x0_mm, p.x), std::min(area.y0_mm, p.y), std::max(area.x1_mm, p.x),
            std::max(area.y1_mm, p.y)};
    if (i > 0) chord_mm = std::max(chord_mm, length(p - before));
    before = p;
  }
  seen.area = grown_by(area, chord_mm);
  seen.pixel_mm = std::max({seen.pixel_mm, kSteps * chord_mm / (x1 - x0), kSteps * chord_mm / (y1 - y0)});
}

double rise_deg(double slope) {
  return degrees(std::atan(slope));
}

/// What a LED can do anywhere in the box of lit points.
struct LedRange {
  Rgb signal_of_unit;    ///< on white, of an irradiance of 1, with as much again as the lens may spread
  double distance_mm;    ///< the least
  double elevation_deg;  ///< the lowest
  double spread_mm;      ///< from the table's centre, where light counts as distant, to the farthest point
  double steepness;  ///< of the vector strength times direction: mm times its gradient over 1 / distance^2
  double sine;       ///< of its radius at the least distance
  double centre_strength;  ///< at the table's centre
  double strength() const { return 1 / (distance_mm * distance_mm); }
  /// Change of the irradiance along a way of that length.
  double change_over(double way_mm) const {
    return way_mm == 0 ? 0 : strength() * std::min(1.0, steepness * way_mm / distance_mm);
  }
};

/// The cosine that a sphere adds where its middle is on the horizon, where it adds most: the form factor of
/// half a sphere over sine^2, (alpha - sin alpha cos alpha) / (pi sin^2 alpha), about 2 sin alpha / (3 pi).
double added_on_horizon(double sine) {
  if (sine == 0) return 0;
  const double alpha = std::asin(sine);
  return (alpha - sine * std::cos(alpha)) / (kPi * sine * sine);
}

class Bounds {
 public:
  Bounds(const Scene& scene, const SceneRig& rig)
      : scene_(scene), rig_(rig), surface_(surface_of(scene.geometry)), slope_(steepest_slope(surface_)) {
    is_plane_ = std::holds_alternative<TablePlane>(surface_);
    is_glossy_ = !std::holds_alternative<Lambert>(scene.material.reflectance);
    find_colours();
    find_points();
    find_leds();
    find_signals();
  }

  EffectBound near_light() const {
    if (is_glossy_) return glossy();
    return change_of_irradiance(
        [](const LedRange& led) { return led.change_over(led.spread_mm); },
        "light of the nearest LED changes by at most {:.2g} of full scale over the field");
  }

  EffectBound relief() const {
    const double height_mm = std::max(std::abs(heights_.lowest_mm), std::abs(heights_.highest_mm));
    if (height_mm == 0) return {0, "the cloth has no height"};
    if (is_glossy_) return glossy();
    return change_of_irradiance(
        [&](const LedRange& led) { return led.change_over(height_mm); },
        fmt::format("heights up to {:.2g} mm", height_mm) + " change light by at most {:.2g} of full scale");
  }

  EffectBound finite_led() const {
    const double radius_mm = scene_.lights.led_radius_mm;
    if (radius_mm == 0) return {0, "the LEDs have no size"};
    const std::string led =
        fmt::format("a LED of {:.3g} mm at {:.0f} mm or more", 2 * radius_mm, nearest_led().distance_mm);
    if (nearest_led().sine >= 1) return all(led + " may touch the cloth");
    if (is_glossy_) return all(led + " widens highlights");
    if (shadows_fall()) return all(led + " has a soft shadow");
    if (!leds_set()) return {0, led + " stands wholly above the horizon of every slope: no shading changes"};
    return change_on_horizon(led + " changes shading by at most {:.2g} of full scale");
  }

  EffectBound led_drift() const {
    const LightSettings& l = scene_.lights;
    const double flicker = kMostDeviation * l.flicker;
    const double loss = 1 - (1 - l.drift) * std::max(1 - flicker, 0.0);
    return share(std::max(loss, flicker / (1 + flicker)), "LEDs change by at most {:.2g} of their light");
  }
  EffectBound stray() const { return change(stray_, "the rig reflects at most {:.2g} of full scale"); }
  EffectBound ambient() const { return change(ambient_, "the room gives at most {:.2g} of full scale"); }

  EffectBound cast_shadows() const {
    const std::string what = fmt::format("slopes of at most {:.1f} degrees under LEDs of at least {:.1f}",
                                         rise_deg(mesh_slope()), lowest_elevation_deg());
    return shadows_fall() ? all(what + " may lie in shadow") : EffectBound{0, what + " cast no shadow"};
  }

  EffectBound interreflection() const {
    if (hidden_ == 0) return {0, "a plane sees nothing of itself"};
    double by_cloth = 0;
    for (int k = 1; k <= scene_.transport.bounces; ++k) by_cloth += std::pow(albedo() * hidden_, k);
    return change(direct_ * by_cloth + hidden_ * (stray_ + ambient_),
                  fmt::format("points that see at most {:.0f} percent cloth", 100 * hidden_) +
                      " change by at most {:.2g} of full scale");
  }

  EffectBound translucency() const {
    const auto [warp, weft] = scene_.material.translucency.yarns();
    const double most = std::max(warp.share, weft.share);
    if (most == 0) return {0, "no light enters the yarns"};
    const std::string why = fmt::format("up to {:.2g} of the light leaves beside where it entered", most) +
                            ": at most {:.2g} of full scale";
    return change(most * direct_, why);
  }

  /// Lambert's law as a material leaves dark what faces away from the middle of a LED.
  EffectBound reflectance() const {
    if (is_glossy_) return glossy();
    if (!leds_set()) return {0, "the material is Lambert's"};
    return change_on_horizon("the material is Lambert's: at most {:.2g} of full scale on the horizon");
  }

  EffectBound spectral() const {
    if (colour_change_ == 0) return {0, "no colour is a spectrum that the camera sees otherwise"};
    if (is_glossy_) return glossy();
    return change(colour_change_ * white_ * bounced_ * bounced_,
                  "camera and observer differ by at most {:.2g} of full scale");
  }

  EffectBound distortion() const {
    const LensSettings& lens = scene_.camera.lens;
    if (lens == LensSettings()) return {0, "the lens has no distortion"};
    const bool moves_axis = lens.offset_x_px != 0 || lens.offset_y_px != 0;
    if (!is_uniform() || is_glossy_ || shadows_fall() || moves_axis) return all("edges move in the picture");
    const double field_mm = length(box_.high - box_.low);
    return change_of_irradiance([&](const LedRange& led) { return led.change_over(field_mm); },
                                "light changes by at most {:.2g} of full scale over the field");
  }

  EffectBound movement() const {
    if (scene_.camera.movement.sigma_mm == 0 && scene_.camera.movement.sigma_deg == 0)
      return {0, "the cloth does not move"};
    if (is_uniform() && slope_ == 0 && !is_glossy_) return {0, "a flat cloth of one colour moves unseen"};
    return all("edges and slopes move from shot to shot");
  }

  EffectBound vignetting() const {
    double least_gain = 1;
    for (const CameraModel& camera : cameras_) {
      const Vignette vignette(scene_.camera.vignette, camera);
      const double far_x = camera.size.width - 1 + margin_px_, far_y = camera.size.height - 1 + margin_px_;
      for (const double x : {-margin_px_ * 1.0, far_x})
        for (const double y : {-margin_px_ * 1.0, far_y})
          least_gain = std::min(least_gain, vignette.gain(x, y));
    }
    return share(1 - least_gain, "the corners lose at most {:.2g} of their light");
  }

  EffectBound defocus() const {
    const BlurKernel kernel = blur_kernel(scene_.camera.blur);
    const double elsewhere = 1 - kernel.weights[kernel.weights.size() / 2];
    if (elsewhere <= 0) return {0, "no light leaves its pixel"};
    return change(elsewhere * light_, fmt::format("{:.2g} of the light", elsewhere) +
                                          " leaves its pixel: at most {:.2g} of full scale");
  }

  EffectBound field_curvature() const {
    const FieldSettings& field = scene_.camera.field;
    const BlurKernel kernel = widest_disc(field);
    const double elsewhere = 1 - kernel.weights[kernel.weights.size() / 2];
    if (elsewhere <= 0) return {0, "no light leaves its pixel in the corners"};
    const std::string why =
        fmt::format("a disc of {:.2g} pixels in the corners changes light by at most ", field.corner_px) +
        "{:.2g} of full scale";
    return change(elsewhere * light_, why);
  }

  EffectBound chromatic_aberration() const {
    const ChromaticSettings& shift = scene_.camera.chromatic;
    const double most_px = std::max(std::abs(shift.red_px), std::abs(shift.blue_px));
    if (most_px == 0) return {0, "the lens shows all colours at one scale"};
    return all(fmt::format("red or blue is seen up to {:.2g} pixels away", most_px));
  }

  EffectBound veil() const {
    const double share = scene_.camera.veil.share;
    if (share == 0) return {0, "the lens spreads no light over the frame"};
    return change(share * light_, "the lens spreads at most {:.2g} of full scale");
  }

  EffectBound bloom() const {
    if (sample_ <= 1) return {0, fmt::format("no photosite holds more than {:.2g} of full scale", sample_)};
    const double spilt = spills() ? scene_.camera.bloom.share * (sample_ - 1) : 0;
    EffectBound bound = whole(spilt, "full photosites lose their noise above white and spill {:.2g}");
    bound.sigma += kMostDeviation;
    return bound;
  }

  EffectBound dark_current() const {
    const DefectSettings& d = scene_.camera.defects;
    const double lost = d.dead_per_million > 0 ? (1 - d.dead_response) * light_ : 0;
    if (lost > dark_) return whole(lost * response(), "a dead photosite loses up to {:.2g} of full scale");
    return whole(dark_, "warmth fills photosites to at most {:.2g} of full scale");
  }

  EffectBound uneven_response() const {
    const DefectSettings& d = scene_.camera.defects;
    double counts = 0;
    for (const auto& row : d.cell_counts)
      for (const double cell : row) counts = std::max(counts, std::abs(cell));
    counts += kMostDeviation * (d.column_counts + d.photosite_counts);
    EffectBound bound = share(response() - 1, "photosites differ by at most {:.2g} of their light");
    bound.sigma += in_sigma(std::min(counts / (rig_.sensor.white - rig_.sensor.black), 1.0), 0);
    bound.why += fmt::format(" and {:.2g} counts", counts);
    return bound;
  }

  /// |v - u| of v = u (1 + a u + b u^2), which the sensor bends to u.
  EffectBound nonlinearity() const {
    const auto [a, b] = scene_.camera.linearity;
    const auto curve = NonLinearity::of(scene_.camera.linearity);
    if (!curve) return all("counts do not rise with light");
    constexpr int kParts = 256;
    const double most = std::min(curve->distorted(std::min(sample_, 1.0)), 1.0);
    double sigma = 0, largest = 0;
    for (int i = 0; i < kParts; ++i) {
      const double low = most * i / kParts, high = most * (i + 1) / kParts;
      const double bend = high * high * std::max(std::abs(a + b * low), std::abs(a + b * high));
      sigma = std::max(sigma, in_sigma(bend, low * (1 + low * (a + b * low))));
      largest = std::max(largest, bend);
    }
    return {sigma, fmt::format("the sensor bends light by at most {:.2g} of full scale", largest)};
  }

  EffectBound noise() const { return {kInfinite, "noise is what all else is measured by"}; }

 private:
  void find_colours() {
    const MaterialSettings& m = scene_.material;
    std::vector<ChannelWeights> observers = {rec709_weights()};
    const auto camera = camera_weights(scene_.spectra.led, scene_.spectra.filters);
    if (camera) observers.push_back(*camera);
    const auto add = [&](Rgb albedo) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double brightest = std::clamp(albedo[c] * (1 + m.yarn_variation), 0.0, 1.0);
        albedo_[c] = std::max(albedo_[c], brightest);
      }
    };
    const auto add_spectrum = [&](const Spectrum& spectrum) {
      const Rgb plain = channel_reflectance(observers.front(), spectrum);
      const Rgb seen = channel_reflectance(observers.back(), spectrum);
      for (const Rgb& colour : {plain, seen}) add(colour);
      for (std::size_t c = 0; c < 3; ++c) {
        const double change = camera ? std::abs(seen[c] - plain[c]) : 1;
        colour_change_ = std::max(colour_change_, (1 + m.yarn_variation) * change);
      }
    };
    const bool every_yarn_has_its_own =
        m.dye || ((m.warp_albedo || m.warp_dye) && (m.weft_albedo || m.weft_dye));
    if (!every_yarn_has_its_own) add(m.albedo);
    for (const auto& albedo : {m.warp_albedo, m.weft_albedo})
      if (albedo) add(*albedo);
    for (const auto& dye : {m.dye, m.warp_dye, m.weft_dye})
      if (dye) add_spectrum(*dye);
    if (scene_.targets.empty()) return;
    for (const Spectrum& patch : scene_.spectra.chart) add_spectrum(patch);
    albedo_.fill(1);
    if (colour_change_ > 0) colour_change_ = 1;  // of grains, too
  }

  void find_points() {
    const CameraSettings& c = scene_.camera;
    const double plane_mm = scene_.geometry.cloth_height_mm;
    margin_px_ =
        blur_kernel(c.blur).radius + widest_disc(c.field).radius + bloom_kernel(c.bloom).radius() +
        static_cast<int>(std::ceil(std::max(std::abs(c.chromatic.red_px), std::abs(c.chromatic.blue_px)))) +
        kBetweenPixels;
    const int light_px = margin_px_ + translucency_reach(scene_);
    Seen seen;
    for (const LensSettings& lens : {c.lens, LensSettings()}) {
      const auto model =
          camera_of({c.width, c.height}, c.distance_mm, c.mm_per_pixel, lens, c.pose, plane_mm);
      if (!model) continue;  // another lens sees: the rig exists
      cameras_.push_back(*model);
      add_seen(*Lens::of(*model), model->size, light_px, plane_mm, seen);
    }
    const Area& a = seen.area;
    const double radius_mm = std::hypot(std::max(std::abs(a.x0_mm), std::abs(a.x1_mm)),
                                        std::max(std::abs(a.y0_mm), std::abs(a.y1_mm)));
    const double shift_mm = kMostDeviation * std::sqrt(2) * c.movement.sigma_mm;
    const double turn = std::min(kMostDeviation * radians(c.movement.sigma_deg), 2.0);
    double around_mm = scene_.transport.bounces * kFarthestBounce * seen.pixel_mm;
    const auto cloth_mm = [&] { return grown_by(a, around_mm + shift_mm + turn * (radius_mm + shift_mm)); };
    heights_ = heights_mm(surface_, cloth_mm());
    const double relief_mm = std::max(heights_.highest_mm - heights_.lowest_mm, seen.pixel_mm);
    around_mm = is_plane_ ? 0 : std::min(around_mm, scene_.transport.bounces * kBounceOverRelief * relief_mm);
    heights_ = heights_mm(surface_, cloth_mm());

    box_.add({a.x0_mm - around_mm, a.y0_mm - around_mm, plane_mm + std::min(heights_.lowest_mm, 0.0)});
    box_.add({a.x1_mm + around_mm, a.y1_mm + around_mm, plane_mm + std::max(heights_.highest_mm, 0.0)});
    box_.add({0, 0, plane_mm});
    for (const TargetSettings& target : scene_.targets) add_target(target);
  }

  void add_target(const TargetSettings& settings) {
    const auto target = Target::make(settings, scene_.seed, 0);
    if (!target) return;  // the rig exists: every target can be made
    const double waves_mm = settings.sheet.wavelength_mm * std::tan(radians(settings.sheet.waviness_deg));
    const double half_mm = std::hypot(target->width_mm(), target->height_mm()) / 2 + waves_mm;
    box_.add(settings.centre_mm - Vec3{half_mm, half_mm, half_mm});
    box_.add(settings.centre_mm + Vec3{half_mm, half_mm, half_mm});
    paper_ = std::max(paper_, 1 - settings.sheet.non_lambertian);
  }

  void find_leds() {
    const std::vector<Rgb> units = rig_.signal_of_unit(scene_.camera.iso);
    const Vec3 centre_mm = {0, 0, scene_.geometry.cloth_height_mm};
    for (std::size_t j = 0; j < units.size(); ++j) {
      const NearLight& led = rig_.leds.leds[j];
      const Vec3 to_farthest = led.position_mm - box_.farthest(led.position_mm);
      LedRange& range = leds_.emplace_back();
      range.signal_of_unit = units[j];
      for (double& signal : range.signal_of_unit) signal *= 1 + scene_.camera.veil.share;
      const double distance_mm = length(led.position_mm - box_.nearest(led.position_mm));
      range.distance_mm = std::max(distance_mm, kNearest_mm);
      range.elevation_deg =
          degrees(std::atan2(led.position_mm.z - box_.high.z, std::hypot(to_farthest.x, to_farthest.y)));
      range.spread_mm = length(box_.farthest(centre_mm) - centre_mm);
      range.sine = distance_mm > scene_.lights.led_radius_mm ? scene_.lights.led_radius_mm / distance_mm : 1;
      // lobe^mu l / d^2: the lobe gives mu, l / d^2 gives 2 (along l), a sphere's horizon less than its sine.
      const bool is_smooth = (led.mu == 0 || led.mu >= 1) && distance_mm > kNearest_mm;
      range.steepness = is_smooth ? 2 + led.mu + range.sine : kInfinite;
      range.centre_strength = incidence(led, centre_mm).strength;
    }
  }

  /// The largest signal that irradiance_of(led) gives on the cloth's brightest colour.
  template <typename IrradianceOf>
  double brightest(const Rgb& albedo, const IrradianceOf& irradiance_of) const {
    double most = 0;
    for (const LedRange& led : leds_)
      for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, albedo[c] * led.signal_of_unit[c] * irradiance_of(led));
    return most;
  }

  void find_signals() {
    const LightSettings& l = scene_.lights;
    const DefectSettings& d = scene_.camera.defects;
    find_hidden();
    const double gain = 1 + kMostDeviation * l.flicker;
    const auto strength = [&](const LedRange& led) { return paper_ * gain * glow() * led.strength(); };
    direct_ = brightest(albedo_, strength);
    const auto at_centre = [](const LedRange& led) { return led.centre_strength; };
    stray_ = l.stray * brightest(albedo_, at_centre);
    const double room = l.ambient * rig_.room_share;
    ambient_ = room * brightest(albedo_, at_centre);
    white_ = brightest({1, 1, 1}, strength) + (l.stray + room) * brightest({1, 1, 1}, at_centre);
    light_ = is_glossy_ ? kInfinite : direct_ * bounced_ + stray_ + ambient_;
    const double hot = d.hot_per_million > 0 ? 1.5 * d.hot_electrons_per_s : 0;
    dark_ = (d.dark_electrons_per_s + hot) * std::exp2((d.temperature_c - 25) / d.dark_doubling_c) *
            rig_.exposure_us * 1e-6 / rig_.sensor.electrons_at_white;
    sample_ = light_ * response() + dark_;
  }

  /// From a point that leans by phi, rays above psi meet no cloth that rises by psi at most: the open share
  /// is at least the integral of the cosine over that cap of the sky, cos phi cos^2 psi.
  void find_hidden() {
    if (is_plane_) return;
    const double phi = std::atan(slope_), psi = std::atan(mesh_slope());
    const double share = 1 - std::cos(phi) * std::cos(psi) * std::cos(psi);
    const double rays = scene_.transport.bounce_rays;
    hidden_ =
        share == 0
            ? 0
            : std::min(share + kRayDeviations * (std::sqrt(share * (1 - share) / rays) + 1 / rays), 1.0);
    bounced_ = 0;
    for (int k = 0; k <= scene_.transport.bounces; ++k) bounced_ += std::pow(albedo() * hidden_, k);
  }

  /// Light that leaves a yarn over the brightest that falls on the cloth: it may get more from others than it
  /// gives away.
  double glow() const {
    const auto [warp, weft] = scene_.material.translucency.yarns();
    return 1 + std::abs(warp.share - weft.share);
  }
  double albedo() const { return *std::max_element(albedo_.begin(), albedo_.end()); }
  double response() const { return 1 + kMostDeviation * scene_.camera.defects.response_percent / 100; }
  /// The steepest slope of a mesh's triangles, whose sides along x and y may both be as steep as the surface.
  double mesh_slope() const { return is_plane_ ? slope_ : std::sqrt(2) * slope_; }
  bool is_uniform() const { return is_plane_ && !scene_.material.print.albedo && scene_.targets.empty(); }
  bool spills() const { return sample_ > 1 && scene_.camera.bloom.share > 0; }
  const LedRange& nearest_led() const {
    return *std::min_element(leds_.begin(), leds_.end(), [](const LedRange& a, const LedRange& b) {
      return a.distance_mm < b.distance_mm;
    });
  }
  double lowest_elevation_deg() const {
    double lowest = 90;
    for (const LedRange& led : leds_)
      lowest = std::min(lowest, led.elevation_deg - degrees(std::asin(led.sine)));
    return lowest;
  }
  /// Whether a part of a LED may be below the horizon of a point.
  bool leds_set() const { return !scene_.targets.empty() || lowest_elevation_deg() < rise_deg(slope_); }
  bool shadows_fall() const { return lowest_elevation_deg() <= rise_deg(mesh_slope()); }

  // Changes in sigma.

  double in_sigma(double change, double signal) const {
    if (change == 0) return 0;
    const double n = rig_.sensor.electrons_at_white, r = rig_.sensor.read_noise_electrons;
    return change * n / std::sqrt(signal * n + r * r);
  }
  /// Bounds charge that may be added to none at all: the brighter signal is at least the change.
  EffectBound whole(double charge, const std::string& why) const {
    const double most = std::min(charge * (spills() ? 1 + scene_.camera.bloom.share : 1), 1.0);
    return {in_sigma(most, most), fmt::format(fmt::runtime(why), most)};
  }
  /// Bounds a change of light, which photosites count more or less of.
  EffectBound change(double light, const std::string& why) const { return whole(light * response(), why); }
  EffectBound all(const std::string& why) const { return whole(sample_, why); }
  EffectBound glossy() const { return all("what the material mirrors cannot be bounded cheaply"); }
  /// Bounds a change by the same share of any signal: most sigma where the signal is largest. Blur may mix
  /// what has grown with what has shrunk: the brighter signal is at least 1 - share of the largest.
  EffectBound share(double of_signal, const std::string& why) const {
    const std::string said = fmt::format(fmt::runtime(why), of_signal);
    if (of_signal == 0) return {0, said};
    if (spills()) return {whole(of_signal * sample_, "").sigma, said};
    const double most = std::min(sample_, 1.0);
    return {in_sigma(of_signal * most, std::max(1 - of_signal, of_signal) * most), said};
  }
  template <typename ChangeOf>
  EffectBound change_of_irradiance(const ChangeOf& change_of, const std::string& why) const {
    const double gain = 1 + kMostDeviation * scene_.lights.flicker;
    return change(paper_ * gain * glow() * bounced_ * brightest(albedo_, change_of), why);
  }

  EffectBound change_on_horizon(const std::string& why) const {
    return change_of_irradiance(
        [](const LedRange& led) { return led.strength() * added_on_horizon(led.sine); }, why);
  }

  const Scene& scene_;
  const SceneRig& rig_;
  Surface surface_;
  double slope_;
  bool is_plane_ = false;
  bool is_glossy_ = false;
  Rgb albedo_{};
  double colour_change_ = 0;  ///< of an albedo, from the observer to the camera
  std::vector<CameraModel> cameras_;
  int margin_px_ = 0;  ///< around the frame, from where it brings light into the frame
  HeightRange heights_;
  Box box_;           ///< of all points whose light enters the picture
  double paper_ = 1;  ///< what targets reflect over Lambert's law
  std::vector<LedRange> leds_;
  double hidden_ = 0;   ///< share of its rays by which a point sees cloth
  double bounced_ = 1;  ///< light with that by way of the cloth over direct light
  // The most that a sample can have, where 1 is full scale.
  double direct_ = 0, stray_ = 0, ambient_ = 0;
  double white_ = 0;   ///< of light on white, without bounces
  double light_ = 0;   ///< of all light
  double dark_ = 0;    ///< of dark charge
  double sample_ = 0;  ///< of a photosite's charge before bloom
};

/// The effects in the order of effect_keys().
using BoundOf = EffectBound (Bounds::*)() const;
constexpr BoundOf kBoundOf[] = {&Bounds::near_light,
                                &Bounds::relief,
                                &Bounds::finite_led,
                                &Bounds::led_drift,
                                &Bounds::stray,
                                &Bounds::ambient,
                                &Bounds::cast_shadows,
                                &Bounds::interreflection,
                                &Bounds::translucency,
                                &Bounds::reflectance,
                                &Bounds::spectral,
                                &Bounds::distortion,
                                &Bounds::movement,
                                &Bounds::vignetting,
                                &Bounds::field_curvature,
                                &Bounds::defocus,
                                &Bounds::chromatic_aberration,
                                &Bounds::veil,
                                &Bounds::bloom,
                                &Bounds::dark_current,
                                &Bounds::uneven_response,
                                &Bounds::nonlinearity,
                                &Bounds::noise};

}  // namespace

EffectBounds bounds_of(const Scene& scene, const SceneRig& rig) {
  const Bounds bounds(scene, rig);
  EffectBounds all;
  for (const auto bound_of : kBoundOf) all.push_back((bounds.*bound_of)());
  return all;
}

}  // namespace weft::simulator
