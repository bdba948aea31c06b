// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/color_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string_view>

#include "core/image/color_spaces.h"

namespace weft {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Curve = std::function<double(double)>;

// --- reading

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value = value << 8 | bytes[at + i];
  return value;
}

double fixed_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::int32_t>(number_at(bytes, at, 4)) / 65536.0;
}

std::string_view word_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return {reinterpret_cast<const char*>(bytes.data()) + at, 4};
}

// The data of a tag; empty where there is none.
std::span<const std::uint8_t> tag_of(std::span<const std::uint8_t> profile, std::string_view name) {
  constexpr std::size_t kTable = 128, kEntry = 12;
  if (profile.size() < kTable + 4) return {};
  const std::size_t count = number_at(profile, kTable, 4);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = kTable + 4 + kEntry * i;
    if (at + kEntry > profile.size()) return {};
    if (word_at(profile, at) != name) continue;
    const std::size_t begin = number_at(profile, at + 4, 4), size = number_at(profile, at + 8, 4);
    if (begin > profile.size() || size > profile.size() - begin) return {};
    return profile.subspan(begin, size);
  }
  return {};
}

// curveType: nothing, a gamma, or a table.
std::optional<Curve> table_curve(std::span<const std::uint8_t> tag) {
  const std::size_t count = number_at(tag, 8, 4);
  if (tag.size() < 12 || count > (tag.size() - 12) / 2) return std::nullopt;
  if (count == 0) return [](double v) { return v; };
  if (count == 1) {
    const double gamma = number_at(tag, 12, 2) / 256.0;
    return [gamma](double v) { return std::pow(v, gamma); };
  }
  std::vector<double> table(count);
  for (std::size_t i = 0; i < count; ++i) table[i] = number_at(tag, 12 + 2 * i, 2) / 65535.0;
  return [table = std::move(table)](double v) {
    const double place = v * static_cast<double>(table.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(place), table.size() - 2);
    return std::lerp(table[below], table[below + 1], place - static_cast<double>(below));
  };
}

// parametricCurveType: of five forms, all but the first have a straight foot or an offset.
std::optional<Curve> formula_curve(std::span<const std::uint8_t> tag) {
  constexpr std::array<std::size_t, 5> kCounts = {1, 3, 4, 5, 7};
  const std::size_t form = number_at(tag, 8, 2);
  if (form >= kCounts.size() || tag.size() < 12 + 4 * kCounts[form]) return std::nullopt;
  std::array<double, 7> p = {1, 1, 0, 0, 0, 0, 0};  // g, a, b, c, d, e, f
  for (std::size_t i = 0; i < kCounts[form]; ++i) p[i] = fixed_at(tag, 12 + 4 * i);
  const double g = p[0], a = p[1], b = p[2], c = p[3];
  if (form == 0) return [g](double v) { return std::pow(v, g); };
  const double from = form < 3 ? (a == 0 ? 0 : -b / a) : p[4];
  const double slope = form < 3 ? 0 : c, above = form == 2 ? c : p[5];
  const double below = form == 2 ? c : p[6];
  return [=](double v) { return v >= from ? std::pow(a * v + b, g) + above : slope * v + below; };
}

std::optional<Curve> curve_of(std::span<const std::uint8_t> tag) {
  if (tag.size() < 12) return std::nullopt;
  if (word_at(tag, 0) == "curv") return table_curve(tag);
  if (word_at(tag, 0) == "para") return formula_curve(tag);
  return std::nullopt;
}

// By light at signals between black and white, where 2.2 and sRGB differ by 0.009.
ColorSpace color_of_curve(const Curve& light_of) {
  double from_line = 0, from_srgb = 0;
  for (int i = 1; i < 16; ++i) {
    const double v = i / 16.0, light = light_of(v);
    if (!std::isfinite(light)) return ColorSpace::kOther;
    from_line = std::max(from_line, std::abs(light - v));
    from_srgb = std::max(from_srgb, std::abs(light - rec709_of_srgb({v, v, v})[0]));
  }
  constexpr double kAlike = 0.012;
  if (from_line < kAlike) return ColorSpace::kLinearColor;
  return from_srgb < kAlike ? ColorSpace::kSrgb : ColorSpace::kOther;
}

// --- writing

void put(Bytes& bytes, std::uint32_t value, int size = 4) {
  for (int i = size - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}
void put(Bytes& bytes, std::string_view text) {
  bytes.insert(bytes.end(), text.begin(), text.end());
}
void put_fixed(Bytes& bytes, std::initializer_list<double> values) {
  for (const double value : values)
    put(bytes, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 65536))));
}

Bytes text_tag(std::string_view ascii) {
  Bytes tag;
  put(tag, "mluc");
  for (const std::uint32_t each : {0U, 1U, 12U}) put(tag, each);
  put(tag, "enUS");
  put(tag, static_cast<std::uint32_t>(2 * ascii.size()));
  put(tag, 28U);
  for (const char c : ascii) put(tag, static_cast<unsigned char>(c), 2);
  return tag;
}
Bytes xyz_tag(double x, double y, double z) {
  Bytes tag;
  put(tag, "XYZ ");
  put(tag, 0U);
  put_fixed(tag, {x, y, z});
  return tag;
}
// Form 3 with the numbers of IEC 61966-2-1.
Bytes srgb_curve_tag() {
  Bytes tag;
  put(tag, "para");
  put(tag, 0U);
  put(tag, 3U, 2);
  put(tag, 0U, 2);
  put_fixed(tag, {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045});
  return tag;
}
// Bradford's matrix from D65 to the D50 of profiles.
Bytes adaptation_tag() {
  Bytes tag;
  put(tag, "sf32");
  put(tag, 0U);
  put_fixed(tag, {1.0478112, 0.0228866, -0.0501270, 0.0295424, 0.9904844, -0.0170491, -0.0092345, 0.0150436,
                  0.7521316});
  return tag;
}

}  // namespace

ColorSpace color_of_profile(std::span<const std::uint8_t> profile) {
  for (const char* name : {"rTRC", "kTRC"}) {
    if (const std::optional<Curve> curve = curve_of(tag_of(profile, name))) return color_of_curve(*curve);
  }
  return ColorSpace::kData;
}

ColorSpace color_of_gamma(double gamma) {
  return color_of_curve([gamma](double v) { return std::pow(v, gamma); });
}

std::vector<std::uint8_t> srgb_profile() {
  const Bytes curve = srgb_curve_tag();
  const std::array<std::pair<const char*, Bytes>, 10> tags = {
      {{"desc", text_tag("sRGB")},
       {"cprt", text_tag("no copyright")},
       {"wtpt", xyz_tag(0.9642, 1, 0.8249)},
       {"chad", adaptation_tag()},
       {"rXYZ", xyz_tag(0.4360747, 0.2225045, 0.0139322)},
       {"gXYZ", xyz_tag(0.3850649, 0.7168786, 0.0971045)},
       {"bXYZ", xyz_tag(0.1430804, 0.0606169, 0.7141733)},
       {"rTRC", curve},
       {"gTRC", curve},
       {"bTRC", curve}}};
  Bytes table, data;
  const std::size_t begin = 128 + 4 + 12 * tags.size();
  put(table, static_cast<std::uint32_t>(tags.size()));
  for (const auto& [name, tag] : tags) {
    put(table, name);
    put(table, static_cast<std::uint32_t>(begin + data.size()));
    put(table, static_cast<std::uint32_t>(tag.size()));
    data.insert(data.end(), tag.begin(), tag.end());
    while (data.size() % 4 != 0) data.push_back(0);
  }
  Bytes profile;
  put(profile, static_cast<std::uint32_t>(begin + data.size()));
  put(profile, 0U);
  put(profile, 0x04300000U);  // version 4.3
  put(profile, "mntrRGB XYZ ");
  for (const std::uint32_t date : {2026U, 1U, 1U, 0U, 0U, 0U}) put(profile, date, 2);
  put(profile, "acsp");
  while (profile.size() < 68) profile.push_back(0);
  put_fixed(profile, {0.9642, 1, 0.8249});
  while (profile.size() < 128) profile.push_back(0);
  profile.insert(profile.end(), table.begin(), table.end());
  profile.insert(profile.end(), data.begin(), data.end());
  return profile;
}

}  // namespace weft
