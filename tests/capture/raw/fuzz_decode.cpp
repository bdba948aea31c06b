// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as a raw file. Build it by the `fuzz` preset.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "capture/raw/decode_raw.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const int file = memfd_create("fuzz_decode", MFD_CLOEXEC);
  if (file < 0 || write(file, data, size) != static_cast<ssize_t>(size)) std::abort();
  const auto frame = weft::capture::decode_raw("/proc/self/fd/" + std::to_string(file));
  close(file);
  if (!frame) return frame.error().what.empty() ? (std::abort(), 0) : 0;
  for (const auto& row : frame->black)
    for (const float black : row)
      if (!(black >= 0 && black < frame->white && frame->white <= 65535)) std::abort();
  return 0;
}
