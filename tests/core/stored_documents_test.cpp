// SPDX-License-Identifier: Apache-2.0
// Every document that is kept in testdata, of every version there ever was, by today's readers: as it is, as
// a newer minor version might have written it, and as a newer major version.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "core/base/files.h"
#include "core/base/product.h"
#include "core/base/sha256.h"
#include "core/rig/calibration.h"
#include "core/rig/session.h"
#include "core/solve/solve.h"
#include "tests/core/image_io/scratch_folder.h"
#include "tests/core/places.h"

namespace weft {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kSource = source_folder();

Result<Json> json_in(const fs::path& file) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  return Json::parse(*text);
}

// What stands in the file once weft has read it and written it again.
using Rewrite = Result<Json> (*)(const fs::path& file);

Result<Json> session_again(const fs::path& file) {
  const Result<Session> session = read_session(file.parent_path());
  if (!session) return session.error();
  if (Result<void> ok = write_session(*session); !ok) return std::move(ok).error();
  return json_in(file);
}

// A calibration never changes: another one is derived from it.
Result<Json> calibration_again(const fs::path& file) {
  const fs::path folder = file.parent_path(), derived = folder.parent_path() / "derived";
  const Result<Calibration> calibration = read_calibration(folder);
  if (!calibration) return calibration.error();
  Calibration change;
  change.subject = calibration->subject;
  const Result<Calibration> next = derive_calibration(folder, std::move(change), derived, {});
  if (!next) return next.error();
  return json_in(derived / file.filename());
}

template <const ProductKind& kKind>
Result<Json> product_again(const fs::path& file) {
  const Result<Json> own = json_in(file);
  if (!own) return own.error();
  Result<std::optional<Json>> found =
      find_finished({kKind, (*own)["id"].get<std::string>(), file.parent_path()});
  if (!found) return std::move(found).error();
  return std::move(**found);
}

constexpr ProductKind kRectified = {"weft.rectified", "rectify.json", "set of rectified maps", ""};
constexpr ProductKind kMaps = {"weft.maps", "maps.json", "set of maps", ""};
constexpr ProductKind kExport = {"weft.export", "export.json", "export", ""};

template <const char* kName>
Result<Json> document_again(const fs::path& file) {
  return read_json(file, kName, 1);
}

constexpr char kSolveReport[] = "weft.solve-report";
constexpr char kCalibrationReport[] = "weft.calibration-report";
constexpr char kCalibrationCheck[] = "weft.calibration-check";
constexpr char kSet[] = "weft.set";
constexpr char kReflectance[] = "weft.reflectance";
constexpr char kPhotographs[] = "weft.photographs";
constexpr char kBatchReport[] = "weft.batch-report";

// Formats of lines, whose stored files tests/library/batch/stored_lines_test.cpp reads.
const std::set<std::string> kOfLines = {"weft.batch/1", "weft.batch/1.1", "weft.batch-result/1",
                                        "weft.batch-result/1.1"};

struct Format {
  std::string name;
  Rewrite rewrite;
};

const std::vector<Format> kFormats = {{"weft.session", session_again},
                                      {"weft.calibration", calibration_again},
                                      {"weft.camera", calibration_again},
                                      {"weft.response", calibration_again},
                                      {"weft.color", calibration_again},
                                      {"weft.lights", calibration_again},
                                      {"weft.solve", product_again<kSolveProduct>},
                                      {"weft.rectified", product_again<kRectified>},
                                      {"weft.maps", product_again<kMaps>},
                                      {"weft.export", product_again<kExport>},
                                      {kSolveReport, document_again<kSolveReport>},
                                      {kCalibrationReport, document_again<kCalibrationReport>},
                                      {kCalibrationCheck, document_again<kCalibrationCheck>},
                                      {kSet, document_again<kSet>},
                                      {kReflectance, document_again<kReflectance>},
                                      {kPhotographs, document_again<kPhotographs>},
                                      {kBatchReport, document_again<kBatchReport>}};

struct Stored {
  fs::path file;
  std::string name;     // weft.session
  std::string version;  // 1.1
  std::string schema() const { return name + '/' + version; }
};

std::vector<Stored> stored_documents() {
  std::vector<Stored> all;
  for (const char* root : {"testdata/schemas", "testdata/golden"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / root)) {
      if (entry.path().extension() != ".json") continue;
      const std::string schema = json_in(entry.path())->at("schema");
      const std::size_t slash = schema.find('/');
      all.push_back({entry.path(), schema.substr(0, slash), schema.substr(slash + 1)});
    }
  }
  std::ranges::sort(all, {}, &Stored::file);
  return all;
}

// A copy of the document and of the files beside it, which `change` has made another version's.
template <typename Change>
fs::path copy_of(const Stored& stored, const fs::path& work, const Change& change) {
  fs::remove_all(work);
  fs::create_directories(work / "copy");
  for (const fs::directory_entry& entry : fs::directory_iterator(stored.file.parent_path())) {
    if (entry.is_regular_file()) fs::copy_file(entry.path(), work / "copy" / entry.path().filename());
  }
  const fs::path file = work / "copy" / stored.file.filename();
  Json document = *json_in(file);
  change(document);
  put_bytes(file, document.dump(2));
  const fs::path index = work / "copy/calibration.json";
  if (file != index && fs::exists(index)) {
    Json parts = *json_in(index);
    parts["parts"][file.filename().string()] = sha256_of(document.dump(2));
    put_bytes(index, parts.dump(2));
  }
  return file;
}

// Calls visit(stored, rewrite) for each stored document.
template <typename Visit>
void for_each_stored(const Visit& visit) {
  for (const Stored& stored : stored_documents()) {
    SCOPED_TRACE(stored.file.lexically_relative(kSource).string() + ", " + stored.schema());
    const auto format = std::ranges::find(kFormats, stored.name, &Format::name);
    if (format == kFormats.end()) {
      ADD_FAILURE() << "a format that this test does not know";
      continue;
    }
    visit(stored, format->rewrite);
  }
}

TEST(StoredDocuments, AreReadAndWrittenAgain) {
  const ScratchFolder work;
  for_each_stored([&](const Stored& stored, Rewrite rewrite) {
    const Result<Json> again = rewrite(copy_of(stored, work / "", [](Json&) {}));
    ASSERT_TRUE(again) << again.error().message();
    Json before = *json_in(stored.file), after = *again;
    if (stored.name == "weft.calibration") {  // derived now, in a form that says so
      for (Json* json : {&before, &after}) {
        json->erase("measured");
        json->erase("schema");
      }
    }
    EXPECT_EQ(Json::diff(before, after), Json::array());
  });
}

TEST(StoredDocuments, OfANewerMinorVersionAreReadAndTheirNewFieldsKept) {
  const ScratchFolder work;
  for_each_stored([&](const Stored& stored, Rewrite rewrite) {
    const std::string newer = stored.name + "/1.99";
    const Result<Json> again = rewrite(copy_of(stored, work / "", [&](Json& json) {
      json["schema"] = newer;
      json["of_a_newer_version"] = {{"kept", {1, 2}}};
    }));
    ASSERT_TRUE(again) << again.error().message();
    EXPECT_EQ(again->value("schema", ""), newer);
    EXPECT_EQ(again->value("of_a_newer_version", Json()), Json::parse(R"({"kept": [1, 2]})"));
  });
}

TEST(StoredDocuments, OfANewerMajorVersionAreRefusedByTheVersionTheyNeed) {
  const ScratchFolder work;
  for_each_stored([&](const Stored& stored, Rewrite rewrite) {
    const auto again =
        rewrite(copy_of(stored, work / "", [&](Json& json) { json["schema"] = stored.name + "/2.1"; }));
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().kind, ErrorKind::kBadData);
    EXPECT_THAT(again.error().message(),
                HasSubstr("use a version of weft that reads " + stored.name + "/2."));
    EXPECT_THAT(again.error().message(), HasSubstr(stored.file.filename().string()));
  });
}

TEST(StoredDocuments, AreThereForEveryVersionThatThePageOfFormatsNames) {
  std::set<std::string> there = kOfLines;
  for (const Stored& stored : stored_documents()) there.insert(stored.schema());
  const std::string page = bytes_of(kSource / "docs/formats.md");
  const std::regex schema(R"(`(weft\.[a-z-]+/\d+)(?:\.(\d+))?`)");
  std::set<std::string> named;
  for (std::sregex_iterator match(page.begin(), page.end(), schema), end; match != end; ++match) {
    const int minor = (*match)[2].matched ? std::stoi((*match)[2]) : 0;
    for (int m = 0; m <= minor; ++m)
      named.insert((*match)[1].str() + (m == 0 ? "" : '.' + std::to_string(m)));
  }
  EXPECT_GE(named.size(), kFormats.size());
  EXPECT_EQ(there, named);
}

}  // namespace
}  // namespace weft
