// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "material/read/compare.h"
#include "material/read/file_meaning.h"

// One of two maps that are compared.

namespace weft::material {

/// How sure it is that a map is of a kind.
enum class Likely { kNo, kMaybe, kYes };

/// Three values a pixel of a map, as long as it lives.
struct Triples {
  std::function<std::array<double, 3>(int x, int y)> at;
  std::function<bool(int x, int y)> are_zero;  ///< the samples, which stand for nothing then
};

struct ComparedMap {
  std::filesystem::path file;
  FileMeaning meaning;
  LoadedImage image;

  Likely is(ComparedKind kind) const;
  /// Normals with y up; linear colours. kBadData where it has no such channels.
  Result<Triples> normals() const;
  Result<Triples> colors() const;
  /// The value of a channel; of roughness its root convention, whatever the file's.
  double number(std::size_t channel, int x, int y) const;
  /// Names of the numbers that it holds; an empty one for a single channel of which nobody says what it is.
  std::vector<std::string> numbers() const;
};

Result<ComparedMap> read_compared(const std::filesystem::path& file);

/// The kind that both maps are, surely at least one of them. kUsage where that is none or more than one.
Result<ComparedKind> kind_of_both(const ComparedMap& tested, const ComparedMap& truth);

}  // namespace weft::material
