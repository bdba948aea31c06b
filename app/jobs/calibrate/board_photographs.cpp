// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/calibrate/board_photographs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

#include "app/jobs/linear_image.h"
#include "calibration/suits.h"
#include "capture/raw/decode.h"
#include "capture/raw/raw_info.h"
#include "core/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using calibration::BoardFault;

constexpr double kMostBlur = 1.7;  // times the median

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

using Setting = std::tuple<std::string, std::string, double, int, int>;

Setting setting_of(const BoardPhotograph& p) {
  return {p.shot.model, p.shot.serial, p.shot.f_number, p.size.width, p.size.height};
}

std::string words(const ShotMetadata& shot) {
  return fmt::format("{}{}{}", shot.model.empty() ? "a camera without a name" : shot.model,
                     shot.serial.empty() ? "" : ", serial number " + shot.serial,
                     shot.f_number > 0 ? fmt::format(", f/{:g}", shot.f_number) : "");
}

// Leaves out what is of another camera, size or aperture than most, or than the subject.
void keep_one_camera(const std::optional<CalibrationSubject>& subject, BoardPhotographs& all) {
  std::map<Setting, int> votes;
  for (const BoardPhotograph& p : all.photographs) {
    if (p.left_out.empty()) ++votes[setting_of(p)];
  }
  if (votes.empty()) return;
  // A size that the subject's photographs have counts before one of a photograph of another camera.
  const auto fits_subject = [&](const Setting& s) {
    if (!subject) return true;
    ShotMetadata shot;
    std::tie(shot.model, shot.serial, shot.f_number, std::ignore, std::ignore) = s;
    return !calibration::difference(*subject, shot);
  };
  const auto most = std::max_element(votes.begin(), votes.end(), [&](const auto& a, const auto& b) {
    return std::pair(fits_subject(a.first), a.second) < std::pair(fits_subject(b.first), b.second);
  });
  ShotMetadata wanted;
  if (fits_subject(most->first)) {
    std::tie(wanted.model, wanted.serial, wanted.f_number, all.size.width, all.size.height) = most->first;
  } else {
    wanted.model = subject->camera_model, wanted.serial = subject->camera_serial,
    wanted.f_number = subject->f_number;
  }
  all.camera = wanted;
  for (BoardPhotograph& p : all.photographs) {
    if (!p.left_out.empty() || (fits_subject(most->first) && setting_of(p) == most->first)) continue;
    p.left_out =
        p.shot.model == wanted.model && p.shot.serial == wanted.serial && p.shot.f_number == wanted.f_number
            ? fmt::format("it has {} x {} pixels, the others {} x {}", p.size.width, p.size.height,
                          all.size.width, all.size.height)
            : fmt::format("it was taken with {}, and this calibration is for {}", words(p.shot),
                          words(wanted));
  }
}

Result<Image<std::uint8_t>> read_grey(const fs::path& file, Size size) {
  if (is_linear_image(file)) {
    const Result<Image<float>> image =
        read_linear_image(file, Transfer::kAuto, Clipped::kKeep, NotNumbers::kMark);
    if (!image) return image.error();
    const std::array<View<const float>, 3> rgb = {image->plane(0), image->plane(1), image->plane(2)};
    return calibration::grey_picture(rgb);
  }
  const Result<RawFrame> frame = capture::decode_raw(file, {.size = size});
  if (!frame) return frame.error();
  return calibration::grey_picture(*frame);
}

Result<void> look_at(const fs::path& file, const BoardFolderOptions& options, BoardPhotograph& photograph) {
  const Result<Image<std::uint8_t>> grey = read_grey(file, photograph.size);
  if (!grey) {
    photograph.left_out = grey.error().message();
    return {};
  }
  photograph.sighting = calibration::find_board(grey->plane(), options.board, options.limits);
  const calibration::BoardSighting& sighting = photograph.sighting;
  if (sighting.fault != BoardFault::kNone)
    photograph.left_out = fmt::format("{}: {}", name_of(sighting.fault), sighting.why);
  if (!photograph.of_table) return {};
  auto tags = calibration::find_tags(grey->plane(), options.tag_dictionary);
  if (!tags) return tags.error();
  const bool share_dictionary = options.board.kind == calibration::BoardKind::kCharuco &&
                                options.board.dictionary == options.tag_dictionary;
  const int first_id = share_dictionary ? options.board.squares_x * options.board.squares_y / 2 : 0;
  std::erase_if(*tags, [&](const calibration::TagSighting& tag) { return tag.id < first_id; });
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
  const auto middle = widths.begin() + static_cast<std::ptrdiff_t>(widths.size() / 2);
  std::nth_element(widths.begin(), middle, widths.end());
  for (BoardPhotograph& p : photographs) {
    if (p.sighting.fault == BoardFault::kBlurred || p.sighting.edge_px <= kMostBlur * *middle) continue;
    p.left_out = fmt::format("{}: its edges are {:.1f} pixels wide, the median of the photographs is {:.1f}",
                             name_of(BoardFault::kBlurred), p.sighting.edge_px, *middle);
  }
}

}  // namespace

Result<BoardPhotographs> read_board_photographs(const BoardFolderOptions& options,
                                                const JobContext& context) {
  const Result<std::vector<fs::path>> files = photographs_in(options.folder);
  if (!files) return files.error();
  BoardPhotographs all;
  for (const fs::path& file : *files) {
    BoardPhotograph photograph;
    photograph.name = file.filename().string();
    photograph.of_table = photograph.name.starts_with("table");
    read_header(file, photograph);
    all.photographs.push_back(std::move(photograph));
  }
  keep_one_camera(options.subject, all);
  const Result<void> read = for_each_frame(files->size(), context, [&](std::size_t i) -> Result<void> {
    if (!all.photographs[i].left_out.empty()) return {};
    return look_at((*files)[i], options, all.photographs[i]);
  });
  if (!read) return read.error();
  leave_out_the_softest(all.photographs);
  return all;
}

}  // namespace weft::app
