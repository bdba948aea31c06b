// SPDX-License-Identifier: Apache-2.0
#include "simulator/spectra/spectrum.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

#include "core/base/files.h"

namespace weft::simulator {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;

Error bad_spectrum(std::string where, std::string why) {
  return {ErrorKind::kBadData, "this is no spectrum", std::move(where), std::move(why),
          fmt::format("give {} values between 0 and 1, from {} to {} nm every {} nm", Spectrum::kSamples,
                      Spectrum::kFirst_nm, Spectrum::nm(Spectrum::kSamples - 1), Spectrum::kStep_nm)};
}

bool is_share(double value) {
  return value >= 0 && value <= 1;  // false for NaN
}

/// Takes the next word off the front of a line; empty at its end.
std::string_view next_word(std::string_view& line) {
  constexpr std::string_view kBlank = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

std::optional<double> number_of(std::string_view word) {
  double value = 0;
  const auto [end, failure] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (failure != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace

Spectrum flat_spectrum(double share) {
  Spectrum spectrum;
  spectrum.samples.fill(share);
  return spectrum;
}

Result<Spectrum> spectrum_of(std::span<const double> samples, const std::string& where) {
  if (samples.size() != Spectrum::kSamples)
    return bad_spectrum(where, fmt::format("it has {} values", samples.size()));
  Spectrum spectrum;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (!is_share(samples[i])) {
      return bad_spectrum(
          where, fmt::format("the value {} at {} nm is not from 0 to 1", samples[i], Spectrum::nm(i)));
    }
    spectrum.samples[i] = samples[i];
  }
  return spectrum;
}

Result<Spectrum> parse_spectrum(std::string_view table, const std::string& where) {
  Spectrum spectrum;
  std::size_t count = 0;
  for (int number = 1; !table.empty(); ++number) {
    std::string_view line = table.substr(0, table.find('\n'));
    table.remove_prefix(std::min(line.size() + 1, table.size()));
    line = line.substr(0, line.find('#'));
    const std::string_view first = next_word(line);
    if (first.empty()) continue;

    const std::string place = fmt::format("{}:{}", where, number);
    const auto nm = number_of(first);
    const auto value = number_of(next_word(line));
    if (!nm || !value || !next_word(line).empty())
      return bad_spectrum(place, "the line is not a wavelength and a value");
    if (count == Spectrum::kSamples) return bad_spectrum(place, "there are more lines than wavelengths");
    if (*nm != Spectrum::nm(count))
      return bad_spectrum(place, fmt::format("the wavelength is {}, not {} nm", *nm, Spectrum::nm(count)));
    if (!is_share(*value)) return bad_spectrum(place, fmt::format("the value {} is not from 0 to 1", *value));
    spectrum.samples[count++] = *value;
  }
  if (count != Spectrum::kSamples) return bad_spectrum(where, fmt::format("it has {} values", count));
  return spectrum;
}

Result<Spectrum> read_spectrum(const std::filesystem::path& file) {
  const auto table = read_text(file, kMostBytes);
  if (!table) return table.error();
  return parse_spectrum(*table, file.string());
}

Result<std::vector<Spectrum>> read_spectra(const std::filesystem::path& folder, int count) {
  std::vector<Spectrum> spectra;
  for (int i = 1; i <= count; ++i) {
    const auto spectrum = read_spectrum(folder / fmt::format("{:02}.txt", i));
    if (!spectrum) return spectrum.error();
    spectra.push_back(*spectrum);
  }
  return spectra;
}

}  // namespace weft::simulator
