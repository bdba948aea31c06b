// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/calibrate_response.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "calibration/color/chart.h"
#include "calibration/response/black_trap.h"
#include "calibration/response/neutral_scale.h"
#include "calibration/response/response_measurement.h"
#include "calibration/run/described.h"
#include "calibration/run/response_reader.h"
#include "calibration/run/scale_file.h"
#include "capture/frames/raw_picture.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/exposure_words.h"
#include "report/plot_svg.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kBigHotShare = 1e-3;
constexpr double kReachNeeded = 0.75;  // of full scale, for a curve to be trusted to the end
constexpr double kPoorFit = 4;         // chi-square a degree of freedom
constexpr double kScaleOff_percent = 3;
constexpr std::array<const char*, 3> kChannels = {"red", "green", "blue"};

// What a grey scale said.
struct ScaleReading {
  std::vector<double> reflectances;
  ScaleCheck straight;  // without the measured curve
  ScaleCheck corrected;
};

// Mean linear v of each patch over all frames; 0 where it is full in one of them.
Result<std::vector<std::array<double, 3>>> read_scale(const ResponseFrames& frames, const Response& response,
                                                      const ScaleSettings& settings) {
  std::vector<std::array<double, 3>> mean(settings.reflectances.size());
  std::vector<bool> is_full(mean.size());
  ChartCorners corners = *settings.corners_px;
  for (auto& corner : corners) {
    for (double& v : corner) v = (v - 0.5) / 2;  // pictures are of half size
  }
  for (const fs::path& file : frames.scale) {
    const Result<RawFrame> frame = capture::decode_raw(file, {.size = frames.size, .cfa = {}, .model = {}});
    if (!frame) return frame.error();
    const auto patches = calibration::read_patches(capture::half_size_picture(*frame, response), corners,
                                                   static_cast<int>(mean.size()), 1);
    if (!patches) return patches.error();
    for (std::size_t i = 0; i < mean.size(); ++i) {
      is_full[i] = is_full[i] || (*patches)[i].full_share > 0;
      for (std::size_t c = 0; c < 3; ++c)
        mean[i][c] += (*patches)[i].mean[c] / static_cast<double>(frames.scale.size());
    }
  }
  for (std::size_t i = 0; i < mean.size(); ++i) {
    if (is_full[i]) mean[i] = {};
  }
  return mean;
}

Result<std::optional<ScaleReading>> check_scale(const ScaleSettings& settings, const ResponseFrames& frames,
                                                const Response& response) {
  if (frames.scale.empty() || !settings.corners_px) return std::optional<ScaleReading>();
  Response straight = response;
  straight.linearity = {};
  ScaleReading reading;
  reading.reflectances = settings.reflectances;
  const auto check = [&](const Response& used, ScaleCheck& out) -> Result<void> {
    const auto v = read_scale(frames, used, settings);
    if (!v) return v.error();
    Result<ScaleCheck> checked = calibration::check_scale(reading.reflectances, *v);
    if (!checked) return std::move(checked).error();
    out = std::move(*checked);
    return {};
  };
  if (Result<void> ok = check(straight, reading.straight); !ok) return std::move(ok).error();
  if (Result<void> ok = check(response, reading.corrected); !ok) return std::move(ok).error();
  return std::optional<ScaleReading>(std::move(reading));
}

// The veil of the lens by the frames of a black trap.
Result<std::optional<TrapReading>> read_trap(const ResponseFrames& frames, const Response& response) {
  if (frames.trap.empty()) return std::optional<TrapReading>();
  std::vector<Image<float>> pictures;
  for (const fs::path& file : frames.trap) {
    const Result<RawFrame> frame = capture::decode_raw(file, {.size = frames.size, .cfa = {}, .model = {}});
    if (!frame) return frame.error();
    pictures.push_back(capture::half_size_picture(*frame, response));
  }
  Result<TrapReading> trap = read_black_trap(pictures);
  if (!trap) {
    Error error = std::move(trap).error();
    error.where = frames.trap.front().parent_path().string();
    return error;
  }
  return std::optional<TrapReading>(std::move(*trap));
}

CountLevels levels_of(const ResponseFrames& frames) {
  CountLevels levels = {.white = frames.file_white};
  for (std::size_t i = 0; i < 4; ++i) levels.black[i] = static_cast<double>(frames.file_black[i / 2][i % 2]);
  const bool has_dark = frames.of({}) != nullptr;
  levels.dark_rgb.fill(frames.mean_black());
  if (has_dark) levels.dark_rgb = frames.dark_rgb;
  if (frames.full_rgb != std::array<float, 3>{})
    levels.full_rgb.assign(frames.full_rgb.begin(), frames.full_rgb.end());
  return levels;
}

std::string percent(double share, int digits = 2) {
  return fmt::format("{:.{}f} %", 100 * share, digits);
}

report::Section summary_section(const ResponseFrames& frames, const ResponseMeasurement& m) {
  const PhotonTransfer& t = m.transfer;
  report::Table table = {{"what", "measured", "standard deviation"}, {}};
  table.rows.push_back({"gain, electrons a count", fmt::format("{:.4f}", t.electrons_per_count),
                        fmt::format("{:.4f}", t.sigma_electrons_per_count)});
  table.rows.push_back({"read noise, counts", fmt::format("{:.4f}", t.read_noise_counts),
                        fmt::format("{:.4f}", t.sigma_read_noise_counts)});
  table.rows.push_back({fmt::format("black level, counts, from {}", name_of(m.black_from)),
                        fmt::format("{:.3f}", m.black_counts), fmt::format("{:.3f}", m.sigma_black_counts)});
  for (std::size_t c = 0; c < 3; ++c) {
    if (frames.full_rgb[c] == 0) continue;
    table.rows.push_back(
        {fmt::format("full, {}, counts, where the files say {:.0f}", kChannels[c], frames.file_white),
         fmt::format("{:.0f}", frames.full_rgb[c]), ""});
  }
  table.rows.push_back({"dark signal, counts a second", fmt::format("{:.3f}", m.dark_counts_per_s), ""});
  for (std::size_t c = 0; c < 3 && m.superposition; ++c) {
    table.rows.push_back({fmt::format("non-linearity, {}, of full scale", kChannels[c]),
                          percent(m.superposition->departure(c), 3),
                          percent(m.superposition->sigma_departure(c), 3)});
  }
  table.rows.insert(table.rows.end(),
                    {{"hot photosites", std::to_string(frames.hot), ""},
                     {"dead photosites", std::to_string(frames.dead), ""},
                     {"light from frame to frame", percent(m.drift, 3), ""},
                     {"pairs of frames", std::to_string(frames.pairs), ""},
                     {"frames left out, being full", std::to_string(frames.full.size()), ""}});
  return {.title = "Measured", .table = std::move(table)};
}

report::Section transfer_section(const ResponseMeasurement& m) {
  report::PlotSeries measured = {.name = "measured"},
                     fitted = {.name = "fitted line", .joined = true, .marked = false};
  for (const TransferBin& bin : m.transfer.bins) {
    measured.points.push_back({bin.signal_counts, bin.variance_counts2});
    fitted.points.push_back({bin.signal_counts, bin.fitted_counts2});
  }
  return {.title = "Photon transfer",
          .paragraphs = {fmt::format("Half the variance of the difference of two frames alike, in squares of "
                                     "{} photosites, against their mean. Chi-square a degree of freedom: "
                                     "{:.3f}; well above 1 the noise is not that of photons.",
                                     kResponseBlock, m.transfer.chi_square_per_freedom)},
          .figures = {
              {"variance by signal, both linear in light", report::plot_svg({.x_label = "signal, counts",
                                                                             .y_label = "variance, counts^2",
                                                                             .series = {measured, fitted},
                                                                             .log_x = true,
                                                                             .log_y = true})}}};
}

report::Section linearity_section(const Superposition& s) {
  report::Section section = {"Linearity"};
  section.paragraphs = {
      fmt::format("What the light of two LEDs one by one has over that of both together, with what the LEDs "
                  "drifted taken out. Chi-square a degree of freedom: {:.2f}; well above 1 something else "
                  "changed between the frames.",
                  s.chi_square_per_freedom)};
  report::Table table = {{"channel", "a", "b", "seen up to", "off a line before", "left, by the fit's sigma"},
                         {}};
  for (std::size_t c = 0; c < 3; ++c) {
    report::PlotSeries before = {.name = "before", .joined = true}, after = {.name = "after", .joined = true};
    for (const SuperpositionBin& bin : s.bins[c]) {
      before.points.push_back({100 * bin.v, 100 * bin.before});
      after.points.push_back({100 * bin.v, 100 * bin.after});
    }
    section.figures.push_back({kChannels[c], report::plot_svg({.x_label = "both, percent of full scale",
                                                               .y_label = "missing, percent",
                                                               .series = {before, after}})});
    table.rows.push_back({kChannels[c], fmt::format("{:.5f}", s.linearity[c][0]),
                          fmt::format("{:.5f}", s.linearity[c][1]), percent(s.highest_v[c], 0),
                          percent(s.departure(c), 3), percent(s.sigma_departure(c), 3)});
  }
  section.table = std::move(table);
  return section;
}

report::Section balance_section(const ResponseMeasurement& m, const Calibration* from) {
  report::Table table = {{"LED", "red / green", "blue / green", "in the calibration before"}, {}};
  const NearLights* lights =
      from != nullptr && from->lights ? std::get_if<NearLights>(&*from->lights) : nullptr;
  for (const LedBalance& b : m.balance) {
    std::string before;
    const auto at = static_cast<std::size_t>(b.led - 1);
    if (lights != nullptr && at < lights->leds.size()) {
      const auto& flux = lights->leds[at].flux_rgb;
      before = fmt::format("{:.4f}, {:.4f}", flux[0] / flux[1], flux[2] / flux[1]);
    }
    table.rows.push_back({fmt::format("LED {}", b.led), fmt::format("{:.4f}", b.light[0] / b.light[1]),
                          fmt::format("{:.4f}", b.light[2] / b.light[1]), before});
  }
  return {.title = "White balance of the LEDs",
          .paragraphs =
              {"Light by channel over that in green, mean over the frame: that of the LED where the scene is "
               "white or grey, and of the same scene differences from LED to LED are those of the LEDs."},
          .table = std::move(table)};
}

report::Section ratio_section(const ResponseMeasurement& m) {
  report::Table table = {{"longer", "shorter", "measured", "by the times", "among LEDs"}, {}};
  for (const MeasuredRatio& r : m.ratios) {
    table.rows.push_back({exposure_words(r.ratio.exposure_us), exposure_words(r.ratio.to_exposure_us),
                          fmt::format("{:.5f}", r.ratio.ratio),
                          fmt::format("{:.5f}", r.ratio.exposure_us / r.ratio.to_exposure_us),
                          percent(r.scatter, 3)});
  }
  return {
      .title = "Exposure times",
      .paragraphs = {"Light gathered by the longer over the shorter exposure, against what their times say."},
      .table = std::move(table)};
}

report::Section scale_section(const ScaleReading& scale) {
  report::Table table = {{"patch", "reflectance", "off before, %", "off after, %"}, {}};
  for (std::size_t i = 0; i < scale.reflectances.size(); ++i) {
    table.rows.push_back({std::to_string(i + 1), fmt::format("{:.4f}", scale.reflectances[i]),
                          fmt::format("{:+.2f}", scale.straight.off_percent[i]),
                          fmt::format("{:+.2f}", scale.corrected.off_percent[i])});
  }
  return {.title = "Grey scale",
          .paragraphs = {fmt::format(
              "Each patch against its reflectance, light along the scale fitted as a parabola ({:+.1f} "
              "percent from end to end). Off by {:.2f} percent rms before the correction of linearity, by "
              "{:.2f} after. At its middle a perfect white would be at {:.3f}, {:.3f}, {:.3f} of full scale.",
              100 * scale.corrected.shading, scale.straight.rms_percent, scale.corrected.rms_percent,
              scale.corrected.v_of_white[0], scale.corrected.v_of_white[1], scale.corrected.v_of_white[2])},
          .table = std::move(table)};
}

report::Section veil_section(const TrapReading& trap) {
  report::Table table = {{"channel", "share of the light"}, {}};
  for (std::size_t c = 0; c < 3; ++c) table.rows.push_back({kChannels[c], percent(trap.share_rgb[c], 3)});
  return {.title = "Veil",
          .paragraphs = {fmt::format(
              "A black trap in white paper shows {} ± {} of the light around it: what the lens scatters over "
              "the frame. It is taken from the readings of every scan and calibration from here on, spread "
              "by a Gaussian of {} frame diagonals, which one trap cannot measure.",
              percent(trap.veil.share, 3), percent(trap.veil.sigma_share, 3), trap.veil.spread)},
          .table = std::move(table)};
}

Json numbers_of(const ResponseFrames& frames, const ResponseMeasurement& m,
                const std::optional<ScaleReading>& scale, const std::optional<TrapReading>& trap) {
  Json numbers = {{"electrons_per_count", m.transfer.electrons_per_count},
                  {"sigma_electrons_per_count", m.transfer.sigma_electrons_per_count},
                  {"read_noise_counts", m.transfer.read_noise_counts},
                  {"sigma_read_noise_counts", m.transfer.sigma_read_noise_counts},
                  {"transfer_chi_square", m.transfer.chi_square_per_freedom},
                  {"black_counts", m.black_counts},
                  {"sigma_black_counts", m.sigma_black_counts},
                  {"black_from", name_of(m.black_from)},
                  {"full_rgb", frames.full_rgb},
                  {"file_white", frames.file_white},
                  {"dark_counts_per_s", m.dark_counts_per_s},
                  {"clipped_share", m.clipped_share},
                  {"drift", m.drift},
                  {"hot", frames.hot},
                  {"dead", frames.dead},
                  {"pairs", frames.pairs},
                  {"full_frames", frames.full}};
  if (m.superposition) {
    const Superposition& s = *m.superposition;
    numbers["linearity"] = s.linearity;
    numbers["departure"] = {s.departure(0), s.departure(1), s.departure(2)};
    numbers["sigma_departure"] = {s.sigma_departure(0), s.sigma_departure(1), s.sigma_departure(2)};
    numbers["linearity_seen_to"] = s.highest_v;
    numbers["superposition_chi_square"] = s.chi_square_per_freedom;
  }
  numbers["white_balance"] = Json::array();
  for (const LedBalance& b : m.balance) {
    numbers["white_balance"].push_back({{"led", b.led}, {"light_rgb", b.light}});
  }
  numbers["exposure_ratios"] = Json::array();
  for (const MeasuredRatio& r : m.ratios) {
    numbers["exposure_ratios"].push_back({{"exposure_us", r.ratio.exposure_us},
                                          {"to_exposure_us", r.ratio.to_exposure_us},
                                          {"ratio", r.ratio.ratio},
                                          {"scatter", r.scatter}});
  }
  if (scale) {
    numbers["scale"] = {{"reflectances", scale->reflectances},
                        {"off_percent", scale->corrected.off_percent},
                        {"rms_percent", scale->corrected.rms_percent},
                        {"rms_percent_before", scale->straight.rms_percent},
                        {"v_of_white", scale->corrected.v_of_white}};
  }
  if (trap) {
    numbers["veil"] = {{"share", trap->veil.share},
                       {"sigma_share", trap->veil.sigma_share},
                       {"share_rgb", trap->share_rgb},
                       {"photographs", trap->places.size()}};
  }
  return numbers;
}

// What could not be measured of linearity and black, and what looks wrong there.
std::vector<Verdict> measurement_verdicts(const ResponseMeasurement& m) {
  std::vector<Verdict> verdicts;
  if (!m.superposition) {
    verdicts.push_back({"LINEARITY_UNKNOWN",
                        "linearity was not measured: no exposure has frames of two LEDs and of both",
                        "take ledNN+ledMM at the exposures of ledNN and ledMM"});
  } else {
    const std::array<double, 3>& highest = m.superposition->highest_v;
    const double reach = std::max({highest[0], highest[1], highest[2]});
    if (reach < kReachNeeded) {
      verdicts.push_back(
          {"LINEARITY_SHORT",
           fmt::format("linearity was seen up to {:.0f} percent of full scale only", 100 * reach),
           "add longer exposures, until two LEDs together are nearly full"});
    }
    if (m.superposition->chi_square_per_freedom > kPoorFit) {
      verdicts.push_back({"LIGHT_NOT_STEADY",
                          fmt::format("light adds up worse than its noise allows (chi-square {:.1f} a degree "
                                      "of freedom): something moved, or the room's light changed",
                                      m.superposition->chi_square_per_freedom),
                          "take the frames again in a dark room without touching the scene"});
    }
  }
  if (m.black_from == BlackFrom::kFile) {
    verdicts.push_back({"BLACK_UNKNOWN", "the black level was not measured, and is the file's",
                        "add dark frames, or for a body that clips black frames of two LEDs and of both"});
  }
  return verdicts;
}

std::vector<Verdict> verdicts_of(const ResponseFrames& frames, const ResponseMeasurement& m,
                                 const std::optional<ScaleReading>& scale) {
  std::vector<Verdict> verdicts = measurement_verdicts(m);
  if (!frames.full.empty()) {
    verdicts.push_back({"FULL_FRAMES",
                        fmt::format("{} frames were full everywhere and left out, {} the first",
                                    frames.full.size(), frames.full.front()),
                        "leave out the longest exposures next time"});
  }
  if (frames.hot > kBigHotShare * static_cast<double>(frames.size.pixels())) {
    verdicts.push_back({"MANY_HOT",
                        fmt::format("{} photosites are hot: were the dark frames dark?", frames.hot),
                        "cover the lens, put out all lights and take dark/ again"});
  }
  if (scale && scale->corrected.rms_percent > kScaleOff_percent) {
    verdicts.push_back({"SCALE_OFF",
                        fmt::format("the grey scale is off its reflectances by {:.1f} percent rms",
                                    scale->corrected.rms_percent),
                        "check scale.toml and that no patch shines"});
  }
  return verdicts;
}

CalibrationReport report_of(const ResponseFrames& frames, const ResponseMeasurement& m,
                            const std::optional<ScaleReading>& scale, const std::optional<TrapReading>& trap,
                            const Calibration* from, const std::string& rig) {
  CalibrationReport report;
  report.part = "response";
  report.title = fmt::format("Response of {} {}, rig {}", frames.camera.model, frames.camera.serial, rig);
  report.summary = fmt::format("{:.3f} electrons a count, read noise {:.3f} counts, black at {:.2f} counts",
                               m.transfer.electrons_per_count, m.transfer.read_noise_counts, m.black_counts);
  if (m.superposition) {
    report.summary +=
        fmt::format(", {:.2f} percent from a straight line in green", 100 * m.superposition->departure(1));
  }
  if (trap) report.summary += fmt::format(", a veil of {:.2f} percent", 100 * trap->veil.share);
  report.summary += fmt::format(", {} bad photosites", frames.hot + frames.dead);
  report.verdicts = verdicts_of(frames, m, scale);
  report.sections = {summary_section(frames, m), transfer_section(m)};
  if (m.superposition) report.sections.push_back(linearity_section(*m.superposition));
  if (!m.ratios.empty()) report.sections.push_back(ratio_section(m));
  if (!m.balance.empty()) report.sections.push_back(balance_section(m, from));
  if (scale) report.sections.push_back(scale_section(*scale));
  if (trap) report.sections.push_back(veil_section(*trap));
  report.numbers = numbers_of(frames, m, scale, trap);
  return report;
}

Result<void> write_hot_picture(const fs::path& file, View<const std::uint8_t> bad) {
  Image<float> picture(bad.size());
  for (int y = 0; y < bad.height(); ++y) {
    for (int x = 0; x < bad.width(); ++x) picture(x, y) = bad(x, y) != 0 ? 1.0F : 0.0F;
  }
  const std::array<View<const float>, 1> planes = {picture.plane()};
  return write_image(file, planes, {"Y"}, {.type = SampleType::kUint8});
}

}  // namespace

void describe(Fields& fields, CalibrateResponseOptions& o) {
  describe_input(fields, o.input,
                 "Folder with dark/, led01/, led02/, led01+led02/, scale/ of raw frames of a still scene");
  describe_kept(fields, o.from);
  describe_new_calibration(fields, o.output);
  describe_rig(fields, o.rig);
  fields.value({.name = "trap",
                .says = "Set of a black trap (weft capture trap): the lens's veil; default trap/ of input",
                .path = PathTo::kFolder},
               o.trap);
}

Result<CalibrateOutcome> calibrate_response(const CalibrateResponseOptions& options,
                                            const JobContext& context) {
  if (Result<void> ok = check_new(options.output); !ok) return std::move(ok).error();
  const Result<ScaleSettings> settings = read_scale_file(options.input / "scale" / "scale.toml");
  if (!settings) return settings.error();
  std::optional<Calibration> from;
  if (!options.from.empty()) {
    Result<Calibration> read = read_calibration(options.from);
    if (!read) return std::move(read).error();
    from = std::move(*read);
  }
  const Result<ResponseFrames> frames =
      read_response_frames(options.input, options.trap, from ? &*from : nullptr, context);
  if (!frames) return frames.error();
  const Result<ResponseMeasurement> measured = measure_response(*frames);
  if (!measured) return measured.error();
  CalibrateOutcome outcome;
  outcome.warnings = frames->warnings;
  if (!frames->scale.empty() && !settings->corners_px) {
    outcome.warnings.push_back(
        fmt::format("{} was not read: its scale.toml has no corners_px", (options.input / "scale").string()));
  }
  const auto scale = check_scale(*settings, *frames, measured->response);
  if (!scale) return scale.error();
  const auto trap = read_trap(*frames, measured->response);
  if (!trap) return trap.error();

  Calibration change;
  change.subject =
      from ? from->subject
           : CalibrationSubject{rig_name(options.rig, options.input), frames->camera.model,
                                frames->camera.serial, frames->camera.f_number, AlbedoScale::kRelative};
  change.subject.measured.clear();
  change.response = measured->response;
  if (frames->camera.iso > 0) change.response->iso = frames->camera.iso;
  change.response->levels = levels_of(*frames);
  if (*trap) {
    change.response->veil = (*trap)->veil;
  } else if (from && from->response) {
    change.response->veil = from->response->veil;
  }
  outcome.report = report_of(*frames, *measured, *scale, *trap, from ? &*from : nullptr, change.subject.rig);

  fs::path beside = absolute_folder(options.output);
  beside += ".hot";
  const PartialFolder aside(beside);
  if (!frames->bad.empty()) {
    if (Result<void> ok = make_writable_folder(aside.path()); !ok) return std::move(ok).error();
    change.hot_picture = aside.path() / "hot.png";
    if (Result<void> ok = write_hot_picture(*change.hot_picture, frames->bad.plane()); !ok) {
      return std::move(ok).error();
    }
  }
  Result<Calibration> written =
      derive_calibration(options.from, std::move(change), options.output, report_files(outcome.report));
  if (!written) return std::move(written).error();
  outcome.calibration = std::move(*written);
  outcome.folder = options.output;
  return outcome;
}

}  // namespace weft::calibration
