// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/edits.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/library/catalogue/shelf.h"

namespace weft::library {
namespace {

std::string notes_of(const std::filesystem::path& folder) {
  return metadata_of(*read_session(folder))->notes;
}

// Edits from the file each time, as after a restart.
Result<void> write_notes(const std::filesystem::path& file, const std::filesystem::path& folder,
                         const std::string& notes) {
  const Result<MetadataChange> change = change_metadata(folder, {{"notes", notes}});
  EXPECT_TRUE(change) << (change ? "" : change.error().message());
  return Edits::open(file)->add(*change, "Ann");
}

TEST(Edits, AreTakenBackAndMadeAgainTwentyTimesAcrossRestarts) {
  const Shelf shelf;
  const auto folder = shelf.put("a"), file = shelf.beside("edits.json");
  for (int i = 1; i <= 23; ++i) ASSERT_TRUE(write_notes(file, folder, std::to_string(i)));
  for (int i = 22; i >= 3; --i) {
    const Result<MetadataChange> undone = Edits::open(file)->undo();
    ASSERT_TRUE(undone) << i << ": " << undone.error().message();
    EXPECT_EQ(notes_of(folder), std::to_string(i));
  }
  EXPECT_FALSE(Edits::open(file)->undo()) << "twenty are remembered";
  for (int i = 4; i <= 23; ++i) {
    const Result<MetadataChange> redone = Edits::open(file)->redo();
    ASSERT_TRUE(redone) << i << ": " << redone.error().message();
    EXPECT_EQ(words_of(*redone), "notes: " + std::to_string(i) + " of a");
  }
  EXPECT_EQ(notes_of(folder), "23");
  EXPECT_FALSE(Edits::open(file)->redo());
}

TEST(Edits, ForgetWhatWasUndoneOnceAnotherFollows) {
  const Shelf shelf;
  const auto folder = shelf.put("a"), other = shelf.put("b"), file = shelf.beside("edits.json");
  ASSERT_TRUE(write_notes(file, folder, "one"));
  ASSERT_TRUE(Edits::open(file)->undo());
  EXPECT_EQ(notes_of(folder), "") << "there was none before";
  ASSERT_TRUE(write_notes(file, other, "two"));
  EXPECT_FALSE(Edits::open(file)->redo());
  EXPECT_EQ(notes_of(folder), "");
}

TEST(Edits, LeaveAloneWhatSomebodyElseChangedSince) {
  const Shelf shelf;
  const auto folder = shelf.put("a"), file = shelf.beside("edits.json");
  ASSERT_TRUE(write_notes(file, folder, "mine"));
  ASSERT_TRUE(change_metadata(folder, {{"notes", "theirs"}}));
  const Result<MetadataChange> undone = Edits::open(file)->undo();
  ASSERT_FALSE(undone);
  EXPECT_EQ(undone.error().kind, ErrorKind::kTryAgain);
  EXPECT_EQ(notes_of(folder), "theirs");
}

TEST(Edits, OfAFileThatHoldsSomethingElseAreRefused) {
  const Shelf shelf;
  const auto file = shelf.beside("edits.json");
  for (const char* text : {"", "{", "[]", R"({"schema":"weft.edits/1"})",
                           R"({"schema":"weft.edits/1","done":[{"session":1}],"undone":[]})",
                           R"({"schema":"weft.edits/2","done":[],"undone":[]})"}) {
    std::ofstream(file, std::ios::trunc) << text;
    const Result<Edits> edits = Edits::open(file);
    ASSERT_FALSE(edits) << text;
    EXPECT_EQ(edits.error().kind, ErrorKind::kBadData) << text;
  }
}

}  // namespace
}  // namespace weft::library
