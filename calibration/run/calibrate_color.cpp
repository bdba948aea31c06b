// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_color.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/color/chart.h"
#include "calibration/run/chart_pictures.h"
#include "calibration/run/color_report.h"
#include "calibration/run/described.h"
#include "core/base/files.h"
#include "core/describe/field_check.h"
#include "core/rig/color_transform.h"
#include "core/rig/suits.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kFullShareOfPatch = 0.01;  // of a patch's pixels
constexpr double kUneven = 0.12;            // of a patch's light
constexpr double kShaded = 0.8;             // of the light that a patch should have
constexpr std::size_t kFewestPatches = 18;  // patches
constexpr double kDark = 0.03;              // of full scale: a photograph's white
constexpr double kSloped = 0.5;             // of the light over the chart
constexpr double kWhiteOff = 0.02;          // of the greys of solved albedo
constexpr double kScaleOff = 0.03;
constexpr const char* kExposeWhite =
    "expose the chart so that its white patch is at 80 percent of full scale";
constexpr std::size_t kWhite = 18;              // patches from 0
constexpr int kFirstGrey = 19, kLastGrey = 22;  // neutral 8 to neutral 3.5

// One picture's patches, balanced and with its light taken out; of patches that cannot be used camera is 0.
struct FlatChart {
  std::array<Rgb, kChartPatches> camera = {};
  std::array<bool, kChartPatches> is_good = {};
  std::array<double, 3> gain = {1, 1, 1};  // of the greys, over green: taken out of `camera`
  double scale = 1;
  double slope_of_light = 0;
};

std::string names_of(const std::vector<int>& patches) {
  std::string names;
  for (const int p : patches) {
    names += fmt::format("{}{} ({})", names.empty() ? "" : ", ", p + 1, patch_name(p));
  }
  return names;
}

Error bad_chart(const ChartPicture& picture, std::string what, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, std::move(what), picture.source.string(), std::move(why), std::move(remedy)};
}

class ChartReader {
 public:
  ChartReader(const CalibrateColorOptions& options, const ChartColors& colors, ColorMeasurement& out,
              std::vector<std::string>& warnings)
      : options_(options), colors_(colors), out_(out), warnings_(warnings) {}

  Result<FlatChart> read(const ChartPicture& picture) {
    if (Result<void> ok = check_measured(picture.rgb, colors_, picture.source.string()); !ok)
      return std::move(ok).error();
    Result<std::vector<PatchReading>> patches = find_patches(picture);
    if (!patches) return std::move(patches).error();
    FlatChart chart;
    if (Result<void> ok = choose(picture, *patches, chart); !ok) return std::move(ok).error();
    if (!picture.is_albedo && chart.camera[kWhite][1] < kDark) {
      note("CHART_DARK",
           fmt::format("{}: the white patch is at {:.1f} percent of full scale", picture.source.string(),
                       100 * chart.camera[kWhite][1]),
           kExposeWhite);
    }
    balance(chart);
    if (picture.is_albedo) check_white(chart);
    if (Result<void> ok = take_light_out(picture, chart); !ok) return std::move(ok).error();
    return chart;
  }

 private:
  void note(const char* name, std::string text, std::string remedy) {
    out_.verdicts.push_back({name, std::move(text), std::move(remedy)});
  }

  // The patches of the upright chart.
  Result<std::vector<PatchReading>> find_patches(const ChartPicture& picture) {
    ChartCorners corners = {};
    if (!options_.corners_px.empty()) {
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t k = 0; k < 2; ++k) {
          corners[i][k] = (options_.corners_px[2 * i + k] + 0.5) / picture.pixels - 0.5;
        }
      }
    } else {
      const auto found = find_chart(picture.rgb);
      if (!found) {
        Error error = found.error();
        error.where = picture.source.string();
        return error;
      }
      corners = *found;
    }
    Result<std::vector<PatchReading>> patches = read_patches(picture.rgb, corners);
    if (!patches) {
      Error error = patches.error();
      error.where = picture.source.string();
      return error;
    }
    const auto full = std::count_if(patches->begin(), patches->end(),
                                    [](const PatchReading& p) { return p.full_share > kFullShareOfPatch; });
    if (full > kChartPatches - static_cast<int>(kFewestPatches)) {
      return bad_chart(picture, "too many patches are full", fmt::format("{} of 24", full), kExposeWhite);
    }
    const ChartSide side = side_of(*patches, colors_.reference);
    if (side == ChartSide::kUpright) {
      const bool lies_turned = corners[1][0] < corners[0][0];
      if (lies_turned) {
        warnings_.push_back(
            fmt::format("{}: the chart lies upside down, and was read so", picture.source.string()));
      }
      return patches;
    }
    if (side == ChartSide::kUpsideDown && options_.corners_px.empty()) {
      std::reverse(patches->begin(), patches->end());
      warnings_.push_back(
          fmt::format("{}: the chart lies upside down, and was read so", picture.source.string()));
      return patches;
    }
    if (side == ChartSide::kUpsideDown) {
      return bad_chart(picture, "the chart is upside down", "its greys are where its skin colours should be",
                       "name the corners from patch 1 (dark skin) on");
    }
    if (side == ChartSide::kMirrored) {
      return bad_chart(picture, "the chart is mirrored", "its columns or rows run backwards",
                       !options_.corners_px.empty() ? "name the corners clockwise from patch 1 (dark skin) on"
                                                    : "use the picture as the camera took it, not flipped");
    }
    return bad_chart(picture, "this is not the chart",
                     "its patches do not have the colours of a 24-patch chart",
                     "check the corners, and chart.toml where the chart is not the classic one");
  }

  Result<void> choose(const ChartPicture& picture, const std::vector<PatchReading>& patches,
                      FlatChart& chart) {
    std::vector<int> full, uneven;
    for (int i = 0; i < kChartPatches; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const PatchReading& p = patches[at];
      chart.camera[at] = p.mean;
      chart.is_good[at] = p.full_share <= kFullShareOfPatch && p.mean[1] > 0;
      if (p.full_share > kFullShareOfPatch) full.push_back(i);
      const double noise = p.mean[1] > 0 ? p.sigma[1] / p.mean[1] : 0;
      if (p.unevenness > kUneven + 10 * noise) uneven.push_back(i);
    }
    if (!full.empty()) {
      note("PATCHES_FULL",
           fmt::format("{}: patches {} are full and were left out", picture.source.string(), names_of(full)),
           "expose the chart shorter");
    }
    if (!uneven.empty()) {
      note("PATCHES_UNEVEN",
           fmt::format("{}: patches {} are not even: dirt, a highlight or the edge of a shadow",
                       picture.source.string(), names_of(uneven)),
           "clean the chart and keep lamps and shadows off it");
    }
    const auto good = static_cast<std::size_t>(std::count(chart.is_good.begin(), chart.is_good.end(), true));
    if (good >= kFewestPatches) return {};
    return bad_chart(picture, "too many patches are full or black",
                     fmt::format("{} of 24 can be used, {} are needed", good, kFewestPatches), kExposeWhite);
  }

  // Mean over the greys of a channel over green, against the reference.
  std::array<double, 3> gain_of_greys(const FlatChart& chart) const {
    std::array<double, 3> sum = {}, reference = {};
    for (int i = kFirstGrey; i <= kLastGrey; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!chart.is_good[at]) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        sum[c] += chart.camera[at][c] / chart.camera[at][1];
        reference[c] += colors_.reference[at][c] / colors_.reference[at][1];
      }
    }
    if (sum[1] == 0) return {1, 1, 1};
    return {sum[0] / reference[0], 1, sum[2] / reference[2]};
  }

  void balance(FlatChart& chart) const {
    chart.gain = gain_of_greys(chart);
    for (Rgb& rgb : chart.camera) {
      for (std::size_t c = 0; c < 3; ++c) rgb[c] /= chart.gain[c];
    }
  }

  void check_white(const FlatChart& chart) {
    const std::array<double, 3>& gain = chart.gain;
    const double worst = std::max(std::abs(gain[0] - 1), std::abs(gain[2] - 1));
    if (worst <= kWhiteOff) return;
    note("WHITE_OFF",
         fmt::format(
             "the chart's greys come out with {:+.1f} percent red and {:+.1f} percent blue over green, "
             "which the fluxes of the lights now make up for",
             100 * (gain[0] - 1), 100 * (gain[2] - 1)),
         "calibrate the lights on a white sheet without brighteners the next time");
  }

  Result<void> take_light_out(const ChartPicture& picture, FlatChart& chart) {
    std::vector<int> numbers;
    const std::vector<ChartSample> samples = samples_of(chart, colors_.reference, numbers);
    const Result<std::vector<double>> light = light_of_each(samples);
    if (!light) return light.error();
    std::vector<int> shaded;
    double darkest = 1;
    for (std::size_t i = 0; i < light->size(); ++i) {
      if ((*light)[i] >= kShaded) continue;
      shaded.push_back(numbers[i]);
      darkest = std::min(darkest, (*light)[i]);
    }
    if (shaded.size() > 1) {
      return bad_chart(picture, "part of the chart is in shadow",
                       fmt::format("patches {} have down to {:.0f} percent of their light", names_of(shaded),
                                   100 * darkest),
                       "move what stands between lamp and chart, or turn the chart");
    }
    const auto fit = fit_color(samples, picture.is_albedo ? ChartLight::kEven : ChartLight::kShaded, false);
    if (!fit) return fit.error();
    chart.scale = fit->scale;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      for (double& v : chart.camera[static_cast<std::size_t>(numbers[i])]) v *= fit->scale / fit->light[i];
    }
    const auto [least, most] = std::minmax_element(fit->light.begin(), fit->light.end());
    chart.slope_of_light = *most / *least - 1;
    if (chart.slope_of_light > kSloped) {
      note("CHART_UNEVENLY_LIT",
           fmt::format("{}: light differs by {:.0f} percent over the chart", picture.source.string(),
                       100 * chart.slope_of_light),
           "light the chart from farther away, or scan it as a session");
    }
    return {};
  }

 public:
  static std::vector<ChartSample> samples_of(const FlatChart& chart, const ChartReference& reference,
                                             std::vector<int>& numbers) {
    std::vector<ChartSample> samples;
    for (int i = 0; i < kChartPatches; ++i) {
      const auto at = static_cast<std::size_t>(i);
      if (!chart.is_good[at]) continue;
      numbers.push_back(i);
      samples.push_back({chart.camera[at], reference[at], 2.0 * (i % kChartColumns) / (kChartColumns - 1) - 1,
                         2.0 * (i / kChartColumns) / (kChartRows - 1) - 1});
    }
    return samples;
  }

 private:
  const CalibrateColorOptions& options_;
  const ChartColors& colors_;
  ColorMeasurement& out_;
  std::vector<std::string>& warnings_;
};

// The mean of several pictures, patch by patch, over those that are good in each.
FlatChart mean_of_charts(const std::vector<FlatChart>& charts) {
  FlatChart mean = charts.front();
  const auto count = static_cast<double>(charts.size());
  mean.scale = 0;
  mean.gain = {};
  for (const FlatChart& chart : charts) {
    mean.scale += chart.scale / count;
    for (std::size_t c = 0; c < 3; ++c) mean.gain[c] += chart.gain[c] / count;
  }
  for (std::size_t i = 0; i < mean.camera.size(); ++i) {
    mean.camera[i] = {};
    for (const FlatChart& chart : charts) {
      mean.is_good[i] = mean.is_good[i] && chart.is_good[i];
      for (std::size_t c = 0; c < 3; ++c) mean.camera[i][c] += chart.camera[i][c] / count;
    }
  }
  return mean;
}

Result<void> fit_curve(ColorMeasurement& color) {
  const auto curve_of = [](const std::vector<ChartSample>& samples) { return fit_color_curve(samples, 1); };
  Result<ColorCurve> curve = curve_of(color.samples);
  if (!curve) return std::move(curve).error();
  color.transform.curve = *curve;
  for (std::size_t i = 0; i < color.samples.size(); ++i) {
    const ChartSample& sample = color.samples[i];
    color.by_curve.push_back(
        ciede2000_of(rec709_of_camera(color.transform, sample.camera), sample.reference));
    std::vector<ChartSample> others = color.samples;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    Result<ColorCurve> without = curve_of(others);
    if (!without) return std::move(without).error();
    ColorTransform transform;
    transform.curve = *without;
    color.curve_left_out.push_back(
        ciede2000_of(rec709_of_camera(transform, sample.camera), sample.reference));
  }
  return {};
}

void note_scale(ColorMeasurement& color, const Calibration* from) {
  const bool is_absolute = from != nullptr && from->subject.albedo_scale == AlbedoScale::kAbsolute;
  if (!color.has_albedo || !is_absolute || std::abs(color.albedo_scale - 1) <= kScaleOff) return;
  color.verdicts.push_back({"ALBEDO_SCALE",
                            fmt::format("solved albedo of the chart is {:+.1f} percent off its reflectances",
                                        100 * (1 / color.albedo_scale - 1)),
                            "check the reflectance of the white sheet that the lights were calibrated with"});
}

struct ReadCharts {
  std::vector<FlatChart> albedos, photographs;
  ShotMetadata camera;  // of the last photograph

  FlatChart mean() const {
    std::vector<FlatChart> all = albedos;
    all.insert(all.end(), photographs.begin(), photographs.end());
    return mean_of_charts(all);
  }
};

Result<ReadCharts> read_charts(const CalibrateColorOptions& options, const Calibration* from,
                               ChartReader& reader, ColorMeasurement& color, const JobContext& context) {
  const Result<std::vector<fs::path>> files = list_chart_pictures(options.input);
  if (!files) return files.error();
  ReadCharts read;
  for (const fs::path& file : *files) {
    if (context.stop.stop_requested()) return interrupted();
    const Result<ChartPicture> picture = read_chart_picture(file, from, options.from, context);
    if (!picture) return picture.error();
    if (const auto why = from ? subject_difference(from->subject, picture->camera) : std::nullopt) {
      return bad_chart(*picture, "frame does not belong to this calibration", *why,
                       "photograph the chart with the rig's own camera and aperture");
    }
    Result<FlatChart> chart = reader.read(*picture);
    if (!chart) return std::move(chart).error();
    if (!picture->is_albedo) read.camera = picture->camera;
    color.slope_of_light = std::max(color.slope_of_light, chart->slope_of_light);
    color.sources.push_back(absolute_folder(file).filename().string());
    (picture->is_albedo ? read.albedos : read.photographs).push_back(*chart);
    context.progress("read", static_cast<double>(color.sources.size()) / static_cast<double>(files->size()));
  }
  color.has_albedo = !read.albedos.empty();
  if (color.has_albedo) color.albedo_scale = mean_of_charts(read.albedos).scale;
  return read;
}

Result<void> fit_matrix(const FlatChart& chart, const ChartReference& reference, ColorMeasurement& color) {
  color.samples = ChartReader::samples_of(chart, reference, color.patches);
  Result<ColorFit> fit = fit_color(color.samples, ChartLight::kEven, true);
  if (!fit) return std::move(fit).error();
  for (ChartSample& sample : color.samples) {
    for (double& v : sample.camera) v *= fit->scale;
  }
  color.fit = std::move(*fit);
  color.transform = {color.fit.rec709_from_camera, color.fit.covariance, {}};
  return {};
}

void multiply(Lights& lights, const std::array<double, 3>& factors) {
  const auto each = [&](std::array<double, 3>& rgb) {
    for (std::size_t c = 0; c < 3; ++c) rgb[c] *= factors[c];
  };
  if (auto* near = std::get_if<NearLights>(&lights)) {
    for (NearLight& led : near->leds) each(led.flux_rgb);
  } else {
    for (DistantLight& light : std::get<DistantLights>(lights).lights) each(light.irradiance_rgb);
  }
}

// Lights under which the chart's greys are solved as grey as they are, and, where no reflectance was measured
// before, as bright as they are. White patches reflect as much less as there is more light.
void take_white_from(const FlatChart& chart, const Calibration& before, Calibration& change) {
  const bool sets_scale = before.subject.albedo_scale == AlbedoScale::kRelative;
  std::array<double, 3> factors = chart.gain;
  for (double& factor : factors) factor /= sets_scale ? chart.scale : 1;
  change.lights = before.lights;
  multiply(*change.lights, factors);
  change.light_covariance = before.light_covariance;
  change.patches = before.patches;
  change.points = before.points;
  for (WhitePatch& patch : change.patches) {
    for (std::size_t c = 0; c < 3; ++c) patch.reflectance_rgb[c] /= factors[c];
  }
  change.subject.albedo_scale = AlbedoScale::kAbsolute;
}

CalibrationSubject subject_of(const CalibrateColorOptions& options, const Calibration* from,
                              const ShotMetadata& camera) {
  CalibrationSubject subject =
      from ? from->subject
           : CalibrationSubject{rig_name(options.rig, options.input), camera.model, camera.serial,
                                camera.f_number, AlbedoScale::kRelative};
  subject.measured.clear();
  return subject;
}

}  // namespace

void describe(Fields& fields, CalibrateColorOptions& o) {
  describe_input(fields, o.input, "Photograph or session of the chart, or a folder of them");
  describe_kept(fields, o.from);
  describe_new_calibration(fields, o.output);
  describe_rig(fields, o.rig);
  fields.value(
      {.name = "corners_px",
       .says = "Outer corners of patches 1, 6, 24, 19 in pixels: x,y,x,y,x,y,x,y; default: found by itself",
       .fewest = 8,
       .most = 8},
      o.corners_px);
  fields.value({"curve", "Affine, cubic, affine in xyY in place of a 3 x 3 matrix"}, o.curve);
}

Result<CalibrateOutcome> calibrate_color(const CalibrateColorOptions& options, const JobContext& context) {
  if (Result<void> fits = check_fields(options); !fits) return std::move(fits).error();
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  std::optional<Calibration> from;
  if (!options.from.empty()) {
    Result<Calibration> read = read_calibration(options.from);
    if (!read) return std::move(read).error();
    from = std::move(*read);
  }
  const Calibration* before = from ? &*from : nullptr;
  const Result<ChartColors> colors = read_chart_colors(options.input);
  if (!colors) return colors.error();

  CalibrateOutcome outcome;
  ColorMeasurement color;
  color.reference = colors->name;
  ChartReader reader(options, *colors, color, outcome.warnings);
  const Result<ReadCharts> read = read_charts(options, before, reader, color, context);
  if (!read) return read.error();
  if (Result<void> ok = fit_matrix(read->mean(), colors->reference, color); !ok) return std::move(ok).error();
  if (options.curve) {
    if (Result<void> ok = fit_curve(color); !ok) return std::move(ok).error();
  }
  note_scale(color, before);

  Calibration change;
  change.subject = subject_of(options, before, read->camera);
  change.color = color.transform;
  if (before != nullptr && before->lights && color.has_albedo)
    take_white_from(mean_of_charts(read->albedos), *before, change);
  outcome.report = report_of(color, change.subject.rig);
  Result<Calibration> written =
      derive_calibration(options.from, std::move(change), options.output, report_files(outcome.report));
  if (!written) return std::move(written).error();
  outcome.calibration = std::move(*written);
  outcome.folder = options.output;
  return outcome;
}

}  // namespace weft::calibration
