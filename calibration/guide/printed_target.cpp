// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/printed_target.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "calibration/camera/marker_squares.h"
#include "calibration/color/chart_reference.h"
#include "calibration/run/chart_pictures.h"
#include "core/base/files.h"
#include "core/image/color_spaces.h"
#include "core/rig/calibration.h"
#include "core/rig/camera.h"
#include "report/pdf_page.h"

namespace weft::calibration {
namespace {

using report::PdfPage;

constexpr std::array<double, 2> kUsualField_mm = {200, 133};
constexpr double kPrinterBorder_mm = 6, kFoot_mm = 14, kLetters_mm = 2.2;
constexpr double kMarkerShare = 0.75;
constexpr const char* kBoardDictionary = "DICT_5X5_1000";
constexpr const char* kTagDictionary = "DICT_APRILTAG_36h11";
constexpr int kBoardColumns = 10, kBoardRows = 7;
constexpr double kBoardOfField = 0.6;   // a board is laid in many places of the frame
constexpr double kSheetOfField = 0.84;  // its tags stay in sight where it is tilted and turned
constexpr int kFirstSheetTag = 20;      // the table's own are from 0 on
constexpr int kSheetTags = 8, kSheetCodes = 69, kBoardCodes = 28;
constexpr int kFirstBallTag = 576;

// Landscape.
std::array<double, 2> size_of(PaperSize paper) {
  constexpr std::array<std::array<double, 2>, 3> kSizes = {{{297, 210}, {420, 297}, {279.4, 215.9}}};
  return kSizes[static_cast<std::size_t>(paper)];
}

double whole_half(double mm) {
  return std::floor(2 * mm) / 2;
}

int halves(double mm) {
  return static_cast<int>(std::lround(2 * mm));
}

/// Where the markers of a target begin, by its size: a photograph tells which one lies there.
int first_marker_of_board(double square_mm) {
  return halves(square_mm) % kBoardCodes * (kBoardColumns * kBoardRows / 2);
}
int first_tag_of_sheet(double width_mm, double height_mm) {
  return kFirstSheetTag + (7 * halves(width_mm) + halves(height_mm)) % kSheetCodes * kSheetTags;
}

// With its lower left corner at (x, y).
Result<void> add_marker(PdfPage& page, const char* dictionary, int id, double x_mm, double y_mm,
                        double side_mm) {
  const Result<std::vector<std::vector<bool>>> rows = marker_squares(dictionary, id);
  if (!rows) return rows.error();
  const auto count = static_cast<double>(rows->size());
  const double square_mm = side_mm / count;
  for (std::size_t row = 0; row < rows->size(); ++row) {
    const std::vector<bool>& squares = (*rows)[row];
    const double bottom_mm = y_mm + side_mm - static_cast<double>(row + 1) * square_mm;
    for (std::size_t first = 0; first < squares.size();) {
      const auto end = static_cast<std::size_t>(
          std::find(squares.begin() + static_cast<std::ptrdiff_t>(first), squares.end(), !squares[first]) -
          squares.begin());
      if (squares[first])
        page.fill(x_mm + static_cast<double>(first) * square_mm, bottom_mm,
                  static_cast<double>(end - first) * square_mm, square_mm);
      first = end;
    }
  }
  return {};
}

// A bar by which the printer is checked, and what the page is.
void add_foot(PdfPage& page, const std::string& says) {
  constexpr double kBar_mm = 100, kHigh_mm = 1.2;
  const double x_mm = page.width_mm() - kPrinterBorder_mm - kBar_mm - 4, y_mm = kPrinterBorder_mm + 2;
  page.fill(x_mm, y_mm, kBar_mm, 0.3);
  for (const double at_mm : {0.0, kBar_mm - 0.3}) page.fill(x_mm + at_mm, y_mm, 0.3, kHigh_mm);
  page.write(x_mm, y_mm + 2, kLetters_mm,
             "from end to end 100 mm: measure it, and print at 100 percent if it is not");
  page.write(kPrinterBorder_mm + 4, y_mm, kLetters_mm, says);
}

Error too_large(const char* what, double width_mm, double height_mm, PaperSize paper) {
  return {ErrorKind::kUsage, "the target does not fit the paper", what,
          fmt::format("it is {:.0f} x {:.0f} mm with its border, and the paper is {}", width_mm, height_mm,
                      kPaperNames[static_cast<std::size_t>(paper)]),
          "take larger paper (--paper a3), or say a smaller field (--field-width, --field-height)"};
}

// Room for something above the foot, its lower left corner where it lies in the middle.
Result<std::array<double, 2>> placed(const PdfPage& page, const char* what, double width_mm, double height_mm,
                                     PaperSize paper) {
  const double x_mm = (page.width_mm() - width_mm) / 2, y_mm = (page.height_mm() + kFoot_mm - height_mm) / 2;
  if (x_mm < kPrinterBorder_mm || page.height_mm() - y_mm - height_mm < kPrinterBorder_mm)
    return too_large(what, width_mm + 2 * kPrinterBorder_mm, height_mm + 2 * kPrinterBorder_mm + kFoot_mm,
                     paper);
  return std::array{x_mm, y_mm};
}

Result<PrintedTarget> board(const TargetRequest& request, std::array<double, 2> field_mm) {
  const double square_mm = std::max(
      whole_half(kBoardOfField * std::min(field_mm[0] / kBoardColumns, field_mm[1] / kBoardRows)), 1.0);
  const double width_mm = kBoardColumns * square_mm, height_mm = kBoardRows * square_mm;
  const auto [page_width, page_height] = size_of(request.paper);
  PdfPage page(page_width, page_height);
  const Result<std::array<double, 2>> at = placed(page, "board", width_mm, height_mm, request.paper);
  if (!at) return at.error();
  const int first_marker = first_marker_of_board(square_mm);
  int id = first_marker;
  for (int row = 0; row < kBoardRows; ++row) {
    for (int column = 0; column < kBoardColumns; ++column) {
      const double x_mm = (*at)[0] + column * square_mm, y_mm = (*at)[1] + height_mm - (row + 1) * square_mm;
      if ((row + column) % 2 == 0) {
        page.fill(x_mm, y_mm, square_mm, square_mm);
        continue;
      }
      const double border_mm = (1 - kMarkerShare) / 2 * square_mm;
      if (Result<void> ok = add_marker(page, kBoardDictionary, id++, x_mm + border_mm, y_mm + border_mm,
                                       kMarkerShare * square_mm);
          !ok)
        return std::move(ok).error();
    }
  }
  PrintedTarget target;
  target.says = fmt::format("a ChArUco board of {} x {} squares of {} mm, {} x {} mm", kBoardColumns,
                            kBoardRows, square_mm, width_mm, height_mm);
  target.remedy =
      "glue it to glass or aluminium: what bends is no board; measure ten squares and mend square_mm";
  target.toml = fmt::format(
      "# {}.\nkind = \"charuco\"\nsquares_x = {}\nsquares_y = {}\nsquare_mm = {}\nmarker_share = {}\n"
      "dictionary = \"{}\"\nfirst_marker = {}\n",
      target.says, kBoardColumns, kBoardRows, square_mm, kMarkerShare, kBoardDictionary, first_marker);
  add_foot(page, "weft: " + target.says);
  target.pdf = page.bytes();
  return target;
}

Result<PrintedTarget> sheet(const TargetRequest& request, std::array<double, 2> field_mm) {
  const double width_mm = whole_half(kSheetOfField * field_mm[0]),
               height_mm = whole_half(kSheetOfField * field_mm[1]);
  const double tag_mm = std::max(whole_half(0.06 * field_mm[1]), 4.0), quiet_mm = tag_mm / 4;
  const auto [page_width, page_height] = size_of(request.paper);
  PdfPage page(page_width, page_height);
  const Result<std::array<double, 2>> at = placed(page, "sheet", width_mm, height_mm, request.paper);
  if (!at) return at.error();
  PrintedTarget target;
  int id = first_tag_of_sheet(width_mm, height_mm);
  target.says = fmt::format("a white sheet of {} x {} mm with tags {} to {}", width_mm, height_mm, id,
                            id + kSheetTags - 1);
  target.remedy =
      "print it on matt paper without brightener, cut it along the corners, lay it flat; "
      "say its reflectance in sheet.toml where it was measured";
  target.toml =
      fmt::format("# {}.\nwidth_mm = {}\nheight_mm = {}\nmargin_mm = 2\n", target.says, width_mm, height_mm);
  const double u_mm = width_mm / 2 - tag_mm / 2 - quiet_mm - 2,
               v_mm = height_mm / 2 - tag_mm / 2 - quiet_mm - 2;
  for (const double v : {v_mm, 0.0, -v_mm}) {
    for (const double u : {-u_mm, 0.0, u_mm}) {
      if (u == 0 && v == 0) continue;
      const double x_mm = (*at)[0] + width_mm / 2 + u - tag_mm / 2,
                   y_mm = (*at)[1] + height_mm / 2 + v - tag_mm / 2;
      if (Result<void> ok = add_marker(page, kTagDictionary, id, x_mm, y_mm, tag_mm); !ok)
        return std::move(ok).error();
      target.toml +=
          fmt::format("\n[[tag]]\nid = {}\nside_mm = {}\ncentre_mm = [{}, {}]\n", id++, tag_mm, u, v);
    }
  }
  // Where to cut: beyond the sheet, which stays white.
  constexpr double kCut_mm = 3, kLine_mm = 0.15;
  for (const double x_mm : {(*at)[0], (*at)[0] + width_mm}) {
    page.fill(x_mm, (*at)[1] - kCut_mm, kLine_mm, kCut_mm);
    page.fill(x_mm, (*at)[1] + height_mm, kLine_mm, kCut_mm);
  }
  add_foot(page, "weft: " + target.says);
  target.pdf = page.bytes();
  return target;
}

/// Four tags, `u_mm` and `v_mm` from a middle; `toml`, which may be null, says where.
Result<void> add_corner_tags(PdfPage& page, std::array<double, 2> middle_mm, int id, double u_mm, double v_mm,
                             double tag_mm, std::string* toml) {
  for (const double v : {v_mm, -v_mm}) {
    for (const double u : {-u_mm, u_mm}) {
      if (Result<void> ok = add_marker(page, kTagDictionary, id, middle_mm[0] + u - tag_mm / 2,
                                       middle_mm[1] + v - tag_mm / 2, tag_mm);
          !ok)
        return ok;
      if (toml != nullptr)
        *toml += fmt::format("\n[[tag]]\nid = {}\nside_mm = {}\ncentre_mm = [{}, {}]\n", id, tag_mm, u, v);
      ++id;
    }
  }
  return {};
}

Result<PrintedTarget> chart(const TargetRequest& request, std::array<double, 2> field_mm) {
  const double patch_mm = std::max(whole_half(0.12 * field_mm[1]), 5.0), gap_mm = patch_mm / 8,
               tag_mm = std::max(whole_half(0.06 * field_mm[1]), 4.0), beside_mm = 1.5 * tag_mm;
  const double width_mm = kChartColumns * (patch_mm + gap_mm) + gap_mm,
               height_mm = kChartRows * (patch_mm + gap_mm) + gap_mm;
  const auto [page_width, page_height] = size_of(request.paper);
  PdfPage page(page_width, page_height);
  const Result<std::array<double, 2>> at =
      placed(page, "chart", width_mm + 2 * beside_mm, height_mm, request.paper);
  if (!at) return at.error();
  const double left_mm = (*at)[0] + beside_mm, bottom_mm = (*at)[1];
  page.fill(left_mm, bottom_mm, width_mm, height_mm);
  const ChartReference colors = published_chart();
  for (int patch = 0; patch < kChartPatches; ++patch) {
    const int column = patch % kChartColumns, row = patch / kChartColumns;
    page.fill(left_mm + gap_mm + column * (patch_mm + gap_mm),
              bottom_mm + height_mm - (row + 1) * (patch_mm + gap_mm), patch_mm, patch_mm,
              srgb_of_rec709(colors[static_cast<std::size_t>(patch)]));
  }
  const Result<void> tagged =
      add_corner_tags(page, {left_mm + width_mm / 2, bottom_mm + height_mm / 2}, kPrintedChartTag,
                      width_mm / 2 + beside_mm / 2, height_mm / 2 - tag_mm / 2, tag_mm, nullptr);
  if (!tagged) return tagged.error();
  PrintedTarget target;
  target.says = fmt::format("a chart of 24 patches, whose colours are the printer's, with tags {} to {}",
                            kPrintedChartTag, kPrintedChartTag + kPrintedChartTags - 1);
  target.remedy =
      "print it on matt paper; it serves series of exposures (weft capture response) as it is, and colour "
      "only "
      "by a chart.toml with lab_d50 of its patches as you measured them";
  add_foot(page, "weft: " + target.says);
  page.write(kPrinterBorder_mm + 4, kPrinterBorder_mm + 6, kLetters_mm,
             "for series of exposures; it tells no colour before somebody measured its patches");
  target.pdf = page.bytes();
  return target;
}

Result<PrintedTarget> ball(const TargetRequest& request, std::array<double, 2> field_mm) {
  constexpr double kLine_mm = 0.3, kWasher = 0.5, kApart = 1.1;
  const double radius_mm = request.ball_mm / 2, tag_mm = std::max(whole_half(0.07 * field_mm[1]), 4.0);
  const double out_mm = kApart * radius_mm + tag_mm, side_mm = 2 * out_mm + 1.5 * tag_mm;
  const auto [page_width, page_height] = size_of(request.paper);
  PdfPage page(page_width, page_height);
  const Result<std::array<double, 2>> at = placed(page, "ball", side_mm, side_mm, request.paper);
  if (!at) return at.error();
  const std::array middle_mm = {(*at)[0] + side_mm / 2, (*at)[1] + side_mm / 2};
  page.ring(middle_mm[0], middle_mm[1], radius_mm, kLine_mm);
  page.ring(middle_mm[0], middle_mm[1], kWasher * radius_mm, kLine_mm);
  PrintedTarget target;
  // Thinner than this, a washer does not lift the ball from the page.
  const double thin_mm = radius_mm * (1 - std::sqrt(1 - kWasher * kWasher));
  target.says = fmt::format("a stand for a mirror ball of {} mm with tags {} to {}", request.ball_mm,
                            kFirstBallTag, kFirstBallTag + 3);
  target.remedy = fmt::format(
      "glue a washer with a hole of {} mm, at most {:.1f} mm thick, on the inner ring and lay the ball into "
      "it; "
      "its centre is {} mm above the middle of the tags, for whatever reads light directions from its "
      "highlight",
      kWasher * request.ball_mm, thin_mm, radius_mm);
  target.toml = fmt::format("# {}.\ndiameter_mm = {}\ncentre_mm = [0, 0, {}]\n", target.says, request.ball_mm,
                            radius_mm);
  if (const Result<void> tagged =
          add_corner_tags(page, middle_mm, kFirstBallTag, out_mm, out_mm, tag_mm, &target.toml);
      !tagged)
    return tagged.error();
  add_foot(page, "weft: " + target.says);
  target.pdf = page.bytes();
  return target;
}

Result<PrintedTarget> tags(const TargetRequest& request, std::array<double, 2> field_mm) {
  constexpr double kGap_mm = 20, kLine_mm = 0.15;
  const double tag_mm = std::max(whole_half(0.07 * field_mm[1]), 4.0), quiet_mm = kCardQuiet * tag_mm,
               white_mm = kCardWhite * tag_mm, card_mm = tag_mm + 2 * quiet_mm, wide_mm = card_mm + white_mm;
  const auto [page_width, page_height] = size_of(request.paper);
  PdfPage page(page_width, page_height);
  const Result<std::array<double, 2>> at =
      placed(page, "tags", 2 * wide_mm + kGap_mm, 2 * card_mm + kGap_mm, request.paper);
  if (!at) return at.error();
  PrintedTarget target;
  target.says =
      fmt::format("four cards for the corners of the table: tags 0 to 3 of {} mm, white beside each", tag_mm);
  target.remedy =
      "cut them out, glue them into the corners of the picture, the white towards its middle, and calibrate "
      "with them in sight";
  target.toml = fmt::format("# {}.\n", target.says);
  for (int id = 0; id < 4; ++id) {
    const double x_mm = (*at)[0] + (id % 2) * (wide_mm + kGap_mm),
                 y_mm = (*at)[1] + (1 - id / 2) * (card_mm + kGap_mm);
    const double tag_x_mm = x_mm + quiet_mm + (id % 2 == 0 ? 0 : white_mm);
    if (Result<void> ok = add_marker(page, kTagDictionary, id, tag_x_mm, y_mm + quiet_mm, tag_mm); !ok)
      return std::move(ok).error();
    page.fill(x_mm, y_mm, wide_mm, kLine_mm);
    page.fill(x_mm, y_mm + card_mm, wide_mm, kLine_mm);
    page.fill(x_mm, y_mm, kLine_mm, card_mm);
    page.fill(x_mm + wide_mm, y_mm, kLine_mm, card_mm);
    target.toml +=
        fmt::format("\n[[tag]]\nid = {}\nside_mm = {}\ndictionary = \"{}\"\n", id, tag_mm, kTagDictionary);
  }
  add_foot(page, "weft: " + target.says);
  target.pdf = page.bytes();
  return target;
}

}  // namespace

void describe(Fields& fields, TargetRequest& r) {
  fields.choice(
      {.name = "target",
       .says = "What to print: board of the lens, sheet of the lights, tags of the table, chart for series "
               "of exposures, stand for a mirror ball",
       .need = kMustSay,
       .option = ""},
      r.part, kTargetNames);
  fields.choice({"paper", "To print on, landscape"}, r.paper, kPaperNames);
  fields.value({"field_width_mm",
                "What the camera sees of the table, mm; default by the rig's calibration, else 200",
                {20, 2000}},
               r.field_width_mm);
  fields.value({"field_height_mm", "The same; default by the rig's calibration, else 133", {20, 2000}},
               r.field_height_mm);
  fields.value({"ball_mm", "Diameter of the ball, mm", {5, 200}}, r.ball_mm);
}

std::optional<std::array<double, 2>> field_of(const std::filesystem::path& folder) {
  if (folder.empty()) return std::nullopt;
  const Result<Calibration> calibration = read_calibration(folder);
  if (!calibration || !calibration->camera) return std::nullopt;
  const CameraModel& camera = *calibration->camera;
  const double right = camera.size.width - 1, bottom = camera.size.height - 1;
  const auto across = [&](double x0, double y0, double x1, double y1) {
    return length(point_on_plane(camera, x1, y1, 0) - point_on_plane(camera, x0, y0, 0));
  };
  return std::array{across(0, bottom / 2, right, bottom / 2), across(right / 2, 0, right / 2, bottom)};
}

Result<PrintedTarget> print_target(const TargetRequest& request,
                                   const std::optional<std::array<double, 2>>& known_mm) {
  const std::array<double, 2> known = known_mm.value_or(kUsualField_mm);
  const std::array field_mm = {request.field_width_mm.value_or(known[0]),
                               request.field_height_mm.value_or(known[1])};
  constexpr std::array kPrint = {&board, &sheet, &tags, &chart, &ball};
  const auto part = static_cast<std::size_t>(request.part);
  Result<PrintedTarget> target = kPrint[part](request, field_mm);
  if (target) target->name = kTargetNames[part];
  return target;
}

std::filesystem::path pdf_of_target(const capture::Rig& rig, const std::string& name) {
  return rig.folder() / kTargetsFolder / (name + ".pdf");
}

namespace {

// What was written of another target, perhaps measured by hand, stays beside the new one.
Result<void> set_aside(const std::filesystem::path& file, const std::string& text) {
  if (!is_there(file)) return {};
  if (const Result<std::string> before = read_text(file); before && *before == text) return {};
  std::filesystem::path aside = file;
  for (int n = 1; is_there(aside); ++n)
    aside.replace_filename(fmt::format("{}.before-{}.toml", file.stem().string(), n));
  std::error_code failed;
  std::filesystem::rename(file, aside, failed);
  return failed ? Result<void>(cannot_write(aside, failed.value())) : Result<void>();
}

}  // namespace

Result<PrintedTarget> print_for_rig(const TargetRequest& request, const capture::Rig& rig) {
  Result<PrintedTarget> target = print_target(request, field_of(capture::calibration_now(rig)));
  if (!target) return target;
  const std::filesystem::path pdf = pdf_of_target(rig, target->name);
  const std::filesystem::path toml = pdf.parent_path() / (target->name + ".toml");
  Result<void> written = make_writable_folder(pdf.parent_path());
  const bool is_described = !target->toml.empty();
  if (written && is_described) written = set_aside(toml, target->toml);
  if (written) written = write_file(pdf, target->pdf);
  if (written && is_described) written = write_file(toml, target->toml);
  if (!written) return std::move(written).error();
  return target;
}

}  // namespace weft::calibration
