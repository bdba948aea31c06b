// SPDX-License-Identifier: Apache-2.0
#include "exchange/u3m/vocabulary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "exchange/u3m/u3m.h"

namespace weft::exchange {
namespace {

TEST(U3mVocabulary, KnowsItsOwnWords) {
  for (const std::string_view word : u3m_fibres()) EXPECT_EQ(u3m_fibre(word), std::string(word));
  for (const std::string_view word : u3m_constructions())
    EXPECT_EQ(u3m_construction(word), std::string(word));
}

TEST(U3mVocabulary, KnowsWordsOfTheTrade) {
  EXPECT_EQ(u3m_fibre("polyamide"), "Polyamid");
  EXPECT_EQ(u3m_fibre("Yak"), "Yack");
  EXPECT_EQ(u3m_fibre("merino wool"), "Wool");
  EXPECT_EQ(u3m_fibre("Virgin  wool"), "Virgin Wool");
  EXPECT_EQ(u3m_fibre("viscose"), "Rayon");
  EXPECT_EQ(u3m_fibre("nettle"), std::nullopt);
  EXPECT_EQ(u3m_fibre(""), std::nullopt);
  EXPECT_EQ(u3m_construction("taffeta"), "TafFeta");
  EXPECT_EQ(u3m_construction("twill 2/1"), "Twill");
  EXPECT_EQ(u3m_construction("2/1 twill"), "Twill");
  EXPECT_EQ(u3m_construction("plain"), "Plain weave");
  EXPECT_EQ(u3m_construction("1x1 rib"), "1 x 1 rib");
  EXPECT_EQ(u3m_construction("felt"), std::nullopt);
}

TEST(U3mVocabulary, ReadsShares) {
  const auto read = [](std::string_view text) {
    std::string told;
    const auto parts = fibres_of(text);
    if (!parts) return std::string("nothing");
    for (const FibrePart& part : *parts) told += part.fibre + "=" + std::to_string(part.share) + ";";
    return told;
  };
  EXPECT_EQ(read("80 % wool, 20 % polyamide"), "wool=0.800000;polyamide=0.200000;");
  EXPECT_EQ(read("wool 80%; polyamide 20%"), "wool=0.800000;polyamide=0.200000;");
  EXPECT_EQ(read("cotton"), "cotton=1.000000;");
  EXPECT_EQ(read("99.8 % silk"), "silk=1.000000;");
  EXPECT_EQ(read("80 % wool"), "nothing") << "a fifth is missing";
  EXPECT_EQ(read("wool 80, cotton 20"), "nothing");
  EXPECT_EQ(read("80 %"), "nothing");
  EXPECT_EQ(read("wool, cotton"), "nothing");
  EXPECT_EQ(read(""), "nothing");
}

TEST(U3mVocabulary, MakesIdsOfTheFourthVersion) {
  EXPECT_EQ(uuid_of("0123456789abcdef0123456789abcdef"), "01234567-89ab-4def-8123-456789abcdef");
  EXPECT_EQ(uuid_of("ffffffffffffffffffffffffffffffffff"), "ffffffff-ffff-4fff-bfff-ffffffffffff");
}

}  // namespace
}  // namespace weft::exchange
