// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/metadata.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "solve/session/left_out_shots.h"
#include "solve/session/session_lock.h"
#include "tests/library/catalogue/shelf.h"

namespace weft::library {
namespace {

TEST(Metadata, IsWrittenIntoTheSessionAndReadBack) {
  const Shelf shelf;
  const auto folder = shelf.put("a", {{"future", {1, 2}}, {"metadata", {{"future", "kept"}}}});
  const Result<MetadataChange> change = change_metadata(folder, {{"id", "4006381333931"},
                                                                 {"tags", {"wool", "red", "wool"}},
                                                                 {"composition", "80 % wool"},
                                                                 {"construction", "twill 2/1"},
                                                                 {"side", "back"},
                                                                 {"kind", "velvet"},
                                                                 {"notes", "first line\nsecond"},
                                                                 {"weight_g_m2", 210},
                                                                 {"thickness_mm", 0.7},
                                                                 {"fabric", "Twill \u00e9"}});
  ASSERT_TRUE(change) << change.error().message();
  const Result<Session> session = read_session(folder);
  ASSERT_TRUE(session);
  EXPECT_EQ(session->fabric, "Twill \u00e9");
  EXPECT_EQ(session->document["future"], Json({1, 2}));
  EXPECT_EQ(session->document["metadata"]["future"], "kept") << "a newer version wrote it";
  EXPECT_EQ(session->shots.size(), 1U);
  EXPECT_EQ(*metadata_of(*session), (Metadata{.revision = 1,
                                              .id = "4006381333931",
                                              .tags = {"red", "wool"},
                                              .composition = "80 % wool",
                                              .construction = "twill 2/1",
                                              .side = "back",
                                              .kind = "velvet",
                                              .notes = "first line\nsecond",
                                              .weight_g_m2 = 210,
                                              .thickness_mm = 0.7}));
  ASSERT_TRUE(change_metadata(folder, {{"notes", nullptr}}));
  EXPECT_EQ(metadata_of(*read_session(folder))->notes, "");
  EXPECT_EQ(metadata_of(*read_session(folder))->revision, 2);
}

TEST(Metadata, ThatIsTheSameAlreadyCountsAsNoChange) {
  const Shelf shelf;
  const auto folder = shelf.put("a");
  const Result<MetadataChange> change = change_metadata(folder, {{"fabric", "twill"}, {"notes", nullptr}});
  ASSERT_TRUE(change);
  EXPECT_TRUE(change->after.empty());
  EXPECT_EQ(change->revision, 0);
  EXPECT_FALSE(read_json(folder / "session.json", "weft.session", 1)->contains("metadata")) << "not written";
}

TEST(Metadata, TakesWhatPagesAndTablesMustEscapeButNoControlCharacters) {
  const Shelf shelf;
  const auto folder = shelf.put("a");
  for (const char* text :
       {"<script>alert(1)</script>", "../../etc/passwd", "=cmd|' /C calc'!A0", "a\"b;c,d"}) {
    EXPECT_TRUE(change_metadata(folder, {{"fabric", text}, {"tags", {text}}})) << text;
    EXPECT_EQ(metadata_of(*read_session(folder))->tags, std::vector<std::string>{text});
  }
  const std::vector<std::pair<Json, const char*>> refused = {
      {{{"fabric", "two\nlines"}}, "control characters"},
      {{{"tags", {"a\tb"}}}, "control characters"},
      {{{"notes", std::string("nul\0l", 5)}}, "control characters"},
      {{{"fabric", std::string(10'000, 'x')}}, "at most 200 bytes"},
      {{{"notes", std::string(10'001, 'x')}}, "at most 10000 bytes"},
      {{{"composition", "broken \xc3\x28"}}, "UTF-8"},
      {{{"tags", Json(std::vector<std::string>(65, "t"))}}, "at most 64 tags"},
      {{{"tags", {""}}}, "no empty tag"},
      {{{"tags", "red"}}, "list of texts"},
      {{{"side", "left"}}, "front or back"},
      {{{"weight_g_m2", -1}}, "from 0"},
      {{{"thickness_mm", "thin"}}, "must be a number"},
      {{{"shots", Json::array()}}, "no such field"},
      {Json::object(), "no field"}};
  for (const auto& [fields, why] : refused) {
    const Result<MetadataChange> change = change_metadata(folder, fields);
    ASSERT_FALSE(change) << why;
    EXPECT_EQ(change.error().kind, ErrorKind::kUsage) << why;
    EXPECT_NE(change.error().why.find(why), std::string::npos) << change.error().message();
  }
}

TEST(Metadata, IsNotChangedOverSomebodyElsesChangeNorWhileAScanWrites) {
  const Shelf shelf;
  const auto folder = shelf.put("a");
  ASSERT_TRUE(change_metadata(folder, {{"tags", {"mine"}}}, {.revision = 0}));
  const Result<MetadataChange> late = change_metadata(folder, {{"tags", {"theirs"}}}, {.revision = 0});
  ASSERT_FALSE(late);
  EXPECT_EQ(late.error().kind, ErrorKind::kTryAgain);
  EXPECT_EQ(metadata_of(*read_session(folder))->tags, std::vector<std::string>{"mine"});

  const Result<Descriptor> scan = solve::lock_session(folder);
  ASSERT_TRUE(scan);
  const Result<MetadataChange> meanwhile = change_metadata(folder, {{"tags", {"theirs"}}});
  ASSERT_FALSE(meanwhile);
  EXPECT_EQ(meanwhile.error().kind, ErrorKind::kTryAgain);
}

TEST(Metadata, OfTheWrongKindIsNamed) {
  for (const Json& metadata :
       {Json("text"), Json({{"tags", "red"}}), Json({{"weight_g_m2", 1e300}}), Json({{"notes", 5}})}) {
    const Result<Metadata> read = metadata_from_json(metadata, "session.json");
    ASSERT_FALSE(read) << metadata.dump();
    EXPECT_EQ(read.error().kind, ErrorKind::kBadData);
  }
}

TEST(LeftOut, NamesShotsThatAreThere) {
  const Shelf shelf;
  const auto folder = shelf.put("a");
  EXPECT_TRUE(solve::left_out(*read_session(folder)).empty());
  const Result<MetadataChange> change = change_metadata(folder, {{"left_out", Json::array({0, 0})}});
  ASSERT_TRUE(change) << change.error().message();
  EXPECT_EQ(words_of(*change), "left_out: 0 of a");
  EXPECT_EQ(solve::left_out(*read_session(folder)), std::vector{0});
  EXPECT_EQ(change_metadata(folder, {{"left_out", Json::array({7})}}).error().kind, ErrorKind::kNoInput);
  for (const Json& wrong : {Json{{"left_out", "0"}}, Json{{"left_out", Json::array({-1})}},
                            Json{{"left_out", Json::array({0.5})}}, Json{{"left_out", 0}},
                            Json{{"left_out", std::vector<int>(65, 0)}}}) {
    EXPECT_EQ(change_metadata(folder, wrong).error().kind, ErrorKind::kUsage) << wrong.dump();
  }
  ASSERT_TRUE(change_metadata(folder, {{"left_out", Json::array()}}));
  EXPECT_FALSE(read_session(folder)->document.contains("left_out"));
}

TEST(NewMetadata, FollowsTheRulesOfTheLibrary) {
  for (const char* right :
       {R"({})", R"({"id": "4006381333931", "tags": ["<b>", "=cmd", "../red"], "notes": "a\nb"})",
        R"({"weight": 120, "barcode": "4711", "is_dyed": true, "weight_g_m2": 210, "side": "back"})"}) {
    const Result<void> ok = check_new_metadata(Json::parse(right));
    EXPECT_TRUE(ok) << right << (ok ? "" : ok.error().message());
  }
  for (const Json& wrong :
       {Json::array(), Json{{"id", "a\nb"}}, Json{{"id", std::string(201, 'x')}},
        Json{{"notes", std::string(10'001, 'x')}}, Json{{"side", "left"}}, Json{{"tags", "red"}},
        Json{{"colour", "a\x1b[31m"}}, Json{{"colour", {{"deep", 1}}}}, Json{{"../x", "a"}}, Json{{"", "a"}},
        Json{{"revision", 7}}, Json{{"current_solve", "0000000000000000"}}, Json{{"weight_g_m2", "heavy"}}}) {
    EXPECT_FALSE(check_new_metadata(wrong)) << wrong.dump();
  }
}

}  // namespace
}  // namespace weft::library
