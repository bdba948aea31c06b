// SPDX-License-Identifier: Apache-2.0
#include "library/import/source_frame.h"

#include <cmath>
#include <limits>
#include <utility>

#include "capture/camera/photograph_facts.h"
#include "capture/raw/decode_raw.h"
#include "capture/raw/raw_info.h"
#include "core/base/iso_time.h"
#include "core/base/statistics.h"
#include "core/image_io/linear_image.h"

namespace weft::library {
namespace {

constexpr double kBright = 0.9;         // share of the patches
constexpr double kHalfOfLittle = 1e-5;  // seconds: milliseconds are cut, not rounded

Result<void> read_header(SourceFrame& frame) {
  const std::filesystem::path& file = frame.source.file;
  if (!frame.source.is_developed) {
    Result<capture::RawInfo> info = capture::read_raw_info(file);
    if (!info) return std::move(info).error();
    frame.size = info->size;
    frame.cfa = info->cfa;
    frame.shot = std::move(info->shot);
    return {};
  }
  const Result<ImageFileInfo> info = read_linear_image_info(file);
  if (!info) return info.error();
  if (transfer_of(*info) != Transfer::kLinear || info->format == "jpeg") {
    return Error{ErrorKind::kBadData, "photograph is not linear", file.string(),
                 info->type == SampleType::kUint8 ? "it holds 8 bits, which went through a tone curve"
                                                  : "it says that it went through a tone curve",
                 "export 16-bit TIFF or float EXR files without a curve"};
  }
  frame.size = info->size;
  return {};
}

double developed_light_on(const Image<float>& image, Rect patch, const capture::GlanceScale& scale) {
  std::array<double, 3> sum = {};
  for (int y = patch.y0; y < patch.y1; ++y) {
    for (int x = patch.x0; x < patch.x1; ++x) {
      for (int c = 0; c < 3; ++c) {
        const float v = image(x, y, c);
        if (!std::isfinite(v)) return std::numeric_limits<double>::quiet_NaN();
        sum[static_cast<std::size_t>(c)] += v;
      }
    }
  }
  double light = 0;
  for (std::size_t c = 0; c < 3; ++c) light += scale.weight_rgb[c] * sum[c];
  return light / (3 * static_cast<double>(patch.pixels()));
}

}  // namespace

Result<SourceFrame> look_at_frame(const SourceFile& source, const NameParts& said) {
  SourceFrame frame;
  frame.source = source;
  frame.said = said;
  frame.label = source.file.lexically_relative(source.root).generic_string();
  if (Result<void> ok = read_header(frame); !ok) return std::move(ok).error();
  const Result<capture::PhotographFacts> facts = capture::read_photograph_facts(source.file);
  if (!facts) return facts.error();
  frame.taken_s = facts->taken_s;
  frame.image_number = facts->image_number;
  frame.knows_zone = facts->taken_s.has_value() && facts->zone_s.has_value();
  if (frame.knows_zone) *frame.taken_s -= *facts->zone_s;
  return frame;
}

std::string time_words(const SourceFrame& frame) {
  if (!frame.taken_s) return "";
  std::string words = iso_time(*frame.taken_s + kHalfOfLittle);
  if (!frame.knows_zone && words.ends_with('Z')) words.pop_back();
  return words;
}

Result<std::vector<double>> light_of(const SourceFrame& frame, const capture::PatchGrid& grid,
                                     const capture::GlanceScale& scale) {
  if (!frame.source.is_developed) {
    const Result<RawFrame> raw = capture::decode_raw(frame.source.file, {.size = grid.frame});
    if (!raw) return raw.error();
    return capture::glance_at(*raw, grid, scale);
  }
  const Result<Image<float>> image =
      read_linear_image(frame.source.file, Transfer::kLinear, Clipped::kMark, NotNumbers::kMark);
  if (!image) return image.error();
  std::vector<double> light;
  for (int i = 0; i < grid.count(); ++i) light.push_back(developed_light_on(*image, grid.patch(i), scale));
  return light;
}

double level_of(const std::vector<double>& light) {
  const std::vector<double> read = finite(light);
  return read.empty() ? 1 : lower_quantile(read, kBright);
}

}  // namespace weft::library
