// SPDX-License-Identifier: Apache-2.0
#include "core/image_io/exr_channels.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>

#include "core/base/parallel.h"

namespace weft {
namespace {

/// A layer ends with its last point.
std::string_view layer_of(std::string_view name) {
  const std::size_t point = name.rfind('.');
  return name.substr(0, point == std::string_view::npos ? 0 : point + 1);
}

std::string suffix_of(std::string_view name) {
  std::string suffix(name.substr(layer_of(name).size()));
  for (char& c : suffix) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return suffix;
}

/// Y is a luminance, but in a layer with X it is the second of three.
std::size_t rank_of(const std::string& suffix, bool is_vector) {
  static constexpr std::array<std::string_view, 18> kUsual = {
      "r",  "red", "g",  "green", "b",  "blue", "y", "a",     "alpha",
      "ar", "ra",  "ag", "ga",    "ab", "ba",   "z", "depth", "zback"};
  static constexpr std::array<std::string_view, 19> kVector = {
      "r",     "red", "g",  "green", "b",  "blue", "x",  "y",     "z",    "a",
      "alpha", "ar",  "ra", "ag",    "ga", "ab",   "ba", "depth", "zback"};
  const auto place = [&](const auto& list) {
    return static_cast<std::size_t>(std::ranges::find(list, suffix) - list.begin());
  };
  return is_vector ? place(kVector) : place(kUsual);
}

/// Layers that hold an X beside a Y or Z.
std::set<std::string_view> vector_layers(const std::vector<std::string>& names) {
  std::set<std::string_view> with_x, vectors;
  for (const std::string& name : names) {
    if (suffix_of(name) == "x") with_x.insert(layer_of(name));
  }
  for (const std::string& name : names) {
    const std::string suffix = suffix_of(name);
    if ((suffix == "y" || suffix == "z") && with_x.contains(layer_of(name))) vectors.insert(layer_of(name));
  }
  return vectors;
}

/// Attributes that say something of the file, which is not for others to say.
bool has_a_meaning(const std::string& name) {
  static const std::set<std::string> kNames = {"DateTime",
                                               "ResolutionUnit",
                                               "capDate",
                                               "channels",
                                               "chromaticities",
                                               "chunkCount",
                                               "compression",
                                               "dataWindow",
                                               "displayWindow",
                                               "lineOrder",
                                               "maxSamplesPerPixel",
                                               "name",
                                               "pixelAspectRatio",
                                               "preview",
                                               "screenWindowCenter",
                                               "screenWindowWidth",
                                               "tiles",
                                               "type",
                                               "version",
                                               "view",
                                               "xDensity"};
  return kNames.contains(name);
}

void add_pitch(PixelPitch pitch_mm, Imf::Header& header) {
  const auto [x_mm, y_mm] = pitch_mm;
  if (!(x_mm > 0 && y_mm > 0)) return;
  Imf::addXDensity(header, static_cast<float>(25.4 / x_mm));
  header.insert("ResolutionUnit", Imf::StringAttribute("in"));
  if (std::abs(x_mm / y_mm - 1) > 1e-9) header.pixelAspectRatio() = static_cast<float>(x_mm / y_mm);
}

}  // namespace

std::vector<std::string> in_usual_order(std::vector<std::string> names) {
  const std::vector<std::string> all = names;  // views into it stay while `names` is sorted
  const std::set<std::string_view> vectors = vector_layers(all);
  std::ranges::stable_sort(names, [&](const std::string& a, const std::string& b) {
    const std::string_view layer = layer_of(a);
    if (layer != layer_of(b)) return layer < layer_of(b);
    const bool is_vector = vectors.contains(layer);
    const std::size_t rank_a = rank_of(suffix_of(a), is_vector), rank_b = rank_of(suffix_of(b), is_vector);
    return rank_a != rank_b ? rank_a < rank_b : a < b;
  });
  return names;
}

Imf::Header exr_header(const ImageToWrite& image) {
  Imf::Header header(image.size.width, image.size.height);
  const Compression compression = image.options.compression;
  header.compression() = compression == Compression::kZip   ? Imf::ZIP_COMPRESSION
                         : compression == Compression::kPiz ? Imf::PIZ_COMPRESSION
                                                            : Imf::NO_COMPRESSION;
  const bool is_half = image.options.type == SampleType::kHalf;
  for (const std::string& name : image.channels)
    header.channels().insert(name, Imf::Channel(is_half ? Imf::HALF : Imf::FLOAT));
  for (const auto& [name, text] : image.options.attributes) {
    if (!name.empty() && !text.empty() && !has_a_meaning(name))
      header.insert(name, Imf::StringAttribute(text));
  }
  add_pitch(image.options.pitch_mm, header);
  // Rec.709 with D65.
  if (image.options.color == ColorSpace::kLinearColor) Imf::addChromaticities(header, Imf::Chromaticities());
  return header;
}

int exr_threads() {
  static const int threads = [] {
    const int all = hardware_threads();
    Imf::setGlobalThreadCount(all);
    return all;
  }();
  return threads;
}

}  // namespace weft
