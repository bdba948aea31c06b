// SPDX-License-Identifier: Apache-2.0
#include "capture/doctor/doctor.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "core/rig/calibration.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::Field;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Verdict = SetupFinding::Verdict;

/// A machine as its /proc, /sys and /dev show it.
class Machine {
 public:
  explicit Machine(const std::string& name) : root_(fs::path(testing::TempDir()) / ("doctor_" + name)) {
    fs::remove_all(root_);
    for (const char* part : {"proc", "sys/bus/usb/devices", "dev/bus/usb/001"})
      fs::create_directories(root_ / part);
    write("dev/ttyACM0", "");
    rig_.board.port = (root_ / "dev/ttyACM0").string();
    rig_.camera.port = "ptpip:127.0.0.1:1:1";
    rig_.camera.serial = "6000001";
  }
  ~Machine() { fs::remove_all(root_); }
  void write(const fs::path& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    std::ofstream(root_ / file) << text;
  }
  /// A process, with a file of this machine open.
  void runs(int pid, const std::string& name, const fs::path& holds = {}) const {
    const fs::path folder = fs::path("proc") / std::to_string(pid);
    write(folder / "comm", name + "\n");
    fs::create_directories(root_ / folder / "fd");
    if (!holds.empty()) fs::create_symlink(fs::canonical(root_ / holds), root_ / folder / "fd/7");
  }
  void plug_camera(const std::string& speed) {
    const fs::path device = "sys/bus/usb/devices/1-2";
    write(device / "busnum", "1\n");
    write(device / "devnum", "5\n");
    write(device / "speed", speed + "\n");
    write(device / "product", "NIKON DSC D5100\n");
    write(device / "1-2:1.0/bInterfaceClass", "06\n");
    write("dev/bus/usb/001/005", "");
    rig_.camera.port.clear();
  }
  void use_usb() { rig_.camera.port.clear(); }
  std::vector<SetupFinding> examine() const {
    return examine_rig(rig_, {[&] { return board; }, [&] { return camera; }}, places());
  }
  std::vector<SetupFinding> examine_outside() const { return examine_rig(rig_, {}, places()); }
  const fs::path& root() const { return root_; }
  Rig& rig() { return rig_; }

  // What the devices say when they are opened.
  Result<std::string> board = std::string("weft lights 1.0");
  Result<CameraFacts> camera = CameraFacts();

 private:
  SystemPlaces places() const {
    return {root_ / "proc", root_ / "sys", root_ / "dev", {root_ / "etc", root_ / "lib"}};
  }
  fs::path root_;
  Rig rig_;
};

auto faults(const std::string& part, const std::string& says, const std::string& remedy) {
  return AllOf(Field("verdict", &SetupFinding::verdict, Verdict::kFault),
               Field("part", &SetupFinding::part, part), Field("says", &SetupFinding::says, HasSubstr(says)),
               Field("remedy", &SetupFinding::remedy, HasSubstr(remedy)));
}

TEST(Doctor, FindsNothingWrongWithAFreePort) {
  const Machine machine("free");
  EXPECT_THAT(machine.examine(), Each(Field("verdict", &SetupFinding::verdict, Verdict::kFine)));
}

TEST(Doctor, LooksAtDevicesFromOutsideWhereItMayNotOpenThem) {
  Machine machine("outside");
  EXPECT_THAT(machine.examine_outside(), IsEmpty());
  machine.runs(421, "ModemManager", "dev/ttyACM0");
  EXPECT_THAT(machine.examine_outside(),
              Contains(faults("board", "ModemManager (process 421)", "disable --now")));
  machine.rig().board.port = (machine.root() / "dev/none").string();
  EXPECT_THAT(machine.examine_outside(), Contains(faults("board", "there is no port", "plug the board in")));
}

TEST(Doctor, NamesTheModemManagerThatHoldsTheBoard) {
  const Machine machine("modem");
  machine.runs(421, "ModemManager", "dev/ttyACM0");
  EXPECT_THAT(machine.examine(), Contains(faults("board", "ModemManager (process 421)",
                                                 "systemctl disable --now ModemManager")));
}

TEST(Doctor, NamesBrlttyAndWarnsOfAnyOtherHolder) {
  const Machine machine("brltty");
  machine.runs(99, "brltty", "dev/ttyACM0");
  machine.runs(100, "minicom", "dev/ttyACM0");
  const std::vector<SetupFinding> found = machine.examine();
  EXPECT_THAT(found, Contains(faults("board", "brltty (process 99)", "apt-get remove brltty")));
  EXPECT_THAT(found, Contains(AllOf(Field(&SetupFinding::verdict, Verdict::kWarning),
                                    Field(&SetupFinding::says, HasSubstr("minicom (process 100)")),
                                    Field(&SetupFinding::remedy, "kill 100"))));
}

TEST(Doctor, WarnsOfAModemManagerThatWaitsUnlessOurRulesKeepItOff) {
  const Machine machine("waits");
  machine.runs(421, "ModemManager");
  EXPECT_THAT(machine.examine(), Contains(Field("verdict", &SetupFinding::verdict, Verdict::kWarning)));
  machine.write("lib/70-weft.rules", "");
  EXPECT_THAT(machine.examine(), Each(Field("verdict", &SetupFinding::verdict, Verdict::kFine)));
}

TEST(Doctor, BlamesAThiefWhoseHoldIsNotShownForABoardThatDoesNotAnswer) {
  Machine machine("hidden");
  machine.write("lib/70-weft.rules", "");
  machine.board = Error{ErrorKind::kTryAgain, "the LED board does not answer", "", "", "flash it"};
  EXPECT_THAT(machine.examine(), Contains(faults("board", "does not answer", "flash it")));
  machine.runs(421, "ModemManager");
  EXPECT_EQ(machine.examine()[0].says,
            "ModemManager (process 421) runs and sends modem commands to every new serial port");
  EXPECT_THAT(machine.examine(),
              Contains(faults("board", "ModemManager", "systemctl disable --now ModemManager")));
  machine.runs(99, "brltty");
  machine.board = Error{ErrorKind::kNoDevice, "the LED board is held by another program", "", "", "end it"};
  EXPECT_THAT(machine.examine(), Contains(faults("board", "brltty (process 99)", "apt-get remove brltty")));
  machine.board = Error{ErrorKind::kBadData, "the firmware is too old", "", "", "flash it"};
  EXPECT_THAT(machine.examine(), Not(Contains(Field("says", &SetupFinding::says, HasSubstr("brltty")))));
}

TEST(Doctor, FindsNothingWrongWithTheOtherEndOfAVirtualBoard) {
  const Machine machine("virtual");
  machine.runs(7, "weft-virtual-ri", "dev/ttyACM0");
  EXPECT_THAT(machine.examine(), Each(Field("verdict", &SetupFinding::verdict, Verdict::kFine)));
}

TEST(Doctor, OpensTheOneDeviceWhoseOtherHasAFault) {
  Machine machine("other");
  machine.board = std::string("greets");
  machine.runs(99, "brltty", "dev/ttyACM0");
  machine.camera->model = "D5100";
  const std::vector<SetupFinding> found = machine.examine();
  EXPECT_THAT(found, Contains(Field("says", &SetupFinding::says, HasSubstr("D5100"))));
  EXPECT_THAT(found, Not(Contains(Field("says", &SetupFinding::says, "greets"))))
      << "what holds it says more";
}

TEST(Doctor, SaysThatAPortIsNotThere) {
  Machine machine("absent");
  machine.rig().board.port = (machine.root() / "dev/ttyUSB3").string();
  EXPECT_THAT(machine.examine(), Contains(faults("board", "there is no port", "plug the board in")));
}

TEST(Doctor, NamesTheDesktopThatClaimsTheCamera) {
  Machine machine("gvfs");
  machine.plug_camera("480");
  machine.runs(77, "gvfsd-gphoto2", "dev/bus/usb/001/005");
  EXPECT_THAT(machine.examine(),
              Contains(faults("camera", "gvfsd-gphoto2 (process 77)", "gio mount -s gphoto2")));
}

TEST(Doctor, BelievesWhatDrivesTheCameraOfWhetherOneIsThere) {
  Machine machine("usb");
  machine.use_usb();
  EXPECT_THAT(machine.examine(), Each(Field("verdict", &SetupFinding::verdict, Verdict::kFine)))
      << "the kernel shows none, and yet it answers";
  machine.camera = Error{ErrorKind::kNoDevice, "no D5100 on USB", "", "there is no camera", "switch it on"};
  EXPECT_THAT(machine.examine(), Contains(faults("camera", "no D5100 on USB", "switch it on")));
}

TEST(Doctor, WarnsOfASlowCable) {
  Machine machine("slow");
  machine.plug_camera("12");
  EXPECT_THAT(machine.examine(), Contains(AllOf(Field(&SetupFinding::verdict, Verdict::kWarning),
                                                Field(&SetupFinding::says, HasSubstr("12 Mbit/s")))));
}

TEST(Doctor, PassesOnWhatAPersonMustDoToTheCamera) {
  Machine machine("dial");
  machine.camera = Error{ErrorKind::kBadData, "the dial is not on M", "camera", "it is on A", "turn it to M"};
  EXPECT_THAT(machine.examine(), Contains(AllOf(faults("camera", "the dial is not on M", "turn it to M"),
                                                Field("kind", &SetupFinding::kind, ErrorKind::kBadData))));
}

TEST(Doctor, WarnsOfALowBatteryAndAClockThatIsOff) {
  Machine machine("battery");
  machine.camera->battery = 0.1;
  machine.camera->clock_offset_s = -3600;
  const std::vector<SetupFinding> found = machine.examine();
  EXPECT_THAT(found, Contains(Field(&SetupFinding::says, HasSubstr("battery will not last"))));
  EXPECT_THAT(found, Contains(Field(&SetupFinding::says, HasSubstr("off by -3600 s"))));
}

TEST(Doctor, CountsTheSessionsThatFitOnTheDisk) {
  Machine machine("disk");
  machine.rig().scan.sessions = machine.root() / "scans";
  const auto fits = examine_folders(machine.rig(), 1);
  EXPECT_THAT(fits, Contains(AllOf(Field(&SetupFinding::part, "disk"),
                                   Field(&SetupFinding::verdict, Verdict::kFine))));
  const auto full = examine_folders(machine.rig(), std::uint64_t{1} << 56);
  EXPECT_THAT(full, Contains(faults("disk", "room for 0 sessions", "free some")));
}

TEST(Doctor, WarnsOfASecondCopyOnTheDiskOfTheSessions) {
  Machine machine("one_disk");
  machine.rig().scan.sessions = machine.root() / "scans";
  machine.rig().scan.copy = machine.root() / "copies";
  EXPECT_THAT(examine_folders(machine.rig(), 1),
              Contains(AllOf(Field(&SetupFinding::part, "second disk"),
                             Field(&SetupFinding::verdict, Verdict::kWarning),
                             Field(&SetupFinding::says, HasSubstr("is on the disk of the sessions")))));
}

TEST(Doctor, RefusesTheCalibrationOfAnotherApertureOrNone) {
  Machine machine("calibration");
  machine.rig().scan.sessions = machine.root() / "scans";
  machine.rig().scan.calibration = machine.root() / "nowhere";
  EXPECT_THAT(examine_folders(machine.rig(), 1), Contains(faults("calibration", "", "")));
}

TEST(Doctor, KnowsACameraByItsNumberHoweverManyZerosItBeginsWith) {
  Machine machine("serial");
  Rig& rig = machine.rig();
  rig.scan.sessions = machine.root() / "scans";
  rig.scan.calibration = machine.root() / "calibration";
  Calibration calibration;
  calibration.subject.rig = rig.name;
  calibration.subject.camera_serial = "0006004711";
  calibration.subject.f_number = rig.scan.f_number;
  ASSERT_TRUE(write_calibration(rig.scan.calibration, calibration));
  rig.camera.serial.clear();
  EXPECT_EQ(camera_serial(rig), "0006004711");
  const auto other_camera = Field("says", &SetupFinding::says, HasSubstr("it is of camera 0006004711"));
  rig.camera.serial = "6004711";
  EXPECT_THAT(examine_folders(rig, 1), Not(Contains(other_camera)));
  EXPECT_EQ(camera_serial(rig), "6004711");
  rig.camera.serial = "6004712";
  EXPECT_THAT(examine_folders(rig, 1), Contains(other_camera));
}

}  // namespace
}  // namespace weft::capture
