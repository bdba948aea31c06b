// SPDX-License-Identifier: Apache-2.0
// The body's live view: the mirror is up and its finder shows what the sensor sees.
#include <algorithm>
#include <chrono>
#include <iterator>

#include "virtual_rig/ptp/body.h"

namespace weft::virtual_rig::ptp {
namespace {

using namespace std::chrono_literals;

constexpr auto kMirror = 300ms;      // until the first picture is there
constexpr auto kPictureEach = 66ms;  // 15 a second
constexpr std::size_t kHeadBytes = 384;
constexpr std::int64_t kPictureWaits = 1 << 12, kIsBusy = 1 << 15;  // bits of D1A4

/// What stands for the picture of a body without a finder: a file that is a JPEG by its ends.
constexpr std::uint8_t kBlack[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F',  0,
                                   1,    1,    0,    0,    1, 0,  1,   0,   0,   0xff, 0xd9};

}  // namespace

Answer PtpBody::start_live_view() {
  if (live_) return {};
  if (busy()) return {.code = kDeviceBusy};
  tell_prohibitions();
  if (properties_.number(kLiveViewProhibited) != 0) return {.code = kInvalidStatus};
  live_ = true;
  properties_.turn(kLiveViewStatus, 1);
  const auto now = RigClock::now();
  busy_until_ = next_look_ = now + kMirror;
  live_until_ =
      now + std::chrono::duration_cast<RigClock::duration>(std::chrono::duration<double>(options_.finder_s));
  return {};
}

Answer PtpBody::end_live_view() {
  live_ = false;
  properties_.turn(kLiveViewStatus, 0);
  return {};
}

Answer PtpBody::live_picture() {
  const auto now = RigClock::now();
  if (now >= live_until_) end_live_view();
  if (!live_ || never_live_) return {.code = kNotLiveView};
  if (now < next_look_) return {.code = kDeviceBusy};
  next_look_ = now + kPictureEach;
  ++looks_;
  if (faults_.take(PtpFault::kLiveStalls, looks_)) return {.delivery = Delivery::kNothing};
  if (faults_.take(PtpFault::kNeverLive, looks_)) never_live_ = true;
  if (faults_.take(PtpFault::kLiveEnds, looks_)) end_live_view();
  if (!live_ || never_live_) return {.code = kNotLiveView};
  Bytes bytes(kHeadBytes);
  const Bytes picture = options_.finder ? options_.finder() : Bytes(std::begin(kBlack), std::end(kBlack));
  bytes.insert(bytes.end(), picture.begin(), picture.end());
  return {.data = Payload::of(std::move(bytes))};
}

/// D1A4: what keeps it from live view.
void PtpBody::tell_prohibitions() {
  const bool waits = std::ranges::any_of(
      objects_, [](const auto& object) { return object.second.facts.storage == kMemory; });
  properties_.turn(kLiveViewProhibited, (waits ? kPictureWaits : 0) | (exposing_ || stuck_ ? kIsBusy : 0));
}

}  // namespace weft::virtual_rig::ptp
