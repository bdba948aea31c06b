// SPDX-License-Identifier: Apache-2.0
#include "library/catalogue/catalogue.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "tests/library/catalogue/shelf.h"

namespace weft::library {
namespace {

Catalogue opened(const Shelf& shelf) {
  Result<Catalogue> catalogue = Catalogue::open(shelf.beside("library.sqlite"));
  EXPECT_TRUE(catalogue) << (catalogue ? "" : catalogue.error().message());
  return std::move(*catalogue);
}

RefreshFacts refreshed(Catalogue& catalogue, const std::vector<std::filesystem::path>& folders) {
  const Result<RefreshFacts> facts = catalogue.refresh(folders, {.threads = 2});
  EXPECT_TRUE(facts) << (facts ? "" : facts.error().message());
  return *facts;
}

// Names of the sessions that fit, in order.
std::vector<std::string> found(Catalogue& catalogue, const Query& query) {
  const Result<CataloguePage> page = catalogue.find(query);
  EXPECT_TRUE(page) << (page ? "" : page.error().message());
  std::vector<std::string> names;
  for (const Entry& entry : page->entries) names.push_back(entry.name);
  return names;
}

Json shot(int index, const char* role, const Json& fields) {
  Json shot = {{"index", index},   {"led", index}, {"role", role},  {"file", "raw/0.dng"},
               {"exposure_us", 1}, {"iso", 100},   {"f_number", 8}, {"time", ""}};
  shot.update(fields);
  return shot;
}

Json taken(const std::string& time) {
  return {{{"index", 0},
           {"led", 1},
           {"role", "lit"},
           {"file", "raw/0.dng"},
           {"exposure_us", 1},
           {"iso", 100},
           {"f_number", 8},
           {"time", time}}};
}

using Names = std::vector<std::string>;

TEST(Catalogue, KnowsTheFirstLitShotThatIsUsedAndWhatWasWarnedOf) {
  const Shelf shelf;
  const Json dark = shot(0, "dark", {{"led", 0}, {"sha256", "d"}});
  const Json again = shot(1, "lit", {{"sha256", "e"}, {"superseded_by", 2}});
  const Json lit_shot = shot(2, "lit", {{"led", 1}, {"sha256", "f"}, {"warnings", Json::array({"dim"})}});
  shelf.put("a", {{"shots", Json::array({dark, again, lit_shot})}});
  shelf.put("b", {{"shots", Json::array({dark})}});
  Catalogue catalogue = opened(shelf);
  refreshed(catalogue, {shelf.path()});
  const Result<Entry> lit = catalogue.find_one("a"), unlit = catalogue.find_one("b");
  ASSERT_TRUE(lit) << lit.error().message();
  EXPECT_EQ(lit->lit_shot, 2);
  EXPECT_EQ(lit->lit_sha256, "f");
  ASSERT_TRUE(unlit) << unlit.error().message();
  EXPECT_EQ(unlit->lit_sha256, "");
  EXPECT_EQ(found(catalogue, {.warned = true}), Names{"a"});
  EXPECT_EQ(found(catalogue, {.state = "complete", .warned = true}), Names{"a"});
}

TEST(Catalogue, OpensOldSessionsAndSaysOfNewerOnesWhichVersionTheyNeed) {
  const Shelf shelf;
  shelf.put("old", {{"schema", "weft.session/1"}});
  shelf.put("later", {{"schema", "weft.session/1.9"}, {"of a later weft", 1}});
  shelf.put("newer", {{"schema", "weft.session/2"}});
  Catalogue catalogue = opened(shelf);
  refreshed(catalogue, {shelf.path()});
  EXPECT_EQ(found(catalogue, {.state = "complete"}).size(), 2U);
  const Result<Entry> newer = catalogue.find_one("newer");
  ASSERT_TRUE(newer) << newer.error().message();
  EXPECT_EQ(newer->state, "unreadable");
  ASSERT_TRUE(newer->error);
  EXPECT_EQ(newer->error->what, "document is newer than this program");
  EXPECT_EQ(newer->error->remedy, "use a version of weft that reads weft.session/2");
}

TEST(Catalogue, FindsSessionsByWhatIsSaidOfThem) {
  const Shelf shelf;
  shelf.put("a", {{"fabric", "Crêpe de Chine"},
                  {"shots", taken("2026-11-03T08:00:00Z")},
                  {"metadata", {{"id", "4006381333931"}, {"tags", {"silk", "red"}}}}});
  shelf.put("b", {{"fabric", "wool twill"},
                  {"shots", taken("2026-11-02T08:00:00Z")},
                  {"state", "capturing"},
                  {"metadata", {{"composition", "wool and silk"}, {"tags", {"red"}}}}});
  shelf.put("c", {{"fabric", "twill"}, {"rig", "bench-2"}, {"shots", taken("2026-11-01T08:00:00Z")}});
  shelf.solve("c", "0000000000000001");
  Catalogue catalogue = opened(shelf);
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).read, 3U);

  EXPECT_EQ(found(catalogue, {}), (Names{"a", "b", "c"})) << "newest first";
  EXPECT_EQ(found(catalogue, {.words = "crepe"}), Names{"a"}) << "without its accent";
  EXPECT_EQ(found(catalogue, {.words = "SIL"}).size(), 2U) << "the beginning of a word";
  EXPECT_EQ(found(catalogue, {.words = "silk twill"}), Names{"b"}) << "all words";
  EXPECT_EQ(found(catalogue, {.words = "4006381333931"}), Names{"a"});
  EXPECT_EQ(found(catalogue, {.words = "nylon"}), Names{});
  EXPECT_EQ(found(catalogue, {.id = "4006381333931"}), Names{"a"});
  EXPECT_EQ(found(catalogue, {.tag = "red"}), (Names{"a", "b"}));
  EXPECT_EQ(found(catalogue, {.state = "capturing"}), Names{"b"});
  EXPECT_EQ(found(catalogue, {.rig = "bench-2"}), Names{"c"});
  EXPECT_EQ(found(catalogue, {.from = "2026-11-02", .before = "2026-11-03"}), Names{"b"});
  EXPECT_EQ(found(catalogue, {.words = "twill", .tag = "red"}), Names{"b"});

  EXPECT_EQ(found(catalogue, {.words = "twill", .warned = true}), Names{"b"}) << "it did not end";

  const Result<Entry> solved = catalogue.find_one("c");
  ASSERT_TRUE(solved) << solved.error().message();
  EXPECT_EQ(solved->solves, 1);
  EXPECT_EQ(solved->current_solve, "0000000000000001");
  EXPECT_EQ(catalogue.find_one("4006381333931")->name, "a");
  EXPECT_EQ(catalogue.tags()->front(), (std::pair<std::string, int>{"red", 2}));
}

TEST(Catalogue, TakesAnyTextForWordsAndNeverForALanguage) {
  const Shelf shelf;
  shelf.put("a", {{"fabric", "\"quoted\" OR NOT (near) a* b:c -d"}});
  Catalogue catalogue = opened(shelf);
  refreshed(catalogue, {shelf.path()});
  for (const char* words : {"\"quoted\"", "OR", "NOT", "(near)", "a*", "b:c", "-d", "\"",
                            "'; DROP TABLE session; --", "*", "{}", "^quoted"}) {
    EXPECT_TRUE(catalogue.find({.words = words})) << words;
  }
  EXPECT_EQ(found(catalogue, {.words = "quoted near"}), Names{"a"});
  EXPECT_EQ(found(catalogue, {.words = std::string("quoted\0near", 11)}), Names{"a"});
  EXPECT_EQ(
      catalogue.find({.words = std::string(100, 'x') + " a b c d e f g h i j k l m n o p"}).error().kind,
      ErrorKind::kUsage)
      << "seventeen words";
}

TEST(Catalogue, ReadsOnlyWhatChangedAndForgetsWhatIsGone) {
  const Shelf shelf;
  for (const char* name : {"a", "b", "c"}) shelf.put(name);
  Catalogue catalogue = opened(shelf);
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).read, 3U);
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).read, 0U);
  const std::int64_t key = catalogue.find_one("b")->key;

  ASSERT_TRUE(change_metadata(shelf.folder_of("b"), {{"tags", {"new"}}}));
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).read, 1U);
  EXPECT_EQ(found(catalogue, {.tag = "new"}), Names{"b"});
  EXPECT_EQ(catalogue.find_one("b")->key, key) << "pages stay where they were";
  ASSERT_TRUE(change_metadata(shelf.folder_of("b"), {{"tags", nullptr}, {"fabric", "linen"}}));
  ASSERT_TRUE(catalogue.refresh(shelf.folder_of("b")));
  EXPECT_EQ(found(catalogue, {.tag = "new"}), Names{});
  EXPECT_EQ(found(catalogue, {.words = "new"}), Names{}) << "its words are taken out too";
  EXPECT_EQ(found(catalogue, {.words = "linen"}), Names{"b"});

  shelf.solve("a", "0000000000000001");
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).read, 1U) << "it was solved";
  std::filesystem::remove_all(shelf.folder_of("c"));
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).removed, 1U);
  EXPECT_EQ(found(catalogue, {}).size(), 2U);
}

TEST(Catalogue, ShowsASessionThatCannotBeReadWithItsError) {
  const Shelf shelf;
  shelf.put("good");
  std::ofstream(shelf.put("broken") / "session.json", std::ios::trunc)
      << "{\"schema\": \"weft.session/1\", \"sh";
  std::filesystem::create_directories(shelf.folder_of("empty"));
  std::filesystem::create_directory_symlink(shelf.path(), shelf.path() / "loop");
  Catalogue catalogue = opened(shelf);
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).sessions, 2U) << "a link is not followed";
  EXPECT_EQ(found(catalogue, {.state = "unreadable"}), Names{"broken"});
  EXPECT_EQ(catalogue.find_one("broken")->error->kind, ErrorKind::kBadData);

  const auto odd = shelf.put("odd", {{"metadata", {{"tags", "red"}}}});
  refreshed(catalogue, {shelf.path()});
  EXPECT_EQ(catalogue.find_one("odd")->state, "complete");
  EXPECT_EQ(catalogue.find_one("odd")->error->why, "must be a list of texts");
  ASSERT_TRUE(change_metadata(odd, {{"tags", {"red"}}})) << "it can be mended";
  refreshed(catalogue, {shelf.path()});
  EXPECT_FALSE(catalogue.find_one("odd")->error);
}

TEST(Catalogue, TellsWhichSessionsOfAFolderAScanCouldFinish) {
  const Shelf shelf;
  shelf.put("done");
  shelf.put("left", {{"state", "capturing"}});
  shelf.put("velvet", {{"state", "capturing"}, {"fabric", "velvet"}});
  shelf.put("below/left_too", {{"state", "capturing"}});
  shelf.put("of_another", {{"state", "capturing"}, {"rig", "bench-2"}});
  std::ofstream(shelf.put("broken") / "session.json", std::ios::trunc) << "{";
  Catalogue catalogue = opened(shelf);
  refreshed(catalogue, {shelf.path()});
  const Query query = {.fabric = "twill", .rig = "bench-1", .unfinished = true, .in = shelf.path()};
  EXPECT_EQ(found(catalogue, query), Names{"left"});
}

TEST(Catalogue, TellsBytesAndWarningsOfASession) {
  const Shelf shelf;
  Json shots = Json::array({taken("2026-11-03T08:00:00Z")[0]});
  shots[0]["warnings"] = {"the dark shot is not quite dark"};
  const auto folder = shelf.put("a", {{"shots", shots}});
  std::filesystem::create_directories(folder / "raw");
  std::ofstream(folder / "raw" / "0.dng") << std::string(1000, 'x');
  std::ofstream(shelf.beside("outside")) << std::string(5000, 'x');
  std::filesystem::create_symlink(shelf.beside("outside"), folder / "raw" / "link.dng");
  Catalogue catalogue = opened(shelf);
  refreshed(catalogue, {shelf.path()});
  const Entry entry = *catalogue.find_one("a");
  EXPECT_EQ(entry.bytes, 1000 + std::filesystem::file_size(folder / "session.json"));
  EXPECT_EQ(entry.warnings, Names{"the dark shot is not quite dark"});
}

TEST(Catalogue, TellsOfAllLedsOnceThatTheyAreOver) {
  const Shelf shelf;
  Json shots = Json::array();
  for (int led = 1; led <= 10; ++led)
    shots.push_back(shot(led, "lit", {{"sha256", "f"}, {"exposed", {{"clipped", 0.9}, {"room", 0.1}}}}));
  shelf.put("a", {{"shots", shots}});
  Catalogue catalogue = opened(shelf);
  refreshed(catalogue, {shelf.path()});
  const Entry entry = *catalogue.find_one("a");
  ASSERT_EQ(entry.warnings.size(), 1U);
  EXPECT_EQ(entry.warnings.front().rfind("All 10 LEDs are over", 0), 0U) << entry.warnings.front();
}

TEST(Catalogue, ForgetsWhatLiesInNoFolderAnyMore) {
  const Shelf near, far;
  near.put("a");
  far.put("b");
  Catalogue catalogue = opened(near);
  refreshed(catalogue, {near.path(), far.path()});
  EXPECT_EQ(refreshed(catalogue, {near.path()}).removed, 0U) << "nothing is known of the other folder";
  EXPECT_EQ(found(catalogue, {}).size(), 2U);
  ASSERT_TRUE(catalogue.keep_only({near.path()}));
  EXPECT_EQ(found(catalogue, {}), Names{"a"});
}

TEST(Catalogue, TellsHowFarItsReadingIs) {
  const Shelf shelf;
  for (int i = 0; i < 600; ++i) {
    const auto folder = shelf.folder_of(fmt::format("s{:03}", i));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "session.json") << "{}";
  }
  Catalogue catalogue = opened(shelf);
  std::vector<double> shares;
  JobContext context;
  context.progress = [&](std::string_view phase, double share) {
    if (phase == "read") shares.push_back(share);
  };
  ASSERT_TRUE(catalogue.refresh({shelf.path()}, context));
  EXPECT_EQ(shares, (std::vector<double>{500.0 / 600, 1.0}));
}

TEST(Catalogue, LooksIntoFoldersBelowAndKeepsWhatItKnewOfAFolderThatCannotBeListed) {
  const Shelf near, far;
  near.put("2026/november/a");
  far.put("b");
  Catalogue catalogue = opened(near);
  EXPECT_EQ(refreshed(catalogue, {near.path(), far.path()}).sessions, 2U);
  std::filesystem::rename(far.path(), far.beside("unmounted"));
  const RefreshFacts facts = refreshed(catalogue, {near.path(), far.path()});
  EXPECT_EQ(facts.unreachable, std::vector{far.path()});
  EXPECT_EQ(facts.removed, 0U);
  EXPECT_EQ(found(catalogue, {}).size(), 2U);
}

TEST(Catalogue, PagesThroughAllSessionsWithoutSkippingOrRepeating) {
  const Shelf shelf;
  for (int i = 0; i < 25; ++i) shelf.put(fmt::format("s{:02}", i), {{"fabric", "twill number"}});
  Catalogue catalogue = opened(shelf);
  refreshed(catalogue, {shelf.path()});
  for (const char* words : {"", "twill"}) {
    std::set<std::string> names;
    Query query = {.words = words, .limit = 7};
    int pages = 0;
    do {
      const Result<CataloguePage> page = catalogue.find(query);
      ASSERT_TRUE(page) << page.error().message();
      EXPECT_EQ(page->total, 25U);
      for (const Entry& entry : page->entries) EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
      query.after = page->after;
      ++pages;
    } while (query.after);
    EXPECT_EQ(names.size(), 25U);
    EXPECT_EQ(pages, 4);
  }
  EXPECT_EQ(catalogue.find({.limit = 0}).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(catalogue.find({.limit = 1001}).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(catalogue.find({.after = 999}).error().kind, ErrorKind::kUsage);
}

TEST(Catalogue, ThatIsDamagedOrNewerIsPutAsideAndMadeAgain) {
  const Shelf shelf;
  shelf.put("a");
  const auto file = shelf.beside("library.sqlite");
  std::ofstream(file) << std::string(5000, 'x');
  {
    Catalogue catalogue = opened(shelf);
    EXPECT_EQ(refreshed(catalogue, {shelf.path()}).read, 1U);
  }
  EXPECT_TRUE(std::filesystem::exists(shelf.beside("library.sqlite.damaged")));
  {
    Result<Database> newer = Database::open(file);
    ASSERT_TRUE(newer && newer->run("PRAGMA user_version = 99"));
  }
  Catalogue catalogue = opened(shelf);
  EXPECT_EQ(refreshed(catalogue, {shelf.path()}).read, 1U);
}

}  // namespace
}  // namespace weft::library
