// SPDX-License-Identifier: Apache-2.0
#include "core/base/product.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>

namespace weft {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

constexpr ProductKind kMaps = {"weft.solve", "solve.json", "solve",
                               "solve the session first with weft solve"};

class Products : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(parent_); }
  void TearDown() override { fs::remove_all(parent_); }

  void complete(const Product& product, int age_s) {
    PartialFolder partial(product.folder);
    ASSERT_TRUE(begin(partial, 0));
    ASSERT_TRUE(
        write_json(partial.path() / kMaps.document, {{"schema", "weft.solve/1"}, {"id", product.id}}));
    ASSERT_TRUE(partial.publish());
    fs::last_write_time(product.folder / kMaps.document,
                        fs::file_time_type::clock::now() - std::chrono::seconds(age_s));
  }

  const fs::path parent_ = fs::temp_directory_path() / ("weft_product_test." + std::to_string(::getpid()));
};

TEST_F(Products, AreNamedByTheirInputsAlone) {
  const Json inputs = {{"session", "a"}, {"method", "fast"}};
  EXPECT_EQ(product_id(inputs), product_id(Json::parse(inputs.dump())));
  EXPECT_NE(product_id(inputs), product_id({{"session", "a"}, {"method", "robust"}}));
  EXPECT_EQ(product_id(inputs).size(), 16U);
  EXPECT_EQ(product_of(kMaps, inputs, parent_, {}).folder, parent_ / product_id(inputs));
  EXPECT_EQ(product_of(kMaps, inputs, parent_, parent_ / "x" / ".." / "mine").folder, parent_ / "mine");
}

TEST_F(Products, AreFoundOnceTheyAreComplete) {
  const Product product = product_of(kMaps, {{"session", "a"}}, parent_, {});
  const auto before = find_finished(product);
  ASSERT_TRUE(before);
  EXPECT_FALSE(before->has_value());
  complete(product, 0);
  const auto after = find_finished(product);
  ASSERT_TRUE(after && after->has_value());
  EXPECT_EQ((**after)["id"], product.id);
}

TEST_F(Products, NeverTakeAFolderThatHoldsSomethingElse) {
  const Product other = product_of(kMaps, {{"session", "b"}}, parent_, parent_ / "mine");
  complete(other, 0);
  const auto found = find_finished(product_of(kMaps, {{"session", "a"}}, parent_, parent_ / "mine"));
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().kind, ErrorKind::kCannotCreate);
  EXPECT_THAT(found.error().message(), HasSubstr("something other than this solve"));
}

TEST_F(Products, LeaveNothingBehindWhereTheyWereNotPublished) {
  {
    PartialFolder partial(parent_ / "deep" / "down");
    ASSERT_TRUE(begin(partial, 0));
    EXPECT_TRUE(fs::exists(partial.path()));
  }
  EXPECT_TRUE(fs::is_empty(parent_));
}

TEST_F(Products, AreNotBegunWithoutRoom) {
  PartialFolder partial(parent_ / "maps");
  const auto begun = begin(partial, std::uint64_t{1} << 62);
  ASSERT_FALSE(begun);
  EXPECT_EQ(begun.error().kind, ErrorKind::kInputOutput);
  EXPECT_THAT(begun.error().message(), HasSubstr("MB are needed"));
}

TEST_F(Products, AreListedByAgeAndFoundByTheirIdAlone) {
  const Product old_one = product_of(kMaps, {{"session", "a"}}, parent_, {});
  const Product new_one = product_of(kMaps, {{"session", "b"}}, parent_, {});
  const auto none = find_product(kMaps, parent_, "");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kNoInput);
  complete(new_one, 10);
  complete(old_one, 100);
  fs::create_directories(parent_ / ".aside");
  std::ofstream(parent_ / ".aside" / kMaps.document) << "{}";
  const auto all = list_products(kMaps, parent_);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].id, old_one.id);
  EXPECT_EQ(all[1].id, new_one.id);
  EXPECT_FALSE(find_product(kMaps, parent_, ""));
  EXPECT_EQ(find_product(kMaps, parent_, old_one.id)->folder, old_one.folder);
  EXPECT_FALSE(find_product(kMaps, parent_, "../" + old_one.id)) << "an id is a name, not a path";
}

}  // namespace
}  // namespace weft
