// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

// Curves over the visible wavelengths: what a light sends, a filter passes, a surface reflects.

namespace weft::simulator {

/// 36 samples from 380 to 730 nm, each between 0 and 1: a share of what arrives, or for a light of its peak.
struct Spectrum {
  static constexpr std::size_t kSamples = 36;
  static constexpr int kFirst_nm = 380;
  static constexpr int kStep_nm = 10;
  static constexpr int nm(std::size_t sample) { return kFirst_nm + kStep_nm * static_cast<int>(sample); }

  std::array<double, kSamples> samples{};

  bool operator==(const Spectrum&) const = default;
};

/// The same at all wavelengths. `share` from 0 to 1.
Spectrum flat_spectrum(double share);

/// A curve from its 36 numbers. kBadData if there are more or fewer, or if one is not between 0 and 1;
/// `where` names the numbers in errors.
Result<Spectrum> spectrum_of(std::span<const double> samples, const std::string& where);

/// A curve from a table: a line `nm value` for each wavelength in rising order; what follows a # is a
/// comment. kBadData names the first line that is wrong.
Result<Spectrum> parse_spectrum(std::string_view table, const std::string& where);
Result<Spectrum> read_spectrum(const std::filesystem::path& file);

/// The curves of a chart: 01.txt, 02.txt and so on to `count` (at most 99) of a folder.
Result<std::vector<Spectrum>> read_spectra(const std::filesystem::path& folder, int count);

}  // namespace weft::simulator
