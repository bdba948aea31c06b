// SPDX-License-Identifier: Apache-2.0
#include "simulator/spectra/spectrum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "tests/simulator/spectra/tables.h"

namespace weft::simulator {
namespace {

using testing::HasSubstr;

std::string table_of(double value, std::size_t lines = Spectrum::kSamples) {
  std::string table = "# made here\n";
  for (std::size_t i = 0; i < lines; ++i)
    table += std::to_string(Spectrum::nm(i)) + " " + std::to_string(value) + "  # a sample\n";
  return table;
}

TEST(Spectrum, IsReadFromATableWithComments) {
  const auto spectrum = parse_spectrum(table_of(0.25), "quarter.txt");
  ASSERT_TRUE(spectrum) << spectrum.error().message();
  EXPECT_EQ(*spectrum, flat_spectrum(0.25));
}

TEST(Spectrum, IsReadFromLinesThatEndAsOnWindowsAndWithoutALastLineEnd) {
  std::string table = table_of(0.5);
  table.pop_back();
  for (std::size_t at = 0; (at = table.find('\n', at)) != table.npos; at += 2) table.insert(at, "\r");
  const auto spectrum = parse_spectrum(table, "half.txt");
  ASSERT_TRUE(spectrum) << spectrum.error().message();
  EXPECT_EQ(*spectrum, flat_spectrum(0.5));
}

struct BadTable {
  std::string change;  ///< what line 4, "400 0.250000", becomes
  std::string why;
};

TEST(Spectrum, NamesTheFirstLineThatIsWrong) {
  for (const BadTable& bad :
       {BadTable{"400 nan", "not from 0 to 1"}, BadTable{"400 inf", "not from 0 to 1"},
        BadTable{"400 1.01", "1.01 is not from 0 to 1"}, BadTable{"400 -0.01", "-0.01 is not from 0 to 1"},
        BadTable{"401 0.5", "the wavelength is 401, not 400 nm"},
        BadTable{"400", "not a wavelength and a value"},
        BadTable{"400 0.5 0.5", "not a wavelength and a value"},
        BadTable{"400 0,5", "not a wavelength and a value"},
        BadTable{"400 1e999", "not a wavelength and a value"}}) {
    std::string table = table_of(0.25);
    table.replace(table.find("400 0.250000"), std::string("400 0.250000").size(), bad.change);
    const auto spectrum = parse_spectrum(table, "bad.txt");
    ASSERT_FALSE(spectrum) << bad.change;
    EXPECT_EQ(spectrum.error().kind, ErrorKind::kBadData);
    EXPECT_EQ(spectrum.error().where, "bad.txt:4") << bad.change;
    EXPECT_THAT(spectrum.error().why, HasSubstr(bad.why));
  }
}

TEST(Spectrum, CountsTheLinesOfATable) {
  EXPECT_THAT(parse_spectrum(table_of(0.5, 35), "short.txt").error().why, HasSubstr("it has 35 values"));
  EXPECT_THAT(parse_spectrum("", "empty.txt").error().why, HasSubstr("it has 0 values"));
  const auto too_long = parse_spectrum(table_of(0.5, 37), "long.txt");
  ASSERT_FALSE(too_long);
  EXPECT_EQ(too_long.error().where, "long.txt:38");
}

TEST(Spectrum, IsMadeOf36Numbers) {
  std::vector<double> samples(Spectrum::kSamples, 0.25);
  const auto spectrum = spectrum_of(samples, "dye");
  ASSERT_TRUE(spectrum) << spectrum.error().message();
  EXPECT_EQ(*spectrum, flat_spectrum(0.25));

  samples[2] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(spectrum_of(samples, "dye").error().why, HasSubstr("at 400 nm is not from 0 to 1"));
  samples.pop_back();
  EXPECT_THAT(spectrum_of(samples, "dye").error().why, HasSubstr("it has 35 values"));
}

TEST(Spectrum, SaysWhichFileIsNotThere) {
  const auto spectra = read_spectra(kTables / "chart", 25);
  ASSERT_FALSE(spectra);
  EXPECT_EQ(spectra.error().kind, ErrorKind::kNoInput);
  EXPECT_THAT(spectra.error().where, HasSubstr("25.txt"));
}

TEST(Spectrum, OfEveryTableOfOursIsReadAndSmooth) {
  int tables = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(kTables)) {
    if (entry.path().extension() != ".txt") continue;
    ++tables;
    const auto spectrum = read_spectrum(entry.path());
    ASSERT_TRUE(spectrum) << spectrum.error().message();
    if (entry.path().filename().string().starts_with("led_")) continue;  // a LED's blue peak is narrow
    for (std::size_t i = 1; i < Spectrum::kSamples; ++i) {
      const double step = spectrum->samples[i] - spectrum->samples[i - 1];
      EXPECT_LT(std::abs(step), 0.25) << entry.path() << " at " << Spectrum::nm(i) << " nm";
    }
  }
  EXPECT_GE(tables, 24 + 4 + 6 + 5) << "under " << kTables;
}

}  // namespace
}  // namespace weft::simulator
