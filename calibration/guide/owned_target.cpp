// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/owned_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "calibration/camera/markers.h"
#include "calibration/run/tag_cards.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/rig/session.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

constexpr int kLeastOfBoard = 4, kLeastOfSheet = 2;

/// Tags of each dictionary, found once.
class SeenTags {
 public:
  explicit SeenTags(View<const std::uint8_t> grey) : grey_(grey) {}

  const std::vector<TagSighting>& of(const std::string& dictionary) {
    const auto [found, is_new] = found_.try_emplace(dictionary);
    if (is_new) {
      if (auto tags = find_tags(grey_, dictionary)) found->second = std::move(*tags);
    }
    return found->second;
  }

 private:
  View<const std::uint8_t> grey_;
  std::map<std::string, std::vector<TagSighting>> found_;
};

int markers_of(const OwnedTarget& target, SeenTags& seen) {
  if (target.sheet) {
    return static_cast<int>(std::ranges::count_if(target.sheet->tags, [&](const SheetTag& tag) {
      const std::vector<TagSighting>& found = seen.of(tag.dictionary);
      return std::ranges::find(found, tag.id, &TagSighting::id) != found.end();
    }));
  }
  const Board& board = target.board->board;
  if (board.kind != BoardKind::kCharuco) return 0;
  return static_cast<int>(std::ranges::count_if(seen.of(board.dictionary), [&](const TagSighting& tag) {
    return tag.id >= board.first_marker && tag.id < board.first_marker + board.markers();
  }));
}

/// The raw photograph of this name, whatever it ends with.
Result<Image<std::uint8_t>> grey_of_photograph(const fs::path& folder, const std::string& stem) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (entry.path().stem() != stem) continue;
    const Result<RawFrame> frame = capture::decode_raw(entry.path());
    return frame ? Result<Image<std::uint8_t>>(grey_picture(*frame)) : frame.error();
  }
  return Error{ErrorKind::kNoInput, "there is no such photograph", (folder / stem).string(), "",
               "take it again"};
}

}  // namespace

std::optional<OwnedTarget> read_target(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return std::nullopt;
  const std::string name = file.filename().string();
  if (name.starts_with("board")) {
    const Result<PrintedBoard> board = read_board_file(file, {});
    if (!board) return std::nullopt;
    const Board& b = board->board;
    return OwnedTarget{
        fmt::format("a board of {} x {} squares of {} mm", b.squares_x, b.squares_y, b.square_mm),
        *text,
        *board,
        {}};
  }
  if (!name.starts_with("sheet")) return std::nullopt;
  const Result<TaggedSheet> sheet = read_sheet_file(file);
  if (!sheet) return std::nullopt;
  return OwnedTarget{
      fmt::format("a white sheet of {} x {} mm", sheet->sheet.width_mm, sheet->sheet.height_mm),
      *text,
      {},
      *sheet};
}

std::vector<OwnedTarget> owned_targets(const fs::path& rig_folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(rig_folder / kTargetsFolder, ignored)) {
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<OwnedTarget> targets;
  for (const fs::path& file : files) {
    if (auto target = read_target(file)) targets.push_back(std::move(*target));
  }
  return targets;
}

const OwnedTarget* target_in(View<const std::uint8_t> grey, std::span<const OwnedTarget> targets) {
  SeenTags seen(grey);
  const OwnedTarget* best = nullptr;
  int most = 0;
  for (const OwnedTarget& target : targets) {
    const int markers = markers_of(target, seen);
    if (markers < (target.board ? kLeastOfBoard : kLeastOfSheet) || markers <= most) continue;
    best = &target;
    most = markers;
  }
  return best;
}

Result<Image<std::uint8_t>> grey_of_session(const fs::path& folder) {
  const Result<Session> session = read_session(folder);
  if (!session) return session.error();
  const auto lit = std::ranges::find_if(
      session->shots, [](const Shot& shot) { return shot.role == ShotRole::kLit && !shot.superseded_by; });
  if (lit == session->shots.end() || session->state != "complete") {
    return Error{ErrorKind::kBadData, "the scan is not finished", folder.string(), "", "scan it once more"};
  }
  const Result<RawFrame> frame = capture::decode_raw(session->path_of(*lit));
  return frame ? Result<Image<std::uint8_t>>(grey_picture(*frame)) : frame.error();
}

Result<bool> adopt_target(const PhotographSet& set, const std::string& step) {
  const bool is_board = set.part == SetPart::kBoard;
  if (!is_board && !set.is_of_sheets()) return false;
  const fs::path description = is_board ? set.board_file() : set.sheet_file();
  std::vector<OwnedTarget> targets;
  if (auto described = read_target(description)) targets.push_back(std::move(*described));
  for (OwnedTarget& owned : owned_targets(set.folder.parent_path().parent_path())) {
    if (owned.board.has_value() == is_board) targets.push_back(std::move(owned));
  }
  // What cannot be looked at is judged by whoever judges photographs.
  const auto grey = is_board ? grey_of_photograph(set.folder, step) : grey_of_session(set.folder / step);
  if (!grey) return false;
  const OwnedTarget* seen = target_in(grey->plane(), targets);
  if (seen == nullptr || seen->text == targets.front().text) return false;
  const Result<void> written = write_file(description, seen->text);
  return written ? Result<bool>(true) : written.error();
}

}  // namespace weft::calibration
