// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/chart_pictures.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <cmath>

#include "app/jobs/linear_image.h"
#include "app/jobs/raw_picture.h"
#include "app/jobs/session_input.h"
#include "capture/raw/decode.h"
#include "core/files.h"
#include "pipeline/bands.h"
#include "solver/method.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

// Means of 2 x 2 pixels of albedo as its bands come.
class HalfAlbedo {
 public:
  explicit HalfAlbedo(Size size) : half_({size.width / 2, size.height / 2}, 3) {}
  void add(const pipeline::MapBand& band) {
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
  SessionOptions options;
  options.folder = session;
  options.calibration = calibration;
  const Result<SessionPlan> plan = plan_session(options);
  if (!plan) return plan.error();
  const Result<LoadedSession> loaded = load_session(*plan, context);
  if (!loaded) return loaded.error();
  HalfAlbedo albedo(loaded->photographs.size);
  const auto keep = [&](const pipeline::MapBand& band) -> Result<void> {
    albedo.add(band);
    return {};
  };
  const Result<double> solved =
      solve_bands(loaded->photographs, *solver::standard_method(), pipeline::kSolveTile, context, keep);
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

// 24 triples.
std::optional<std::array<std::array<double, 3>, 24>> triples_of(const toml::array* list) {
  if (list == nullptr || list->size() != 24) return {};
  std::array<std::array<double, 3>, 24> triples = {};
  for (std::size_t i = 0; i < 24; ++i) {
    const toml::array* triple = list->get_as<toml::array>(i);
    if (triple == nullptr || triple->size() != 3) return {};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::optional<double> value = triple->get(c)->value<double>();
      if (!value || !std::isfinite(*value)) return {};
      triples[i][c] = *value;
    }
  }
  return triples;
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
    picture.camera = frame->shot;
    picture.rgb = half_size_picture(*frame, from != nullptr && from->response ? *from->response : Response());
  }
  picture.source = file;
  return picture;
}

Result<ChartColors> read_chart_colors(const fs::path& input) {
  const fs::path file =
      (is_there(input / "session.json") ? absolute_folder(input).parent_path() : input) / "chart.toml";
  const ChartColors published = {calibration::published_chart(),
                                 "as published for charts from November 2014"};
  if (!is_there(file)) return published;
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  toml::table table;
  try {
    table = toml::parse(*text);
  } catch (const toml::parse_error& e) {
    return bad_chart_file(file, fmt::format("line {}: {}", e.source().begin.line, e.description()));
  }
  if (table.size() != 1) return bad_chart_file(file, fmt::format("it has {} keys", table.size()));
  const std::string key(table.begin()->first.str());
  if (key == "edition") {
    const std::string edition = table[key].value_or(std::string());
    if (edition == "2014") return published;
    if (edition == "before 2014") {
      return ChartColors{calibration::published_chart_before_2014(),
                         "as published for charts before November 2014"};
    }
    return bad_chart_file(file, fmt::format("there is no edition \"{}\"", edition));
  }
  if (key != "lab_d50" && key != "rec709" && key != "srgb") {
    return bad_chart_file(file, fmt::format("{} means nothing", key));
  }
  const auto triples = triples_of(table[key].as_array());
  if (!triples) return bad_chart_file(file, fmt::format("{} is not 24 lists of three numbers", key));
  ChartColors colors;
  colors.name = "by chart.toml";
  for (std::size_t i = 0; i < 24; ++i) {
    const auto& t = (*triples)[i];
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

void describe(Fields& fields, ChartEdition& chart) {
  fields.value({.name = "edition",
                .says = "When the chart was made: from November 2014 on, or before",
                .words = {"2014", "before 2014"}},
               chart.edition);
}

}  // namespace weft::app
