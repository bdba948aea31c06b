// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "core/image_io/image_io.h"
#include "exchange/presets/channels.h"

// What the numbers of an image file mean: by the export.json of weft that lists it, else by the names of its
// channels and by what its format says of colours.

namespace weft::material {

/// What one channel of a file holds.
struct ChannelMeaning {
  /// By the catalogue of exports ("albedo.r", "normal.y", "height"); empty: nobody says.
  std::string is = {};
  bool is_srgb = false;  ///< as a colour it has that transfer function (transfer_of() of linear_image.h)
  std::optional<exchange::ChannelRange> range = {};  ///< values of the samples 0 and 1; none: nobody says

  /// A colour's value is the linear one.
  double value_of(double sample) const;
  /// A value that is no colour's.
  double in_range(double sample) const;
};

struct FileMeaning {
  ImageFileInfo info;
  std::vector<ChannelMeaning> channels;  ///< as many as the file has
  bool is_listed = false;                ///< by an export.json
  exchange::NormalDirection direction = exchange::NormalDirection::kOpenGl;
  exchange::RoughnessConvention roughness = exchange::RoughnessConvention::kRoot;

  /// Where these stand in the file; nothing where one of them does not.
  std::optional<std::vector<std::size_t>> find(const std::vector<std::string>& wanted) const;
};

/// Header alone. Errors as of read_image_info(), and kBadData for a DDS that parse_dds() refuses.
Result<FileMeaning> meaning_of(const std::filesystem::path& file);

/// The samples of what meaning_of() takes: those of read_image(), or the largest level of a DDS without its
/// padding.
Result<LoadedImage> read_samples(const std::filesystem::path& file);

/// Whether planes of normals hold n / 2 + 1/2: nothing is below 0, and lengths are then nearer to 1 than
/// those of -1 to 1 are.
bool are_packed_normals(const std::array<View<const float>, 3>& planes);
/// Whether planes can hardly be anything but normals, packed or not: 98 percent of the pixels have a length
/// of 0.9 to 1.1 and look upwards. Black pixels say nothing.
bool are_unit_normals(const std::array<View<const float>, 3>& planes, bool packed);

}  // namespace weft::material
