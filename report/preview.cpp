// SPDX-License-Identifier: Apache-2.0
#include "report/preview.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "core/base/statistics.h"
#include "core/base/vec.h"
#include "core/solve/solve_record.h"

namespace weft::report {
namespace {

constexpr double kLeastFullScale = 1e-6;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// A picture whose pixels are colour(x, y), magenta where a channel is not a number.
template <typename ColourOf>
Picture picture_of(Size size, const ColourOf& colour) {
  Picture picture(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const Colour c = colour(x, y);
      const Colour shown = std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b) ? c : kMissing;
      picture(x, y, 0) = shown.r;
      picture(x, y, 1) = shown.g;
      picture(x, y, 2) = shown.b;
    }
  }
  return picture;
}

/// NaN unless `v` has a direction.
Vec3 unit_or_nan(Vec3 v) {
  const double norm = length(v);
  return norm > 0 && std::isfinite(norm) ? (1 / norm) * v : Vec3{kNan, kNan, kNan};
}

Vec3 vector_at(const Image<float>& planes, int x, int y) {
  return {planes(x, y, 0), planes(x, y, 1), planes(x, y, 2)};
}

/// NaN stays NaN.
float encoded(double linear) {
  return std::isfinite(linear) ? srgb_from_linear(static_cast<float>(linear)) : kNan;
}

/// The power of ten of a number's leading digit.
double decade_of(double value) {
  return std::pow(10, std::floor(std::log10(value) + 1e-9));
}

/// A bar of all colours with its numbers, `width` pixels wide at least.
Picture scale_bar(int width, double full_scale, std::string_view unit, int scale) {
  // One interval a unit of the leading digit, more where that would be too few.
  const int leading = static_cast<int>(std::lround(full_scale / decade_of(full_scale)));
  int intervals = leading == 1 ? 5 : leading == 2 ? 4 : leading;
  const auto label = [&](int i) {
    return fmt::format("{:.4g}{}", full_scale * i / intervals, i == intervals ? unit : "");
  };
  const int label_width = text_width(label(1), scale) + text_width(label(intervals), scale);
  if (width < intervals * label_width) intervals = 1;
  width = std::max(width, 2 * label_width);

  const int gap = 4 * scale, bar = 8 * scale, last = width - 1;
  Picture strip = blank_picture({width, gap + bar + 2 * gap + kGlyphHeight * scale});
  for (int x = 0; x < width; ++x) {
    fill(strip, {x, gap, x + 1, gap + bar}, heat_colour(static_cast<double>(x) / std::max(1, last)));
  }
  for (int i = 0; i <= intervals; ++i) {
    const int x = static_cast<int>(static_cast<std::int64_t>(last) * i / intervals);
    const int text = text_width(label(i), scale);
    fill(strip, {x - scale / 2, gap + bar, x - scale / 2 + scale, gap + bar + gap / 2}, kInk);
    draw_text(strip, std::clamp(x - text / 2, 0, width - text), 2 * gap + bar, label(i), kInk, scale);
  }
  return strip;
}

Picture stacked(const Picture& above, const Picture& below) {
  Picture both = blank_picture({std::max(above.width(), below.width()), above.height() + below.height()});
  paste(both, 0, 0, above);
  paste(both, 0, above.height(), below);
  return both;
}

struct StatusColour {
  StatusBit bit;
  Colour colour;
};

// The gravest first.
constexpr std::array<StatusColour, 8> kStatusColours = {{{kNoSolution, kMissing},
                                                         {kIllConditioned, {0.86f, 0.15f, 0.15f}},
                                                         {kDark, {0.36f, 0.24f, 0.62f}},
                                                         {kZeroDof, {0.95f, 0.55f, 0.15f}},
                                                         {kSpecular, {0.97f, 0.95f, 0.90f}},
                                                         {kInvalidReading, {0.30f, 0.75f, 0.75f}},
                                                         {kSaturated, {0.95f, 0.85f, 0.25f}},
                                                         {kShadowed, {0.25f, 0.42f, 0.62f}}}};
constexpr Colour kNothingToSay{0.24f, 0.25f, 0.26f};

Colour status_colour(std::size_t status) {
  for (const StatusColour& each : kStatusColours) {
    if (status & each.bit) return each.colour;
  }
  return kNothingToSay;
}

// By azimuth, degrees: opposite directions have one colour, those at right angles the opposite one.
Colour direction_colour(double azimuth_deg) {
  const auto channel = [&](double at) {
    return static_cast<float>(0.55 + 0.35 * std::cos(2 * radians(azimuth_deg) - radians(at)));
  };
  return {channel(20), channel(140), channel(260)};
}

std::string_view status_name(StatusBit bit) {
  for (const StatusName& each : kStatusNames) {
    if (each.bit == bit) return each.name;
  }
  return "?";
}

std::string percent(std::int64_t part, std::int64_t whole) {
  const double share = whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole) : 0.0;
  return part > 0 && share < 0.01 ? "<0.01%" : fmt::format("{:.2f}%", share);
}

}  // namespace

float srgb_from_linear(float linear) {
  const float c = std::clamp(linear, 0.0f, 1.0f);
  return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
}

double display_scale(const Image<float>& albedo) {
  std::vector<float> brightest;
  for (int y = 0; y < albedo.height(); ++y) {
    for (int x = 0; x < albedo.width(); ++x) {
      brightest.push_back(std::max({albedo(x, y, 0), albedo(x, y, 1), albedo(x, y, 2)}));
    }
  }
  const double bright = lower_quantile(finite(std::move(brightest)), 0.99);
  return bright > 0 ? 0.8 / bright : 1;
}

Picture albedo_picture(const Image<float>& albedo, double scale) {
  return picture_of(albedo.size(), [&](int x, int y) {
    const Vec3 rho = scale * vector_at(albedo, x, y);
    return Colour{encoded(rho.x), encoded(rho.y), encoded(rho.z)};
  });
}

Picture normal_picture(const Image<float>& normal) {
  return picture_of(normal.size(), [&](int x, int y) {
    const Vec3 n = unit_or_nan(vector_at(normal, x, y));
    const auto shown = [](double component) { return static_cast<float>(component * 0.5 + 0.5); };
    return Colour{shown(n.x), shown(n.y), shown(n.z)};
  });
}

Picture relit_picture(const Image<float>& albedo, const Image<float>& normal, double scale) {
  constexpr double kAmbient = 0.15;
  const Vec3 l = normalized({-1, 1, std::sqrt(2.0)});
  return picture_of(albedo.size(), [&](int x, int y) {
    const Vec3 n = unit_or_nan(vector_at(normal, x, y));
    const double n_l = dot(n, l);
    const double shading = kAmbient + (1 - kAmbient) * (n_l < 0 ? 0 : n_l) / l.z;
    const Vec3 light = scale * shading * vector_at(albedo, x, y);
    return Colour{encoded(light.x), encoded(light.y), encoded(light.z)};
  });
}

void angular_error_deg(std::span<const View<const float>> normal, std::span<const View<const float>> truth,
                       View<float> error_deg) {
  for (int y = 0; y < error_deg.height(); ++y) {
    for (int x = 0; x < error_deg.width(); ++x) {
      const Vec3 n = {normal[0](x, y), normal[1](x, y), normal[2](x, y)};
      const Vec3 t = {truth[0](x, y), truth[1](x, y), truth[2](x, y)};
      const bool both = dot(n, n) > 0 && dot(t, t) > 0;
      error_deg(x, y) = both ? static_cast<float>(angle_deg(n, t)) : kNan;
    }
  }
}

Colour heat_colour(double t) {
  t = std::clamp(t, 0.0, 1.0);
  const double lightness = 0.25 + 0.67 * t, chroma = 0.086 + 0.1 * t * t * t, hue = radians(300 - 195 * t);
  const double a = chroma * std::cos(hue), b = chroma * std::sin(hue);
  // Ottosson 2020, "A perceptual color space for image processing": from OKLab over cone responses to linear
  // sRGB.
  const auto cube = [](double v) { return v * v * v; };
  const double l = cube(lightness + 0.3963377774 * a + 0.2158037573 * b);
  const double m = cube(lightness - 0.1055613458 * a - 0.0638541728 * b);
  const double s = cube(lightness - 0.0894841775 * a - 1.2914855480 * b);
  return {encoded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
          encoded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
          encoded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

double round_full_scale(View<const float> values) {
  std::vector<float> all;
  for (int y = 0; y < values.height(); ++y)
    all.insert(all.end(), values.row(y), values.row(y) + values.width());
  const double wanted = lower_quantile(finite(std::move(all)), 0.99);
  if (!(wanted > kLeastFullScale)) return kLeastFullScale;
  const double decade = decade_of(wanted);
  return decade * std::ceil(wanted / decade * (1 - 1e-6));
}

Picture heat_picture(View<const float> values, double full_scale, std::string_view unit) {
  full_scale = std::isfinite(full_scale) ? std::max(full_scale, kLeastFullScale) : kLeastFullScale;
  const Picture map = picture_of(values.size(), [&](int x, int y) {
    const double t = values(x, y) / full_scale;
    return std::isfinite(t) ? heat_colour(t) : kMissing;
  });
  return stacked(map, scale_bar(map.width(), full_scale, unit, text_scale_for(map.width())));
}

Picture lobe_picture(const Image<float>& shares, std::span<const LobeKey> keys) {
  struct Entry {
    Colour colour;
    std::string says;
  };
  std::vector<Entry> entries;
  for (const LobeKey& key : keys) {
    const Colour c = direction_colour(key.azimuth_deg.value_or(0));
    const float paler = key.is_second ? 0.5F : 0;
    entries.push_back(
        {{c.r + paler * (1 - c.r), c.g + paler * (1 - c.g), c.b + paler * (1 - c.b)}, key.says});
  }
  entries.push_back({kNothingToSay, "no lobe"});
  const auto linear = [](Colour c) {
    return Vec3{linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)};
  };
  const Picture map = picture_of(shares.size(), [&](int x, int y) {
    double left = 1;
    Vec3 mixed = {0, 0, 0};
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const double share = shares(x, y, static_cast<int>(k));
      left -= share;
      mixed = mixed + share * linear(entries[k].colour);
    }
    mixed = mixed + left * linear(kNothingToSay);
    return Colour{encoded(mixed.x), encoded(mixed.y), encoded(mixed.z)};
  });
  const int scale = text_scale_for(map.width()), line = kGlyphHeight * scale, gap = line / 2 + 1;
  const auto width_of = [&](const Entry& entry) { return text_width(entry.says, scale) + 2 * line + gap; };
  // As many in a row as the map is wide.
  std::vector<std::pair<int, int>> places;
  int x = 0, rows = 1, widest = map.width();
  for (const Entry& each : entries) {
    if (x > 0 && x + width_of(each) > map.width()) {
      x = 0;
      ++rows;
    }
    places.emplace_back(x, gap + (rows - 1) * (line + gap));
    x += width_of(each);
    widest = std::max(widest, x);
  }
  Picture legend = blank_picture({widest, gap + rows * (line + gap)});
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto [left, top] = places[i];
    fill(legend, {left, top, left + line, top + line}, entries[i].colour);
    draw_text(legend, left + line + gap, top, entries[i].says, kInk, scale);
  }
  return stacked(map, legend);
}

StatusPreview::StatusPreview(Size size, int longest_side)
    : averages_(size, 3, longest_side), row_({size.width, 1}, 3) {
  for (std::size_t status = 0; status < linear_colours_.size(); ++status) {
    const Colour c = status_colour(status);
    linear_colours_[status] = {linear_from_srgb(c.r), linear_from_srgb(c.g), linear_from_srgb(c.b)};
  }
}

void StatusPreview::add_rows(View<const std::uint16_t> status) {
  const std::array<View<const float>, 3> row = {row_.plane(0), row_.plane(1), row_.plane(2)};
  for (int y = 0; y < status.height(); ++y) {
    for (int x = 0; x < status.width(); ++x) {
      const std::size_t bits = status(x, y) & 0xFFU;
      ++histogram_[bits];
      row_(x, 0, 0) = linear_colours_[bits].r;
      row_(x, 0, 1) = linear_colours_[bits].g;
      row_(x, 0, 2) = linear_colours_[bits].b;
    }
    averages_.add_rows(row);
  }
}

Picture StatusPreview::picture() const {
  const Picture map = albedo_picture(averages_.averages());
  const int scale = text_scale_for(map.width()), line = kGlyphHeight * scale, gap = line / 2 + 1;
  const int entry_width = text_width("INVALID_READING 100.00%  ", scale) + line + gap;
  const int columns = std::clamp(map.width() / entry_width, 1, 4);
  const int count = static_cast<int>(kStatusColours.size()), rows = (count + columns - 1) / columns;
  Picture legend = blank_picture({std::max(map.width(), entry_width), gap + rows * (line + gap)});
  for (int i = 0; i < count; ++i) {
    const StatusColour& each = kStatusColours[static_cast<std::size_t>(i)];
    std::int64_t having = 0, all = 0;
    for (std::size_t status = 0; status < histogram_.size(); ++status) {
      having += status & each.bit ? histogram_[status] : 0;
      all += histogram_[status];
    }
    const int x = i / rows * entry_width, y = gap + i % rows * (line + gap);
    fill(legend, {x, y, x + line, y + line}, each.colour);
    draw_text(legend, x + line + gap, y, fmt::format("{} {}", status_name(each.bit), percent(having, all)),
              kInk, scale);
  }
  return stacked(map, legend);
}

}  // namespace weft::report
