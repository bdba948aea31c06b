// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/response_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "capture/raw/decode_raw.h"
#include "capture/raw/raw_info.h"
#include "core/image_io/linear_image.h"
#include "core/rig/dark_counts.h"
#include "core/rig/photosites.h"
#include "core/rig/reading_stop.h"
#include "core/rig/suits.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kFullShareOfFrame = 0.9;
constexpr double kBrightShare = 0.01;  // of full photosites, at most, in frames searched for dead ones
constexpr std::size_t kMostKept = 4;

std::vector<fs::path> sorted_entries(const fs::path& folder) {
  std::vector<fs::path> entries;
  std::error_code failed;
  for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
    if (it->path().filename().string().front() != '.') entries.push_back(it->path());
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

// "led01+led02" is {1, 2}, "dark" {}; nothing for any other name.
std::optional<std::vector<int>> leds_of(const std::string& name) {
  std::vector<int> leds;
  if (name == "dark") return leds;
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t end = std::min(name.find('+', at), name.size());
    const std::string part = name.substr(at, end - at);
    const bool good = part.size() > 3 && part.size() < 7 && part.compare(0, 3, "led") == 0 &&
                      part.find_first_not_of("0123456789", 3) == std::string::npos;
    if (!good || std::stoi(part.substr(3)) < 1) return {};
    leds.push_back(std::stoi(part.substr(3)));
    at = end + 1;
  }
  std::sort(leds.begin(), leds.end());
  if (std::adjacent_find(leds.begin(), leds.end()) != leds.end()) return {};
  return leds;
}

Error of_another(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "frame does not belong to this calibration", file.string(), std::move(why),
          "use frames of one body, ISO, aperture and focal length, as the rig scans with"};
}

// What all frames must share.
class Body {
 public:
  explicit Body(const Calibration* from) : from_(from) {}

  Result<void> check(const fs::path& file, const capture::RawInfo& info) {
    if (!first_) {
      first_ = info;
      first_file_ = file;
      if (from_ == nullptr) return {};
      if (auto why = subject_difference(from_->subject, info.shot)) return of_another(file, *why);
      if (from_->camera && from_->camera->size != info.size) {
        return of_another(
            file, fmt::format("it has {} x {} pixels, the calibration's camera {} x {}", info.size.width,
                              info.size.height, from_->camera->size.width, from_->camera->size.height));
      }
      return {};
    }
    const ShotMetadata &a = first_->shot, &b = info.shot;
    const auto differs = [&](const char* what, const auto& mine, const auto& others) -> Result<void> {
      if (mine == others) return {};
      return of_another(
          file, fmt::format("its {} is {}, that of {} is {}", what, mine, first_file_.string(), others));
    };
    for (const Result<void>& ok :
         {differs("camera", b.model, a.model), differs("serial number", b.serial, a.serial),
          differs("ISO", b.iso, a.iso),
          differs("aperture", fmt::format("f/{:.3g}", b.f_number), fmt::format("f/{:.3g}", a.f_number)),
          differs("width", info.size.width, first_->size.width),
          differs("height", info.size.height, first_->size.height)}) {
      if (!ok) return ok;
    }
    if (const auto why = focal_difference(b.focal_mm, a.focal_mm)) return of_another(file, *why);
    if (info.cfa != first_->cfa) return of_another(file, "its colour filters are laid out differently");
    return {};
  }
  const std::optional<capture::RawInfo>& first() const { return first_; }

 private:
  const Calibration* from_;
  std::optional<capture::RawInfo> first_;
  fs::path first_file_;
};

// The photosites of both lists, which are sorted.
std::vector<Photosite> common(const std::vector<Photosite>& a, const std::vector<Photosite>& b) {
  std::vector<Photosite> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both;
}

void mark(View<std::uint8_t> bad, const std::vector<Photosite>& photosites) {
  for (const Photosite& p : photosites) bad(p.x, p.y) = 255;
}

std::ptrdiff_t marked(View<const std::uint8_t> bad) {
  std::ptrdiff_t count = 0;
  for (int y = 0; y < bad.height(); ++y) count += std::count(bad.row(y), bad.row(y) + bad.width(), 255);
  return count;
}

class Reader {
 public:
  Reader(ResponseFrames& out, const JobContext& context) : out_(out), context_(context) {
    for (const auto& [leds, exposures] : out_.by_leds) {
      for (const ExposureFrames& e : exposures) total_ += static_cast<double>(e.files.size());
      if (!leds.empty()) total_ += static_cast<double>(exposures.back().files.size());
    }
  }

  // The longest exposures show it.
  Result<void> find_full() {
    std::vector<std::array<TopTally, 3>> tallies;
    std::optional<RawFrame> like;
    for (const auto& [leds, exposures] : out_.by_leds) {
      if (leds.empty()) continue;
      for (const fs::path& file : exposures.back().files) {
        Result<RawFrame> frame = read(file);
        if (!frame) return std::move(frame).error();
        tallies.push_back(top_tallies(*frame));
        like = std::move(*frame);
      }
    }
    if (like) out_.full_rgb = find_count_stops(tallies, *like);
    return {};
  }

  Result<void> read_dark(std::vector<ExposureFrames>& exposures) {
    double frames = 0;
    out_.bad = Image<std::uint8_t>(out_.size);
    for (ExposureFrames& exposure : exposures) {
      std::optional<RawFrame> before;
      std::vector<Photosite> hot;  // in every frame: one alone shows cosmic rays, too
      for (const fs::path& file : exposure.files) {
        Result<RawFrame> frame = read(file);
        if (!frame) return std::move(frame).error();
        const DarkCounts dark = dark_counts(*frame);
        for (std::size_t c = 0; c < 3; ++c)
          out_.dark_rgb[c] = (out_.dark_rgb[c] * frames + dark.median[c]) / (frames + 1);
        ++frames;
        std::vector<Photosite> found = hot_photosites(*frame, 1, context_.threads);
        Image<std::uint8_t> bad(out_.size);
        mark(bad.plane(), found);
        join(exposure.light, block_light(*frame, bad.plane()));
        pair_up(before, std::move(*frame), bad.plane());
        hot = file == exposure.files.front() ? std::move(found) : common(hot, found);
      }
      mark(out_.bad.plane(), hot);
    }
    out_.hot = static_cast<int>(marked(out_.bad.plane()));
    return {};
  }

  Result<void> read_lit(std::vector<ExposureFrames>& exposures) {
    std::optional<RawFrame> brightest;
    double most = 0;
    for (ExposureFrames& exposure : exposures) {
      std::optional<RawFrame> before;
      for (const fs::path& file : exposure.files) {
        Result<RawFrame> frame = read(file);
        if (!frame) return std::move(frame).error();
        const BlockLight light = block_light(*frame, out_.bad.plane());
        const auto [least_full, most_full] =
            std::minmax_element(light.full_share.begin(), light.full_share.end());
        if (*least_full > kFullShareOfFrame) {
          out_.full.push_back(file.string());
          continue;
        }
        join(exposure.light, light);
        exposure.brightness.push_back(light.mean[0] + light.mean[1] + light.mean[2]);
        if (*most_full < kBrightShare && exposure.brightness.back() > most) {
          most = exposure.brightness.back();
          brightest = copy_of(*frame);
        }
        pair_up(before, std::move(*frame), out_.bad.plane());
      }
    }
    std::erase_if(exposures, [](const ExposureFrames& e) { return e.light.frames == 0; });
    if (brightest && bright_.size() < kMostKept) bright_.push_back(std::move(*brightest));
    return {};
  }

  void find_dead() {
    if (bright_.size() < 3 || out_.bad.empty()) return;
    const std::vector<Photosite> dead = dead_photosites(bright_, nullptr, 1, context_.threads);
    out_.dead = static_cast<int>(dead.size());
    mark(out_.bad.plane(), dead);
  }

 private:
  // Every second frame makes a pair with the one before.
  void pair_up(std::optional<RawFrame>& before, RawFrame frame, View<const std::uint8_t> bad) {
    if (!before) {
      before = std::move(frame);
      return;
    }
    const auto points = transfer_points(*before, frame, bad);
    out_.transfer.insert(out_.transfer.end(), points.begin(), points.end());
    ++out_.pairs;
    before.reset();
  }

  Result<RawFrame> read(const fs::path& file) {
    if (context_.stop.stop_requested()) return interrupted();
    Result<RawFrame> frame = capture::decode_raw(file, {.size = out_.size, .cfa = out_.cfa, .model = {}});
    if (!frame) return frame;
    if (out_.file_white == 0) {
      out_.file_white = static_cast<double>(frame->white);
      out_.file_black = frame->black;
    } else if (out_.file_white != static_cast<double>(frame->white) || out_.file_black != frame->black) {
      return of_another(file, "its black and white levels differ from those of the first frame");
    }
    frame->full = out_.full_rgb;
    context_.progress("read", ++done_ / total_);
    return frame;
  }

  ResponseFrames& out_;
  const JobContext& context_;
  std::vector<RawFrame> bright_;
  double done_ = 0, total_ = 0;
};

// The frames of one folder by their exposure, after a look at their headers.
Result<std::vector<ExposureFrames>> listed(const fs::path& folder, Body& body) {
  std::map<double, std::vector<fs::path>> by_exposure;
  for (const fs::path& file : sorted_entries(folder)) {
    if (file.extension() == ".toml") continue;
    if (is_linear_image(file)) {
      return Error{ErrorKind::kBadData, "a developed picture says nothing of the sensor", file.string(),
                   "the response is measured in counts", "put the camera's raw files there"};
    }
    const Result<capture::RawInfo> info = capture::read_raw_info(file);
    if (!info) return info.error();
    if (Result<void> ok = body.check(file, *info); !ok) return std::move(ok).error();
    if (!(info->shot.exposure_us > 0)) {
      return Error{ErrorKind::kBadData, "frame does not say how long it was exposed", file.string(), "",
                   "use frames with their metadata, as the camera wrote them"};
    }
    by_exposure[std::round(info->shot.exposure_us)].push_back(file);
  }
  std::vector<ExposureFrames> exposures;
  for (auto& [exposure_us, files] : by_exposure) {
    ExposureFrames e;
    e.exposure_us = exposure_us;
    e.files = std::move(files);
    exposures.push_back(std::move(e));
  }
  return exposures;
}

}  // namespace

Result<ResponseFrames> read_response_frames(const fs::path& folder, const fs::path& trap,
                                            const Calibration* from, const JobContext& context) {
  std::error_code failed;
  if (!fs::is_directory(folder, failed)) {
    return Error{ErrorKind::kNoInput, "no such folder", folder.string(), "",
                 "name the folder with dark/, led01/, led02/ and led01+led02/"};
  }
  ResponseFrames out;
  Body body(from);
  std::vector<fs::path> entries = sorted_entries(folder);
  if (!trap.empty()) {
    std::erase_if(entries, [](const fs::path& entry) { return entry.filename() == "trap"; });
    entries.push_back(trap / "trap");
    if (!fs::is_directory(entries.back(), failed)) {
      return Error{ErrorKind::kNoInput, "there is no photograph of a trap", trap.string(),
                   "it has no folder trap", "take them: weft capture trap"};
    }
  }
  for (const fs::path& entry : entries) {
    const std::string name = entry.filename().string();
    if (!fs::is_directory(entry, failed)) continue;
    const std::optional<std::vector<int>> leds = leds_of(name);
    if (!leds && name != "scale" && name != "trap") {
      out.warnings.push_back(fmt::format(
          "{} was left out: it is none of dark, ledNN, ledNN+ledMM, scale and trap", entry.string()));
      continue;
    }
    Result<std::vector<ExposureFrames>> exposures = listed(entry, body);
    if (!exposures) return std::move(exposures).error();
    if (exposures->empty()) {
      out.warnings.push_back(fmt::format("{} holds no frames", entry.string()));
    } else if (leds) {
      out.by_leds[*leds] = std::move(*exposures);
    } else {
      std::vector<fs::path>& files = name == "scale" ? out.scale : out.trap;
      for (const ExposureFrames& e : *exposures) files.insert(files.end(), e.files.begin(), e.files.end());
    }
  }
  const bool has_lit = std::any_of(out.by_leds.begin(), out.by_leds.end(),
                                   [](const auto& group) { return !group.first.empty(); });
  if (!has_lit) {
    return Error{ErrorKind::kNoInput, "there are no frames of a lit scene", folder.string(),
                 "it has no folder ledNN with raw frames",
                 "put frames lit by LED 1 into led01/, by LED 2 into led02/, by both into led01+led02/"};
  }
  out.camera = body.first()->shot;
  out.size = body.first()->size;
  out.cfa = body.first()->cfa;

  Reader reader(out, context);
  if (Result<void> ok = reader.find_full(); !ok) return std::move(ok).error();
  for (auto& [leds, exposures] : out.by_leds) {  // the dark ones come first: {} is least
    Result<void> ok = leds.empty() ? reader.read_dark(exposures) : reader.read_lit(exposures);
    if (!ok) return std::move(ok).error();
  }
  reader.find_dead();
  return out;
}

}  // namespace weft::calibration
