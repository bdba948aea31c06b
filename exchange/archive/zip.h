// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"

// Zip archives whose entries are stored as they are (PKWARE, APPNOTE 6.3.10), in the two dialects that
// formats of materials ask for.

namespace weft::exchange {

enum class ZipKind {
  /// U3MA 1.1: made by 0x003F, needs 0x14, flag bit 11 alone, no extra fields, no comments, attributes 0.
  kStrict,
  /// USDZ 1.3: the bytes of every entry begin at a multiple of 64, by an extra field with the id 0x1986.
  kAligned,
};

struct ZipEntry {
  std::string name;  ///< a portable path (exchange/document.h)
  std::string_view bytes;
};

/// An archive of these entries in their order, each dated 1980-01-01. kBadData: no entries, a path that is
/// not portable, two that differ in nothing or in the case of letters alone, 4 GiB and more, above 65535
/// entries.
Result<std::string> zip_of(std::span<const ZipEntry> entries, ZipKind kind);

}  // namespace weft::exchange
