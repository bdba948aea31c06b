// SPDX-License-Identifier: Apache-2.0
#include "calibration/guide/printed_target.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "calibration/camera/boards.h"
#include "calibration/camera/markers.h"
#include "calibration/guide/owned_target.h"
#include "calibration/guide/photograph_set.h"
#include "calibration/run/board_photographs.h"
#include "calibration/run/chart_pictures.h"
#include "calibration/run/sheet_files.h"
#include "core/base/files.h"
#include "core/base/temporary_folder.h"
#include "core/image/image.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr double kPixels = 16;  // a millimetre

// The rectangles of a page, as a printer fills them; lines thinner than half a pixel are lost.
Image<std::uint8_t> printed(const std::string& pdf, double width_mm, double height_mm) {
  Image<std::uint8_t> picture({static_cast<int>(kPixels * width_mm), static_cast<int>(kPixels * height_mm)});
  for (int row = 0; row < picture.height(); ++row) {
    for (int column = 0; column < picture.width(); ++column) picture(column, row) = 255;
  }
  std::istringstream lines(pdf);
  for (std::string line; std::getline(lines, line);) {
    if (!line.ends_with(" re f")) continue;
    std::istringstream numbers(line);
    double x = 0, y = 0, width = 0, height = 0;
    numbers >> x >> y >> width >> height;
    const auto pixels = [](double points) {
      return static_cast<int>(std::lround(kPixels * points * 25.4 / 72));
    };
    for (int row = picture.height() - pixels(y + height); row < picture.height() - pixels(y); ++row) {
      for (int column = pixels(x); column < pixels(x + width); ++column) picture(column, row) = 0;
    }
  }
  return picture;
}

TargetRequest with_field(double width_mm, double height_mm) {
  TargetRequest request;
  request.field_width_mm = width_mm;
  request.field_height_mm = height_mm;
  return request;
}

class PrintedTargets : public testing::Test {
 protected:
  void print_one(TargetPart part) {
    TargetRequest request;
    request.part = part;
    const Result<PrintedTarget> target = print_target(request, std::nullopt);
    ASSERT_TRUE(target) << target.error().message();
    pdf_ = target->pdf;
    picture_ = printed(target->pdf, 297, 210);
    file_ = folder_.path() / (target->name + ".toml");
    ASSERT_TRUE(write_file(file_, target->toml));
  }

  TemporaryFolder folder_;
  fs::path file_;
  std::string pdf_;
  Image<std::uint8_t> picture_{{1, 1}};
};

TEST_F(PrintedTargets, IsABoardThatIsFoundByWhatIsWrittenOfIt) {
  print_one(TargetPart::kBoard);
  const Result<PrintedBoard> written = read_board_file(file_, {});
  ASSERT_TRUE(written) << written.error().message();
  const BoardSighting seen = find_board(picture_.plane(), written->board);
  EXPECT_EQ(seen.fault, BoardFault::kNone) << seen.why;
  ASSERT_EQ(seen.corners.size(), 54U);
  const BoardCorner &first = seen.corners.front(), &last = seen.corners.back();
  const double wide_px = std::hypot(last.px.x - first.px.x, last.px.y - first.px.y),
               wide_mm = std::hypot(last.u_mm - first.u_mm, last.v_mm - first.v_mm);
  EXPECT_NEAR(wide_px / kPixels, wide_mm, 0.05) << "at its true size";
}

TEST_F(PrintedTargets, IsASheetWhoseTagsLieWhereItIsWritten) {
  print_one(TargetPart::kSheet);
  const Result<TaggedSheet> written = read_sheet_file(file_);
  ASSERT_TRUE(written) << written.error().message();
  ASSERT_EQ(written->tags.size(), 8U);
  const auto seen = find_tags(picture_.plane(), "DICT_APRILTAG_36h11");
  ASSERT_TRUE(seen) << seen.error().message();
  std::map<int, PixelPoint> centres;
  for (const TagSighting& tag : *seen) {
    PixelPoint& centre = centres[tag.id];
    for (const PixelPoint& corner : tag.corners_px) centre.x += corner.x / 4, centre.y += corner.y / 4;
  }
  ASSERT_EQ(centres.size(), 8U);
  const SheetTag& first = written->tags.front();
  for (const SheetTag& tag : written->tags) {
    EXPECT_NEAR((centres[tag.id].x - centres[first.id].x) / kPixels, tag.centre_u_mm - first.centre_u_mm, 0.1)
        << tag.id;
    EXPECT_NEAR((centres[first.id].y - centres[tag.id].y) / kPixels, tag.centre_v_mm - first.centre_v_mm, 0.1)
        << tag.id;
  }
}

TEST_F(PrintedTargets, OfTheTableIsFourTags) {
  print_one(TargetPart::kTags);
  const auto seen = find_tags(picture_.plane(), "DICT_APRILTAG_36h11");
  ASSERT_TRUE(seen) << seen.error().message();
  EXPECT_EQ(seen->size(), 4U);
}

TEST_F(PrintedTargets, OfAChartTellsNoColourBeforeItIsMeasured) {
  print_one(TargetPart::kChart);
  std::size_t patches = 0;
  for (std::size_t at = pdf_.find(" re f Q"); at != std::string::npos; at = pdf_.find(" re f Q", at + 1))
    ++patches;
  EXPECT_EQ(patches, 24U);
  EXPECT_THAT(pdf_, HasSubstr("it tells no colour before somebody measured its patches"));
  // In as few pixels as a camera has for it.
  constexpr int kEach = 4;
  Image<float> rgb({picture_.width() / kEach, picture_.height() / kEach}, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < rgb.height(); ++y) {
      for (int x = 0; x < rgb.width(); ++x)
        rgb(x, y, c) = static_cast<float>(picture_(kEach * x + kEach / 2, kEach * y + kEach / 2)) / 255;
    }
  }
  const ChartColors published = {published_chart(), "as published", false},
                    measured = {published_chart(), "as measured", true};
  const Result<void> refused = check_measured(rgb, published, "chart.weft");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(refused.error().message(), HasSubstr("lab_d50"));
  EXPECT_TRUE(check_measured(rgb, measured, "chart.weft"));
  EXPECT_TRUE(check_measured(Image<float>({400, 300}, 3), published, "chart.weft")) << "no tag beside it";
}

TEST_F(PrintedTargets, OfABallHasTagsAboutItsOutline) {
  print_one(TargetPart::kBall);
  const auto seen = find_tags(picture_.plane(), "DICT_APRILTAG_36h11");
  ASSERT_TRUE(seen) << seen.error().message();
  ASSERT_EQ(seen->size(), 4U);
  double x_mm = 0, y_mm = 0;
  for (const TagSighting& tag : *seen) {
    for (const PixelPoint& corner : tag.corners_px)
      x_mm += corner.x / 16 / kPixels, y_mm += corner.y / 16 / kPixels;
  }
  // The first ring begins at its right.
  std::istringstream lines(pdf_);
  double right_mm = 0, middle_mm = 0, points = 0;
  std::string word;
  for (std::string line; right_mm == 0 && std::getline(lines, line);) {
    std::istringstream numbers(line);
    if (line.ends_with(" m") && numbers >> points >> word >> right_mm >> middle_mm)
      right_mm *= 25.4 / 72, middle_mm *= 25.4 / 72;
  }
  EXPECT_NEAR(right_mm - x_mm, 20, 0.1) << "the radius of a ball of 40 mm";
  EXPECT_NEAR(middle_mm, 210 - y_mm, 0.1);
  EXPECT_THAT(read_text(file_).value(), HasSubstr("diameter_mm = 40\ncentre_mm = [0, 0, 20]"));
}

// What was printed once and what was printed for another rig lie in one drawer.
TEST_F(PrintedTargets, IsToldFromOthersByItsMarkers) {
  capture::Rig rig;
  rig.file = folder_.path() / "rig.toml";
  const auto print_of = [&](TargetPart part, double width_mm, double height_mm) {
    TargetRequest request = with_field(width_mm, height_mm);
    request.part = part;
    const Result<PrintedTarget> target = print_for_rig(request, rig);
    EXPECT_TRUE(target) << target.error().message();
    return printed(target->pdf, 297, 210);
  };
  struct Case {
    Image<std::uint8_t> picture;
    std::string says;
  };
  std::vector<Case> cases;
  cases.push_back({print_of(TargetPart::kBoard, 150, 105), "a board of 10 x 7 squares of 9 mm"});
  cases.push_back({print_of(TargetPart::kBoard, 250, 175), "a board of 10 x 7 squares of 15 mm"});
  cases.push_back({print_of(TargetPart::kSheet, 200, 133), "a white sheet of 168 x 111.5 mm"});
  cases.push_back({print_of(TargetPart::kSheet, 240, 160), "a white sheet of 201.5 x 134 mm"});
  const std::vector<OwnedTarget> owned = owned_targets(folder_.path());
  ASSERT_EQ(owned.size(), 4U);
  for (const Case& each : cases) {
    const OwnedTarget* there = target_in(each.picture.plane(), owned);
    ASSERT_NE(there, nullptr) << each.says;
    EXPECT_EQ(there->says, each.says);
  }
  const Image<std::uint8_t> tags = print_of(TargetPart::kTags, 200, 133);
  EXPECT_EQ(target_in(tags.plane(), owned), nullptr) << "they lie on every table";
}

TEST_F(PrintedTargets, FitsItsPaperOrSaysWhichWould) {
  const Result<PrintedTarget> refused = print_target(with_field(700, 500), std::nullopt);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().kind, ErrorKind::kUsage);
  EXPECT_THAT(refused.error().message(), HasSubstr("--paper a3"));
  EXPECT_TRUE(print_target(with_field(60, 40), std::nullopt));
}

TEST_F(PrintedTargets, OfARigIsKnownToItsSets) {
  capture::Rig rig;
  rig.file = folder_.path() / "rig.toml";
  ASSERT_TRUE(write_file(rig.file, "name = \"north\"\n"));
  TargetRequest sheet;
  sheet.part = TargetPart::kSheet;
  ASSERT_TRUE(print_for_rig(sheet, rig));
  EXPECT_TRUE(is_there(pdf_of_target(rig, "sheet")));
  const fs::path targets = folder_.path() / "targets";
  ASSERT_TRUE(print_for_rig(sheet, rig));
  EXPECT_FALSE(is_there(targets / "sheet.before-1.toml")) << "it is the same";
  ASSERT_TRUE(write_file(targets / "sheet.toml", "# measured by hand\n"));
  ASSERT_TRUE(print_for_rig(sheet, rig));
  EXPECT_EQ(read_text(targets / "sheet.before-1.toml").value(), "# measured by hand\n");
  EXPECT_THAT(newest_description(folder_.path() / "sets", SetPart::kMoved), HasSubstr("[[tag]]"));
  EXPECT_EQ(newest_description(folder_.path() / "sets", SetPart::kBoard), "");
}

}  // namespace
}  // namespace weft::calibration
