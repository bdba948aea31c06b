// SPDX-License-Identifier: Apache-2.0
#include "exchange/presets/loss.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "exchange/presets/pack.h"

namespace weft::exchange {
namespace {

constexpr int kLossRows = 64;
constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kDegPerRad = 57.29577951308232;

// Where the file has this channel.
std::optional<std::size_t> index_in(const PresetFile& file, const std::string& channel) {
  const auto found = std::ranges::find(file.channels, channel);
  if (found == file.channels.end()) return std::nullopt;
  return static_cast<std::size_t>(found - file.channels.begin());
}

// Angles by their logarithm, 100 steps an octave.
class AngleCounts {
 public:
  void add(double deg) {
    sum_ += deg;
    max_ = std::max(max_, deg);
    ++count_;
    const double step = deg > kLeast ? 1 + kSteps * std::log2(deg / kLeast) : 0;
    ++counts_[std::min(static_cast<std::size_t>(step), counts_.size() - 1)];
  }
  AngleLoss loss() const {
    std::int64_t seen = 0;
    std::size_t bin = 0;
    while (bin + 1 < counts_.size() && (seen += counts_[bin]) * 100 < count_ * 95) ++bin;
    const double p95 = bin == 0 ? kLeast : kLeast * std::exp2((static_cast<double>(bin) - 0.5) / kSteps);
    return {sum_ / static_cast<double>(std::max<std::int64_t>(count_, 1)), std::min(p95, max_), max_};
  }

 private:
  static constexpr double kLeast = 1e-5;
  static constexpr double kSteps = 100;
  std::vector<std::int64_t> counts_ = std::vector<std::int64_t>(2500);
  std::int64_t count_ = 0;
  double sum_ = 0, max_ = 0;
};

// The views of some rows of an image.
std::vector<View<float>> rows_of(Image<float>& image, int y0, int rows) {
  std::vector<View<float>> views;
  for (int p = 0; p < image.planes(); ++p)
    views.push_back(image.plane(p).crop({0, y0, image.width(), y0 + rows}));
  return views;
}

// A direction of two or three parts.
std::array<float, 3> direction(const std::vector<View<float>>& values,
                               const std::array<std::size_t, 3>& places, bool has_z, int x, int y) {
  const float nx = values[places[0]](x, y), ny = values[places[1]](x, y);
  const float nz = has_z ? values[places[2]](x, y) : std::sqrt(std::max(0.0F, 1 - nx * nx - ny * ny));
  return {nx, ny, nz};
}

class LossMeter {
 public:
  LossMeter(const PresetFile& file, const ChannelFacts& facts) : file_(file) {
    const auto x = index_in(file, "normal.x"), y = index_in(file, "normal.y"), z = index_in(file, "normal.z");
    has_normal_ = x && y;
    has_z_ = z.has_value();
    normal_ = {x.value_or(0), y.value_or(0), z.value_or(0)};
    const auto r = index_in(file, "albedo.r"), g = index_in(file, "albedo.g"), b = index_in(file, "albedo.b");
    has_albedo_ = r && g && b;
    albedo_ = {r.value_or(0), g.value_or(0), b.value_or(0)};
    for (const std::string& name : file.channels) {
      ranges_.push_back(range_of(*channel_named(name), facts));
      loss_.channels.push_back({.channel = name, .least = kNever, .most = -kNever});
    }
  }

  void add_values(const std::vector<View<float>>& truth, const std::vector<View<float>>& read);
  void add_samples(const std::vector<View<float>>& truth, const std::vector<View<float>>& read);
  Loss loss(Size size);

 private:
  void add_channel(std::size_t c, View<const float> truth, View<const float> read);

  const PresetFile& file_;
  Loss loss_;
  std::vector<ChannelRange> ranges_;
  AngleCounts angles_;
  std::array<std::size_t, 3> normal_ = {}, albedo_ = {};
  bool has_normal_ = false, has_z_ = false, has_albedo_ = false;
  double albedo_abs_ = 0, albedo_squares_ = 0;
};

void LossMeter::add_channel(std::size_t c, View<const float> truth, View<const float> read) {
  ChannelLoss& loss = loss_.channels[c];
  constexpr double kLargestHalf = 65504;
  const bool is_half = file_.stored.is_float() && file_.stored.bits == 16;
  const double span = ranges_[c].most - ranges_[c].least;
  const double least = is_half ? -kLargestHalf : ranges_[c].least - 1e-6 * span;
  const double most = is_half ? kLargestHalf : ranges_[c].most + 1e-6 * span;
  const bool is_cut = is_half || !file_.stored.is_float();
  for (int y = 0; y < truth.height(); ++y) {
    for (int x = 0; x < truth.width(); ++x) {
      const auto value = static_cast<double>(truth(x, y));
      const double difference = std::abs(value - static_cast<double>(read(x, y)));
      loss.least = std::min(loss.least, value);
      loss.most = std::max(loss.most, value);
      loss.mean += value;
      loss.mean_abs += difference;
      loss.most_abs = std::max(loss.most_abs, difference);
      loss.cut += is_cut && (value < least || value > most) ? 1 : 0;
    }
  }
}

void LossMeter::add_values(const std::vector<View<float>>& truth, const std::vector<View<float>>& read) {
  for (std::size_t c = 0; c < truth.size(); ++c) add_channel(c, truth[c], read[c]);
  for (int y = 0; y < truth.front().height(); ++y) {
    for (int x = 0; x < truth.front().width(); ++x) {
      if (has_normal_) {
        angles_.add(angle_deg(direction(truth, normal_, has_z_, x, y).data(),
                              direction(read, normal_, has_z_, x, y).data()));
      }
      for (std::size_t i = 0; has_albedo_ && i < 3; ++i)
        albedo_abs_ += static_cast<double>(std::abs(truth[albedo_[i]](x, y) - read[albedo_[i]](x, y)));
    }
  }
}

void LossMeter::add_samples(const std::vector<View<float>>& truth, const std::vector<View<float>>& read) {
  if (!has_albedo_) return;
  for (const std::size_t c : albedo_) {
    for (int y = 0; y < truth[c].height(); ++y) {
      for (int x = 0; x < truth[c].width(); ++x) {
        const double wanted = file_.stored.is_float()
                                  ? static_cast<double>(truth[c](x, y))
                                  : std::clamp(static_cast<double>(truth[c](x, y)), 0.0, 1.0);
        const double difference = wanted - static_cast<double>(read[c](x, y));
        albedo_squares_ += difference * difference;
      }
    }
  }
}

Loss LossMeter::loss(Size size) {
  const auto pixels = static_cast<double>(size.pixels());
  for (ChannelLoss& channel : loss_.channels) {
    channel.mean /= pixels;
    channel.mean_abs /= pixels;
  }
  if (has_normal_) loss_.normal = angles_.loss();
  if (has_albedo_) {
    loss_.albedo = {.mean_abs = albedo_abs_ / (3 * pixels)};
    const double mean_square = albedo_squares_ / (3 * pixels);
    if (mean_square > 1e-20) loss_.albedo->psnr_db = -10 * std::log10(mean_square);
  }
  return std::move(loss_);
}

constexpr int kFewestTexels = 8;

DistanceLoss difference_of(const std::string& channel, int level, View<const float> own,
                           View<const float> engine) {
  DistanceLoss loss = {.channel = channel, .level = level};
  for (int y = 0; y < own.height(); ++y) {
    for (int x = 0; x < own.width(); ++x) {
      loss.mean += static_cast<double>(own(x, y));
      loss.engine += static_cast<double>(engine(x, y));
      loss.mean_abs += static_cast<double>(std::abs(own(x, y) - engine(x, y)));
    }
  }
  const auto texels = static_cast<double>(own.size().pixels());
  for (double* sum : {&loss.mean, &loss.engine, &loss.mean_abs}) *sum /= texels;
  return loss;
}

}  // namespace

void describe(Fields& fields, AngleLoss& l) {
  fields.value({"mean", "Degrees", {}, kOrNull}, l.mean_deg);
  fields.value({"p95", "95th percentile, degrees", {}, kOrNull}, l.p95_deg);
  fields.value({"max", "Degrees", {}, kOrNull}, l.max_deg);
}

void describe(Fields& fields, ColorLoss& l) {
  fields.value({"mean", "Of the difference of reflectances", {}, kOrNull}, l.mean_abs);
  fields.value({"psnr_db", "Of the samples; null where nothing is lost", {}, kOrNull}, l.psnr_db);
}

void describe(Fields& fields, DistanceLoss& l) {
  fields.value({"channel", "Which roughness", {}, kMustSay}, l.channel);
  fields.value({"level", "Seen from 2 to its power times as far", {}, kMustSay}, l.level);
  fields.value({"mean", "Of the cloth", {}, kOrNull}, l.mean);
  fields.value({"engine", "Of means of the file, as an engine makes them", {}, kOrNull}, l.engine);
  fields.value({"lost", "Mean of the difference", {}, kOrNull}, l.mean_abs);
}

void describe(Fields& fields, Loss& l) {
  fields.object({"normal_deg", "Angles between normals, degrees", {}, kUnlessEmpty}, l.normal);
  fields.object({"albedo", "Of colours", {}, kUnlessEmpty}, l.albedo);
  fields.list({"by_distance", "Of a file of one level: what becomes of its roughness", {}, kUnlessEmpty},
              l.by_distance);
}

double angle_deg(const float* a, const float* b) {
  const double ax = static_cast<double>(a[0]), ay = static_cast<double>(a[1]), az = static_cast<double>(a[2]);
  const double bx = static_cast<double>(b[0]), by = static_cast<double>(b[1]), bz = static_cast<double>(b[2]);
  const double cx = ay * bz - az * by, cy = az * bx - ax * bz, cz = ax * by - ay * bx;
  return kDegPerRad * std::atan2(std::sqrt(cx * cx + cy * cy + cz * cz), ax * bx + ay * by + az * bz);
}

Loss measure_loss(const PresetFile& file, const SourcePlanes& planes, const ChannelFacts& facts,
                  Image<float> samples) {
  const Size size = samples.size();
  LossMeter meter(file, facts);
  Image<float> truth({size.width, std::min(kLossRows, size.height)}, samples.planes());
  for (int y = 0; y < size.height; y += kLossRows) {
    const int rows = std::min(kLossRows, size.height - y);
    const std::vector<View<float>> wanted = rows_of(truth, 0, rows), read = rows_of(samples, y, rows);
    pack_values(file, planes, facts, y, wanted);
    to_samples(file, facts, wanted);
    meter.add_samples(wanted, read);
    pack_values(file, planes, facts, y, wanted);
    to_values(file, facts, read);
    meter.add_values(wanted, read);
  }
  return meter.loss(size);
}

std::vector<DistanceLoss> loss_by_distance(const PresetFile& file, const SourcePlanes& planes,
                                           const ChannelFacts& facts, LobeLevels lobe, Size size,
                                           int threads) {
  std::vector<DistanceLoss> losses;
  for (const std::string& name : file.channels) {
    if (!name.starts_with("roughness")) continue;
    const PresetFile alone = {.name = file.name, .channels = {name}, .stored = file.stored};
    Image<float> engine(size), own;
    const View<float> values = engine.plane();
    pack_values(alone, planes, facts, 0, {&values, 1});
    for (int level = 1; level <= static_cast<int>(lobe.size()); ++level) {
      engine = next_level(alone, engine, threads);
      if (std::min(engine.width(), engine.height()) < kFewestTexels) break;
      own = Image<float>(engine.size());
      put_lobe(alone, facts, lobe, level, own);
      losses.push_back(difference_of(name, level, own.plane(), engine.plane()));
    }
  }
  return losses;
}

}  // namespace weft::exchange
