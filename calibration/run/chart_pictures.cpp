// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/chart_pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "calibration/camera/markers.h"
#include "calibration/run/calibrated_levels.h"
#include "calibration/run/sheet_files.h"
#include "capture/frames/raw_picture.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/image_io/linear_image.h"
#include "core/toml/field_toml.h"
#include "core/toml/toml_json.h"
#include "solve/bands/bands.h"
#include "solve/input/load.h"
#include "solve/input/session_input.h"
#include "solver/method.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

// Means of 2 x 2 pixels of albedo as its bands come.
class HalfAlbedo {
 public:
  explicit HalfAlbedo(Size size) : half_({size.width / 2, size.height / 2}, 3) {}
  void add(const solve::MapBand& band) {
    for (int c = 0; c < 3; ++c) {
      const View<const float>& albedo = band.albedo[static_cast<std::size_t>(c)];
      for (int y = band.albedo_rows.y0; y < std::min(band.albedo_rows.y1, 2 * half_.height()); ++y) {
        const float* row = albedo.row(y - band.albedo_rows.y0);
        for (int x = 0; x < 2 * half_.width(); ++x) half_(x / 2, y / 2, c) += row[x] / 4;
      }
    }
  }
  Image<float> take() { return std::move(half_); }

 private:
  Image<float> half_;
};

Result<ChartPicture> solve_chart(const fs::path& session, const fs::path& calibration,
                                 const JobContext& context) {
  solve::SessionOptions options;
  options.folder = session;
  options.calibration = calibration;
  const Result<solve::SolvePlan> plan = solve::plan_session(options);
  if (!plan) return plan.error();
  const Result<solve::Photographs> loaded = solve::load_photographs(*plan, context);
  if (!loaded) return loaded.error();
  HalfAlbedo albedo(loaded->size);
  const auto keep = [&](const solve::MapBand& band) -> Result<void> {
    albedo.add(band);
    return {};
  };
  const Result<double> solved =
      solve_bands(*loaded, *solver::standard_method(), solve::kSolveTile, context, keep);
  if (!solved) return solved.error();
  ChartPicture picture;
  picture.is_albedo = true;
  picture.rgb = albedo.take();
  return picture;
}

Error bad_chart_file(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "chart.toml cannot be used", file.string(), std::move(why),
          "give edition = \"2014\" or \"before 2014\", or 24 colours as lab_d50, rec709 or srgb"};
}

/// What chart.toml says: one of these.
struct ChartFile {
  ChartEdition chart;
  Json lab_d50, rec709, srgb;
};

void describe(Fields& fields, ChartFile& file) {
  describe(fields, file.chart);
  for (const auto& [name, colors] : {std::pair("lab_d50", &file.lab_d50), std::pair("rec709", &file.rec709),
                                     std::pair("srgb", &file.srgb)}) {
    fields.value({name, "Colours of its 24 patches, three numbers each"}, *colors);
    const auto rows = rows_of(*colors, 3);
    fields.require(colors->is_null() || (rows && rows->size() == 24), name,
                   "must be 24 lists of three numbers");
  }
}

// The colours in the 24 triples of one key.
Result<ChartColors> written_colors(const fs::path& file, const std::string& key, const Json& list) {
  ChartColors colors;
  colors.name = "by chart.toml";
  colors.is_measured = true;
  const std::vector<std::vector<double>> rows = *rows_of(list, 3);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::array<double, 3> t = {rows[i][0], rows[i][1], rows[i][2]};
    colors.reference[i] = key == "lab_d50" ? rec709_of_lab_d50({t[0], t[1], t[2]})
                          : key == "srgb"  ? rec709_of_srgb({t[0] / 255, t[1] / 255, t[2] / 255})
                                           : t;
    const double luminance = xyz_of_rec709(colors.reference[i])[1];
    if (!(luminance > 0 && luminance < 1.2)) {
      return bad_chart_file(file, fmt::format("patch {} has a luminance of {:.3g}", i + 1, luminance));
    }
  }
  return colors;
}

}  // namespace

Result<std::vector<fs::path>> list_chart_pictures(const fs::path& input) {
  std::error_code failed;
  const bool is_session = is_there(input / "session.json");
  if (is_session || fs::is_regular_file(input, failed)) return std::vector<fs::path>{input};
  std::vector<fs::path> files;
  for (fs::directory_iterator it(input, failed), end; !failed && it != end; it.increment(failed)) {
    const fs::path path = it->path();
    const bool is_hidden = path.filename().string().front() == '.';
    const bool is_written = path.extension() == ".toml" || path.extension() == ".json";
    const bool is_wanted = it->is_directory() ? is_there(path / "session.json") : !is_written;
    if (!is_hidden && is_wanted) files.push_back(path);
  }
  if (!files.empty()) {
    std::sort(files.begin(), files.end());
    return files;
  }
  return Error{ErrorKind::kNoInput, "there is no picture of a chart", input.string(),
               failed ? failed.message() : "the folder holds neither photographs nor sessions",
               "name a folder with raw photographs of the chart, or with sessions of it"};
}

Result<ChartPicture> read_chart_picture(const fs::path& file, const Calibration* from,
                                        const fs::path& calibration, const JobContext& context) {
  ChartPicture picture;
  if (is_there(file / "session.json")) {
    Result<ChartPicture> solved = solve_chart(file, calibration, context);
    if (!solved) return solved;
    picture = std::move(*solved);
  } else if (is_linear_image(file)) {
    Result<Image<float>> image = read_linear_image(file, Transfer::kLinear, Clipped::kMark);
    if (!image) return std::move(image).error();
    picture.rgb = std::move(*image);
    picture.pixels = 1;
  } else {
    const Result<RawFrame> frame = capture::decode_raw(file);
    if (!frame) return frame.error();
    if (from != nullptr && from->response) {
      if (Result<void> ok = check_levels(*frame, *from->response, file); !ok) return std::move(ok).error();
    }
    picture.camera = frame->shot;
    picture.rgb =
        capture::half_size_picture(*frame, from != nullptr && from->response ? *from->response : Response());
  }
  picture.source = file;
  return picture;
}

Result<ChartColors> read_chart_colors(const fs::path& input) {
  const fs::path file =
      (is_there(input / "session.json") ? absolute_folder(input).parent_path() : input) / "chart.toml";
  const ChartColors published = {published_chart(), "as published for charts from November 2014", false};
  if (!is_there(file)) return published;
  const Result<toml::table> table = read_toml(file);
  if (!table) return table.error();
  const Result<ChartFile> said = read_fields<ChartFile>(*table, file.string(), kCalibrationPage);
  if (!said) return said.error();
  if (table->size() != 1) return bad_chart_file(file, fmt::format("it has {} keys", table->size()));
  if (!said->lab_d50.is_null()) return written_colors(file, "lab_d50", said->lab_d50);
  if (!said->rec709.is_null()) return written_colors(file, "rec709", said->rec709);
  if (!said->srgb.is_null()) return written_colors(file, "srgb", said->srgb);
  if (said->chart.edition == "2014") return published;
  return ChartColors{published_chart_before_2014(), "as published for charts before November 2014", false};
}

Result<void> check_measured(const Image<float>& rgb, const ChartColors& colors, const std::string& where) {
  if (colors.is_measured) return {};
  const std::array<View<const float>, 3> planes = {rgb.plane(0), rgb.plane(1), rgb.plane(2)};
  const Image<std::uint8_t> grey = grey_picture(planes);
  const auto tags = find_tags(grey.plane(), kPrintedChartDictionary);
  if (!tags) return tags.error();
  const auto seen = std::ranges::count_if(*tags, [](const TagSighting& tag) {
    return tag.id >= kPrintedChartTag && tag.id < kPrintedChartTag + kPrintedChartTags;
  });
  if (seen < 2) return {};
  return Error{ErrorKind::kBadData, "nobody knows the colours of this chart", where,
               "it came from a printer (weft target chart)",
               "measure its 24 patches and write them into chart.toml as lab_d50, or lay a chart whose maker "
               "measured it"};
}

void describe(Fields& fields, ChartEdition& chart) {
  fields.value({.name = "edition",
                .says = "When the chart was made: from November 2014 on, or before",
                .words = {"2014", "before 2014"}},
               chart.edition);
}

}  // namespace weft::calibration
