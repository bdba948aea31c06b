// SPDX-License-Identifier: Apache-2.0
// The whole rig as its hosts meet it: the board through libserialport, the camera through libgphoto2.
#include "virtual_rig/virtual_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "capture/board/led_board.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "tests/virtual_rig/ptp/client_process.h"
#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/small_scene.h"
#include "virtual_rig/control_socket.h"
#include "virtual_rig/terminal/modem_lines.h"
#include "virtual_rig/terminal/port_name.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class Rigged : public testing::Test {
 protected:
  void start(bool usb = false, bool same_noise = false) {
    VirtualRigOptions options;
    options.scene = small_scene();
    options.folder = fresh_folder() / "rig";
    options.cache = options.folder.parent_path() / "cache";
    options.firmware = WEFT_FIRMWARE;
    options.bootloader_s = 0.02;
    options.usb = usb;
    options.same_noise = same_noise;
    folder_ = options.folder;
    Result<std::unique_ptr<VirtualRig>> rig = VirtualRig::start(options);
    ASSERT_TRUE(rig) << rig.error().message();
    rig_ = std::move(*rig);
    setenv(kModemVariable, (folder_ / "modem").c_str(), 1);
  }
  void TearDown() override {
    camera_.reset();
    board_.reset();
    unsetenv(kModemVariable);
  }

  Json status() const { return Json::parse(rig_->command("status").value()); }

  void light(std::vector<int> leds) {
    if (!board_) {
      auto board = capture::LedBoard::open({terminal_port_name(folder_ / "board"), 4});
      ASSERT_TRUE(board) << board.error().message();
      board_ = std::move(*board);
    }
    const Result<double> lit = board_->light(leds, 20);
    ASSERT_TRUE(lit) << lit.error().message();
  }

  std::string camera_port() const {
    const std::string port = std::to_string(status().at("port").get<int>());
    return "ptpip:127.0.0.1:" + port + ":" + port;
  }

  /// One photograph, a sixtieth of a second.
  Image<std::uint16_t> photograph() {
    if (!camera_) {
      camera_ = std::make_unique<GphotoClient>(camera_port());
      EXPECT_GE(camera_->init(), 0);
      EXPECT_GE(camera_->set("capturetarget", "Internal RAM"), 0);
      EXPECT_GE(camera_->set("shutterspeed2", "1/60"), 0);
    }
    const GphotoClient::Shot shot = camera_->shoot(20);
    EXPECT_TRUE(shot.whole());
    std::ofstream(folder_.parent_path() / "shot.dng", std::ios::binary)
        .write(reinterpret_cast<const char*>(shot.file.bytes.data()),
               static_cast<std::streamsize>(shot.file.bytes.size()));
    return decoded("shot.dng");
  }

  Image<std::uint16_t> decoded(const std::string& name) const {
    Result<RawFrame> frame = capture::decode_raw(folder_.parent_path() / name);
    EXPECT_TRUE(frame) << frame.error().message();
    return frame ? std::move(frame->counts) : Image<std::uint16_t>();
  }

  /// Sum of the counts over what a LED's own picture has, weighted by it: 1 where the picture is of it alone.
  double likeness(const Image<std::uint16_t>& counts, int led) const {
    double both = 0, own = 0, taken = 0;
    const View<const float> plane = rig_->frames().led(led);
    for (int y = 0; y < counts.height(); ++y) {
      for (int x = 0; x < counts.width(); ++x) {
        const double wanted = static_cast<double>(plane(x, y)), count = counts(x, y);
        both += wanted * count;
        own += wanted * wanted;
        taken += count * count;
      }
    }
    return both / std::sqrt(own * taken);
  }

  fs::path folder_;
  std::unique_ptr<VirtualRig> rig_;
  std::unique_ptr<capture::LedBoard> board_;
  std::unique_ptr<GphotoClient> camera_;
};

TEST_F(Rigged, PhotographsTheLedThatTheFirmwareLights) {
  start();
  light({3});
  EXPECT_EQ(status().at("pins"), Json({3}));
  const Image<std::uint16_t> counts = photograph();
  ASSERT_EQ(counts.size(), (Size{128, 96}));
  for (int led = 1; led <= 3; ++led) {
    EXPECT_EQ(likeness(counts, led) > 0.999, led == 3) << "LED " << led << ": " << likeness(counts, led);
  }
  light({});
  EXPECT_LT(likeness(photograph(), 3), 0.9) << "in the dark there is only noise";
  EXPECT_EQ(status().at("shots"), 2);
}

TEST_F(Rigged, IsPhotographedByTheStockGphoto2Program) {
  start();
  light({2});
  const ProgramRun run =
      run_program({"/usr/bin/gphoto2", "--port", camera_port(), "--camera", "PTP/IP Camera", "--set-config",
                   "capturetarget=0", "--set-config", "shutterspeed2=1/60", "--capture-image-and-download",
                   "--filename", "stock.dng", "--force-overwrite"},
                  {"HOME=" + (folder_ / "home").string(), "LC_ALL=C"}, folder_.parent_path().string(), 30);
  EXPECT_EQ(run.exit_code, 0) << run.output;
  EXPECT_GT(likeness(decoded("stock.dng"), 2), 0.999);
}

TEST_F(Rigged, WritesDownWhatEachExposureWas) {
  start();
  light({2});
  static_cast<void>(photograph());
  const Result<std::string> log = read_text(folder_ / "exposures.jsonl");
  ASSERT_TRUE(log) << log.error().message();
  const Json line = Json::parse(*log);
  EXPECT_EQ(line.at("pin_shares"), Json({0.0, 1.0, 0.0}));
  EXPECT_EQ(line.at("light_s").at(1).get<double>(), line.at("exposure_us").get<double>() * 1e-6);
  EXPECT_GT(line.at("image_number").get<int>(), 0);
}

TEST_F(Rigged, ShowsAStuckLedAndForgetsIt) {
  start();
  EXPECT_EQ(send_command(folder_ / "control", "light stuck 1").value(), "ok");
  light({});
  EXPECT_GT(likeness(photograph(), 1), 0.999);
  EXPECT_EQ(send_command(folder_ / "control", "light normal").value(), "ok");
  EXPECT_LT(likeness(photograph(), 1), 0.9);
}

TEST_F(Rigged, TakesTheSamePictureAgainWhereItIsAskedTo) {
  start(false, true);
  light({2});
  const Image<std::uint16_t> first = photograph();
  const Image<std::uint16_t> again = photograph();
  ASSERT_EQ(first.size(), again.size());
  for (int y = 0; y < first.height(); ++y) {
    ASSERT_TRUE(std::equal(first.plane().row(y), first.plane().row(y) + first.width(), again.plane().row(y)))
        << "row " << y;
  }
}

TEST_F(Rigged, ForwardsFaultsOfBoardAndCamera) {
  start();
  light({1});
  EXPECT_EQ(rig_->command("board unplug").value(), "ok");
  EXPECT_FALSE(fs::exists(folder_ / "board")) << "the cable is out";
  EXPECT_EQ(status().at("pins"), Json::array());
  EXPECT_EQ(rig_->command("board replug").value(), "ok");
  EXPECT_TRUE(fs::exists(folder_ / "board"));
  EXPECT_EQ(rig_->command("camera drop_in_exposure 2").value(), "ok");
}

TEST_F(Rigged, RefusesCommandsThatItDoesNotKnow) {
  start();
  for (const char* line :
       {"", "board", "board explode", "camera", "camera explode", "camera drop_in_exposure 0",
        "camera drop_in_exposure two", "light", "light dead 9", "stops 1 2", "stops 1 2 70000", "stops 1 2 x",
        "status now", "sing"}) {
    const Result<std::string> answer = rig_->command(line);
    ASSERT_FALSE(answer) << line;
    EXPECT_EQ(answer.error().kind, ErrorKind::kUsage) << line;
  }
  EXPECT_THAT(send_command(folder_ / "control", "board explode").value(), testing::StartsWith("error: "));
}

TEST_F(Rigged, TellsItsHostWhenItIsToEnd) {
  start();
  pollfd waiting = {rig_->end_descriptor(), POLLIN, 0};
  EXPECT_EQ(::poll(&waiting, 1, 0), 0);
  EXPECT_EQ(send_command(folder_ / "control", "end").value(), "ok");
  EXPECT_EQ(::poll(&waiting, 1, 1000), 1);
}

TEST_F(Rigged, LeavesNothingBehind) {
  start(true);
  for (const char* name :
       {"rig.toml", "calibration", "environment", "board", "modem", "control", "camera.sock"}) {
    EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  }
  EXPECT_THAT(read_text(folder_ / "rig.toml").value(),
              HasSubstr("[camera]\nprofile = \"nikon-d5100\"\nport = \"\""));
  EXPECT_THAT(read_text(folder_ / "environment").value(), HasSubstr("WEFT_USB_CAMERAS="));
  rig_.reset();
  EXPECT_FALSE(fs::exists(folder_));
}

TEST_F(Rigged, StandsBesideOthers) {
  start();
  VirtualRigOptions options;
  options.scene = small_scene();
  options.cache = folder_.parent_path() / "cache";
  options.firmware = WEFT_FIRMWARE;
  std::vector<std::unique_ptr<VirtualRig>> others;
  for (int i = 0; i < 4; ++i) {
    options.folder = folder_.parent_path() / ("rig" + std::to_string(i));
    Result<std::unique_ptr<VirtualRig>> rig = VirtualRig::start(options);
    ASSERT_TRUE(rig) << rig.error().message();
    others.push_back(std::move(*rig));
  }
  light({1});
  EXPECT_EQ(status().at("pins"), Json({1}));
  for (const auto& other : others) {
    EXPECT_EQ(Json::parse(other->command("status").value()).at("pins"), Json::array());
  }
}

TEST(VirtualRig, RefusesMoreLedsThanABoardHas) {
  VirtualRigOptions options;
  options.scene = small_scene();
  options.scene.lights.rings = {{11, 45, 0, 500}};
  options.folder = fresh_folder() / "rig";
  options.cache = options.folder.parent_path() / "cache";
  options.firmware = WEFT_FIRMWARE;
  const Result<std::unique_ptr<VirtualRig>> rig = VirtualRig::start(options);
  ASSERT_FALSE(rig);
  EXPECT_EQ(rig.error().kind, ErrorKind::kBadData);
  EXPECT_THAT(rig.error().message(), HasSubstr("11"));
}

}  // namespace
}  // namespace weft::virtual_rig
