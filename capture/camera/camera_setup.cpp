// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/camera_setup.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "core/base/iso_time.h"
#include "core/base/number.h"
#include "core/rig/same_camera.h"

namespace weft::capture {
namespace {

/// The first word of a file, "" if it has none.
std::string word_in(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string word;
  in >> word;
  return word;
}

constexpr double kMostOff = 0.01;

std::optional<double> plain_number(std::string_view text) {
  const std::optional<double> value = as_number(text);
  return value && *value > 0 ? value : std::nullopt;
}

using Steady = std::chrono::steady_clock;

/// What is plugged in and may be the camera, the wanted port first.
Result<std::vector<CameraAddress>> candidates(const CameraProfile& profile, const WantedCamera& wanted) {
  if (wanted.port.starts_with("ptpip:"))
    return std::vector<CameraAddress>{{profile.ptpip_model, wanted.port}};
  Result<std::vector<CameraAddress>> found = GphotoCamera::on_usb();
  if (!found) return found;
  std::vector<std::string> others;
  std::erase_if(*found, [&](const CameraAddress& address) {
    const bool known = std::ranges::count(profile.usb_models, address.model) > 0;
    if (!known) others.push_back(address.model);
    return !known;
  });
  std::stable_partition(found->begin(), found->end(),
                        [&](const CameraAddress& address) { return address.port == wanted.port; });
  // Without a number, a port that was named means the camera that is there and no other.
  const bool named = wanted.port.size() > std::string_view("usb:").size();
  if (wanted.serial.empty() && named)
    std::erase_if(*found, [&](const CameraAddress& a) { return a.port != wanted.port; });
  if (!found->empty()) return found;
  return Error{ErrorKind::kNoDevice, fmt::format("no {} on USB", profile.model), wanted.port,
               others.empty() ? "there is no camera" : fmt::format("there is {}", fmt::join(others, ", ")),
               "switch the camera on and check its cable"};
}

/// A body as a person tells it from others; one that another program holds cannot be asked.
std::string name_of(const CameraAddress& address, const CameraProfile& profile) {
  const auto camera = GphotoCamera::open(address);
  const Result<std::string> serial = camera ? serial_of(**camera, profile) : camera.error();
  if (serial) return *serial;
  const std::string told = usb_serial_of(address.port);
  return told.empty() ? "the one at " + address.port : told;
}

Error which_of(const std::vector<CameraAddress>& addresses, const CameraProfile& profile) {
  std::vector<std::string> names;
  for (const CameraAddress& address : addresses) names.push_back(name_of(address, profile));
  return {ErrorKind::kBadData, fmt::format("there are {} cameras that may be the rig's", names.size()),
          "usb:", fmt::format("they have the serial numbers {}", fmt::join(names, ", ")),
          "write the rig's in its rig file: serial = \"...\" below [camera]"};
}

Result<void> check_model(GphotoCamera& camera, const CameraProfile& profile) {
  const Result<std::string> model = camera.value(profile.widgets.model);
  if (!model) return model.error();
  if (*model == profile.model) return {};
  return Error{ErrorKind::kBadData, "this is another camera than the profile's", camera.address().port,
               fmt::format("a {}, not a {}", *model, profile.model),
               "connect the rig's camera, or name its profile in the rig file"};
}

Result<void> check_by_hand(GphotoCamera& camera, const CameraProfile::ByHand& demand) {
  const Result<std::string> value = camera.value(demand.widget);
  if (!value) return value.error();
  if (std::ranges::count(demand.values, *value) > 0) return {};
  return Error{ErrorKind::kBadData, demand.says, camera.address().port,
               fmt::format("{} is {}", demand.widget, *value), demand.remedy};
}

Result<void> check_battery(GphotoCamera& camera, const CameraProfile& profile) {
  const Result<double> left = battery_of(camera, profile);
  if (!left) return left.error();
  if (*left >= profile.least_battery) return {};
  return Error{
      ErrorKind::kBadData, "the camera's battery is low", camera.address().port,
      fmt::format("{:.0f} percent are left, {:.0f} are needed", 100 * *left, 100 * profile.least_battery),
      "charge the battery or use the mains adapter"};
}

/// Sets a widget to the choice nearest to a number; what the choice is worth.
Result<double> set_nearest(GphotoCamera& camera, const std::string& widget, double wanted, const char* name,
                           std::optional<double> (*value_of)(std::string_view)) {
  const auto listed = camera.choices(widget);
  if (!listed) return listed.error();
  const Result<Choice> choice = nearest_choice(choices_of(*listed, value_of), wanted, name);
  if (!choice) return choice.error();
  if (Result<void> set = camera.set(widget, choice->text); !set) return std::move(set).error();
  return choice->value;
}

Result<double> read_number(GphotoCamera& camera, const std::string& widget,
                           std::optional<double> (*value_of)(std::string_view)) {
  const Result<std::string> text = camera.value(widget);
  if (!text) return text.error();
  return value_of(*text).value_or(0);
}

std::optional<double> clock_of(GphotoCamera& camera, const std::string& widget) {
  const Result<std::string> text = camera.value(widget);
  const std::optional<double> seconds = text ? as_number(*text) : std::nullopt;
  return seconds && *seconds > 0 ? seconds : std::nullopt;
}

}  // namespace

std::string usb_serial_of(const std::string& port, const std::filesystem::path& devices) {
  int bus = 0, address = 0;
  if (std::sscanf(port.c_str(), "usb:%d,%d", &bus, &address) != 2) return "";
  std::error_code failed;
  for (const auto& device : std::filesystem::directory_iterator(devices, failed)) {
    if (word_in(device.path() / "busnum") == std::to_string(bus) &&
        word_in(device.path() / "devnum") == std::to_string(address))
      return word_in(device.path() / "serial");
  }
  return "";
}

std::optional<double> shutter_us_of(std::string_view text) {
  if (text.ends_with('s')) text.remove_suffix(1);
  const std::size_t slash = text.find('/');
  const auto over = plain_number(text.substr(0, slash));
  const auto under =
      slash == std::string_view::npos ? std::optional(1.0) : plain_number(text.substr(slash + 1));
  if (!over || !under) return {};
  return 1e6 * *over / *under;
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with("f/")) text.remove_prefix(2);
  return plain_number(text);
}

std::vector<Choice> choices_of(const std::vector<std::string>& listed,
                               std::optional<double> (*value_of)(std::string_view)) {
  std::vector<Choice> choices;
  for (const std::string& text : listed) {
    if (const auto value = value_of(text)) choices.push_back({text, *value});
  }
  std::ranges::stable_sort(choices, {}, &Choice::value);
  return choices;
}

Result<Choice> nearest_choice(const std::vector<Choice>& choices, double wanted, const std::string& name) {
  const auto off = [wanted](const Choice& choice) { return std::abs(choice.value - wanted); };
  const auto nearest = std::ranges::min_element(choices, {}, off);
  if (nearest != choices.end() && off(*nearest) <= kMostOff * wanted) return *nearest;

  std::string sides;
  const auto above = std::ranges::upper_bound(choices, wanted, {}, &Choice::value);
  if (above != choices.begin()) sides = std::prev(above)->text;
  if (above != choices.end()) sides += (sides.empty() ? "" : " and ") + above->text;
  return Error{ErrorKind::kBadData, "the camera has no such " + name, fmt::format("{:.10g}", wanted),
               sides.empty() ? "it lists none" : "the nearest are " + sides,
               sides.empty()
                   ? "set the camera's mode dial to M and fit the lens that the rig was calibrated with"
                   : "ask for one of those"};
}

Result<std::string> serial_of(GphotoCamera& camera, const CameraProfile& profile) {
  Result<std::string> serial = camera.value(profile.widgets.serial);
  if (serial) serial->erase(0, serial->find_first_not_of('0'));
  return serial;
}

Result<std::unique_ptr<GphotoCamera>> open_camera(const CameraProfile& profile, const WantedCamera& wanted) {
  auto addresses = candidates(profile, wanted);
  if (!addresses) return addresses.error();
  if (wanted.serial.empty() && addresses->size() > 1) return which_of(*addresses, profile);
  // Where the kernel knows which one it is, no other is opened: it may be another rig's.
  const auto is_another = [&](const CameraAddress& address) {
    const std::string told = usb_serial_of(address.port);
    return told.empty() || !same_serial(told, wanted.serial);
  };
  if (!std::ranges::all_of(*addresses, is_another)) std::erase_if(*addresses, is_another);
  std::vector<std::string> others;
  std::optional<Error> trouble;
  for (const CameraAddress& address : *addresses) {
    auto camera = GphotoCamera::open(address);
    if (!camera) {
      trouble = std::move(camera).error();
      continue;
    }
    const Result<std::string> serial = serial_of(**camera, profile);
    if (!serial) return serial.error();
    if (!same_serial(*serial, wanted.serial)) {
      others.push_back(*serial);
      continue;
    }
    if (Result<void> right = check_model(**camera, profile); !right) return std::move(right).error();
    return camera;
  }
  if (trouble) return *trouble;
  return Error{ErrorKind::kBadData, "this is another camera than the rig's", wanted.port,
               fmt::format("serial number {}, not {}", fmt::join(others, ", "), wanted.serial),
               "connect the rig's camera, or calibrate the rig with this one"};
}

Result<void> check_body(GphotoCamera& camera, const CameraProfile& profile) {
  for (const CameraProfile::ByHand& demand : profile.by_hand) {
    if (Result<void> right = check_by_hand(camera, demand); !right) return right;
  }
  return check_battery(camera, profile);
}

Result<void> lock_settings(GphotoCamera& camera, const CameraProfile& profile) {
  for (const auto& [widget, value] : profile.set) {
    if (Result<void> set = camera.set(widget, value); !set) return set;
  }
  for (const auto& [widget, value] : profile.set_where_there) {
    if (!camera.has(widget)) continue;
    if (Result<void> set = camera.set(widget, value); !set) return set;
  }
  return {};
}

Result<double> battery_of(GphotoCamera& camera, const CameraProfile& profile) {
  if (profile.widgets.battery.empty()) return 1.0;
  const Result<std::string> text = camera.value(profile.widgets.battery);
  if (!text) return text.error();
  const std::string_view number = *text;
  if (const auto percent = as_number(number.substr(0, number.find('%'))))
    return std::clamp(*percent / 100, 0.0, 1.0);
  return *text == "Low" ? 0.0 : 1.0;  // bodies that have words only
}

Result<int> drop_old_photographs(GphotoCamera& camera) {
  int dropped = 0;
  const auto end = Steady::now() + std::chrono::seconds(2);
  for (int quiet = 0; quiet < 2 && Steady::now() < end;) {
    const auto event = camera.wait_for_event(20);
    if (!event) return event.error();
    quiet = event->quiet ? quiet + 1 : 0;
    if (!event->file) continue;
    camera.forget(*event->file);
    ++dropped;
  }
  return dropped;
}

Result<ExposureSettings> exposure_of(GphotoCamera& camera, const CameraProfile& profile) {
  const auto& widgets = profile.widgets;
  ExposureSettings settings;
  const Result<double> shutter = read_number(camera, widgets.shutter, &shutter_us_of);
  if (!shutter) return shutter.error();
  settings.exposure_us = *shutter;
  const Result<double> iso = read_number(camera, widgets.iso, &number_of);
  if (!iso) return iso.error();
  settings.iso = *iso;
  settings.f_number = 0;  // nobody knows
  if (widgets.f_number.empty()) return settings;
  const Result<double> f_number = read_number(camera, widgets.f_number, &number_of);
  if (!f_number) return f_number.error();
  settings.f_number = *f_number;
  return settings;
}

Result<ExposureSettings> set_exposure(GphotoCamera& camera, const CameraProfile& profile,
                                      const ExposureSettings& wanted) {
  const auto& widgets = profile.widgets;
  ExposureSettings settings = wanted;
  const auto shutter =
      set_nearest(camera, widgets.shutter, wanted.exposure_us, "exposure in us", &shutter_us_of);
  if (!shutter) return shutter.error();
  settings.exposure_us = *shutter;
  const auto iso = set_nearest(camera, widgets.iso, wanted.iso, "ISO", &number_of);
  if (!iso) return iso.error();
  settings.iso = *iso;
  if (widgets.f_number.empty()) return settings;
  const auto f_number = set_nearest(camera, widgets.f_number, wanted.f_number, "f-number", &number_of);
  if (!f_number) return f_number.error();
  settings.f_number = *f_number;
  return settings;
}

Result<std::vector<double>> shutter_times_us(GphotoCamera& camera, const CameraProfile& profile) {
  const auto listed = camera.choices(profile.widgets.shutter);
  if (!listed) return listed.error();
  std::vector<double> times;
  for (const Choice& choice : choices_of(*listed, &shutter_us_of)) times.push_back(choice.value);
  return times;
}

std::optional<CameraClock> read_clock(GphotoCamera& camera, const CameraProfile& profile, bool watched) {
  const std::string& widget = profile.widgets.clock;
  if (widget.empty()) return {};
  double before = seconds_since_1970();
  const auto first = clock_of(camera, widget);
  if (!first) return {};
  const double glanced = seconds_since_1970();
  if (!watched) return CameraClock{*first + 0.5 - (before + glanced) / 2, 0.5 + (glanced - before) / 2};
  const auto end = Steady::now() + std::chrono::milliseconds(1500);
  while (Steady::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const double asked = seconds_since_1970();
    const auto now = clock_of(camera, widget);
    if (!now) return {};
    const double answered = seconds_since_1970();
    if (*now != *first) return CameraClock{*now - (before + answered) / 2, (answered - before) / 2};
    before = asked;
  }
  return {};
}

}  // namespace weft::capture
