// SPDX-License-Identifier: Apache-2.0
#include "virtual_rig/ptp/properties.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "virtual_rig/ptp/clock.h"
#include "virtual_rig/ptp/dataset.h"

namespace weft::virtual_rig::ptp {
namespace {

using enum PropertyType;
using enum PropertyForm;

constexpr std::uint16_t kNikons = 0xd000;  // and above
constexpr std::int64_t kJpegFine = 2, kNef = 4;
constexpr std::int64_t kManual = 1, kProgram = 2;
constexpr double kLongExposure_us = 1e6;

std::vector<PropertyValue> numbers(const std::vector<std::int64_t>& from) {
  return {from.begin(), from.end()};
}

/// Seconds as Nikon's shutter speed has them: numerator in the upper half, denominator in the lower.
constexpr std::int64_t fraction(std::int64_t numerator, std::int64_t denominator) {
  return numerator << 16 | denominator;
}

double seconds(std::int64_t shutter) {
  return static_cast<double>(shutter >> 16) / static_cast<double>(shutter & 0xffff);
}

/// PTP's exposure time: whole tenths of a millisecond, cut off.
std::int64_t exposure_time(std::int64_t shutter) {
  return (shutter >> 16) * 10000 / (shutter & 0xffff);
}

/// 1/4000 s to 30 s in thirds of a stop.
std::vector<std::int64_t> shutter_speeds() {
  std::vector<std::int64_t> speeds;
  for (const int denominator :
       {4000, 3200, 2500, 2000, 1600, 1250, 1000, 800, 640, 500, 400, 320, 250, 200, 160, 125,
        100,  80,   60,   50,   40,   30,   25,   20,  15,  13,  10,  8,   6,   5,   4,   3})
    speeds.push_back(fraction(1, denominator));
  for (const int tenths : {25, 20, 16, 13}) speeds.push_back(fraction(10, tenths));
  speeds.push_back(fraction(1, 1));
  for (const int tenths : {13, 16, 20, 25, 30, 40, 50, 60, 80, 100, 130, 150, 200, 250, 300})
    speeds.push_back(tenths % 10 == 0 ? fraction(tenths / 10, 1) : fraction(tenths, 10));
  return speeds;
}

std::vector<std::int64_t> exposure_times() {
  std::vector<std::int64_t> times;
  for (const std::int64_t speed : shutter_speeds()) times.push_back(exposure_time(speed));
  return times;
}

std::int64_t nearest_speed(std::int64_t time) {
  const std::vector<std::int64_t> speeds = shutter_speeds();
  return *std::ranges::min_element(
      speeds, {}, [time](std::int64_t speed) { return std::abs(exposure_time(speed) - time); });
}

void put(ByteWriter& writer, PropertyType type, const PropertyValue& value) {
  if (type == kString) return put_string(writer, std::get<std::string>(value));
  const std::int64_t number = std::get<std::int64_t>(value);
  if (type == kUint8)
    writer.put(static_cast<std::uint8_t>(number));
  else if (type == kUint32)
    writer.put(static_cast<std::uint32_t>(number));
  else
    writer.put(static_cast<std::uint16_t>(number));
}

std::optional<PropertyValue> get(PropertyType type, BytesView bytes) {
  ByteReader reader(bytes);
  const auto widened = [](auto number) -> std::optional<PropertyValue> {
    if (!number) return std::nullopt;
    return PropertyValue(std::int64_t{*number});
  };
  switch (type) {
    case kUint8:
      return widened(reader.get<std::uint8_t>());
    case kInt16:
      return widened(reader.get<std::int16_t>());
    case kUint16:
      return widened(reader.get<std::uint16_t>());
    case kUint32:
      return widened(reader.get<std::uint32_t>());
    case kString:
      break;
  }
  return get_string(reader);
}

bool allows(const Property& property, const PropertyValue& value) {
  if (property.form == kAny) return true;
  if (property.form == kList) return std::ranges::count(property.values, value) > 0;
  return value >= property.values[0] && value <= property.values[1];
}

Property list(PropertyCode code, PropertyType type, std::int64_t value,
              const std::vector<std::int64_t>& values) {
  return {code, type, true, value, kList, numbers(values)};
}

Property range(PropertyCode code, std::int64_t value, std::int64_t most) {
  return {code, kUint8, true, value, kRange, numbers({0, most, 1})};
}

Property fixed(Property property) {
  property.writable = false;
  return property;
}

std::vector<Property> d5100() {
  constexpr std::int64_t kTenth = fraction(1, 10);
  return {
      fixed(range(kBatteryLevel, 100, 100)),
      {kImageSize, kString, true, "4928x3264", kList, {"4928x3264", "3696x2448", "2464x1632"}},
      list(kImageQuality, kUint8, kNef, {0, 1, kJpegFine, kNef, 5, 6, 7}),
      list(kWhiteBalance, kUint16, 4, {2, 4, 5, 6, 7, 0x8010, 0x8011, 0x8013}),
      list(kFNumber, kUint16, 800,
           {350, 400, 450, 500, 560, 630, 710, 800, 900, 1000, 1100, 1300, 1400, 1600, 1800, 2000, 2200}),
      fixed({kFocalLength, kUint32, true, 5000, kRange, numbers({5000, 5000, 1})}),
      fixed(list(kFocusMode, kUint16, 1, {1, 0x8010, 0x8011, 0x8012, 0x8013})),
      list(kMeteringMode, kUint16, 3, {2, 3, 4}),
      list(kExposureTime, kUint32, exposure_time(kTenth), exposure_times()),
      fixed(list(kExposureProgram, kUint16, kManual, {kManual, kProgram, 3, 4, 0x8010})),
      list(kIso, kUint16, 100,
           {100, 125, 160, 200, 250, 320, 400, 500, 640, 800, 1000, 1250, 1600, 2000, 2500, 3200, 4000, 5000,
            6400}),
      list(kExposureBias, kInt16, 0, {-1000, -666, -333, 0, 333, 666, 1000}),
      {kDateTime, kString, true, "", kAny, {}},
      list(kCaptureMode, kUint16, 1, {1, 2, 0x8011}),
      {kBurstNumber, kUint16, true, 1, kRange, numbers({1, 100, 1})},
      range(kAutoIso, 0, 1),
      range(kLongExposureNoise, 0, 1),
      range(kHighIsoNoise, 0, 3),
      range(kReleaseWithoutCard, 0, 1),
      list(kShutterSpeed, kUint32, kTenth, shutter_speeds()),
      fixed(range(kExternalPower, 0, 1)),
      fixed(range(kShotsLeft, 39, 99)),
      range(kRecordingMedia, 0, 2),
      range(kDLighting, 0, 5),
      fixed(range(kFocusMode2, 3, 4)),  // 3: MF by the lens's switch
      range(kIsoAuto, 0, 1),
      range(kRemoteTimeout, 3, 3),
      fixed(range(kLiveViewStatus, 0, 1)),
      fixed({kLiveViewProhibited, kUint32, true, std::int64_t{0}, kAny, {}}),
  };
}

}  // namespace

PropertyTable::PropertyTable(double battery, bool dial_manual, bool raw, double clock_offset_s)
    : properties_(d5100()), clock_offset_s_(clock_offset_s) {
  turn(kBatteryLevel, std::lround(100 * std::clamp(battery, 0., 1.)));
  turn(kImageQuality, raw ? kNef : kJpegFine);
  turn_dial(dial_manual);
}

Property* PropertyTable::find(std::uint16_t code) {
  const auto found = std::ranges::find(properties_, code, &Property::code);
  return found == properties_.end() ? nullptr : &*found;
}

const Property* PropertyTable::find(std::uint16_t code) const {
  return const_cast<PropertyTable*>(this)->find(code);
}

PropertyValue PropertyTable::shown(const Property& property) const {
  if (property.code != kDateTime) return property.value;
  return ptp_time(read_clock(std::chrono::system_clock::now(), clock_offset_s_));
}

std::vector<std::uint16_t> PropertyTable::codes(bool nikons) const {
  std::vector<std::uint16_t> codes;
  for (const Property& property : properties_)
    if ((property.code >= kNikons) == nikons) codes.push_back(property.code);
  return codes;
}

std::optional<Bytes> PropertyTable::description(std::uint16_t code) const {
  const Property* const property = find(code);
  if (!property) return std::nullopt;
  ByteWriter writer;
  writer.put(code)
      .put(static_cast<std::uint16_t>(property->type))
      .put(static_cast<std::uint8_t>(property->writable));
  put(writer, property->type, shown(*property));  // from the factory
  put(writer, property->type, shown(*property));
  writer.put(static_cast<std::uint8_t>(property->form));
  if (property->form == kList) writer.put(static_cast<std::uint16_t>(property->values.size()));
  for (const PropertyValue& value : property->values) put(writer, property->type, value);
  return writer.take();
}

std::optional<Bytes> PropertyTable::value(std::uint16_t code) const {
  const Property* const property = find(code);
  if (!property) return std::nullopt;
  ByteWriter writer;
  put(writer, property->type, shown(*property));
  return writer.take();
}

ResponseCode PropertyTable::set(std::uint16_t code, BytesView bytes) {
  Property* const property = find(code);
  if (!property) return kPropertyNotSupported;
  if (!property->writable) return kAccessDenied;
  const std::optional<PropertyValue> value = get(property->type, bytes);
  if (!value) return kInvalidPropFormat;
  if (!allows(*property, *value)) return kInvalidPropValue;
  if (code == kDateTime) {
    const std::optional<double> offset_s = offset_when_set_to(std::get<std::string>(*value));
    if (!offset_s) return kInvalidPropValue;
    clock_offset_s_ = *offset_s;
  }
  assign(*property, *value);
  return kOk;
}

/// Keeps the two shutter times of a body at one, and its two names of auto ISO.
void PropertyTable::assign(Property& property, const PropertyValue& value) {
  property.value = value;
  if (property.code == kShutterSpeed)
    find(kExposureTime)->value = exposure_time(std::get<std::int64_t>(value));
  else if (property.code == kExposureTime)
    find(kShutterSpeed)->value = nearest_speed(std::get<std::int64_t>(value));
  else if (property.code == kAutoIso || property.code == kIsoAuto)
    find(kAutoIso)->value = find(kIsoAuto)->value = value;
}

std::int64_t PropertyTable::number(PropertyCode code) const {
  return std::get<std::int64_t>(find(code)->value);
}

void PropertyTable::turn(PropertyCode code, std::int64_t number) {
  assign(*find(code), number);
}

void PropertyTable::turn_dial(bool manual) {
  turn(kExposureProgram, manual ? kManual : kProgram);
  for (const PropertyCode code : {kShutterSpeed, kExposureTime, kFNumber}) find(code)->writable = manual;
}

void PropertyTable::change_exposure() {
  const std::vector<std::int64_t> speeds = shutter_speeds();
  auto speed = std::ranges::find(speeds, number(kShutterSpeed));
  turn(kShutterSpeed, speed + 1 == speeds.end() ? speed[-1] : speed[1]);
}

double PropertyTable::exposure_us() const {
  return seconds(number(kShutterSpeed)) * 1e6;
}

double PropertyTable::f_number() const {
  return static_cast<double>(number(kFNumber)) / 100;
}

double PropertyTable::taken_iso() const {
  const std::int64_t set = number(kIso);
  if (number(kIsoAuto) == 0) return static_cast<double>(set);
  return static_cast<double>(std::min(4 * set, std::get<std::int64_t>(find(kIso)->values.back())));
}

bool PropertyTable::takes_dark_after() const {
  return number(kLongExposureNoise) != 0 && exposure_us() > kLongExposure_us;
}

}  // namespace weft::virtual_rig::ptp
