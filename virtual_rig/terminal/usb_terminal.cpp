// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/terminal/usb_terminal.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>

#include <utility>

#include "core/base/files.h"

namespace weft::virtual_rig {
namespace {

namespace fs = std::filesystem;

/// A link in the place of one that is there.
void make_link(const fs::path& to, const fs::path& link) {
  fs::create_directories(link.parent_path());
  fs::remove(link);
  fs::create_symlink(to, link);
}

void write_attributes(const fs::path& device, int number, const std::string& serial) {
  const std::pair<const char*, std::string> attributes[] = {{"busnum", "1"},
                                                            {"devnum", std::to_string(number + 2)},
                                                            {"idVendor", "2341"},
                                                            {"idProduct", "0043"},
                                                            {"manufacturer", "Arduino"},
                                                            {"product", "Uno"},
                                                            {"serial", serial}};
  for (const auto& [name, value] : attributes) {
    if (Result<void> written = write_file(device / name, value + "\n"); !written) {
      throw fs::filesystem_error(written.error().message(), device / name, {});
    }
  }
}

}  // namespace

Result<std::unique_ptr<UsbTerminal>> UsbTerminal::make(const fs::path& machine, int number,
                                                       const std::string& serial,
                                                       const fs::path& terminal) try {
  struct stat facts {};
  if (::stat(terminal.c_str(), &facts) != 0) throw fs::filesystem_error("no terminal", terminal, {});
  std::unique_ptr<UsbTerminal> usb(new UsbTerminal);
  const std::string name = fmt::format("ttyACM{}", number);
  const fs::path sys = machine / "sys";
  usb->device_ = sys / "devices/usb1" / fmt::format("1-{}", number);
  usb->in_class_ = sys / "class/tty" / name;
  usb->by_number_ = sys / "dev/char" / fmt::format("{}:{}", major(facts.st_rdev), minor(facts.st_rdev));
  usb->node_ = machine / "dev" / name;
  usb->udev_link_ = machine / "dev/weft-led";

  const fs::path interface = usb->device_ / fmt::format("1-{}:1.0", number);
  const fs::path tty = interface / "tty" / name;
  fs::create_directories(tty);
  write_attributes(usb->device_, number, serial);
  make_link("../..", tty / "device");
  make_link(fs::relative(tty, usb->in_class_.parent_path()), usb->in_class_);
  make_link(fs::relative(tty, usb->by_number_.parent_path()), usb->by_number_);
  make_link(terminal, usb->node_);
  make_link(name, usb->udev_link_);
  return usb;
} catch (const fs::filesystem_error& failed) {
  return Error{ErrorKind::kCannotCreate, "the virtual board's USB device cannot be made", machine.string(),
               failed.what(), "choose a folder that can be written"};
}

UsbTerminal::~UsbTerminal() {
  std::error_code ignored;
  for (const fs::path& link : {in_class_, by_number_, node_}) fs::remove(link, ignored);
  if (fs::read_symlink(udev_link_, ignored) == node_.filename()) fs::remove(udev_link_, ignored);
  fs::remove_all(device_, ignored);
}

}  // namespace weft::virtual_rig
