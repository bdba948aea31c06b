// SPDX-License-Identifier: Apache-2.0
// The stand-in for libusb by its own functions: what libgphoto2 does not reach in every test.
#include <gtest/gtest.h>
#include <libusb.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <random>

#include "tests/virtual_rig/ptp/gphoto_client.h"
#include "tests/virtual_rig/ptp/studio.h"
#include "virtual_rig/ptp/bytes.h"
#include "virtual_rig/usb/cable.h"

namespace weft::virtual_rig {
namespace {

using ptp::Bytes;
using ptp::ByteWriter;

constexpr unsigned char kIn = 0x81, kOut = 0x02, kInterrupt = 0x83;

/// The one camera of the bus, open.
class OpenedCamera {
 public:
  explicit OpenedCamera(const std::string& socket) {
    setenv("WEFT_USB_CAMERAS", socket.c_str(), 1);
    libusb_init(&context_);
    const ssize_t count = libusb_get_device_list(context_, &devices_);
    EXPECT_EQ(count, 1);
    if (count == 1) {
      EXPECT_EQ(libusb_open(device(), &handle_), LIBUSB_SUCCESS);
    }
  }
  ~OpenedCamera() {
    libusb_close(handle_);
    libusb_free_device_list(devices_, 1);
    libusb_exit(context_);
  }
  libusb_device* device() { return devices_[0]; }
  libusb_device_handle* handle() { return handle_; }
  libusb_context* context() { return context_; }

  int write(Bytes bytes) {
    int sent = 0;
    return libusb_bulk_transfer(handle_, kOut, bytes.data(), static_cast<int>(bytes.size()), &sent, 1000);
  }
  /// What a read of so many bytes gets; nothing if it fails.
  Bytes read(int most, unsigned timeout_ms = 1000) {
    Bytes bytes(static_cast<std::size_t>(most));
    int got = 0;
    result_ = libusb_bulk_transfer(handle_, kIn, bytes.data(), most, &got, timeout_ms);
    bytes.resize(static_cast<std::size_t>(got));
    return bytes;
  }
  int result() const { return result_; }

 private:
  libusb_context* context_ = nullptr;
  libusb_device** devices_ = nullptr;
  libusb_device_handle* handle_ = nullptr;
  int result_ = LIBUSB_SUCCESS;
};

VirtualCameraOptions on_stand_in() {
  return {.usb = private_home() + "/stand_in", .away_s = 0.3};
}

Bytes command(std::uint16_t operation, std::uint32_t parameter) {
  return ByteWriter().put(16u).put(std::uint16_t{1}).put(operation).put(1u).put(parameter).take();
}

TEST(UsbStandIn, DescribesAStillImageDevice) {
  Studio studio(on_stand_in());
  OpenedCamera camera(on_stand_in().usb);
  libusb_device_descriptor device = {};
  ASSERT_EQ(libusb_get_device_descriptor(camera.device(), &device), LIBUSB_SUCCESS);
  EXPECT_EQ(device.idVendor, 0x04b0);
  EXPECT_EQ(device.idProduct, 0x0429);
  libusb_config_descriptor* configuration = nullptr;
  ASSERT_EQ(libusb_get_config_descriptor(nullptr, 0, &configuration), LIBUSB_SUCCESS);
  const libusb_interface_descriptor& setting = configuration->interface[0].altsetting[0];
  EXPECT_EQ(setting.bInterfaceClass, LIBUSB_CLASS_IMAGE);
  ASSERT_EQ(setting.bNumEndpoints, 3);
  EXPECT_EQ(setting.endpoint[2].bEndpointAddress, kInterrupt);
  EXPECT_NE(libusb_get_config_descriptor(nullptr, 1, &configuration), LIBUSB_SUCCESS);
}

TEST(UsbStandIn, CarriesContainersAndTellsATimeOut) {
  Studio studio(on_stand_in());
  OpenedCamera camera(on_stand_in().usb);
  EXPECT_EQ(camera.write(command(0x1002, 1)), LIBUSB_ERROR_BUSY) << "without a claim";
  ASSERT_EQ(libusb_claim_interface(camera.handle(), 0), LIBUSB_SUCCESS);
  ASSERT_EQ(camera.write(command(0x1002, 1)), LIBUSB_SUCCESS);
  EXPECT_EQ(camera.read(512),
            ByteWriter().put(12u).put(std::uint16_t{3}).put(std::uint16_t{0x2001}).put(1u).take());
  EXPECT_TRUE(camera.read(512, 30).empty());
  EXPECT_EQ(camera.result(), LIBUSB_ERROR_TIMEOUT);
}

TEST(UsbStandIn, ThrowsAwayWhatWaitsWhenTheEndpointIsCleared) {
  Studio studio(on_stand_in());
  OpenedCamera camera(on_stand_in().usb);
  ASSERT_EQ(libusb_claim_interface(camera.handle(), 0), LIBUSB_SUCCESS);
  ASSERT_EQ(camera.write(command(0x1001, 0)), LIBUSB_SUCCESS);
  EXPECT_EQ(camera.read(20).size(), 20u);
  EXPECT_EQ(libusb_clear_halt(camera.handle(), kIn), LIBUSB_SUCCESS);
  EXPECT_TRUE(camera.read(512, 30).empty());
  std::array<unsigned char, 4> status = {};
  EXPECT_EQ(libusb_control_transfer(camera.handle(), 0xa1, 0x67, 0, 0, status.data(), 4, 1000), 4);
  EXPECT_EQ(status, (std::array<unsigned char, 4>{4, 0, 0x01, 0x20}));
  EXPECT_EQ(libusb_control_transfer(camera.handle(), 0x21, 0x99, 0, 0, nullptr, 0, 1000), LIBUSB_ERROR_PIPE);
}

struct Interrupts {
  int completed = 0, cancelled = 0, gone = 0;
  Bytes last;
};

void count(libusb_transfer* transfer) {
  auto& interrupts = *static_cast<Interrupts*>(transfer->user_data);
  if (transfer->status == LIBUSB_TRANSFER_COMPLETED) {
    ++interrupts.completed;
    interrupts.last.assign(transfer->buffer, transfer->buffer + transfer->actual_length);
  } else if (transfer->status == LIBUSB_TRANSFER_CANCELLED) {
    ++interrupts.cancelled;
  } else {
    ++interrupts.gone;
  }
}

TEST(UsbStandIn, BringsEventsToTransfersThatWaitForThem) {
  Studio studio(on_stand_in());
  OpenedCamera camera(on_stand_in().usb);
  Interrupts interrupts;
  std::array<unsigned char, 64> buffers[3];
  std::array<libusb_transfer*, 3> transfers;
  for (std::size_t i = 0; i < 3; ++i) {
    transfers[i] = libusb_alloc_transfer(0);
    libusb_fill_interrupt_transfer(transfers[i], camera.handle(), kInterrupt, buffers[i].data(), 64, count,
                                   &interrupts, 0);
    ASSERT_EQ(libusb_submit_transfer(transfers[i]), LIBUSB_SUCCESS);
  }
  const auto handle_for_100_ms = [&] {
    timeval wait = {0, 100'000};
    return libusb_handle_events_timeout(camera.context(), &wait);
  };
  handle_for_100_ms();
  EXPECT_EQ(interrupts.completed, 0);

  studio.inject("battery_low");
  for (int tries = 0; tries < 20 && interrupts.completed == 0; ++tries) handle_for_100_ms();
  EXPECT_EQ(interrupts.completed, 1);
  EXPECT_EQ(
      interrupts.last,
      ByteWriter().put(16u).put(std::uint16_t{4}).put(std::uint16_t{0x4006}).put(0u).put(0x5001u).take());

  ASSERT_EQ(libusb_cancel_transfer(transfers[2]), LIBUSB_SUCCESS);
  EXPECT_EQ(libusb_cancel_transfer(transfers[0]), LIBUSB_ERROR_NOT_FOUND);
  handle_for_100_ms();
  EXPECT_EQ(interrupts.cancelled, 1);

  studio.inject("usb_replug");
  for (int tries = 0; tries < 20 && interrupts.gone == 0; ++tries) handle_for_100_ms();
  EXPECT_EQ(interrupts.gone, 1);
  EXPECT_EQ(libusb_claim_interface(camera.handle(), 0), LIBUSB_ERROR_NO_DEVICE);
  std::ranges::for_each(transfers, libusb_free_transfer);
}

TEST(UsbStandIn, OutlivesNoiseOnTheCable) {
  Studio studio(on_stand_in());
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    usb::Cable cable(on_stand_in().usb);
    ASSERT_TRUE(cable.connected()) << round;
    if (round % 4) cable.call(usb::UsbCall::kClaim, {}, {});
    Bytes bytes(random() % 64);
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
    if (round % 2 && bytes.size() >= 8) {
      std::ranges::copy(
          ByteWriter().put(static_cast<std::uint32_t>(bytes.size())).put(1u | 0x1001u << 16).take(),
          bytes.begin());
      bytes[6] = static_cast<std::uint8_t>(random() % 32);
    }
    cable.call(usb::UsbCall::kBulkOut, bytes, {});
    Bytes in(512);
    const auto any = static_cast<usb::UsbCall>(random() % 16);
    if (any != usb::UsbCall::kEvents) cable.call(any, {}, in, 1);  // which is not answered
  }
  OpenedCamera camera(on_stand_in().usb);
  const auto not_busy = [&](auto call) {  // as the last of the noise may be, which is still answered
    int said = LIBUSB_ERROR_BUSY;
    for (int tries = 0; tries < 1000 && said == LIBUSB_ERROR_BUSY; ++tries) said = call();
    return said;
  };
  // As the driver does, to begin anew.
  EXPECT_EQ(not_busy([&] { return libusb_set_configuration(camera.handle(), 1); }), LIBUSB_SUCCESS);
  EXPECT_EQ(not_busy([&] { return libusb_claim_interface(camera.handle(), 0); }), LIBUSB_SUCCESS);
  EXPECT_EQ(camera.write(command(0x1001, 0)), LIBUSB_SUCCESS);
  const Bytes answer = camera.read(512);
  EXPECT_GT(answer.size(), 100u) << testing::PrintToString(answer);
}

}  // namespace
}  // namespace weft::virtual_rig
