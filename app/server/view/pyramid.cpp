// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/pyramid.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/json_document.h"
#include "core/base/parallel.h"
#include "core/solve/solve_record.h"
#include "core/solve/status_blend.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr int kFirstKept = 2;  // level; those below are cut
constexpr int kFlagBits = static_cast<int>(kStatusNames.size());
constexpr int kRowsAtOnce = 256;  // of the map, while levels are made
constexpr int kMakers = 2;        // threads: a scan may run beside

Size halved(Size size) {
  return {(size.width + 1) / 2, (size.height + 1) / 2};
}

/// Averages of 2 x 2 pixels, at the right and lower edge of those there are.
// How often it is halved until no side is longer.
int halvings_to(Size size, int side) {
  int count = 0;
  for (; std::max(size.width, size.height) > side; size = halved(size)) ++count;
  return count;
}

Image<float> halved(const Image<float>& image, bool is_deviation) {
  Image<float> half(halved(image.size()), image.planes());
  const int last_x = image.width() - 1, last_y = image.height() - 1;
  for (int p = 0; p < image.planes(); ++p) {
    for (int y = 0; y < half.height(); ++y) {
      const float* upper = image.plane(p).row(2 * y);
      const float* lower = image.plane(p).row(std::min(2 * y + 1, last_y));
      float* out = half.plane(p).row(y);
      const auto average = [&](int left, int right) {
        const float a = upper[left], b = upper[right], c = lower[left], d = lower[right];
        return is_deviation ? std::sqrt(0.25F * (a * a + b * b + c * c + d * d)) : 0.25F * (a + b + c + d);
      };
      for (int x = 0; x < image.width() / 2; ++x) out[x] = average(2 * x, 2 * x + 1);
      if (half.width() > image.width() / 2) out[half.width() - 1] = average(last_x, last_x);
    }
  }
  return half;
}

void paste(const Image<float>& part, int row, Image<float>& into) {
  for (int p = 0; p < part.planes(); ++p) {
    for (int y = 0; y < part.height(); ++y)
      std::copy_n(part.plane(p).row(y), part.width(), into.plane(p).row(row + y));
  }
}

/// Planes of shares, a bit each, and of any.
Image<float> shares_of(const Image<float>& bits) {
  Image<float> shares(bits.size(), kFlagBits + 1);
  for (int y = 0; y < bits.height(); ++y) {
    for (int x = 0; x < bits.width(); ++x) {
      const auto status = static_cast<unsigned>(bits(x, y));
      for (int bit = 0; bit < kFlagBits; ++bit) shares(x, y, bit) = static_cast<float>((status >> bit) & 1U);
      shares(x, y, kFlagBits) = (status & ~(kHowSolved | kBlendBits)) != 0 ? 1.0F : 0.0F;
    }
  }
  return shares;
}

Image<float> one_plane(const Image<float>& image, int plane) {
  Image<float> one(image.size());
  for (int y = 0; y < image.height(); ++y)
    std::copy_n(image.plane(plane).row(y), image.width(), one.plane().row(y));
  return one;
}

Rect doubled(Rect part, Size within) {
  return {2 * part.x0, 2 * part.y0, std::min(2 * part.x1, within.width),
          std::min(2 * part.y1, within.height)};
}

}  // namespace

Result<std::unique_ptr<Pyramid>> Pyramid::open(const fs::path& folder, const Layer& layer,
                                               const fs::path& kept) {
  std::unique_ptr<Pyramid> pyramid(new Pyramid(layer, kept));
  Result<ExrWindow> map = Error{ErrorKind::kUsage, "", "", "", ""};
  if (layer.kind != LayerKind::kFlags) {
    map = ExrWindow::open(folder / layer.file);
    if (!map && map.error().kind != ErrorKind::kUsage) return std::move(map).error();
  }
  if (!map && !is_there(pyramid->file_of(0))) {
    if (Result<void> ok = pyramid->unpack(folder / layer.file); !ok) return std::move(ok).error();
  }
  if (!map) map = ExrWindow::open(pyramid->file_of(0));
  if (!map) return std::move(map).error();
  pyramid->size_ = map->size();
  pyramid->map_ = std::move(*map);
  return pyramid;
}

Result<std::unique_ptr<Pyramid>> Pyramid::open_raw(const fs::path& file, const fs::path& kept) {
  std::unique_ptr<Pyramid> pyramid(
      new Pyramid({"raw", LayerKind::kMosaic, "share", file.filename().string(), {"Y"}, false}, kept));
  if (!is_there(pyramid->file_of(0))) {
    const Result<RawFrame> raw = capture::decode_raw(file);
    if (!raw) return raw.error();
    Image<float> shares(raw->counts.size());
    for (int y = 0; y < shares.height(); ++y) {
      const auto& black = raw->black[static_cast<std::size_t>(y & 1)];
      const std::uint16_t* counts = raw->counts.plane().row(y);
      for (int x = 0; x < shares.width(); ++x) {
        const float dark = black[static_cast<std::size_t>(x & 1)];
        shares(x, y) = (static_cast<float>(counts[x]) - dark) / (raw->white - dark);
      }
    }
    if (Result<void> ok = make_writable_folder(kept); !ok) return std::move(ok).error();
    const Result<void> said = write_file(kept / "filters.json", Json(raw->cfa.site).dump());
    if (!said) return said.error();
    if (Result<void> ok = pyramid->keep(0, shares, {"Y"}); !ok) return std::move(ok).error();
  }
  const Result<std::string> filters = read_text(kept / "filters.json");
  if (!filters) return filters.error();
  pyramid->cfa_.site = Json::parse(*filters).get<decltype(CfaPattern::site)>();
  Result<ExrWindow> map = ExrWindow::open(pyramid->file_of(0));
  if (!map) return std::move(map).error();
  pyramid->size_ = map->size();
  pyramid->map_ = std::move(*map);
  return pyramid;
}

int levels_of(Size size) {
  return halvings_to(size, kLeastSide) + 1;
}

int Pyramid::levels() const {
  return levels_of(size_);
}

int Pyramid::top() const {
  return halvings_to(size_, kTileSide);
}

Size Pyramid::size(int level) const {
  Size size = size_;
  for (int i = 0; i < level; ++i) size = halved(size);
  return size;
}

std::optional<Rect> Pyramid::tile(int level, int column, int row) const {
  if (level < 0 || level >= levels() || column < 0 || row < 0) return std::nullopt;
  const Size whole = size(level);
  if (column > (whole.width - 1) / kTileSide || row > (whole.height - 1) / kTileSide) return std::nullopt;
  const int x = column * kTileSide, y = row * kTileSide;
  return Rect{x, y, std::min(x + kTileSide, whole.width), std::min(y + kTileSide, whole.height)};
}

Result<Image<float>> Pyramid::read(int level, Rect part, int bit) {
  if (layer_.kind == LayerKind::kFlags) {
    Result<Image<float>> shares = read_flags(level, part);
    if (!shares) return shares;
    return one_plane(*shares, bit < 0 ? kFlagBits : bit);
  }
  if (level == 1) return read_halved(part);
  if (level == 0 && layer_.kind == LayerKind::kMosaic) return read_mosaic(part);
  const Result<ExrWindow> window = window_of(level);
  if (!window) return window.error();
  return window->read(part, channels_of(level));
}

fs::path Pyramid::file_of(int level) const {
  const std::string bits = layer_.kind == LayerKind::kFlags ? fmt::format("-{}bits", kFlagBits) : "";
  return kept_ / fmt::format("{}{}-{}.exr", layer_.name, bits, level);
}

std::vector<std::string> Pyramid::channels_of(int level) const {
  if (layer_.kind == LayerKind::kMosaic && level > 0) return {"R", "G", "B"};
  if (layer_.kind != LayerKind::kFlags || level == 0) return layer_.channels;
  std::vector<std::string> names;
  for (int bit = 0; bit < kFlagBits; ++bit) names.push_back(fmt::format("bit{}", bit));
  names.emplace_back("any");
  return names;
}

Result<void> Pyramid::keep(int level, const Image<float>& image,
                           const std::vector<std::string>& channels) const {
  std::vector<View<const float>> planes;
  for (int p = 0; p < image.planes(); ++p) planes.push_back(image.plane(p));
  WriteOptions options;
  options.type = SampleType::kHalf;
  return write_image(file_of(level), planes, channels, options);
}

/// Bits of a PNG as numbers; of other maps their values.
Result<void> Pyramid::unpack(const fs::path& map) {
  Result<LoadedImage> image = read_image(map);
  if (!image) return std::move(image).error();
  Image<float> planes(image->info.size, static_cast<int>(layer_.channels.size()));
  const float scale = layer_.kind == LayerKind::kFlags ? 65535 : 1;
  for (int p = 0; p < planes.planes(); ++p) {
    const View<const float> from = image->channel(layer_.channels[static_cast<std::size_t>(p)]);
    for (int y = 0; y < planes.height(); ++y) {
      std::transform(from.row(y), from.row(y) + planes.width(), planes.plane(p).row(y),
                     [&](float v) { return scale * v; });
    }
  }
  if (Result<void> ok = make_writable_folder(kept_); !ok) return ok;
  std::vector<View<const float>> views;
  for (int p = 0; p < planes.planes(); ++p) views.push_back(planes.plane(p));
  WriteOptions options;
  options.type = image->info.type == SampleType::kHalf || layer_.kind == LayerKind::kFlags
                     ? SampleType::kHalf
                     : SampleType::kFloat;
  return write_image(file_of(0), views, layer_.channels, options);
}

Result<ExrWindow> Pyramid::window_of(int level) {
  if (level == 0) return *map_;
  const std::lock_guard lock(making_);
  // The topmost is written last: where it is, all are.
  if (!is_there(file_of(levels() - 1)) || !is_there(file_of(level))) {
    if (Result<void> made = make_levels(); !made) return std::move(made).error();
  }
  return ExrWindow::open(file_of(level));
}

Result<void> Pyramid::make_levels() {
  if (Result<void> ok = make_writable_folder(kept_); !ok) return ok;
  const Size half = size(1), quarter = size(kFirstKept);
  const std::vector<std::string> channels = channels_of(kFirstKept);
  Image<float> image(quarter, static_cast<int>(channels.size()));
  const int step = kRowsAtOnce / 4;
  const auto bands = static_cast<std::size_t>((quarter.height + step - 1) / step);
  std::vector<Result<void>> done(bands);
  parallel_for(bands, kMakers, [&](std::size_t band, int) {
    const int row = static_cast<int>(band) * step;
    const Rect rows = {0, 2 * row, half.width, std::min(2 * (row + step), half.height)};
    const Result<Image<float>> part =
        layer_.kind == LayerKind::kFlags ? read_flags(1, rows) : read_halved(rows);
    if (!part) {
      done[band] = part.error();
    } else {
      paste(halved(*part, layer_.is_deviation), row, image);
    }
  });
  for (Result<void>& each : done) {
    if (!each) return std::move(each);
  }
  for (int level = kFirstKept; level < levels(); ++level) {
    if (level > kFirstKept) image = halved(image, layer_.is_deviation);
    if (Result<void> ok = keep(level, image, channels); !ok) return ok;
  }
  return {};
}

Result<Image<float>> Pyramid::read_flags(int level, Rect part) {
  if (level <= 1) {
    const Rect below = level == 0 ? part : doubled(part, size_);
    const Result<Image<float>> bits = map_->read(below, layer_.channels);
    if (!bits) return bits.error();
    Image<float> shares = shares_of(*bits);
    return level == 0 ? std::move(shares) : halved(shares, false);
  }
  const Result<ExrWindow> window = window_of(level);
  if (!window) return window.error();
  return window->read(part, channels_of(level));
}

Result<Image<float>> Pyramid::read_halved(Rect part) {
  const Rect below = doubled(part, size_);
  const Result<Image<float>> full =
      layer_.kind == LayerKind::kMosaic ? read_mosaic(below) : map_->read(below, layer_.channels);
  if (!full) return full.error();
  return halved(*full, layer_.is_deviation);
}

/// Each photosite with the colours of its cell; a last column or row without a cell shows its neighbour's.
Result<Image<float>> Pyramid::read_mosaic(Rect part) {
  const Size even = {size_.width & ~1, size_.height & ~1};
  const Rect cells = {std::min(part.x0, even.width - 1) & ~1, std::min(part.y0, even.height - 1) & ~1,
                      std::min((part.x1 + 1) & ~1, even.width), std::min((part.y1 + 1) & ~1, even.height)};
  const Result<Image<float>> sites = map_->read(cells, layer_.channels);
  if (!sites) return sites.error();
  Image<float> rgb({part.width(), part.height()}, 3);
  for (int y = 0; y < rgb.height(); ++y) {
    const int cell_y = (std::min(part.y0 + y, even.height - 1) & ~1) - cells.y0;
    for (int x = 0; x < rgb.width(); ++x) {
      const int cell_x = (std::min(part.x0 + x, even.width - 1) & ~1) - cells.x0;
      for (int i = 0; i < 4; ++i) {
        const int channel = cfa_.channel_at(i & 1, i >> 1);
        rgb(x, y, channel) += (channel == 1 ? 0.5F : 1.0F) * (*sites)(cell_x + (i & 1), cell_y + (i >> 1));
      }
    }
  }
  return rgb;
}

}  // namespace weft::app
