// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as what a host sends a camera over PTP/IP. Build it by the `fuzz` preset.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "virtual_rig/ptp/network_link.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft::virtual_rig;
  ptp::BytesView rest(data, size);
  const ptp::ReadBytes read = [&rest](std::span<std::uint8_t> into) {
    if (rest.size() < into.size()) return false;
    std::ranges::copy(rest.first(into.size()), into.begin());
    rest = rest.subspan(into.size());
    return true;
  };
  const ptp::WriteBytes write = [](std::span<const ptp::BytesView> parts) {
    if (parts.empty() || parts[0].size() < 8) std::abort();
    return true;
  };
  ptp::PtpBody body({}, [](const CameraExposure&) -> weft::Result<ptp::Bytes> { return ptp::Bytes(100); });
  ptp::serve_operations(read, write, body);
  return 0;
}
