// SPDX-License-Identifier: Apache-2.0
// The virtual camera over USB: the real libgphoto2 and its port driver "usb1", on the stand-in for libusb.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "tests/virtual_rig/ptp/client_process.h"
#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/ptp/studio.h"

namespace weft::virtual_rig {
namespace {

using testing::HasSubstr;

constexpr const char* kModel = "Nikon DSC D5100 (PTP mode)";

std::string socket_path(int index = 0) {
  return private_home() + "/usb" + std::to_string(index);
}

VirtualCameraOptions on_usb(int index = 0) {
  return {.serial = "600000" + std::to_string(index + 1),
          .usb = socket_path(index),
          .away_s = 0.4,
          .late_s = 0.6};
}

/// Cameras found by their kind: "usb:001,007".
std::vector<std::string> detected() {
  GPContext* const context = gp_context_new();
  CameraAbilitiesList* abilities = nullptr;
  gp_abilities_list_new(&abilities);
  gp_abilities_list_load(abilities, context);
  GPPortInfoList* ports = nullptr;
  gp_port_info_list_new(&ports);
  gp_port_info_list_load(ports);
  CameraList* found = nullptr;
  gp_list_new(&found);
  gp_abilities_list_detect(abilities, ports, found, context);
  std::vector<std::string> addresses;
  for (int i = 0; i < gp_list_count(found); ++i) {
    const char *name = nullptr, *port = nullptr;
    gp_list_get_name(found, i, &name);
    gp_list_get_value(found, i, &port);
    if (std::string(port) == "usb:") continue;  // what stands for a bus on which nothing was found
    EXPECT_STREQ(name, kModel);
    addresses.emplace_back(port);
  }
  gp_list_free(found);
  gp_port_info_list_free(ports);
  gp_abilities_list_free(abilities);
  gp_context_unref(context);
  return addresses;
}

/// The one camera's address, once it is there.
std::string only_address() {
  for (int tries = 0; tries < 200; ++tries)
    if (const std::vector<std::string> found = detected(); found.size() == 1) return found[0];
  ADD_FAILURE() << "no camera on the bus";
  return "usb:";
}

std::unique_ptr<GphotoClient> connected(const std::string& port, const char* target = "Internal RAM") {
  auto client = std::make_unique<GphotoClient>(port);
  EXPECT_EQ(client->init(), GP_OK);
  EXPECT_EQ(client->set("capturetarget", target), GP_OK);
  EXPECT_EQ(client->set("shutterspeed2", "1/60"), GP_OK);
  return client;
}

class UsbCamera : public testing::Test {
 protected:
  void SetUp() override { setenv("WEFT_USB_CAMERAS", (socket_path(0) + ":" + socket_path(1)).c_str(), 1); }
};

TEST_F(UsbCamera, IsDetectedAtAnAddress) {
  EXPECT_TRUE(detected().empty());
  Studio first(on_usb(0));
  EXPECT_EQ(detected(), std::vector<std::string>{"usb:001,007"});
  Studio second(on_usb(1));
  EXPECT_EQ(detected(), (std::vector<std::string>{"usb:001,007", "usb:002,007"}));
  EXPECT_THAT(connected("usb:001,007")->get("serialnumber"), HasSubstr("6000001"));
  EXPECT_THAT(connected("usb:002,007")->get("serialnumber"), HasSubstr("6000002"));
}

TEST_F(UsbCamera, DeliversTwentyShotsToMemoryAndToTheCard) {
  Studio studio(on_usb());
  std::uint32_t number = 0;
  for (const char* const target : {"Internal RAM", "Memory card"}) {
    const auto client = connected(only_address(), target);
    for (int i = 0; i < 10; ++i) {
      const GphotoClient::Shot shot = client->shoot();
      ASSERT_TRUE(shot.whole()) << number << " and " << shot.triggered << ' ' << shot.waited << ' '
                                << shot.file.code;
      ASSERT_EQ(studio.number_of(shot.file.bytes), ++number);
    }
    EXPECT_EQ(client->exit(), GP_OK);
  }
}

/// Data that end with a full packet are followed by an empty one.
TEST_F(UsbCamera, DeliversEveryLengthAroundAPacket) {
  for (const std::size_t bytes : {500u, 512u, 1012u, 1023u, 1024u, 65536u, 66036u}) {
    Studio studio(on_usb(), bytes);
    const auto client = connected(only_address());
    for (std::uint32_t number = 1; number <= 2; ++number)
      ASSERT_EQ(studio.number_of(client->shoot().file.bytes), number) << bytes;
  }
}

TEST_F(UsbCamera, IsRefusedToTheSecondWhoWantsIt) {
  Studio studio(on_usb());
  const std::string port = only_address();
  const auto first = connected(port);
  GphotoClient second(port);
  EXPECT_EQ(second.init(), GP_ERROR_IO_USB_CLAIM);
  EXPECT_TRUE(first->shoot().whole());
  first->exit();
  EXPECT_EQ(second.init(), GP_OK);
}

TEST_F(UsbCamera, IsRefusedWhileAnotherProgramHasIt) {
  Studio studio(on_usb());
  studio.inject("usb_claimed");
  GphotoClient client(only_address());
  EXPECT_EQ(client.init(), GP_ERROR_IO_USB_CLAIM);
  EXPECT_EQ(client.init_within(5), GP_OK);
}

TEST_F(UsbCamera, IsLetGoOfByAnotherProgramWhenAllIsWell) {
  VirtualCameraOptions options = on_usb();
  options.away_s = 3600;
  Studio studio(options);
  studio.inject("usb_claimed");
  GphotoClient client(only_address());
  ASSERT_EQ(client.init(), GP_ERROR_IO_USB_CLAIM);
  studio.inject("well");
  EXPECT_EQ(client.init(), GP_OK);
}

TEST_F(UsbCamera, IsGoneWhenItsCableIsPulled) {
  Studio studio(on_usb());
  studio.inject("usb_unplug", 2);
  auto client = connected(only_address());
  ASSERT_TRUE(client->shoot().whole());
  const auto start = std::chrono::steady_clock::now();
  EXPECT_FALSE(client->shoot().whole());
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_TRUE(detected().empty());
  EXPECT_LT(client->init(), 0);
  studio.inject("usb_replug");
  EXPECT_EQ(detected(), std::vector<std::string>{"usb:001,008"});
  client = connected("usb:001,008");
  EXPECT_EQ(studio.number_of(client->next_file(1).file.bytes), 2u) << "what it had still to deliver";
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 3u);
}

TEST_F(UsbCamera, IsThereAgainWhenAllIsWell) {
  Studio studio(on_usb());
  studio.inject("usb_unplug", 1);
  EXPECT_FALSE(connected(only_address())->shoot().whole());
  ASSERT_TRUE(detected().empty());
  studio.inject("well");
  EXPECT_EQ(detected().size(), 1u);
}

class UsbLoss : public UsbCamera, public testing::WithParamInterface<const char*> {};

TEST_P(UsbLoss, IsAnErrorAndTheCameraIsBackUnderANewAddress) {
  Studio studio(on_usb());
  const std::string port = only_address();
  auto client = connected(port);
  studio.inject(GetParam());
  const GphotoClient::Shot lost = client->shoot(3);
  EXPECT_FALSE(lost.whole());
  EXPECT_LT(lost.seconds, 5) << "a read of the bus times out after 20 s";
  client->exit();
  const std::string again = only_address();
  EXPECT_EQ(again, "usb:001,008");
  client = connected(again);
  const auto number = static_cast<std::uint32_t>(studio.camera().shots() + 1);
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), number);
}

INSTANTIATE_TEST_SUITE_P(VirtualCamera, UsbLoss,
                         testing::Values("drop_in_exposure", "drop_before_object", "drop_in_data",
                                         "usb_replug", "power_cycle"),
                         [](const auto& one) { return std::string(one.param); });

TEST_F(UsbCamera, SaysATimeOutOfTheBus) {
  Studio studio(on_usb());
  studio.inject("usb_timeout");
  auto client = connected(only_address());
  const GphotoClient::Shot lost = client->shoot(3);
  EXPECT_FALSE(lost.whole());
  EXPECT_LT(lost.seconds, 5) << "a read of the bus times out after 20 s";
  client->exit();
  client = connected(only_address());
  EXPECT_EQ(studio.number_of(client->shoot().file.bytes), 2u);
}

TEST_F(UsbCamera, TakesAHostThoughASessionIsStillOpen) {
  Studio studio(on_usb());
  studio.inject("usb_stale_session");
  EXPECT_EQ(studio.number_of(connected(only_address())->shoot().file.bytes), 1u);
}

TEST_F(UsbCamera, IsFreeOnceItsHostIsKilledAndOwesItTheShot) {
  ClientProcess child([](const std::string& port) {
    const auto client = connected(port);
    client->set("shutterspeed2", "1/2");
    return client->trigger();
  });
  Studio studio(on_usb());
  const std::string port = only_address();
  child.begin(port);
  while (studio.camera().shots() == 0 && !child.wait(0.01).ended) {
  }
  child.kill();
  GphotoClient client(port);
  ASSERT_EQ(client.init_within(5), GP_OK);
  EXPECT_EQ(studio.number_of(client.next_file(3).file.bytes), 1u);
}

TEST_F(UsbCamera, IsTheSameBodyOnBothLinks) {
  Studio studio(on_usb());
  connected(studio.network())->shoot();
  EXPECT_EQ(studio.number_of(connected(only_address())->shoot().file.bytes), 2u);
}

TEST_F(UsbCamera, IsWhatTheStockGphoto2FindsAndTakesAPictureWith) {
  Studio studio(on_usb());
  const std::vector<std::string> environment = {"LD_PRELOAD=" WEFT_USB, "HOME=" + private_home(), "LC_ALL=C"};
  const ProgramRun found =
      run_program({"/usr/bin/gphoto2", "--auto-detect"}, environment, private_home(), 20);
  EXPECT_EQ(found.exit_code, 0) << found.output;
  EXPECT_THAT(found.output, testing::ContainsRegex("Nikon DSC D5100 \\(PTP mode\\) +usb:001,007"));

  const std::string file = private_home() + "/captured.dng";
  const ProgramRun captured =
      run_program({"/usr/bin/gphoto2", "--set-config", "capturetarget=0", "--capture-image-and-download",
                   "--filename", file, "--force-overwrite"},
                  environment, private_home(), 20);
  EXPECT_EQ(captured.exit_code, 0) << captured.output;
  std::ifstream in(file, std::ios::binary);
  const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(in), {});
  EXPECT_EQ(studio.number_of(bytes), 1u);
}

}  // namespace
}  // namespace weft::virtual_rig
