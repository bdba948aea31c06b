// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_setup.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "core/base/files.h"

namespace weft::capture {
namespace {

namespace fs = std::filesystem;

/// A list of devices as the kernel shows it.
class Devices {
 public:
  explicit Devices(const char* name)
      : folder_(fs::path(testing::TempDir()) / (name + std::to_string(getpid()))) {
    fs::create_directories(folder_);
  }
  ~Devices() { fs::remove_all(folder_); }
  void add(const char* name, int bus, int device, const std::string& serial) {
    fs::create_directories(folder_ / name);
    EXPECT_TRUE(write_file(folder_ / name / "busnum", std::to_string(bus) + "\n"));
    EXPECT_TRUE(write_file(folder_ / name / "devnum", std::to_string(device) + "\n"));
    if (serial.empty()) return;
    EXPECT_TRUE(write_file(folder_ / name / "serial", serial + "\n"));
  }
  const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
};

TEST(UsbSerial, IsWhatTheKernelWasToldAtThatAddress) {
  Devices devices("weft_usb_serial_");
  devices.add("1-2", 1, 17, "000006004711");
  devices.add("2-2", 2, 17, "000006004712");
  devices.add("1-3", 1, 7, "");
  fs::create_directories(devices.folder() / "1-2:1.0");  // an interface, which has no address
  EXPECT_EQ(usb_serial_of("usb:001,017", devices.folder()), "000006004711");
  EXPECT_EQ(usb_serial_of("usb:002,017", devices.folder()), "000006004712");
  EXPECT_EQ(usb_serial_of("usb:001,007", devices.folder()), "") << "it told none";
}

TEST(UsbSerial, IsEmptyWhereNothingIsKnown) {
  Devices devices("weft_no_usb_serial_");
  devices.add("1-2", 1, 17, "6004711");
  EXPECT_EQ(usb_serial_of("usb:001,018", devices.folder()), "");
  EXPECT_EQ(usb_serial_of("ptpip:127.0.0.1:15740:15740", devices.folder()), "");
  EXPECT_EQ(usb_serial_of("usb:001,017", devices.folder() / "absent"), "");
}

}  // namespace
}  // namespace weft::capture
