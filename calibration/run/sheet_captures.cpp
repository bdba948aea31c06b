// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/sheet_captures.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>

#include "calibration/run/calibrated_levels.h"
#include "calibration/run/lit_dark.h"
#include "capture/frames/session_frames.h"
#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/image_io/linear_image.h"
#include "core/rig/exposure_words.h"
#include "core/rig/radiometry.h"
#include "core/rig/session.h"
#include "core/rig/veil.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kDarkShare = 0.01;  // of the brightest LED's light: less is no light
constexpr double kWarnFullShare = 0.01;
constexpr double kMostFullShare = 0.5;

Error bad_capture(const fs::path& where, std::string what, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, std::move(what), where.string(), std::move(why), std::move(remedy)};
}

std::size_t index_of(const SheetBlockGrid& grid, int column, int row) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.columns) +
         static_cast<std::size_t>(column);
}

// The light of all LEDs together, as a picture to find tags in.
class SumPicture {
 public:
  explicit SumPicture(Size size) : sum_(size) {}

  void add(const RawFrame& frame) {
    const std::lock_guard lock(mutex_);
    if (count_++ == 0) {
      like_.cfa = frame.cfa;
      like_.black = frame.black;
      like_.white = frame.white;
    }
    for (int y = 0; y < sum_.height(); ++y) {
      const std::uint16_t* from = frame.counts.plane().row(y);
      std::uint32_t* to = sum_.plane().row(y);
      for (int x = 0; x < sum_.width(); ++x) to[x] += from[x];
    }
  }
  void add_to(Image<float>& cells, int cell_px) const {
    const Rect all = {0, 0, sum_.width(), sum_.height()};
    add_cells(sum_.plane(), all, cell_px, 1, cells);
  }
  Image<std::uint8_t> grey() {
    like_.counts = Image<std::uint16_t>(sum_.size());
    for (int y = 0; y < sum_.height(); ++y) {
      const std::uint32_t* from = sum_.plane().row(y);
      std::uint16_t* to = like_.counts.plane().row(y);
      for (int x = 0; x < sum_.width(); ++x) to[x] = static_cast<std::uint16_t>(from[x] / count_);
    }
    return grey_picture(like_);
  }

 private:
  std::mutex mutex_;
  Image<std::uint32_t> sum_;
  std::uint32_t count_ = 0;
  RawFrame like_;
};

class SessionReader {
 public:
  SessionReader(const SheetCapturesOptions& options, const JobContext& context, fs::path folder)
      : options_(options), context_(context), folder_(std::move(folder)) {}

  Result<SheetCapture> read(int block_px, FixedPointFinder& points, std::vector<Verdict>& warnings) {
    block_px_ = block_px;
    if (Result<void> ok = look(); !ok) return std::move(ok).error();
    SheetCapture capture;
    capture.name = folder_.filename().string();
    Result<std::vector<std::string>> digests = lit_sha256(session_);
    if (!digests) return std::move(digests).error();
    capture.lit_sha256 = std::move(*digests);
    capture.leds.resize(light_count(*options_.calibration.lights));
    cells_ = Image<float>(cells_in({0, 0, size().width, size().height}, point_cell_px(size())));
    Result<Image<std::uint8_t>> grey = raw_ ? read_mosaics(capture.leds) : read_developed(capture.leds);
    if (!grey) return std::move(grey).error();
    if (Result<void> ok = find_pose(*grey, capture); !ok) return std::move(ok).error();
    mark_paper(capture);
    points.add(cells_, outline_of(capture.pose.rig_from_sheet));
    if (Result<void> ok = check_light(capture, warnings); !ok) return std::move(ok).error();
    return capture;
  }

  const Session& session() const { return session_; }

 private:
  Result<void> look();
  Result<Image<std::uint8_t>> read_mosaics(std::vector<SheetBlockGrid>& leds);
  Result<Image<std::uint8_t>> read_developed(std::vector<SheetBlockGrid>& leds);
  Result<void> check_dark(std::span<const double> dark, std::span<const std::vector<double>> lit) const;
  Result<void> find_pose(const Image<std::uint8_t>& grey, SheetCapture& capture) const;
  void mark_paper(SheetCapture& capture) const;
  std::vector<PixelPoint> outline_of(const Pose& rig_from_sheet) const;
  Result<void> check_light(const SheetCapture& capture, std::vector<Verdict>& warnings) const;

  Size size() const { return options_.calibration.camera->size; }
  double seconds(const Shot& shot) const { return shot.exposure_us * 1e-6 * shot.iso / 100; }

  const SheetCapturesOptions& options_;
  const JobContext& context_;
  fs::path folder_;
  int block_px_ = 16;
  Session session_;
  std::vector<Shot> lit_;
  bool raw_ = true;
  Image<float> cells_;  ///< the light of all LEDs together, as fixed points are found in
};

// Everything that can be told before a pixel is decoded.
Result<void> SessionReader::look() {
  Result<Session> session = capture::read_complete_session(folder_);
  if (!session) return std::move(session).error();
  session_ = std::move(*session);
  for (const Shot* shot : session_.lit()) lit_.push_back(*shot);
  if (lit_.empty())
    return bad_capture(folder_, "session has no lit shot", "", "take the session out of the folder");
  capture::FrameHeaders headers(
      session_, options_.calibration,
      "name the calibration of this rig with --from, or take the session out of the folder");
  for (const Shot& shot : session_.shots) {
    if (shot.role != ShotRole::kLit && shot.role != ShotRole::kDark) continue;
    if (Result<void> ok = headers.look_at(shot); !ok) return ok;
  }
  raw_ = headers.is_raw();
  return {};
}

Result<Image<std::uint8_t>> SessionReader::read_mosaics(std::vector<SheetBlockGrid>& leds) {
  std::optional<RawFrame> dark;
  if (const Shot* shot = session_.dark()) {
    Result<RawFrame> frame = capture::read_raw_shot(session_, *shot, size());
    if (!frame) return std::move(frame).error();
    dark = std::move(*frame);
  }
  std::vector<std::vector<double>> light(lit_.size());
  SumPicture sum(size());
  const auto read_frame = [&](std::size_t i) -> Result<void> {
    const Shot& shot = lit_[i];
    Result<RawFrame> frame = capture::read_raw_shot(session_, shot, size());
    if (!frame) return std::move(frame).error();
    if (Result<void> ok = check_levels(*frame, *options_.calibration.response, session_.path_of(shot)); !ok)
      return ok;
    const Radiometry radiometry(*frame, dark ? &*dark : nullptr, *options_.calibration.response,
                                {shot.exposure_us, shot.iso});
    const auto read = [&](Rect rows, View<float> out) { radiometry.read(frame->counts.plane(), rows, out); };
    std::optional<VeilOverFrame> veil;
    if (const auto& measured = options_.calibration.response->veil)
      veil.emplace(*measured, size(), frame->cfa, read);
    SheetBlockGrid grid(size(), block_px_);
    Image<float> band({size().width, block_px_});
    for (int row = 0; row < grid.rows; ++row) {
      const Rect rows = {0, row * block_px_, size().width, (row + 1) * block_px_};
      read(rows, band.plane());
      if (veil) veil->take_off(rows, band.plane());
      average_row(grid, row, band.plane(), frame->cfa);
    }
    leds[static_cast<std::size_t>(shot.led - 1)] = std::move(grid);
    if (dark) light[i] = light_by_parts(*frame);
    sum.add(*frame);
    return {};
  };
  // Two at a time, whatever the threads: memory is bounded by frames.
  JobContext two = context_;
  two.threads = std::min(resolved_threads(context_.threads), 2);
  if (Result<void> ok = for_each_frame(lit_.size(), two, read_frame); !ok) return std::move(ok).error();
  if (dark) {
    if (Result<void> ok = check_dark(light_by_parts(*dark), light); !ok) return std::move(ok).error();
  }
  sum.add_to(cells_, point_cell_px(size()));
  return sum.grey();
}

Result<Image<std::uint8_t>> SessionReader::read_developed(std::vector<SheetBlockGrid>& leds) {
  Image<float> dark;
  if (const Shot* shot = session_.dark()) {
    Result<Image<float>> image = capture::read_developed_shot(session_, *shot);
    if (!image) return std::move(image).error();
    dark = std::move(*image);
  }
  Image<float> sum(size(), 3);
  std::vector<std::vector<double>> light;
  for (const Shot& shot : lit_) {
    Result<Image<float>> image = capture::read_developed_shot(session_, shot);
    if (!image) return std::move(image).error();
    if (!dark.empty()) {
      light.push_back(light_by_parts(std::as_const(*image).plane(1)));
      subtract(*image, dark);
    }
    scale(*image, 1 / seconds(shot));
    SheetBlockGrid grid(size(), block_px_);
    for (int row = 0; row < grid.rows; ++row) {
      const Rect band = {0, row * block_px_, size().width, (row + 1) * block_px_};
      average_row(grid, row,
                  std::array<View<const float>, 3>{std::as_const(*image).plane(0).crop(band),
                                                   std::as_const(*image).plane(1).crop(band),
                                                   std::as_const(*image).plane(2).crop(band)});
    }
    leds[static_cast<std::size_t>(shot.led - 1)] = std::move(grid);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < size().height; ++y) {
        for (int x = 0; x < size().width; ++x) {
          const float v = (*image)(x, y, c);
          if (std::isfinite(v)) sum(x, y, c) += v;
        }
      }
    }
  }
  if (!dark.empty()) {
    if (Result<void> ok = check_dark(light_by_parts(std::as_const(dark).plane(1)), light); !ok)
      return std::move(ok).error();
  }
  const std::array<View<const float>, 3> planes = {std::as_const(sum).plane(0), std::as_const(sum).plane(1),
                                                   std::as_const(sum).plane(2)};
  const int cell_px = point_cell_px(size());
  for (std::size_t c = 0; c < 3; ++c)
    add_cells(planes[c], {0, 0, size().width, size().height}, cell_px, c == 1 ? 2 : 1, cells_);
  return grey_picture(planes);
}

// A dark shot that is lit takes a LED's light from all others: none of them is to blame.
Result<void> SessionReader::check_dark(std::span<const double> dark,
                                       std::span<const std::vector<double>> lit) const {
  const std::optional<std::size_t> like = photograph_like(dark, lit);
  if (!like) return {};
  return bad_capture(
      session_.path_of(*session_.dark()),
      fmt::format("the dark shot of {} is lit", folder_.filename().string()),
      fmt::format("it looks like LED {}'s photograph", lit_[*like].led),
      fmt::format("look whether LED {} stays lit, or frames are numbered wrongly, and scan the sheet "
                  "again",
                  lit_[*like].led));
}

Result<void> SessionReader::find_pose(const Image<std::uint8_t>& grey, SheetCapture& capture) const {
  std::set<std::string> dictionaries;
  for (const SheetTag& tag : options_.sheet.tags) dictionaries.insert(tag.dictionary);
  std::vector<TagSighting> sightings;
  for (const std::string& dictionary : dictionaries) {
    Result<std::vector<TagSighting>> found = find_tags(grey.plane(), dictionary);
    if (!found) return std::move(found).error();
    sightings.insert(sightings.end(), found->begin(), found->end());
  }
  const CameraModel& camera = *options_.calibration.camera;
  auto pose = sheet_pose(camera, sightings, options_.sheet.tags, folder_.string());
  if (!pose) return std::move(pose).error();
  capture.pose = *pose;
  return {};
}

void SessionReader::mark_paper(SheetCapture& capture) const {
  const SheetBlockGrid grid(size(), block_px_);
  capture.is_paper.resize(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  parallel_for(static_cast<std::size_t>(grid.rows), context_.threads, [&](std::size_t j, int) {
    const int row = static_cast<int>(j);
    for (int column = 0; column < grid.columns; ++column) {
      capture.is_paper[index_of(grid, column, row)] =
          shows_paper(*options_.calibration.camera, options_.sheet.sheet, capture.pose.rig_from_sheet,
                      grid.centre_px(column), grid.centre_px(row), block_px_);
    }
  });
}

std::vector<PixelPoint> SessionReader::outline_of(const Pose& rig_from_sheet) const {
  const double u = options_.sheet.sheet.width_mm / 2, v = options_.sheet.sheet.height_mm / 2;
  std::vector<PixelPoint> outline;
  for (const Vec3 corner : {Vec3{-u, v, 0}, Vec3{u, v, 0}, Vec3{u, -v, 0}, Vec3{-u, -v, 0}}) {
    const Vec3 p = project(*options_.calibration.camera, rig_from_sheet(corner));
    outline.push_back({p.x, p.y});
  }
  return outline;
}

// LEDs that gave no light, and paper that is full.
Result<void> SessionReader::check_light(const SheetCapture& capture, std::vector<Verdict>& warnings) const {
  std::vector<double> level(capture.leds.size());
  std::vector<double> full(capture.leds.size());
  double brightest = 0;
  for (std::size_t k = 0; k < capture.leds.size(); ++k) {
    const SheetBlockGrid& grid = capture.leds[k];
    double sum = 0, count = 0, paper = 0;
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        if (!capture.is_paper[index_of(grid, column, row)]) continue;
        ++paper;
        const bool is_full =
            grid.at(column, row, 0).full + grid.at(column, row, 1).full + grid.at(column, row, 2).full > 0;
        if (is_full) ++full[k];
        if (!std::isfinite(grid.at(column, row, 1).reading)) continue;
        sum += grid.at(column, row, 1).reading;
        ++count;
      }
    }
    level[k] = count > 0 ? sum / count : 0;
    if (paper > 0) full[k] /= paper;
    brightest = std::max(brightest, level[k]);
  }
  for (std::size_t k = 0; k < capture.leds.size(); ++k) {
    const auto shot = std::find_if(lit_.begin(), lit_.end(),
                                   [&](const Shot& s) { return s.led == static_cast<int>(k) + 1; });
    if (shot == lit_.end()) continue;
    if (full[k] > kMostFullShare) {
      return bad_capture(session_.path_of(*shot), "the paper is full",
                         fmt::format("under LED {} {:.0f} percent of it are at white", k + 1, 100 * full[k]),
                         "photograph the sheet with a shorter exposure, the same for all poses");
    }
    if (!(level[k] > kDarkShare * brightest)) {
      return bad_capture(session_.path_of(*shot), fmt::format("LED {} did not light", k + 1),
                         fmt::format("the paper reads {:.2g} under it and {:.2g} under the brightest LED",
                                     level[k], brightest),
                         "look at the LED and its wire, and scan the sheet again");
    }
    if (full[k] > kWarnFullShare) {
      warnings.push_back(
          {"PAPER_FULL",
           fmt::format("{}: under LED {} {:.0f} percent of the paper are at white and not used", capture.name,
                       k + 1, 100 * full[k]),
           "expose shorter, all poses alike"});
    }
  }
  return {};
}

// Brings the sessions' readings to the exposure of the first by its measured ratio.
Result<double> exposure_scale(const Session& session, const Session& first, const Response& response) {
  const Shot &shot = *session.lit().front(), &like = *first.lit().front();
  if (shot.exposure_us == like.exposure_us && shot.iso == like.iso) return 1.0;
  const auto ratio = response.exposure_ratio(shot.exposure_us, like.exposure_us);
  if (ratio && shot.iso == like.iso) return shot.exposure_us / like.exposure_us / *ratio;
  return bad_capture(
      session.path_of(shot), "the sheet was exposed differently",
      fmt::format(
          "{} at ISO {:.6g}, in {} {} at ISO {:.6g}, and the calibration has no measured ratio of the two",
          exposure_words(shot.exposure_us), shot.iso, first.folder.filename().string(),
          exposure_words(like.exposure_us), like.iso),
      "photograph the sheet in all poses with one exposure");
}

void warn_of_poses(SheetCaptures& all, std::size_t leds) {
  for (std::size_t i = 0; i < all.captures.size(); ++i) {
    const SheetCapture& capture = all.captures[i];
    for (std::size_t j = 0; j < i; ++j) {
      if (same_pose(all.captures[j].pose.rig_from_sheet, capture.pose.rig_from_sheet))
        all.warnings.push_back(
            {"SAME_POSE",
             fmt::format("{} and {} show the sheet in one pose, which says no more than one of them",
                         all.captures[j].name, capture.name),
             "turn the sheet, or tilt it to a side that is not there yet, and scan it in place of one of "
             "them"});
    }
    std::vector<std::size_t> unlit;
    for (std::size_t k = 0; k < leds; ++k) {
      if (capture.leds[k].columns == 0) unlit.push_back(k + 1);
    }
    if (!unlit.empty())
      all.warnings.push_back({"LED_UNLIT",
                              fmt::format("{} did not light LED {}", capture.name, fmt::join(unlit, ", ")),
                              "scan the sheet with all LEDs"});
  }
}

}  // namespace

Result<SheetCaptures> read_sheet_captures(const SheetCapturesOptions& options, const JobContext& context) {
  std::vector<fs::path> folders;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(options.folder, failed)) {
    if (entry.path().extension() == ".weft") folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  if (folders.empty()) {
    return Error{ErrorKind::kNoInput, "there is nothing to calibrate from", options.folder.string(),
                 failed ? failed.message() : "it holds no session (*.weft)",
                 "name a folder with a session for each pose of a white sheet"};
  }
  SheetCaptures all;
  const Size size = options.calibration.camera->size;
  all.block_px = size.width < 1000 ? 8 : 16;
  const SheetBlockGrid like(size, all.block_px);
  all.columns = like.columns;
  all.rows = like.rows;
  FixedPointFinder points(*options.calibration.camera, options.calibration.points);
  std::optional<Session> first;
  for (std::size_t i = 0; i < folders.size(); ++i) {
    JobContext part = context;
    part.progress = [&](std::string_view phase, double share) {
      context.progress(phase, (static_cast<double>(i) + share) / static_cast<double>(folders.size()));
    };
    SessionReader reader(options, part, folders[i]);
    Result<SheetCapture> capture = reader.read(all.block_px, points, all.warnings);
    if (!capture) return std::move(capture).error();
    if (!first) first = reader.session();
    const Result<double> scale = exposure_scale(reader.session(), *first, *options.calibration.response);
    if (!scale) return scale.error();
    for (SheetBlockGrid& grid : capture->leds) {
      for (BlockMean& block : grid.blocks) {
        block.reading *= *scale;
        block.standard_error *= static_cast<float>(*scale);
      }
    }
    all.captures.push_back(std::move(*capture));
  }
  const std::size_t leds = light_count(*options.calibration.lights);
  for (std::size_t k = 0; k < leds; ++k) {
    const bool lit = std::any_of(all.captures.begin(), all.captures.end(),
                                 [&](const SheetCapture& c) { return c.leds[k].columns > 0; });
    if (lit) continue;
    return bad_capture(options.folder, "a LED was never lit", fmt::format("no session lights LED {}", k + 1),
                       "scan the sheet with all LEDs, or take the LED out of rig.toml");
  }
  all.points = points.found();
  warn_of_poses(all, leds);
  return all;
}

Result<std::vector<std::string>> lit_sha256(const Session& session) {
  std::vector<std::string> digests;
  for (const Shot* shot : session.lit()) {
    Result<std::string> digest =
        shot->sha256.empty() ? sha256_of_file(session.path_of(*shot)) : Result<std::string>(shot->sha256);
    if (!digest) return std::move(digest).error();
    digests.push_back(std::move(*digest));
  }
  return digests;
}

std::vector<PaperReading> single_blocks(const SheetCaptures& captures,
                                        const std::vector<std::vector<char>>& left_out) {
  std::vector<PaperReading> readings;
  for (std::size_t j = 0; j < captures.captures.size(); ++j) {
    const SheetCapture& capture = captures.captures[j];
    for (int row = 0; row < captures.rows; ++row) {
      for (int column = 0; column < captures.columns; ++column) {
        const auto block = static_cast<std::size_t>(row) * static_cast<std::size_t>(captures.columns) +
                           static_cast<std::size_t>(column);
        if (!capture.is_paper[block] || left_out[j][block]) continue;
        for (std::size_t k = 0; k < capture.leds.size(); ++k) {
          const SheetBlockGrid& grid = capture.leds[k];
          if (grid.columns == 0) continue;
          PaperReading r = {j, k, grid.centre_px(column), grid.centre_px(row), {}, {}};
          bool whole = true;
          for (int c = 0; c < 3; ++c) {
            const auto channel = static_cast<std::size_t>(c);
            const BlockMean& mean = grid.at(column, row, c);
            whole = whole && mean.reading > 0;
            r.reading_rgb[channel] = mean.reading;
            r.relative_sigma[channel] = static_cast<double>(mean.standard_error) / mean.reading;
          }
          if (whole) readings.push_back(r);
        }
      }
    }
  }
  return readings;
}

std::vector<PaperReading> merged_blocks(const SheetCaptures& captures,
                                        const std::vector<std::vector<char>>& left_out,
                                        const CellGrid& cells) {
  std::vector<PaperReading> readings;
  for (std::size_t j = 0; j < captures.captures.size(); ++j) {
    const SheetCapture& capture = captures.captures[j];
    for (int row = 0; row < cells.rows; ++row) {
      const int top = row * captures.rows / cells.rows, bottom = (row + 1) * captures.rows / cells.rows;
      for (int column = 0; column < cells.columns; ++column) {
        const int left = column * captures.columns / cells.columns,
                  right = (column + 1) * captures.columns / cells.columns;
        std::vector<std::array<int, 2>> places;
        for (int y = top; y < bottom; ++y) {
          for (int x = left; x < right; ++x) {
            const auto block = static_cast<std::size_t>(y) * static_cast<std::size_t>(captures.columns) +
                               static_cast<std::size_t>(x);
            if (capture.is_paper[block] && !left_out[j][block]) places.push_back({x, y});
          }
        }
        for (std::size_t k = 0; k < capture.leds.size(); ++k) {
          if (capture.leds[k].columns == 0 || places.empty()) continue;
          const MergedBlock merged = merge(capture.leds[k], places);
          const double least =
              std::min({merged.reading_rgb[0], merged.reading_rgb[1], merged.reading_rgb[2]});
          if (2 * merged.blocks < (right - left) * (bottom - top) || !(least > 0)) continue;
          readings.push_back({j, k, merged.x_px, merged.y_px, merged.reading_rgb, merged.relative_sigma});
        }
      }
    }
  }
  return readings;
}

}  // namespace weft::calibration
