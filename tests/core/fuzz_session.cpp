// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as a session.json.
#include <sys/stat.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/rig/session.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::filesystem::path folder = "/dev/shm/weft_fuzz_session_" + std::to_string(getpid());
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "session.json", std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  const auto session = weft::read_session(folder);
  if (!session) return session.error().what.empty() ? (std::abort(), 0) : 0;
  for (const weft::Shot& shot : session->shots) {
    const auto file = session->path_of(shot).lexically_normal();
    if (!file.string().starts_with(folder.string())) std::abort();
    const bool is_timed = shot.exposure_us > 0 || (!session->is_of_rig() && shot.exposure_us == 0);
    if (!is_timed || shot.led < 0) std::abort();
  }
  if (const auto& reading = session->photographs; reading && !(reading->ambient >= 0)) std::abort();
  const auto written = weft::write_session(*session);
  if (!written || !weft::read_session(folder)) std::abort();
  return 0;
}
