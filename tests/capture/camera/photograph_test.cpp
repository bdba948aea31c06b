// SPDX-License-Identifier: Apache-2.0
// What a photograph says of itself, and what is made of that.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "capture/camera/photograph_evidence.h"
#include "capture/camera/photograph_facts.h"
#include "tests/capture/raw/dng_bytes.h"

namespace weft::capture {
namespace {

using Bytes = std::vector<std::uint8_t>;

PhotographFacts facts_of(const Bytes& bytes) {
  return photograph_facts([&bytes](std::uint64_t offset, std::span<std::uint8_t> part) {
    if (offset > bytes.size() || bytes.size() - offset < part.size()) return false;
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), part.size(), part.begin());
    return true;
  });
}

/// A TIFF built by hand: a Nikon's raw file is known by its maker note, which nothing here can write.
class TiffBytes {
 public:
  explicit TiffBytes(bool big_endian) : big_(big_endian) {
    bytes_ = big_ ? Bytes{'M', 'M', 0, 42, 0, 0, 0, 8} : Bytes{'I', 'I', 42, 0, 8, 0, 0, 0};
  }
  struct Entry {
    std::uint16_t tag, type;
    std::uint32_t count, value;
  };
  TiffBytes& directory(const std::vector<Entry>& entries) {
    number(entries.size(), 2);
    for (const Entry& entry : entries) {
      number(entry.tag, 2), number(entry.type, 2), number(entry.count, 4);
      // Shorts stand at the front of their four bytes.
      if (entry.type == 3) {
        number(entry.value, 2), number(0, 2);
      } else {
        number(entry.value, 4);
      }
    }
    number(0, 4);
    return *this;
  }
  TiffBytes& text(const std::string& text) {
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
    return *this;
  }
  TiffBytes& append(const Bytes& more) {
    bytes_.insert(bytes_.end(), more.begin(), more.end());
    return *this;
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(bytes_.size()); }
  const Bytes& bytes() const { return bytes_; }

 private:
  void number(std::uint64_t value, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      bytes_.push_back(static_cast<std::uint8_t>(value >> (8 * (big_ ? size - 1 - i : i))));
  }
  bool big_;
  Bytes bytes_;
};

constexpr std::uint32_t directory_bytes(std::uint32_t entries) {
  return 2 + 12 * entries + 4;
}

Bytes nef(bool big_endian) {
  // Header, main directory, its make, EXIF directory, its time, the maker note.
  const std::uint32_t make_at = 8 + directory_bytes(2), exif_at = make_at + 18,
                      time_at = exif_at + directory_bytes(3), note_at = time_at + 20;
  TiffBytes note(big_endian);
  note.directory({{0x00A7, 4, 1, 40321}});
  TiffBytes file(big_endian);
  file.directory({{271, 2, 18, make_at}, {34665, 4, 1, exif_at}}).text("NIKON CORPORATION");
  file.directory({{36867, 2, 20, time_at}, {37500, 7, 10 + note.size(), note_at}, {37521, 2, 3, 0x33340000}});
  file.text("2026:01:31 23:59:58");
  file.append({'N', 'i', 'k', 'o', 'n', 0, 2, 0x11, 0, 0}).append(note.bytes());
  return file.bytes();
}

TEST(PhotographFacts, OfADngAreItsCountTimeAndExposure) {
  simulator::DngTags tags;
  tags.date_time_original = "2026:01:31 23:59:58";
  tags.milliseconds = 370;
  tags.image_number = 1234567;
  const auto bytes = simulator::dng_bytes(sample_frame({40, 30}), tags);
  ASSERT_TRUE(bytes) << bytes.error().message();
  const PhotographFacts facts = facts_of(*bytes);
  EXPECT_EQ(facts.ending, "dng");
  EXPECT_EQ(facts.image_number, 1234567U);
  ASSERT_TRUE(facts.taken_s);
  EXPECT_NEAR(*facts.taken_s, 1769903998.37, 1e-3);
  EXPECT_LE(facts.resolution_s, 0.01);
  EXPECT_NEAR(facts.exposure_us, 1e6 / 60, 1e-3);
  EXPECT_EQ(facts.iso, 100);
  EXPECT_EQ(facts.f_number, 8);
  EXPECT_EQ(facts.data_end, bytes->size());
}

TEST(PhotographFacts, OfANefHoldTheShutterCountOfTheMakerNote) {
  for (const bool big_endian : {false, true}) {
    const PhotographFacts facts = facts_of(nef(big_endian));
    EXPECT_EQ(facts.ending, "nef");
    EXPECT_EQ(facts.image_number, 40321U) << (big_endian ? "MM" : "II");
    ASSERT_TRUE(facts.taken_s);
    EXPECT_NEAR(*facts.taken_s, 1769903998, 1);
  }
}

TEST(PhotographFacts, OfARawThatIsNoTiffAreItsKind) {
  const auto ending_of = [](std::string begins) {
    begins.resize(64);
    return facts_of({begins.begin(), begins.end()}).ending;
  };
  EXPECT_EQ(ending_of({"\0\0\0\x18"
                       "ftypcrx \0\0\0\x01"
                       "crx isom",
                       24}),
            "cr3");
  EXPECT_EQ(ending_of({"IIU\0\x18\0\0\0", 8}), "rw2");
  EXPECT_EQ(ending_of({"IIRO\x08\0\0\0", 8}), "orf");
  EXPECT_EQ(ending_of({"IIRS\x08\0\0\0", 8}), "orf");
  EXPECT_EQ(ending_of({"MMOR\0\0\0\x08", 8}), "orf");
  EXPECT_EQ(ending_of("FUJIFILMCCD-RAW 0201FF389501"), "raf");
  EXPECT_EQ(ending_of({"II\x1a\0\0\0HEAPCCDR", 14}), "crw");
  EXPECT_EQ(ending_of({"\0MRM\0\0\x10\0", 8}), "mrw");
  EXPECT_EQ(ending_of({"FOVb\0\0\x02\0", 8}), "x3f");
  EXPECT_EQ(ending_of({"\0\0\0\x18"
                       "ftypmp42",
                       12}),
            "")
      << "a film is no photograph";
}

TEST(PhotographFacts, AreEmptyWhereThereAreNone) {
  EXPECT_EQ(facts_of({}).ending, "");
  EXPECT_EQ(facts_of({0xff, 0xd8, 0xff, 0xe0, 0, 0}).ending, "jpg");
  const PhotographFacts bare = facts_of(DngBytes().bytes);
  EXPECT_EQ(bare.ending, "dng");
  EXPECT_FALSE(bare.image_number);
  EXPECT_FALSE(bare.taken_s);
}

TEST(PhotographFacts, DoNotBelieveATimeThatIsNone) {
  for (const char* when : {"2026:02:30 10:00:00", "2026:13:01 10:00:00", "2026:01:01 25:00:00",
                           "2026-01-01 10:00:00", "    :  :     :  :  ", "2026:-1:01 10:00:00"}) {
    const std::uint32_t time_at = 8 + directory_bytes(1);
    TiffBytes file(false);
    file.directory({{36867, 2, 20, time_at}}).text(when);
    EXPECT_FALSE(facts_of(file.bytes()).taken_s) << when;
  }
}

TEST(PhotographFacts, OfATimeWithAZoneAreWhatTheClockIsAhead) {
  const auto zone_of = [](const std::string& zone) {
    const std::uint32_t time_at = 8 + directory_bytes(2);
    TiffBytes file(false);
    file.directory({{36867, 2, 20, time_at}, {36881, 2, 7, time_at + 20}})
        .text("2026:01:31 23:59:58")
        .text(zone);
    const PhotographFacts facts = facts_of(file.bytes());
    EXPECT_EQ(facts.taken_s, 1769903998) << "by its own clock";
    return facts.zone_s;
  };
  EXPECT_EQ(zone_of("+05:30"), 19800);
  EXPECT_EQ(zone_of("-08:00"), -28800);
  for (const char* none : {"      ", "+25:00", "+01:75", "+1:000", "Z00:00", "+-1:00"})
    EXPECT_FALSE(zone_of(none)) << none;
}

TEST(PhotographFacts, OfEveryTruncationAreRead) {
  for (const bool big_endian : {false, true}) {
    const Bytes whole = nef(big_endian);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const PhotographFacts facts =
          facts_of(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
      EXPECT_FALSE(facts.image_number) << size << " bytes of " << whole.size();
    }
  }
}

PhotographFacts good_facts() {
  PhotographFacts facts;
  facts.ending = "nef";
  facts.data_end = 1000;
  facts.image_number = 7;
  facts.taken_s = 5000.0 + 3600;  // an hour ahead
  facts.resolution_s = 0.01;
  facts.exposure_us = 16667;
  facts.iso = 100;
  facts.f_number = 8;
  return facts;
}

AskedFor asked() {
  AskedFor asked;
  asked.exposure = {1e6 / 60, 100, 8};
  asked.bytes = 1000;
  asked.triggered_s = 5000;
  asked.arrived_s = 5001;
  asked.clock = CameraClock{3600, 0.03};
  asked.last_image_number = 6;
  return asked;
}

TEST(PhotographEvidence, TakesTheOneThatWasAskedFor) {
  const auto checked = check_photograph(good_facts(), asked());
  EXPECT_TRUE(checked) << checked.error().message();
  EXPECT_NEAR(*taken_s(good_facts(), asked().clock), 5000, 1e-9);
}

TEST(PhotographEvidence, RefusesAnOlderOneByItsCountOrItsTime) {
  PhotographFacts same = good_facts();
  same.image_number = 6;
  PhotographFacts before = good_facts();
  *before.taken_s -= 1;
  for (const PhotographFacts& facts : {same, before}) {
    const auto checked = check_photograph(facts, asked());
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().kind, ErrorKind::kProtocol);
    EXPECT_EQ(checked.error().what, "an older photograph arrived");
  }
}

TEST(PhotographEvidence, AllowsForWhatTheClockIsUnsureOf) {
  PhotographFacts before = good_facts();
  *before.taken_s -= 1;
  AskedFor unsure = asked();
  unsure.clock->uncertainty_s = 1;
  EXPECT_TRUE(check_photograph(before, unsure));
  PhotographFacts whole_seconds = before;
  whole_seconds.resolution_s = 1;
  EXPECT_TRUE(check_photograph(whole_seconds, asked()));
  AskedFor blind = asked();
  blind.clock.reset();
  EXPECT_TRUE(check_photograph(before, blind));
}

TEST(PhotographEvidence, RefusesAFileThatEndsBeforeItsImageDoes) {
  AskedFor short_by_one = asked();
  short_by_one.bytes = 999;
  const auto checked = check_photograph(good_facts(), short_by_one);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().what, "the photograph is not whole");
}

TEST(PhotographEvidence, RefusesAPhotographOfTheFuture) {
  PhotographFacts ahead = good_facts();
  *ahead.taken_s += 3600;
  const auto checked = check_photograph(ahead, asked());
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().kind, ErrorKind::kProtocol);
}

TEST(PhotographEvidence, RefusesWhatWasNotTakenAsSet) {
  for (double PhotographFacts::*field :
       {&PhotographFacts::exposure_us, &PhotographFacts::iso, &PhotographFacts::f_number}) {
    PhotographFacts facts = good_facts();
    facts.*field *= 1.26;
    const auto checked = check_photograph(facts, asked());
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().kind, ErrorKind::kBadData);
    facts.*field = 0;  // not told
    EXPECT_TRUE(check_photograph(facts, asked()));
  }
}

TEST(PhotographEvidence, SaysOfAnotherIsoThatTheCameraChoseIt) {
  PhotographFacts facts = good_facts();
  facts.iso = 400;
  const Error said = check_photograph(facts, asked()).error();
  EXPECT_EQ(said.why, "ISO is 400, not 100");
  EXPECT_EQ(said.remedy, "switch the camera's auto ISO off, and leave its dials alone during a scan");
}

TEST(PhotographEvidence, TellsAJpegFromWhatIsNoPhotograph) {
  PhotographFacts facts = good_facts();
  facts.ending = "jpg";
  EXPECT_EQ(check_photograph(facts, asked()).error().kind, ErrorKind::kBadData);
  facts.ending = "";
  EXPECT_EQ(check_photograph(facts, asked()).error().kind, ErrorKind::kProtocol);
}

TEST(PhotographEvidence, SaysWhichKindOfRawIsNotReadYet) {
  for (const char* ending : {"cr3", "rw2", "orf", "raf", "crw", "mrw", "x3f"}) {
    PhotographFacts facts;
    facts.ending = ending;
    const auto checked = check_photograph(facts, asked());
    ASSERT_FALSE(checked) << ending;
    EXPECT_EQ(checked.error().kind, ErrorKind::kBadData) << "taking it again would not help";
    EXPECT_EQ(checked.error().what, "this kind of raw is not read yet");
    EXPECT_EQ(checked.error().why, std::string("a ") + ending + " arrived");
  }
}

}  // namespace
}  // namespace weft::capture
