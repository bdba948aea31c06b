// SPDX-License-Identifier: Apache-2.0
#include "capture/board/serial_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <libserialport.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <thread>

#include "core/base/files.h"

namespace weft::capture {
namespace {

constexpr int kBaud = 115200;

Error no_port(const std::string& name, const std::string& what, const std::string& why,
              const std::string& remedy) {
  return {ErrorKind::kNoDevice, what, name, why, remedy};
}

/// Who holds a lock on the device, "weft (process 1234)", as /proc/locks says; empty where it does not.
std::string holder_of(const struct stat& device) {
  const std::string inode =
      fmt::format("{:02x}:{:02x}:{}", major(device.st_dev), minor(device.st_dev), device.st_ino);
  std::ifstream locks("/proc/locks");
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, manner, access, at;
    int process = 0;
    if (!(words >> number >> kind >> manner >> access >> process >> at)) continue;
    if (kind != "FLOCK" || at != inode || process <= 0) continue;
    std::string program = "another program";
    std::ifstream comm(fmt::format("/proc/{}/comm", process));
    std::getline(comm, program);
    return fmt::format("{} (process {})", program, process);
  }
  return {};
}

Error busy(const std::string& name, const std::string& holder) {
  return no_port(name, "the LED board is held by another program",
                 holder.empty() ? "it is not said by which" : holder,
                 "end that program, or scan through its daemon");
}

Error cannot_open(const std::string& name, int error_number) {
  if (error_number == EACCES || error_number == EPERM) {
    return no_port(name, "the LED board's port may not be opened by this user", system_reason(error_number),
                   remedy_of_access(name));
  }
  if (error_number == EBUSY) {
    struct stat facts {};
    const bool known = stat(name.c_str(), &facts) == 0;
    return busy(name, known ? holder_of(facts) : std::string());
  }
  return no_port(
      name, "the LED board is not there", system_reason(error_number),
      "plug it in, or name its port in the rig file: `ls /dev/serial/by-id` lists those there are");
}

/// Opens the device and locks it, without its serial settings being touched.
Result<Descriptor> lock_device(const std::string& name) {
  Descriptor device(name, O_RDONLY | O_NOCTTY | O_NONBLOCK);
  if (!device) return cannot_open(name, errno);
  if (flock(device.get(), LOCK_EX | LOCK_NB) == 0) return device;
  struct stat facts {};
  const bool known = fstat(device.get(), &facts) == 0;
  return busy(name, known ? holder_of(facts) : std::string());
}

/// What the kernel calls the device, "/dev/ttyACM0": libserialport 0.1.1 looks for what stands after /dev/ in
/// /sys/class/tty, so it opens none of the links that udev makes. A device without such a name keeps its own.
std::string kernel_name(const Descriptor& device, const std::string& name) {
  struct stat facts {};
  if (fstat(device.get(), &facts) != 0 || !S_ISCHR(facts.st_mode)) return name;
  std::error_code failed;
  const auto in_class = std::filesystem::read_symlink(
      fmt::format("/sys/dev/char/{}:{}", major(facts.st_rdev), minor(facts.st_rdev)), failed);
  return failed ? name : "/dev/" + in_class.filename().string();
}

UsbDevice usb_of(const sp_port* port) {
  int vendor = 0, product = 0;
  if (sp_get_port_usb_vid_pid(port, &vendor, &product) != SP_OK) return {};
  const auto text = [](const char* said) { return std::string(said ? said : ""); };
  const std::string maker = text(sp_get_port_usb_manufacturer(port)),
                    name = text(sp_get_port_usb_product(port));
  return {fmt::format("{:04x}:{:04x}", vendor, product), text(sp_get_port_usb_serial(port)),
          name.starts_with(maker) || name.empty() ? name : maker + " " + name};
}

/// "2341:0043 5573"; empty where it is no USB device.
std::string usb_identity_of(const sp_port* port) {
  const UsbDevice usb = usb_of(port);
  return usb.numbers.empty() ? "" : usb.numbers + " " + usb.serial;
}

std::vector<std::string> names_of(const std::function<bool(const sp_port*)>& is_meant) {
  std::vector<std::string> names;
  sp_port** ports = nullptr;
  if (sp_list_ports(&ports) != SP_OK) return names;
  for (sp_port** port = ports; *port != nullptr; ++port)
    if (is_meant(*port)) names.emplace_back(sp_get_port_name(*port));
  sp_free_port_list(ports);
  return names;
}

unsigned int count_ms(std::chrono::milliseconds time) {
  return static_cast<unsigned int>(std::max<std::int64_t>(1, time.count()));  // 0 would be for ever
}

}  // namespace

void SerialPort::FreePort::operator()(sp_port* port) const {
  sp_close(port);
  sp_free_port(port);
}

Result<std::unique_ptr<SerialPort>> SerialPort::open(const std::string& name) {
  auto lock = lock_device(name);
  if (!lock) return std::move(lock).error();
  std::unique_ptr<SerialPort> port(new SerialPort(name, std::move(*lock)));
  if (auto ready = port->set_up(); !ready) return std::move(ready).error();
  return port;
}

Result<void> SerialPort::set_up() {
  sp_port* port = nullptr;
  if (sp_get_port_by_name(kernel_name(lock_, name_).c_str(), &port) != SP_OK) {
    return no_port(name_, "this is not a serial port", "libserialport does not know it",
                   "name the LED board's port in the rig file: `ls /dev/serial/by-id` lists those there are");
  }
  if (sp_open(port, SP_MODE_READ_WRITE) != SP_OK) {
    const int why = sp_last_error_code();
    sp_free_port(port);
    return cannot_open(name_, why);
  }
  port_.reset(port);
  int descriptor = -1;
  const bool set = sp_set_baudrate(port, kBaud) == SP_OK && sp_set_bits(port, 8) == SP_OK &&
                   sp_set_parity(port, SP_PARITY_NONE) == SP_OK && sp_set_stopbits(port, 1) == SP_OK &&
                   sp_set_flowcontrol(port, SP_FLOWCONTROL_NONE) == SP_OK &&
                   sp_get_port_handle(port, &descriptor) == SP_OK &&
                   fcntl(descriptor, F_SETFD, FD_CLOEXEC) == 0 && ioctl(descriptor, TIOCEXCL) == 0;
  if (!set) return gone();
  return {};
}

Result<void> SerialPort::pulse_dtr() {
  constexpr auto kLow = std::chrono::milliseconds(20);  // the reset capacitor discharges in a few
  bool done = sp_set_dtr(port_.get(), SP_DTR_OFF) == SP_OK;
  std::this_thread::sleep_for(kLow);
  done = done && sp_flush(port_.get(), SP_BUF_BOTH) == SP_OK && sp_set_dtr(port_.get(), SP_DTR_ON) == SP_OK;
  if (!done) return gone();
  return {};
}

Result<void> SerialPort::write(std::span<const std::uint8_t> bytes, std::chrono::milliseconds most) {
  const int written = sp_blocking_write(port_.get(), bytes.data(), bytes.size(), count_ms(most));
  if (written < 0) return gone();
  if (static_cast<std::size_t>(written) < bytes.size()) {
    return Error{ErrorKind::kTryAgain, "the LED board's port takes no bytes", name_,
                 fmt::format("{} of {} in {} ms", written, bytes.size(), most.count()),
                 "plug the board out and in"};
  }
  return {};
}

Result<std::size_t> SerialPort::read(std::span<std::uint8_t> bytes, std::chrono::milliseconds most) {
  const int count = sp_blocking_read_next(port_.get(), bytes.data(), bytes.size(), count_ms(most));
  // A port that has gone reads as one that is silent, until it is asked how much is waiting.
  if (count < 0 || (count == 0 && !is_there())) return gone();
  return static_cast<std::size_t>(count);
}

bool SerialPort::is_there() const {
  return sp_input_waiting(port_.get()) >= 0;
}

std::string SerialPort::usb_identity() const {
  return usb_identity_of(port_.get());
}

UsbDevice SerialPort::usb() const {
  return usb_of(port_.get());
}

std::vector<std::string> SerialPort::names_of_usb(const std::string& identity) {
  return names_of([&](const sp_port* port) { return usb_identity_of(port) == identity; });
}

std::vector<std::string> SerialPort::other_boards() const {
  const std::string own = sp_get_port_name(port_.get());
  return names_of(
      [&](const sp_port* port) { return own != sp_get_port_name(port) && may_be_led_board(usb_of(port)); });
}

Error SerialPort::gone() const {
  return no_port(name_, "the LED board is gone", "its port does not exist any more",
                 "check its cable and plug it in");
}

}  // namespace weft::capture
