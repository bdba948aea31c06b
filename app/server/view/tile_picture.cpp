// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/tile_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/image_io/pack_row.h"
#include "report/preview.h"

namespace weft::app {
namespace {

// Fine enough that every 8-bit value of sRGB is met where its light begins.
constexpr int kLinearSteps = 65535;

const std::vector<std::uint8_t>& srgb_table() {
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> made(kLinearSteps + 1);
    for (int i = 0; i <= kLinearSteps; ++i) {
      const float linear = static_cast<float>(i) / kLinearSteps;
      made[static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>(std::lround(255 * report::srgb_from_linear(linear)));
    }
    return made;
  }();
  return table;
}

// What is not a number is dark.
float held(float value) {
  return value > 0 ? std::min(value, 1.0F) : 0.0F;
}
std::uint8_t srgb_of(const std::vector<std::uint8_t>& table, float linear) {
  return table[static_cast<std::size_t>(held(linear) * kLinearSteps + 0.5F)];
}
std::uint32_t step_of(float n, float half) {
  return static_cast<std::uint32_t>(std::clamp(n, -1.0F, 1.0F) * half + half + 0.5F);
}

std::string raw_normals(const Image<float>& planes) {
  std::string bytes(static_cast<std::size_t>(planes.size().pixels()) * sizeof(std::uint32_t), '\0');
  char* to = bytes.data();
  for (int y = 0; y < planes.height(); ++y) {
    for (int x = 0; x < planes.width(); ++x, to += sizeof(std::uint32_t)) {
      const std::uint32_t packed = step_of(planes(x, y, 0), 511) | step_of(planes(x, y, 1), 511) << 10 |
                                   step_of(planes(x, y, 2), 511) << 20 | 3U << 30;
      std::memcpy(to, &packed, sizeof packed);
    }
  }
  return bytes;
}

std::string raw_halves(const Image<float>& planes) {
  const auto width = static_cast<std::size_t>(planes.width());
  const std::size_t row_bytes = width * static_cast<std::size_t>(planes.planes()) * 2;
  std::string bytes(row_bytes * static_cast<std::size_t>(planes.height()), '\0');
  std::vector<const float*> rows(static_cast<std::size_t>(planes.planes()));
  for (int y = 0; y < planes.height(); ++y) {
    for (int p = 0; p < planes.planes(); ++p) rows[static_cast<std::size_t>(p)] = planes.plane(p).row(y);
    pack_row(rows, width, SampleType::kHalf,
             reinterpret_cast<std::byte*>(bytes.data() + row_bytes * static_cast<std::size_t>(y)));
  }
  return bytes;
}

std::vector<std::uint8_t> shares(const Image<float>& plane) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(static_cast<std::size_t>(plane.size().pixels()));
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x)
      bytes.push_back(static_cast<std::uint8_t>(255 * held(plane(x, y)) + 0.5F));
  }
  return bytes;
}

/// Interleaved: of(x, y) gives the three samples of a pixel.
template <typename Of>
Result<std::string> rgb_picture(Size size, PictureFormat format, const Of& of) {
  std::vector<std::uint8_t> samples;
  samples.reserve(static_cast<std::size_t>(size.pixels()) * 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      for (const std::uint8_t sample : of(x, y)) samples.push_back(sample);
    }
  }
  return encode_image(samples, size, 3, format);
}

using Rgb8 = std::array<std::uint8_t, 3>;

std::vector<Rgb8> heat_table() {
  std::vector<Rgb8> table;
  for (int i = 0; i < 256; ++i) {
    const report::Colour colour = report::heat_colour(i / 255.0);
    const auto sample = [](float v) { return static_cast<std::uint8_t>(std::lround(255 * v)); };
    table.push_back({sample(colour.r), sample(colour.g), sample(colour.b)});
  }
  return table;
}

}  // namespace

std::string raw_tile(LayerKind kind, const Image<float>& planes) {
  if (kind == LayerKind::kNormal) return raw_normals(planes);
  if (kind != LayerKind::kFlags) return raw_halves(planes);
  const std::vector<std::uint8_t> bytes = shares(planes);
  return {bytes.begin(), bytes.end()};
}

Result<std::string> picture_tile(LayerKind kind, const Image<float>& planes, const Look& look,
                                 PictureFormat format) {
  switch (kind) {
    case LayerKind::kNormal: {
      if (format == PictureFormat::kJpeg) {
        return Error{ErrorKind::kUsage, "normals have no such tile", ".jpg",
                     "what it loses would turn them by degrees", "ask for .png or .raw"};
      }
      return rgb_picture(planes.size(), format, [&](int x, int y) {
        const auto sample = [&](int p) { return static_cast<std::uint8_t>(step_of(planes(x, y, p), 127)); };
        return Rgb8{sample(0), sample(1), sample(2)};
      });
    }
    case LayerKind::kColor:
    case LayerKind::kMosaic: {
      const std::vector<std::uint8_t>& table = srgb_table();
      const auto gain = static_cast<float>(look.gain);
      return rgb_picture(planes.size(), format, [&](int x, int y) {
        return Rgb8{srgb_of(table, gain * planes(x, y, 0)), srgb_of(table, gain * planes(x, y, 1)),
                    srgb_of(table, gain * planes(x, y, 2))};
      });
    }
    case LayerKind::kScalar: {
      static const std::vector<Rgb8> table = heat_table();
      const auto least = static_cast<float>(look.least);
      const auto scale = static_cast<float>(1 / (look.most - look.least));
      return rgb_picture(planes.size(), format, [&](int x, int y) {
        return table[static_cast<std::size_t>(255 * held((planes(x, y) - least) * scale) + 0.5F)];
      });
    }
    case LayerKind::kFlags:
      return encode_image(shares(planes), planes.size(), 1, format);
  }
  return Error{ErrorKind::kInternal, "unknown kind of layer", "", "", ""};
}

Result<std::string> relit_tile(const Image<float>& normal, const Image<float>& albedo, const Look& look,
                               PictureFormat format) {
  const std::vector<std::uint8_t>& table = srgb_table();
  const auto gain = static_cast<float>(look.gain);
  const auto lx = static_cast<float>(look.light.x), ly = static_cast<float>(look.light.y),
             lz = static_cast<float>(look.light.z);
  return rgb_picture(normal.size(), format, [&](int x, int y) {
    const float lit =
        gain * std::max(0.0F, lx * normal(x, y, 0) + ly * normal(x, y, 1) + lz * normal(x, y, 2));
    return Rgb8{srgb_of(table, lit * albedo(x, y, 0)), srgb_of(table, lit * albedo(x, y, 1)),
                srgb_of(table, lit * albedo(x, y, 2))};
  });
}

Image<float> turned_deg(const Image<float>& normal, const Image<float>& other) {
  Image<float> degrees(normal.size());
  const std::array<View<const float>, 3> a = {normal.plane(0), normal.plane(1), normal.plane(2)};
  const std::array<View<const float>, 3> b = {other.plane(0), other.plane(1), other.plane(2)};
  report::angular_error_deg(a, b, degrees.plane());
  return degrees;
}

Image<float> off_percent(const Image<float>& albedo, const Image<float>& other) {
  Image<float> percent(albedo.size());
  for (int y = 0; y < albedo.height(); ++y) {
    for (int x = 0; x < albedo.width(); ++x) {
      float sum = 0;
      int channels = 0;
      for (int p = 0; p < albedo.planes(); ++p) {
        if (!(other(x, y, p) > 0)) continue;
        sum += std::abs(albedo(x, y, p) - other(x, y, p)) / other(x, y, p);
        ++channels;
      }
      percent(x, y) = channels == 0 ? 0 : 100 * sum / static_cast<float>(channels);
    }
  }
  return percent;
}

}  // namespace weft::app
