// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "core/image/image.h"
#include "exchange/archive/zip.h"

// Whether what the writers of exchange/ wrote keeps the rules of its format. Each refusal is kBadData.

namespace weft::exchange {

/// Whether the container is whole: header, lengths and padding of its two chunks, JSON that is an asset 2.0,
/// views inside the buffer and apart, accessors inside their views and aligned, images that begin as their
/// type does, indices that point at something. `where` is the JSON pointer.
Result<void> check_glb(std::string_view bytes);

/// Whether a text is a U3M 1.1 document: members, ranges and words of its schema, and beyond that shares with
/// a sum of 1. `pixels_of` gives the pixels of a file that it names, where they are known, and dpi must agree
/// with them. `where` is the JSON pointer.
Result<void> check_u3m(std::string_view text, const std::map<std::string, Size, std::less<>>& pixels_of = {});

/// Whether `bytes` are an archive as zip_of() writes it: both headers of every entry agree and follow the
/// dialect, checksums are right, nothing lies before, between or behind. `where` is the entry.
Result<void> check_zip(std::string_view bytes, ZipKind kind);

}  // namespace weft::exchange
