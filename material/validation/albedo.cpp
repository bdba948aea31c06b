// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/statistics.h"
#include "material/validation/checks.h"

namespace weft::material {
namespace {

struct ExtremeChannels {
  double least = 0, most = 0;
};

ExtremeChannels extremes_at(const Image<float>& albedo, int x, int y) {
  const auto [least, most] = std::minmax({albedo(x, y, 0), albedo(x, y, 1), albedo(x, y, 2)});
  return {double{least}, double{most}};
}

/// Sums for a straight line through pairs of numbers, and their correlation.
struct Pairs {
  double n = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;

  void add(double x, double y) {
    n += 1;
    a += x;
    b += y;
    aa += x * x;
    ab += x * y;
    bb += y * y;
  }
  double variance_a() const { return std::max(aa / n - (a / n) * (a / n), 0.0); }
  double variance_b() const { return std::max(bb / n - (b / n) * (b / n), 0.0); }
  double covariance() const { return ab / n - a / n * (b / n); }
  double slope() const { return variance_a() > 1e-12 ? covariance() / variance_a() : 0; }
  double correlation() const {
    const double both = variance_a() * variance_b();
    return both > 1e-24 ? covariance() / std::sqrt(both) : 0;
  }
};

// The quantile of luminance among the pixels that count.
double luminance_quantile(const Checked& checked, double share) {
  std::vector<float> values;
  for (int y = 0; y < checked.size().height; ++y) {
    for (int x = 0; x < checked.size().width; ++x) {
      if (checked.counts(x, y) != 0) values.push_back(static_cast<float>(luminance_at(checked.albedo, x, y)));
    }
  }
  return double{quantile(std::move(values), share)};
}

double srgb_8bit(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  return 255 * (v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055);
}

const char* remedy_of_brightness(const Checked& checked) {
  if (checked.maps.is_colour_changed) return "take a smaller exposure or gain in the step color";
  return has_better_level(checked)
             ? "solve with --quality reference, which takes light between yarns out of the albedo"
         : checked.maps.is_of_rig
             ? "check the white patch of the calibration and its reflectance; leave it if the cloth is so "
               "white"
             : "its scale is not known: give it another by the step color of a recipe";
}

// Where the albedo, and its logarithm with it, says something of the light.
bool has_light(const Checked& checked, int x, int y) {
  return checked.counts(x, y) != 0 && luminance_at(checked.albedo, x, y) > 1e-4;
}

}  // namespace

Finding dark_albedo(const Checked& checked) {
  const ValidationLimits& limits = checked.limits;
  const double number = luminance_quantile(checked, limits.outside_share);
  if (number >= limits.dark_warning) {
    return passed("ALBEDO_DARK", fmt::format("the darkest albedo is {:.3f}", number), number,
                  limits.dark_warning);
  }
  const bool is_error = number < limits.dark_error;
  const double limit = is_error ? limits.dark_error : limits.dark_warning;
  Marked dark = marked(checked, [&](int x, int y) { return luminance_at(checked.albedo, x, y) < limit; });
  // Black cloth is as dark as that; a black level that was guessed makes it darker or brighter.
  const bool may_be_right = checked.maps.has_measured_black;
  return failed(
      is_error && !may_be_right ? Severity::kError : Severity::kWarning,
      {"ALBEDO_DARK",
       fmt::format("{:.1f} percent of the cloth is darker than {:.4f} (sRGB {:.0f}), the darkest {:.4f}{}",
                   100 * dark.count / checked.pixels, limit, srgb_8bit(limit), number,
                   may_be_right ? "; black cloth and velvet are, and the black level was measured" : ""),
       may_be_right ? "leave it if the cloth is black" : "measure the black level: scan with a dark frame"},
      number, limit, std::move(dark.where));
}

Finding bright_albedo(const Checked& checked) {
  const ValidationLimits& limits = checked.limits;
  const double number = luminance_quantile(checked, 1 - limits.outside_share);
  if (number <= limits.bright_warning) {
    return passed("ALBEDO_BRIGHT", fmt::format("the brightest albedo is {:.3f}", number), number,
                  limits.bright_warning);
  }
  const bool is_error = number > limits.bright_error;
  const double limit = is_error ? limits.bright_error : limits.bright_warning;
  Marked bright = marked(checked, [&](int x, int y) { return luminance_at(checked.albedo, x, y) > limit; });
  return failed(
      is_error ? Severity::kError : Severity::kWarning,
      {"ALBEDO_BRIGHT",
       fmt::format("{:.1f} percent of the cloth is brighter than {:.3f} (sRGB {:.0f}), the brightest {:.3f}",
                   100 * bright.count / checked.pixels, limit, srgb_8bit(limit), number),
       remedy_of_brightness(checked)},
      number, limit, std::move(bright.where));
}

Finding gamut(const Checked& checked) {
  double least = 1;
  const Marked negative = marked(checked, [&](int x, int y) {
    const double channel = extremes_at(checked.albedo, x, y).least;
    least = std::min(least, channel);
    return channel < 0;
  });
  if (least >= checked.limits.gamut) {
    return passed("GAMUT", fmt::format("the least channel is {:.4f}", least), least, checked.limits.gamut);
  }
  Marked outside = marked(
      checked, [&](int x, int y) { return extremes_at(checked.albedo, x, y).least < checked.limits.gamut; });
  return failed(
      Severity::kWarning,
      {"GAMUT",
       fmt::format("{:.2f} percent of the cloth has a negative channel of Rec.709, {:.2f} percent below "
                   "{:g}; the least is {:.4f}",
                   100 * negative.count / checked.pixels, 100 * outside.count / checked.pixels,
                   checked.limits.gamut, least),
       "leave it: such colours are outside of Rec.709, float files keep them and others cut them at 0"},
      least, checked.limits.gamut, std::move(outside.where));
}

Finding saturation(const Checked& checked) {
  const double limit = checked.limits.saturation;
  const auto ratio_at = [&](int x, int y) {
    const ExtremeChannels c = extremes_at(checked.albedo, x, y);
    return c.most > 0.02 ? c.most / std::max(c.least, 1e-4) : 1;  // of black nothing can be said
  };
  double most = 1;
  Marked found = marked(checked, [&](int x, int y) {
    most = std::max(most, ratio_at(x, y));
    return ratio_at(x, y) > limit;
  });
  const double share = found.count / checked.pixels;
  if (share <= checked.limits.outside_share) {
    return passed("SATURATION", fmt::format("the largest channel is up to {:.1f} times the least", most),
                  most, limit);
  }
  return failed(
      Severity::kWarning,
      {"SATURATION",
       fmt::format("in {:.1f} percent of the cloth one channel is over {:g} times another, {:.0f} times at "
                   "most",
                   100 * share, limit, most),
       std::string("leave it if the cloth is as pure as that, else ") +
           (checked.maps.is_of_rig ? "calibrate colour again with weft calibrate color"
                                   : "look at the colours of the photographs")},
      most, limit, std::move(found.where));
}

Finding greys(const Checked& checked) {
  double worst = 0, worst_reflectance = 0;
  Image<std::uint8_t> where(checked.size());
  for (const KnownGrey& grey : checked.maps.greys) {
    const Rect r = {std::max(grey.pixels.x0, 0), std::max(grey.pixels.y0, 0),
                    std::min(grey.pixels.x1, checked.size().width),
                    std::min(grey.pixels.y1, checked.size().height)};
    std::array<double, 3> sum{};
    double count = 0;
    for (int y = r.y0; y < r.y1; ++y) {
      for (int x = r.x0; x < r.x1; ++x) {
        if (checked.counts(x, y) == 0) continue;
        where(x, y) = 255;
        count += 1;
        for (int c = 0; c < 3; ++c)
          sum[static_cast<std::size_t>(c)] += double{checked.surface().albedo(x, y, c)};
      }
    }
    if (!(count > 0 && grey.reflectance > 0)) continue;
    for (const double s : sum) {
      const double off = std::abs(s / count / grey.reflectance - 1);
      if (off > worst) worst_reflectance = grey.reflectance;
      worst = std::max(worst, off);
    }
  }
  const double limit = checked.limits.grey_off;
  if (worst <= limit) {
    return passed("GREYS", fmt::format("known greys are right to {:.1f} percent", 100 * worst), worst, limit);
  }
  return failed(Severity::kError,
                {"GREYS",
                 fmt::format("a channel of the grey of {:.3f} is off by {:.1f} percent", worst_reflectance,
                             100 * worst),
                 "calibrate colour and lights again, or check the reflectance that was typed"},
                worst, limit, std::move(where));
}

Finding light_by_openness(const Checked& checked) {
  Pairs pairs;
  for (int y = 0; y < checked.size().height; ++y) {
    for (int x = 0; x < checked.size().width; ++x) {
      const double open = double{checked.maps.openness(x, y)};
      if (has_light(checked, x, y) && std::isfinite(open)) {
        pairs.add(open, std::log(luminance_at(checked.albedo, x, y)));
      }
    }
  }
  const double slope = pairs.n > 0 ? pairs.slope() : 0, limit = checked.limits.lighting;
  if (std::abs(slope) <= limit) {
    return passed("LIGHT_IN_ALBEDO_OPENNESS",
                  fmt::format("log albedo changes by {:.3f} over openness", slope), slope, limit);
  }
  Marked hidden = marked(checked, [&](int x, int y) { return double{checked.maps.openness(x, y)} < 0.8; });
  return failed(
      Severity::kWarning,
      {"LIGHT_IN_ALBEDO_OPENNESS",
       fmt::format("log albedo changes by {:+.3f} over openness, where cloth of one colour has 0: {}", slope,
                   slope > 0 ? "shadows are left in it" : "light between yarns is left in it"),
       has_better_level(checked)
           ? "solve with --quality reference; leave it if yarns of two colours lie at two depths"
           : "leave it: reference took out what it found, and yarns of two colours at two depths look so "
             "too"},
      slope, limit, std::move(hidden.where));
}

Finding light_by_normals(const Checked& checked) {
  Pairs along_x, along_y;
  for (int y = 0; y < checked.size().height; ++y) {
    for (int x = 0; x < checked.size().width; ++x) {
      if (!has_light(checked, x, y)) continue;
      const Vec3 n = normal_at(checked.surface(), x, y);
      const double tone = std::log(luminance_at(checked.albedo, x, y));
      along_x.add(n.x, tone);
      along_y.add(n.y, tone);
    }
  }
  const double x = along_x.n > 0 ? along_x.correlation() : 0, y = along_y.n > 0 ? along_y.correlation() : 0;
  const double worst = std::max(std::abs(x), std::abs(y)), limit = checked.limits.lighting;
  const std::string numbers =
      fmt::format("albedo correlates by {:+.3f} and {:+.3f} with the normal's x and y", x, y);
  if (worst <= limit) return passed("LIGHT_IN_ALBEDO_NORMALS", numbers, worst, limit);
  const std::string with_what = checked.maps.is_of_rig ? " with weft calibrate check" : "";
  return failed(Severity::kWarning,
                {"LIGHT_IN_ALBEDO_NORMALS", numbers + ": one side of the yarns is brighter",
                 has_better_level(checked)
                     ? "solve with --quality reference; if it stays, check the lights" + with_what
                     : "check the lights" + with_what + "; leave it if they are where they should be"},
                worst, limit);
}

}  // namespace weft::material
