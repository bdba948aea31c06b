// SPDX-License-Identifier: Apache-2.0
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTileDescriptionAttribute.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <set>
#include <utility>

#include "core/image_io/exr_channels.h"
#include "core/image_io/image_source.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

constexpr double kMostPixels = 1e12;

/// How often larger than its file the pixels of an EXR can be, with room above what a constant image gives.
double most_expansion(Imf::Compression compression) {
  if (compression == Imf::NO_COMPRESSION) return 1;
  return compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION ? 1e6 : 1e4;
}

double stored_bytes(const Imf::Header& header, double pixels) {
  double bytes = 0;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
    bytes += c.channel().type == Imf::HALF ? 2 : 4;
  return bytes * pixels;
}

std::vector<std::string> channels_of(const Imf::Header& header) {
  std::vector<std::string> names;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) names.emplace_back(c.name());
  return in_usual_order(std::move(names));
}

/// Whether channels are colours, of a layer or of none, or grey.
bool are_of_light(const std::vector<std::string>& channels) {
  return std::ranges::any_of(
      channels, [](const std::string& name) { return name == "R" || name == "Y" || name.ends_with(".R"); });
}

/// Width and height of the data window, which may be none.
std::array<double, 2> size_of(const Imf::Header& header) {
  const Imath::Box2i& window = header.dataWindow();
  return {1.0 + window.max.x - static_cast<double>(window.min.x),
          1.0 + window.max.y - static_cast<double>(window.min.y)};
}

/// Why such an image is not read, or nothing.
std::string objection(const Imf::Header& header, double width, double height, double file_bytes) {
  if (header.hasType() && Imf::isDeepData(header.type())) return "its pixels have depth";
  if (width < 1 || height < 1 || header.channels().begin() == header.channels().end())
    return "it has no pixels";
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    const int x = c.channel().xSampling, y = c.channel().ySampling;
    if (x != 1 || y != 1)
      return fmt::format("Subsampled channels are not supported (channel \"{}\" has sampling {},{})",
                         c.name(), x, y);
  }
  const Size size = {static_cast<int>(width), static_cast<int>(height)};
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tiles = header.tileDescription();
    if (tile_is_too_large(tiles.xSize, tiles.ySize, size))
      return fmt::format("its tiles of {} x {} pixels are larger than the image", tiles.xSize, tiles.ySize);
  }
  const double stored = stored_bytes(header, width * height);
  if (stored > most_expansion(header.compression()) * file_bytes)
    return fmt::format("its {} x {} pixels of {:.0f} bytes in all are more than its {:.0f} bytes hold",
                       size.width, size.height, stored, file_bytes);
  return "";
}

ImageAttributes attributes_of(const Imf::Header& header) {
  static const std::set<std::string> kOfTheFile = {"ResolutionUnit", "name", "type", "view"};
  ImageAttributes attributes;
  for (auto each = header.begin(); each != header.end(); ++each) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&each.attribute());
    if (text != nullptr && !kOfTheFile.contains(each.name())) attributes[each.name()] = text->value();
  }
  return attributes;
}

ImageFileInfo info_of(const Imf::Header& header, Size size) {
  ImageFileInfo info;
  info.size = size;
  info.type = SampleType::kHalf;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    if (c.channel().type != Imf::HALF) info.type = SampleType::kFloat;
  }
  info.channels = channels_of(header);
  info.format = "openexr";
  const Imath::V2i begin = header.dataWindow().min - header.displayWindow().min;
  info.origin = {begin.x, begin.y};
  info.attributes = attributes_of(header);
  if (Imf::hasXDensity(header)) {
    const double density = static_cast<double>(Imf::xDensity(header));
    info.pitch_mm = pitch_of_density(density, density * static_cast<double>(header.pixelAspectRatio()), 25.4);
  }
  if (Imf::hasChromaticities(header)) {
    info.color = ColorSpace::kLinearColor;
    info.color_by = "its chromaticities";
  }
  return info;
}

/// A channel of a file, its first pixel at `window.min`, as it goes into a plane.
Imf::Slice slice_of(Imf::PixelType type, const Imath::Box2i& window, View<float> plane) {
  const std::int64_t row = 4 * static_cast<std::int64_t>(plane.stride());
  const std::int64_t origin =
      std::bit_cast<std::int64_t>(plane.row(0)) - 4 * std::int64_t{window.min.x} - row * window.min.y;
  return {type == Imf::UINT ? Imf::UINT : Imf::FLOAT, std::bit_cast<char*>(origin), 4,
          static_cast<std::size_t>(row)};
}

/// Counts of 32 bits, which stand where their values will.
void scale_counts(View<float> plane) {
  for (int y = 0; y < plane.height(); ++y) {
    float* row = plane.row(y);
    for (int x = 0; x < plane.width(); ++x)
      row[x] = static_cast<float>(std::bit_cast<std::uint32_t>(row[x]) / 4294967295.0);
  }
}

class ExrSource : public ImageSource {
 public:
  explicit ExrSource(const fs::path& file) : file_(file.c_str(), exr_threads()) {}

  std::string open(double file_bytes) {
    ImageFileInfo parts;
    part_ = choose_part(pictures(), parts);
    const Imf::Header& header = file_.header(part_);
    const std::array<double, 2> size = size_of(header);
    std::string why = objection(header, size[0], size[1], file_bytes);
    if (!why.empty()) return why;
    info_ = info_of(header, {static_cast<int>(size[0]), static_cast<int>(size[1])});
    info_.alike = std::move(parts.alike);
    info_.remarks = std::move(parts.remarks);
    return "";
  }

  /// OpenEXR holds a row of tiles.
  double scratch_bytes() const override {
    const Imf::Header& header = file_.header(part_);
    const double rows = header.hasTileDescription() ? header.tileDescription().ySize : 0;
    return (1 << 20) + 4.0 * static_cast<double>(info_.channels.size()) * rows * info_.size.width;
  }

  std::string read(Image<float>& planes) override {
    Imf::InputPart part(file_, part_);
    const Imath::Box2i& window = part.header().dataWindow();
    const Imf::ChannelList& channels = part.header().channels();
    Imf::FrameBuffer frame;
    for (std::size_t c = 0; c < info_.channels.size(); ++c)
      frame.insert(info_.channels[c],
                   slice_of(channels[info_.channels[c]].type, window, planes.plane(static_cast<int>(c))));
    part.setFrameBuffer(frame);
    part.readPixels(window.min.y, window.max.y);
    for (std::size_t c = 0; c < info_.channels.size(); ++c) {
      if (channels[info_.channels[c]].type == Imf::UINT) scale_counts(planes.plane(static_cast<int>(c)));
    }
    return "";
  }

 private:
  /// The parts that may be a picture, where there is more than one.
  std::vector<PicturePart> pictures() const {
    std::vector<PicturePart> found;
    for (int i = 0; i < file_.parts(); ++i) {
      const Imf::Header& header = file_.header(i);
      const std::vector<std::string> channels = channels_of(header);
      const bool is_deep = header.hasType() && Imf::isDeepData(header.type());
      const std::array<double, 2> size = size_of(header);
      if (is_deep || !are_of_light(channels) || size[0] < 1 || size[1] < 1 || size[0] * size[1] > kMostPixels)
        continue;
      const std::string name = header.hasName() ? fmt::format(" \"{}\"", header.name()) : "";
      found.push_back({i,
                       {static_cast<int>(size[0]), static_cast<int>(size[1])},
                       fmt::format("part {}{}, {} x {} pixels of {}", i + 1, name, size[0], size[1],
                                   fmt::join(channels, ", "))});
    }
    return found;
  }

  Imf::MultiPartInputFile file_;
  int part_ = 0;
};

}  // namespace

Result<std::unique_ptr<ImageSource>> open_exr(const fs::path& file) {
  auto source = std::make_unique<ExrSource>(file);
  if (std::string why = source->open(static_cast<double>(fs::file_size(file))); !why.empty())
    return bad_image(file, std::move(why));
  return std::unique_ptr<ImageSource>(std::move(source));
}

}  // namespace weft
