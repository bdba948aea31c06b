// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/image/image.h"
#include "report/downsampler.h"
#include "report/drawing.h"

// Pictures of maps for people. Maps come in as the averages of a Downsampler, or whole if they are small, and
// every picture has their size. Pixels that are not finite are magenta.

namespace weft::report {

inline constexpr Colour kMissing{1, 0, 1};

/// The transfer function of sRGB, IEC 61966-2-1, of a linear value held to [0, 1].
float srgb_from_linear(float linear);

/// The factor that brings the 99th percentile of max(R, G, B) to 0.8: how to show an albedo whose scale is
/// relative. 1 where there is nothing to see. Pictures that are compared share one factor and state it.
double display_scale(const Image<float>& albedo);

/// `scale` times the linear Rec.709 albedo (planes R, G, B), in sRGB. A scale of 1 shows true reflectance.
Picture albedo_picture(const Image<float>& albedo, double scale = 1);

/// Normals (planes X, Y, Z in the rig frame) at unit length as n * 0.5 + 0.5: green is up, as in OpenGL.
Picture normal_picture(const Image<float>& normal);

/// The cloth under one distant lamp from the upper left, 45 degrees high: scale * albedo * (0.15 + 0.85 *
/// max(0, n.l) / l_z), so that what lies flat keeps its albedo.
Picture relit_picture(const Image<float>& albedo, const Image<float>& normal, double scale = 1);

/// Angle between two normal maps (planes X, Y, Z, any length) in degrees, row by row; NaN where one has none.
void angular_error_deg(std::span<const View<const float>> normal, std::span<const View<const float>> truth,
                       View<float> error_deg);

/// A colour for `t` in [0, 1] whose lightness rises evenly from dark violet over green to light yellow: in
/// OKLCh (Ottosson 2020) L goes from 0.25 to 0.92 and hue from 300 to 105 degrees, within what sRGB shows.
Colour heat_colour(double t);

/// The least number of one significant digit that covers 99 of 100 values.
double round_full_scale(View<const float> values);

/// Values from 0 to `full_scale` by `heat_colour`, above that its last colour, over a scale bar with `unit`.
/// The picture is higher than the map by the bar, and not narrower than the bar's numbers.
Picture heat_picture(View<const float> values, double full_scale, std::string_view unit = "°");

/// A kind of pixel on a picture of lobes.
struct LobeKey {
  std::string says;
  std::optional<double> azimuth_deg = {};  ///< of its yarn; none where its lobe has no direction
  bool is_second = false;                  ///< of the second material: paler
};
/// Which pixels were solved with a lobe and where their yarns lie, by colour, over a legend. Plane k of
/// `shares` is of pixels of key k; what is left has no lobe.
Picture lobe_picture(const Image<float>& shares, std::span<const LobeKey> keys);

/// Counts what a status map says and shows it: each pixel in the colour of its gravest bit, averaged in
/// linear light over squares as in Downsampler, over a legend with the share of pixels that have each bit.
class StatusPreview {
 public:
  explicit StatusPreview(Size size, int longest_side = kPreviewSide);
  /// The next rows of the map, from the top.
  void add_rows(View<const std::uint16_t> status);
  Picture picture() const;

 private:
  std::array<Colour, 256> linear_colours_;        // of every status
  std::array<std::int64_t, 256> histogram_ = {};  // pixels with every status
  Downsampler averages_;
  Image<float> row_;
};

}  // namespace weft::report
