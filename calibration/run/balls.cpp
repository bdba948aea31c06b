// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/balls.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <system_error>
#include <utility>

#include "capture/camera/photograph_facts.h"
#include "capture/frames/picture_meaning.h"
#include "capture/frames/raw_picture.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/text.h"
#include "core/image_io/image_io.h"
#include "solve/input/photo_mask.h"
#include "solve/run/look_at_lights.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr int kLongestSide = 2000;
constexpr double kMostBytes = 1e9;
constexpr const char* kPictureName = "balls.png";
constexpr double kMaskMargin = 1.05;  // of the radius: an edge is blurred, and throws light about it
constexpr double kNearLamps_deg = 0.5;

/// Raws, where there are any: what lies beside them shows the same.
Result<std::vector<fs::path>> pictures_in(const fs::path& folder) {
  std::vector<fs::path> files, raws;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    const fs::path& file = entry->path();
    const std::string name = file.filename().string();
    if (name.starts_with('.') || name == kPictureName || solve::is_mask_name(file)) continue;
    if (capture::is_raw_name(file)) raws.push_back(file);
    if (is_linear_image(file)) files.push_back(file);
  }
  if (failed) return cannot_read(folder, failed.value());
  if (!raws.empty()) files = std::move(raws);
  if (files.empty())
    return Error{ErrorKind::kNoInput, "there are no photographs", folder.string(),
                 "no raw, TIFF, PNG, EXR or JPEG is there", "name the folder of the photographs"};
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return stands_before(a.filename().string(), b.filename().string());
  });
  return files;
}

/// For each photograph the one that shows the ball under its lamp.
Result<std::vector<fs::path>> shots_of_ball(const std::vector<fs::path>& photographs,
                                            const fs::path& folder) {
  if (folder.empty()) return photographs;
  const Result<std::vector<fs::path>> shots = pictures_in(folder);
  if (!shots) return shots.error();
  std::vector<fs::path> by_name;
  for (const fs::path& photograph : photographs) {
    const auto same =
        std::ranges::find(*shots, photograph.stem(), [](const fs::path& p) { return p.stem(); });
    if (same != shots->end()) by_name.push_back(*same);
  }
  if (by_name.size() == photographs.size()) return by_name;
  if (shots->size() == photographs.size()) return *shots;
  return Error{ErrorKind::kBadData, "photographs of the ball do not go with those of the cloth",
               folder.string(),
               fmt::format("{} of the ball, {} of the cloth, and {} names are the same", shots->size(),
                           photographs.size(), by_name.size()),
               "give each photograph of the cloth one of the ball under the same lamp"};
}

/// Means over squares of `by` pixels, of R, G and B.
Image<float> grey_of(const Image<float>& rgb, int by) {
  Image<float> grey(Size{rgb.width() / by, rgb.height() / by});
  for (int y = 0; y < grey.height(); ++y) {
    for (int x = 0; x < grey.width(); ++x) {
      float sum = 0;
      for (int j = 0; j < by; ++j) {
        for (int i = 0; i < by; ++i) {
          for (int c = 0; c < 3; ++c) sum += rgb(x * by + i, y * by + j, c);
        }
      }
      grey(x, y) = sum / static_cast<float>(3 * by * by);
    }
  }
  return grey;
}

/// A photograph as it is shown, linear; a mosaic by cells of its filters, and as it is stored.
struct ReadPicture {
  Image<float> rgb;
  Size size;     ///< of the photograph
  int cell = 1;  ///< pixels of it that one of `rgb` is across
};

Result<ReadPicture> read_picture(const fs::path& file, Transfer transfer) {
  const Result<capture::PictureMeaning> meaning = capture::meaning_of_picture(file);
  if (!meaning) return meaning.error();
  if (meaning->is_raw) {
    const Result<RawFrame> raw = capture::decode_raw(file);
    if (!raw) return raw.error();
    Image<float> rgb = capture::half_size_picture(*raw, Response{});
    for (int c = 0; c < rgb.planes(); ++c) {
      for (int y = 0; y < rgb.height(); ++y) {
        for (int x = 0; x < rgb.width(); ++x) rgb(x, y, c) = std::min(rgb(x, y, c), 1.0F);
      }
    }
    return ReadPicture{std::move(rgb), raw->counts.size(), 2};
  }
  Result<Image<float>> rgb = read_linear_image(file, transfer, Clipped::kKeep);
  if (!rgb) return std::move(rgb).error();
  Image<float> shown = as_shown(std::move(*rgb), meaning->orientation);
  const Size size = shown.size();
  return ReadPicture{std::move(shown), size};
}

// So that pictures have at most kLongestSide pixels a side, and all together fit into kMostBytes.
int shrunk_by(Size size, std::size_t count) {
  int by = std::max(1, (std::max(size.width, size.height) + kLongestSide - 1) / kLongestSide);
  const double bytes = sizeof(float) * static_cast<double>(size.pixels()) * static_cast<double>(count);
  while (bytes / (by * by) > kMostBytes) ++by;
  return by;
}

struct ReadShots {
  BallPhotographs photographs;
  Size size;
  int by = 1;
};

Result<ReadShots> read_shots(const std::vector<fs::path>& files, Transfer transfer) {
  ReadShots read;
  for (const fs::path& file : files) {
    const Result<ReadPicture> picture = read_picture(file, transfer);
    if (!picture) return picture.error();
    if (read.photographs.shots.empty()) {
      read.size = picture->size;
      read.by = picture->cell * shrunk_by(picture->rgb.size(), files.size());
    }
    if (picture->size != read.size)
      return Error{ErrorKind::kBadData, "photographs differ in size", file.string(),
                   fmt::format("{} x {} pixels, the first has {} x {}", picture->size.width,
                               picture->size.height, read.size.width, read.size.height),
                   "use photographs of one camera that was not moved"};
    read.photographs.shots.push_back(grey_of(picture->rgb, read.by / picture->cell));
    read.photographs.names.push_back(file.string());
  }
  return read;
}

Circle scaled(const Circle& c, double by) {
  const double middle = (by - 1) / 2;
  return {c.x * by + middle, c.y * by + middle, c.radius * by};
}
Circle shrunk(const Circle& c, double by) {
  const double middle = (by - 1) / 2;
  return {(c.x - middle) / by, (c.y - middle) / by, c.radius / by};
}

/// In pixels of the photographs.
BallLights enlarged(BallLights lights, int by) {
  for (FoundBall& ball : lights.balls) {
    ball.outline.circle = scaled(ball.outline.circle, by);
    ball.outline.sigma_px *= by;
    for (LampOnBall& lamp : ball.lamps) {
      const Circle at = scaled({lamp.x, lamp.y, 0}, by);
      lamp.x = at.x;
      lamp.y = at.y;
    }
  }
  return lights;
}

bool are_placed(const BallLights& lights) {
  return std::ranges::all_of(lights.lamps,
                             [](const FoundLamp& lamp) { return lamp.position_mm.has_value(); });
}

std::vector<std::string> notes_of(const BallLights& lights, const BallOptions& options,
                                  const std::optional<double>& mm_per_pixel) {
  std::vector<std::string> notes;
  if (!(options.fov_deg > 0))
    notes.emplace_back("no --fov: directions lean by the angle under which the camera sees the ball");
  for (const FoundBall& ball : lights.balls) {
    if (ball.as_told)
      notes.push_back(fmt::format("no edge was found near {:.0f},{:.0f},{:.0f}: it is taken as told",
                                  ball.outline.circle.x, ball.outline.circle.y, ball.outline.circle.radius));
  }
  if (!lights.lamps.front().strength) {
    const bool unsaid = lights.balls.front().kind == BallKind::kMirror;
    notes.emplace_back(unsaid ? "strengths are not known: --ball-kind says what a mirror is"
                              : "strengths are not known: highlights are clipped");
  }
  if (mm_per_pixel)
    notes.push_back(fmt::format("positions are over what the balls lie on: solve with --mm-per-pixel {:.4g}",
                                *mm_per_pixel));
  if (lights.apart_deg > kNearLamps_deg && !lights.lamps.front().position_mm)
    notes.push_back(
        fmt::format("balls say directions {:.1f} degrees apart: the lamps are near, and light "
                    "each part of the cloth from elsewhere",
                    lights.apart_deg));
  return notes;
}

solve::LightList list_of(const std::vector<fs::path>& photographs, const BallLights& lights,
                         const fs::path& file, double ball_mm) {
  solve::LightList list;
  list.file = file;
  list.kind = "RTI light file";
  list.are_positions = are_placed(lights);
  list.have_strengths = lights.lamps.front().strength.has_value();
  for (std::size_t k = 0; k < photographs.size(); ++k) {
    const FoundLamp& lamp = lights.lamps[k];
    const double s = lamp.strength.value_or(1);
    const Vec3 toward = list.are_positions ? *lamp.position_mm + Vec3{0, 0, ball_mm / 2} : lamp.direction;
    list.lights.push_back({photographs[k].filename().string(), photographs[k], toward, {s, s, s}});
  }
  return list;
}

/// White where cloth is.
Result<void> write_mask(const fs::path& file, Size size, const std::vector<FoundBall>& balls) {
  Image<float> mask(size);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const bool on_ball = std::ranges::any_of(balls, [&](const FoundBall& ball) {
        const Circle& c = ball.outline.circle;
        return std::hypot(x - c.x, y - c.y) < kMaskMargin * c.radius + 2;
      });
      mask(x, y) = on_ball ? 0.0F : 1.0F;
    }
  }
  const std::array<View<const float>, 1> planes = {mask.plane()};
  return write_image(file, planes, {"Y"}, {.type = SampleType::kUint8});
}

}  // namespace

Result<BallsReport> lights_by_balls(const BallsOptions& options) {
  const fs::path output = options.output.empty() ? options.photographs / "lights.lp" : options.output;
  BallsReport report;
  report.picture = output.parent_path() / kPictureName;
  for (const fs::path& file : {output, report.picture})
    if (Result<void> ok = solve::refuse_existing(file); !ok) return std::move(ok).error();
  const Result<std::vector<fs::path>> photographs = pictures_in(options.photographs);
  if (!photographs) return photographs.error();
  const Result<std::vector<fs::path>> files = shots_of_ball(*photographs, options.ball_folder);
  if (!files) return files.error();
  const Result<ReadShots> shots = read_shots(*files, options.transfer);
  if (!shots) return shots.error();
  BallOptions ball = options.ball;
  for (Circle& told : ball.told) told = shrunk(told, shots->by);
  Result<BallLights> found = lights_of_balls(shots->photographs, ball);
  if (!found) return std::move(found).error();
  report.lights = enlarged(std::move(*found), shots->by);
  report.list = list_of(*photographs, report.lights, output, ball.ball_mm);
  if (are_placed(report.lights))
    report.mm_per_pixel = ball.ball_mm / (2 * report.lights.balls.front().outline.circle.radius);
  report.notes = notes_of(report.lights, ball, report.mm_per_pixel);
  if (options.ball_folder.empty()) {
    Result<fs::path> mask = solve::find_mask(options.photographs);
    if (!mask) return std::move(mask).error();
    const fs::path& folder = options.mask_folder.empty() ? options.photographs : options.mask_folder;
    report.mask = mask->empty() ? folder / "mask.png" : fs::path();
    if (!mask->empty())
      report.notes.push_back(fmt::format("{} is there: paint the ball black in it", mask->string()));
  }
  if (!report.mask.empty()) {
    if (Result<void> ok = write_mask(report.mask, shots->size, report.lights.balls); !ok)
      return std::move(ok).error();
  }
  if (Result<void> ok =
          write_ball_picture(report.picture, shots->photographs.shots, report.lights, shots->by);
      !ok)
    return std::move(ok).error();
  if (Result<void> ok = solve::write_light_file(report.list, output); !ok) return std::move(ok).error();
  return report;
}

Json json_of(const BallsReport& report) {
  Json balls = Json::array(), lights = Json::array();
  for (const FoundBall& ball : report.lights.balls) {
    const Circle& c = ball.outline.circle;
    balls.push_back({{"x", c.x},
                     {"y", c.y},
                     {"radius", c.radius},
                     {"sigma_px", ball.outline.sigma_px},
                     {"kind", name_of(ball.kind)},
                     {"as_told", ball.as_told}});
  }
  for (std::size_t k = 0; k < report.lights.lamps.size(); ++k) {
    const FoundLamp& lamp = report.lights.lamps[k];
    const Vec3& d = lamp.direction;
    Json light = {{"photograph", report.list.lights[k].photograph.string()},
                  {"direction", {d.x, d.y, d.z}},
                  {"sigma_deg", lamp.sigma_deg},
                  {"position_mm", nullptr},
                  {"strength", nullptr}};
    if (lamp.position_mm) {
      light["position_mm"] = {lamp.position_mm->x, lamp.position_mm->y, lamp.position_mm->z};
      light["position_sigma_mm"] = lamp.position_sigma_mm;
    }
    if (lamp.strength) {
      light["strength"] = *lamp.strength;
      light["strength_sigma"] = lamp.strength_sigma;
    }
    lights.push_back(std::move(light));
  }
  return {{"file", report.list.file.string()}, {"picture", report.picture.string()},
          {"mask", report.mask.string()},      {"balls", std::move(balls)},
          {"lights", std::move(lights)},       {"notes", report.notes}};
}

}  // namespace weft::calibration
