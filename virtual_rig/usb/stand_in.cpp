// SPDX-License-Identifier: Apache-2.0
// The functions of libusb-1.0 that libgphoto2's port driver "usb1" calls, on a bus that has the virtual
// cameras of WEFT_USB_CAMERAS (sockets, a ':' between two) and nothing else.
#include <libusb.h>
#include <poll.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "virtual_rig/usb/cable.h"
#include "virtual_rig/usb/wire.h"

using weft::virtual_rig::usb::Cable;
using weft::virtual_rig::usb::Description;
using weft::virtual_rig::usb::UsbCall;
using weft::virtual_rig::usb::UsbStatus;

namespace {

constexpr std::uint8_t kBulkIn = 0x81, kBulkOut = 0x02, kInterruptIn = 0x83;
constexpr std::uint16_t kInterruptPacket = 64;
constexpr std::uint8_t kStillImage = 6, kStillCapture = 1, kPtp = 1;

struct Submitted {
  libusb_transfer* transfer;
  bool cancelled;
};

}  // namespace

struct libusb_context {
  std::list<Submitted> submitted;
};

struct libusb_device {
  std::atomic<int> owners = 1;
  libusb_context* context = nullptr;
  std::string socket;
  std::uint8_t bus = 0;
  Description is = {};
};

struct libusb_device_handle {
  libusb_device* device;
  Cable calls, events;
};

namespace {

libusb_context& context_of(libusb_context* context) {
  static libusb_context of_callers_without;
  return context ? *context : of_callers_without;
}

std::vector<std::string> sockets() {
  const char* const named = std::getenv("WEFT_USB_CAMERAS");
  std::vector<std::string> found(1);
  for (const char c : std::string_view(named ? named : ""))
    c == ':' ? void(found.emplace_back()) : found.back().push_back(c);
  return found;
}

/// The camera at the other end; nothing if none is.
std::optional<Description> camera_at(Cable& cable) {
  Description camera = {};
  const std::span<std::uint8_t> bytes(reinterpret_cast<std::uint8_t*>(&camera), sizeof camera);
  if (!cable.connected() || !cable.call(UsbCall::kDescribe, {}, bytes)) return std::nullopt;
  return camera;
}

void let_go(libusb_device* device) {
  if (--device->owners == 0) delete device;
}

int result_of(const std::optional<Cable::Answer>& answer) {
  if (!answer) return LIBUSB_ERROR_NO_DEVICE;
  switch (answer->status) {
    case UsbStatus::kDone:
      return LIBUSB_SUCCESS;
    case UsbStatus::kBusy:
      return LIBUSB_ERROR_BUSY;
    case UsbStatus::kTimeOut:
      return LIBUSB_ERROR_TIMEOUT;
    case UsbStatus::kStall:
      return LIBUSB_ERROR_PIPE;
  }
  return LIBUSB_ERROR_OTHER;
}

/// A call without data. The driver makes its message from errno.
int call(libusb_device_handle* handle, UsbCall what) {
  const int result = result_of(handle->calls.call(what, {}, {}));
  if (result == LIBUSB_ERROR_BUSY) errno = EBUSY;
  if (result == LIBUSB_ERROR_NO_DEVICE) errno = ENODEV;
  return result;
}

libusb_endpoint_descriptor endpoint(std::uint8_t address, std::uint8_t type, std::uint16_t packet) {
  libusb_endpoint_descriptor descriptor = {};
  descriptor.bLength = LIBUSB_DT_ENDPOINT_SIZE;
  descriptor.bDescriptorType = LIBUSB_DT_ENDPOINT;
  descriptor.bEndpointAddress = address;
  descriptor.bmAttributes = type;
  descriptor.wMaxPacketSize = packet;
  return descriptor;
}

/// All cameras are of one kind.
struct Configuration {
  std::array<libusb_endpoint_descriptor, 3> endpoints = {
      endpoint(kBulkIn, LIBUSB_TRANSFER_TYPE_BULK, weft::virtual_rig::usb::kPacket),
      endpoint(kBulkOut, LIBUSB_TRANSFER_TYPE_BULK, weft::virtual_rig::usb::kPacket),
      endpoint(kInterruptIn, LIBUSB_TRANSFER_TYPE_INTERRUPT, kInterruptPacket)};
  libusb_interface_descriptor setting = {};
  libusb_interface interface = {};
  libusb_config_descriptor descriptor = {};

  Configuration() {
    setting.bLength = LIBUSB_DT_INTERFACE_SIZE;
    setting.bDescriptorType = LIBUSB_DT_INTERFACE;
    setting.bNumEndpoints = 3;
    setting.bInterfaceClass = kStillImage;
    setting.bInterfaceSubClass = kStillCapture;
    setting.bInterfaceProtocol = kPtp;
    setting.endpoint = endpoints.data();
    interface.altsetting = &setting;
    interface.num_altsetting = 1;
    descriptor.bLength = LIBUSB_DT_CONFIG_SIZE;
    descriptor.bDescriptorType = LIBUSB_DT_CONFIG;
    descriptor.bNumInterfaces = 1;
    descriptor.bConfigurationValue = 1;
    descriptor.interface = &interface;
  }
};

void complete(libusb_context& context, libusb_transfer_status status, int length) {
  libusb_transfer* const transfer = context.submitted.front().transfer;
  context.submitted.pop_front();
  transfer->status = status;
  transfer->actual_length = length;
  transfer->callback(transfer);  // may submit it again
}

/// Cancelled ones end first, in the order in which they were submitted.
bool complete_cancelled(libusb_context& context) {
  const auto one = std::ranges::find(context.submitted, true, &Submitted::cancelled);
  if (one == context.submitted.end()) return false;
  context.submitted.splice(context.submitted.begin(), context.submitted, one);
  complete(context, LIBUSB_TRANSFER_CANCELLED, 0);
  return true;
}

/// Waits for an event of the device that the oldest transfer asks for one.
int handle_events(libusb_context& context, int timeout_ms) {
  if (complete_cancelled(context)) return LIBUSB_SUCCESS;
  if (context.submitted.empty()) {
    poll(nullptr, 0, timeout_ms);
    return LIBUSB_SUCCESS;
  }
  libusb_transfer& transfer = *context.submitted.front().transfer;
  Cable& events = transfer.dev_handle->events;
  pollfd one = {.fd = events.fd(), .events = POLLIN, .revents = 0};
  if (poll(&one, 1, timeout_ms) <= 0) return LIBUSB_SUCCESS;
  const auto event = events.event({transfer.buffer, static_cast<std::size_t>(transfer.length)});
  if (event)
    complete(context, LIBUSB_TRANSFER_COMPLETED, static_cast<int>(event->length));
  else
    complete(context, LIBUSB_TRANSFER_NO_DEVICE, 0);
  return LIBUSB_SUCCESS;
}

}  // namespace

extern "C" {

int libusb_init(libusb_context** context) {
  if (context) *context = new libusb_context;
  return LIBUSB_SUCCESS;
}

void libusb_exit(libusb_context* context) {
  delete context;
}

ssize_t libusb_get_device_list(libusb_context* context, libusb_device*** list) {
  std::vector<libusb_device*> found;
  std::uint8_t bus = 0;
  for (const std::string& socket : sockets()) {
    ++bus;
    Cable cable(socket);
    const std::optional<Description> camera = camera_at(cable);
    if (!camera) continue;
    auto* const device = new libusb_device;
    device->context = &context_of(context);
    device->socket = socket;
    device->bus = bus;
    device->is = *camera;
    found.push_back(device);
  }
  *list = new libusb_device* [found.size() + 1] {};
  std::ranges::copy(found, *list);
  return static_cast<ssize_t>(found.size());
}

void libusb_free_device_list(libusb_device** list, int unreference) {
  for (libusb_device** device = list; list && unreference && *device; ++device) let_go(*device);
  delete[] list;
}

std::uint8_t libusb_get_bus_number(libusb_device* device) {
  return device->bus;
}

std::uint8_t libusb_get_device_address(libusb_device* device) {
  return device->is.address;
}

int libusb_get_device_descriptor(libusb_device* device, libusb_device_descriptor* descriptor) {
  *descriptor = {};
  descriptor->bLength = LIBUSB_DT_DEVICE_SIZE;
  descriptor->bDescriptorType = LIBUSB_DT_DEVICE;
  descriptor->bcdUSB = 0x0200;
  descriptor->bMaxPacketSize0 = 64;
  descriptor->idVendor = weft::virtual_rig::usb::kNikon;
  descriptor->idProduct = device->is.product;
  descriptor->bcdDevice = 0x0100;
  descriptor->bNumConfigurations = 1;
  return LIBUSB_SUCCESS;
}

int libusb_get_config_descriptor(libusb_device*, std::uint8_t index, libusb_config_descriptor** descriptor) {
  static Configuration configuration;
  *descriptor = &configuration.descriptor;
  return index == 0 ? LIBUSB_SUCCESS : LIBUSB_ERROR_NOT_FOUND;
}

void libusb_free_config_descriptor(libusb_config_descriptor*) {}

int libusb_get_max_packet_size(libusb_device*, unsigned char address) {
  return address == kInterruptIn ? kInterruptPacket : weft::virtual_rig::usb::kPacket;
}

int libusb_open(libusb_device* device, libusb_device_handle** handle) {
  auto opened = std::unique_ptr<libusb_device_handle>(
      new libusb_device_handle{device, Cable(device->socket), Cable(device->socket)});
  const std::optional<Description> camera = camera_at(opened->calls);
  if (!camera || camera->address != device->is.address || !opened->events.connected() ||
      !opened->events.listen())
    return LIBUSB_ERROR_NO_DEVICE;
  ++device->owners;
  *handle = opened.release();
  return LIBUSB_SUCCESS;
}

void libusb_close(libusb_device_handle* handle) {
  if (!handle) return;
  let_go(handle->device);
  delete handle;
}

int libusb_kernel_driver_active(libusb_device_handle*, int) {
  return 0;
}

int libusb_detach_kernel_driver(libusb_device_handle*, int) {
  return LIBUSB_ERROR_NOT_FOUND;
}

int libusb_attach_kernel_driver(libusb_device_handle*, int) {
  return LIBUSB_ERROR_NOT_FOUND;
}

int libusb_claim_interface(libusb_device_handle* handle, int) {
  return call(handle, UsbCall::kClaim);
}

int libusb_release_interface(libusb_device_handle* handle, int) {
  return call(handle, UsbCall::kRelease);
}

int libusb_set_configuration(libusb_device_handle* handle, int) {
  return call(handle, UsbCall::kConfigure);
}

int libusb_set_interface_alt_setting(libusb_device_handle* handle, int, int) {
  return call(handle, UsbCall::kConfigure);
}

int libusb_clear_halt(libusb_device_handle* handle, unsigned char) {
  return call(handle, UsbCall::kConfigure);
}

int libusb_reset_device(libusb_device_handle* handle) {
  return call(handle, UsbCall::kReset);
}

int libusb_control_transfer(libusb_device_handle* handle, std::uint8_t type, std::uint8_t request,
                            std::uint16_t, std::uint16_t, unsigned char* data, std::uint16_t length,
                            unsigned int timeout_ms) {
  const bool in = type & LIBUSB_ENDPOINT_IN;
  if ((type & 0x60) == LIBUSB_REQUEST_TYPE_STANDARD) {  // GET_STATUS of an endpoint: not halted
    std::fill_n(data, in ? length : 0, std::uint8_t{0});
    return in ? length : 0;
  }
  std::array<std::uint8_t, 64> answer;
  const auto called = handle->calls.call(UsbCall::kControl, {}, answer, timeout_ms, request);
  if (const int result = result_of(called); result != LIBUSB_SUCCESS) return result;
  const auto count = in ? std::min<std::uint32_t>(called->length, length) : length;
  if (in) std::copy_n(answer.begin(), count, data);
  return static_cast<int>(count);
}

int libusb_bulk_transfer(libusb_device_handle* handle, unsigned char address, unsigned char* data, int length,
                         int* transferred, unsigned int timeout_ms) {
  const std::span<std::uint8_t> bytes(data, static_cast<std::size_t>(length));
  const bool in = address & LIBUSB_ENDPOINT_IN;
  const auto called = in ? handle->calls.call(UsbCall::kBulkIn, {}, bytes, timeout_ms)
                         : handle->calls.call(UsbCall::kBulkOut, bytes, {}, timeout_ms);
  const int result = result_of(called);
  const bool done = result == LIBUSB_SUCCESS;
  if (transferred) *transferred = !done ? 0 : in ? static_cast<int>(called->length) : length;
  return result;
}

libusb_transfer* libusb_alloc_transfer(int) {
  return static_cast<libusb_transfer*>(std::calloc(1, sizeof(libusb_transfer)));
}

void libusb_free_transfer(libusb_transfer* transfer) {
  if (!transfer) return;
  if (transfer->flags & LIBUSB_TRANSFER_FREE_BUFFER) std::free(transfer->buffer);
  std::free(transfer);
}

int libusb_submit_transfer(libusb_transfer* transfer) {
  transfer->dev_handle->device->context->submitted.push_back({transfer, false});
  return LIBUSB_SUCCESS;
}

int libusb_cancel_transfer(libusb_transfer* transfer) {
  std::list<Submitted>& submitted = transfer->dev_handle->device->context->submitted;
  const auto one = std::ranges::find(submitted, transfer, &Submitted::transfer);
  if (one == submitted.end()) return LIBUSB_ERROR_NOT_FOUND;
  one->cancelled = true;
  return LIBUSB_SUCCESS;
}

int libusb_handle_events_timeout(libusb_context* context, timeval* timeout) {
  return handle_events(context_of(context),
                       static_cast<int>(timeout->tv_sec * 1000 + timeout->tv_usec / 1000));
}

int libusb_handle_events(libusb_context* context) {
  return handle_events(context_of(context), 1000);
}

}  // extern "C"
