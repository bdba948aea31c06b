// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "virtual_rig/ptp/bytes.h"
#include "virtual_rig/ptp/codes.h"

namespace weft::virtual_rig::ptp {

using PropertyValue = std::variant<std::int64_t, std::string>;

/// How a value is encoded, as PTP numbers it.
enum class PropertyType : std::uint16_t {
  kUint8 = 2,
  kInt16 = 3,
  kUint16 = 4,
  kUint32 = 6,
  kString = 0xffff,
};

/// Which values a property takes, as PTP numbers it.
enum class PropertyForm : std::uint8_t { kAny = 0, kRange = 1, kList = 2 };

/// A property, its value, and what it may be set to.
struct Property {
  std::uint16_t code = 0;
  PropertyType type = PropertyType::kUint8;
  bool writable = true;
  PropertyValue value;
  PropertyForm form = PropertyForm::kAny;
  std::vector<PropertyValue> values;  ///< least, most and step of a range; all of a list
};

/// What may be read and set of a D5100. Not safe from several threads.
class PropertyTable {
 public:
  PropertyTable(double battery, bool dial_manual, bool raw, double clock_offset_s);

  /// Those of PTP itself, which DeviceInfo lists, or those of Nikon's, which it asks for separately.
  std::vector<std::uint16_t> codes(bool nikons) const;
  /// DevicePropDesc; nothing for a property that it has not.
  std::optional<Bytes> description(std::uint16_t code) const;
  std::optional<Bytes> value(std::uint16_t code) const;
  /// A value off the wire. Shutter time and aperture move with the dial on M alone.
  ResponseCode set(std::uint16_t code, BytesView value);

  std::int64_t number(PropertyCode code) const;
  /// As by a hand on the body.
  void turn(PropertyCode code, std::int64_t number);
  /// The dial: on M, or on P, where shutter time and aperture are the camera's.
  void turn_dial(bool manual);
  /// Shutter time one step longer, or shorter from the longest.
  void change_exposure();

  double exposure_us() const;
  double f_number() const;
  /// What pictures are taken at: auto ISO makes it four times what is set, as far as it goes.
  double taken_iso() const;
  /// Whether noise reduction has the body take a dark picture after one of this exposure.
  bool takes_dark_after() const;
  double clock_offset_s() const { return clock_offset_s_; }
  void set_clock_offset(double offset_s) { clock_offset_s_ = offset_s; }

 private:
  Property* find(std::uint16_t code);
  const Property* find(std::uint16_t code) const;
  PropertyValue shown(const Property& property) const;
  void assign(Property& property, const PropertyValue& value);

  std::vector<Property> properties_;
  double clock_offset_s_;
};

}  // namespace weft::virtual_rig::ptp
