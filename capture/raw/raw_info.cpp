// SPDX-License-Identifier: Apache-2.0
#include "capture/raw/raw_info.h"

#include <utility>

#include "capture/raw/opened_raw.h"

namespace weft::capture {

Result<RawInfo> read_raw_info(const std::filesystem::path& file) {
  auto raw = open_raw(file);
  if (!raw) return std::move(raw).error();
  return std::move(raw->info);
}

}  // namespace weft::capture
