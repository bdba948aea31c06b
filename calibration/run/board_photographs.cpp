// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/board_photographs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "capture/raw/decode_raw.h"
#include "capture/raw/raw_info.h"
#include "core/base/files.h"
#include "core/base/statistics.h"
#include "core/image_io/linear_image.h"
#include "core/rig/suits.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr double kMostBlur = 1.7;   // times the median
constexpr double kMostFull = 0.02;  // of a board's photosites

Result<std::vector<fs::path>> photographs_in(const fs::path& folder) {
  constexpr std::array kNoPhotographs = {".toml", ".json", ".txt", ".md", ".html"};
  std::error_code failure;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    const std::string name = entry.path().filename().string(), ending = entry.path().extension().string();
    const bool is_other =
        std::find(kNoPhotographs.begin(), kNoPhotographs.end(), ending) != kNoPhotographs.end();
    if (entry.is_regular_file() && !name.starts_with('.') && !is_other) files.push_back(entry.path());
  }
  if (failure) return cannot_read(folder, failure.value());
  if (files.empty()) {
    return Error{ErrorKind::kNoInput, "there are no photographs", folder.string(), "the folder holds none",
                 "name the folder with the photographs of the board"};
  }
  std::sort(files.begin(), files.end());
  return files;
}

// What the header of a photograph says; a reason where it cannot be used.
void read_header(const fs::path& file, BoardPhotograph& photograph) {
  if (is_linear_image(file)) {
    const Result<ImageFileInfo> info = read_linear_image_info(file);
    if (!info) return void(photograph.left_out = info.error().message());
    photograph.size = info->size;
    return;
  }
  const Result<capture::RawInfo> info = capture::read_raw_info(file);
  if (!info) return void(photograph.left_out = info.error().message());
  photograph.size = info->size;
  photograph.shot = info->shot;
}

bool is_same_camera(const ShotMetadata& a, const ShotMetadata& b) {
  return a.model == b.model && a.serial == b.serial && a.f_number == b.f_number;
}

// Whether two photographs were taken with one setting.
bool are_alike(const BoardPhotograph& a, const BoardPhotograph& b) {
  return is_same_camera(a.shot, b.shot) && !focal_difference(a.shot.focal_mm, b.shot.focal_mm) &&
         a.size == b.size;
}

std::string words(const ShotMetadata& shot) {
  return fmt::format("{}{}{}", shot.model.empty() ? "a camera without a name" : shot.model,
                     shot.serial.empty() ? "" : ", serial number " + shot.serial,
                     shot.f_number > 0 ? fmt::format(", f/{:g}", shot.f_number) : "");
}

// Leaves out what is of another camera, size, aperture or focal length than most, or than was asked for.
void keep_one_camera(const BoardFolderOptions& asked, BoardPhotographs& all) {
  // What was asked for counts before any number of others.
  const auto fits = [&](const BoardPhotograph& p) {
    return !(asked.subject && subject_difference(*asked.subject, p.shot)) &&
           (!asked.size || p.size == *asked.size);
  };
  const BoardPhotograph* most = nullptr;
  std::pair<bool, std::ptrdiff_t> most_votes;
  for (const BoardPhotograph& p : all.photographs) {
    if (!p.left_out.empty()) continue;
    const auto votes = std::count_if(all.photographs.begin(), all.photographs.end(), [&](const auto& other) {
      return other.left_out.empty() && are_alike(p, other);
    });
    if (most != nullptr && std::pair(fits(p), votes) <= most_votes) continue;
    most = &p;
    most_votes = {fits(p), votes};
  }
  if (most == nullptr) return;
  const bool some_fit = most_votes.first;
  BoardPhotograph wanted = *most;
  if (asked.size) wanted.size = *asked.size;
  if (!some_fit && asked.subject) {
    wanted.shot.model = asked.subject->camera_model;
    wanted.shot.serial = asked.subject->camera_serial;
    wanted.shot.f_number = asked.subject->f_number;
    wanted.shot.focal_mm = asked.subject->focal_length_mm;
  }
  all.camera = wanted.shot;
  all.size = wanted.size;
  for (BoardPhotograph& p : all.photographs) {
    if (!p.left_out.empty() || (some_fit && are_alike(p, wanted))) continue;
    if (!is_same_camera(p.shot, wanted.shot)) {
      p.left_out = fmt::format("it was taken with {}, and this calibration is for {}", words(p.shot),
                               words(wanted.shot));
    } else if (const auto why = focal_difference(p.shot.focal_mm, wanted.shot.focal_mm)) {
      p.left_out = *why;
    } else {
      p.left_out = fmt::format("it has {} x {} pixels, the {} {} x {}", p.size.width, p.size.height,
                               asked.size ? "calibrated camera" : "others", all.size.width, all.size.height);
    }
  }
}

struct Picture {
  Image<std::uint8_t> grey;
  std::optional<RawFrame> raw;  ///< where it is no developed picture
};

Result<Picture> read_picture(const fs::path& file, Size size) {
  if (is_linear_image(file)) {
    const Result<Image<float>> image =
        read_linear_image(file, Transfer::kAuto, Clipped::kKeep, NotNumbers::kMark);
    if (!image) return image.error();
    const std::array<View<const float>, 3> rgb = {image->plane(0), image->plane(1), image->plane(2)};
    return Picture{grey_picture(rgb), {}};
  }
  Result<RawFrame> frame = capture::decode_raw(file, {.size = size});
  if (!frame) return std::move(frame).error();
  Image<std::uint8_t> grey = grey_picture(*frame);
  return Picture{std::move(grey), std::move(*frame)};
}

/// Share of the photosites among a board's corners that the light has filled.
double full_share(const RawFrame& frame, const BoardSighting& board) {
  const auto across = [](const BoardCorner& c) { return c.px.x; };
  const auto down = [](const BoardCorner& c) { return c.px.y; };
  const auto [left, right] = std::ranges::minmax(board.corners, {}, across);
  const auto [top, bottom] = std::ranges::minmax(board.corners, {}, down);
  const auto [width, height] = frame.counts.size();
  const int x0 = std::clamp(static_cast<int>(left.px.x), 0, width),
            x1 = std::clamp(static_cast<int>(right.px.x), x0, width);
  const int y0 = std::clamp(static_cast<int>(top.px.y), 0, height),
            y1 = std::clamp(static_cast<int>(bottom.px.y), y0, height);
  double full = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) full += frame.counts(x, y) >= frame.white ? 1 : 0;
  }
  return full / std::max(1.0, static_cast<double>(x1 - x0) * (y1 - y0));
}

Result<void> look_at(const fs::path& file, const BoardFolderOptions& options, BoardPhotograph& photograph) {
  const Result<Picture> picture = read_picture(file, photograph.size);
  if (!picture) {
    photograph.left_out = picture.error().message();
    return {};
  }
  const View<const std::uint8_t> grey = picture->grey.plane();
  photograph.sighting = find_board(grey, options.board, options.limits);
  const BoardSighting& sighting = photograph.sighting;
  if (sighting.fault != BoardFault::kNone) {
    photograph.left_out = fmt::format("{}: {}", name_of(sighting.fault), sighting.why);
  } else if (const double full = picture->raw ? full_share(*picture->raw, sighting) : 0; full > kMostFull) {
    photograph.left_out = fmt::format(
        "too bright: {:.0f} percent of the board are as bright as the camera can count, and white "
        "that is full grows into black",
        100 * full);
  }
  if (!photograph.of_table) return {};
  auto tags = find_tags(grey, options.tag_dictionary);
  if (!tags) return tags.error();
  const Board& board = options.board;
  const bool share_dictionary =
      board.kind == BoardKind::kCharuco && board.dictionary == options.tag_dictionary;
  std::erase_if(*tags, [&](const TagSighting& tag) {
    return share_dictionary && tag.id >= board.first_marker && tag.id < board.first_marker + board.markers();
  });
  photograph.tags = std::move(*tags);
  return {};
}

// Blur is also why a board cannot be read in full.
void leave_out_the_softest(std::vector<BoardPhotograph>& photographs) {
  std::vector<double> widths;
  for (const BoardPhotograph& p : photographs) {
    if (p.left_out.empty()) widths.push_back(p.sighting.edge_px);
  }
  if (widths.empty()) return;
  const double middle = median(std::move(widths));
  for (BoardPhotograph& p : photographs) {
    if (p.sighting.fault == BoardFault::kBlurred || p.sighting.edge_px <= kMostBlur * middle) continue;
    p.left_out = fmt::format("{}: its edges are {:.1f} pixels wide, the median of the photographs is {:.1f}",
                             name_of(BoardFault::kBlurred), p.sighting.edge_px, middle);
  }
}

BoardPhotograph headed(const fs::path& file) {
  BoardPhotograph photograph;
  photograph.name = file.filename().string();
  photograph.of_table = photograph.name.starts_with("table");
  read_header(file, photograph);
  return photograph;
}

}  // namespace

Result<BoardPhotograph> read_board_photograph(const fs::path& file, const BoardFolderOptions& options) {
  BoardPhotograph photograph = headed(file);
  if (!photograph.left_out.empty()) return photograph;
  if (Result<void> looked = look_at(file, options, photograph); !looked) return looked.error();
  return photograph;
}

Result<BoardPhotographs> read_board_photographs(const BoardFolderOptions& options,
                                                const JobContext& context) {
  const Result<std::vector<fs::path>> files = photographs_in(options.folder);
  if (!files) return files.error();
  BoardPhotographs all;
  for (const fs::path& file : *files) all.photographs.push_back(headed(file));
  keep_one_camera(options, all);
  const Result<void> read = for_each_frame(files->size(), context, [&](std::size_t i) -> Result<void> {
    if (!all.photographs[i].left_out.empty()) return {};
    return look_at((*files)[i], options, all.photographs[i]);
  });
  if (!read) return read.error();
  leave_out_the_softest(all.photographs);
  return all;
}

}  // namespace weft::calibration
