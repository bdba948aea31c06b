// SPDX-License-Identifier: Apache-2.0
#include "exchange/u3m/vocabulary.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "exchange/u3m/u3m.h"

namespace weft::exchange {

namespace {

constexpr std::array<std::string_view, 55> kFibres = {"Abaca",
                                                      "Acetate",
                                                      "Acrylic",
                                                      "Alfa",
                                                      "Alginate",
                                                      "Alpaca",
                                                      "Aluminium",
                                                      "Angora",
                                                      "Aramid",
                                                      "Beaver",
                                                      "Camelhair",
                                                      "Cashmere",
                                                      "Cotton",
                                                      "Cupro",
                                                      "Elastane",
                                                      "Guanaco",
                                                      "Hardware",
                                                      "Hemp",
                                                      "Jute",
                                                      "Linen",
                                                      "Llama",
                                                      "Lycra",
                                                      "Lyocell",
                                                      "Meril",
                                                      "Metallic Fibre",
                                                      "Metallised Polyester",
                                                      "Micropolypch",
                                                      "Modacrylic",
                                                      "Modal Cotton",
                                                      "Modal",
                                                      "Mohair",
                                                      "Neoprene",
                                                      "Nylon",
                                                      "Organic cotton",
                                                      "Polyacryl",
                                                      "Polyamid",
                                                      "Polyester",
                                                      "Polyethylene",
                                                      "Polypropylen",
                                                      "Polytaslan",
                                                      "Ramie",
                                                      "Rayon",
                                                      "Recycled Cotton",
                                                      "Recycled Polyamide",
                                                      "Recycled Polyester",
                                                      "Silk",
                                                      "Spandex",
                                                      "Tactel",
                                                      "Triacetate",
                                                      "Vicugna",
                                                      "Vinyl",
                                                      "Virgin Wool",
                                                      "Wild Silk",
                                                      "Wool",
                                                      "Yack"};

constexpr std::array<std::string_view, 33> kConstructions = {"1 x 1 flatknit",
                                                             "1 x 1 rib",
                                                             "2 x 2 rib",
                                                             "4 x 2 rib",
                                                             "Canvas",
                                                             "Dobby",
                                                             "Doubleknit",
                                                             "Doubleweave",
                                                             "Engineered",
                                                             "Fleece",
                                                             "French terry",
                                                             "Interlock",
                                                             "Jacquard",
                                                             "Mesh",
                                                             "Oxford",
                                                             "Pique",
                                                             "Plain weave",
                                                             "Polarfleece",
                                                             "Poplin",
                                                             "Raschel",
                                                             "Ripstop",
                                                             "Satin",
                                                             "Single jersey",
                                                             "Spacer",
                                                             "TafFeta",
                                                             "Terry loop",
                                                             "Towel",
                                                             "Tricot",
                                                             "Twill - left hand (S)",
                                                             "Twill - right hand (Z)",
                                                             "Twill",
                                                             "Velour",
                                                             "Waffle"};

constexpr std::array<std::string_view, 8> kMaterialTypes = {"Artwork", "Elastics", "Knit", "Leather",
                                                            "Metal",   "Seam",     "Wood", "Woven"};

using Synonym = std::pair<std::string_view, std::string_view>;

/// Words of the trade, as plain_words() has them, and U3M's.
constexpr std::array<Synonym, 17> kFibreSynonyms = {{{"polyamide", "Polyamid"},
                                                     {"polyacrylic", "Polyacryl"},
                                                     {"polyacrylonitrile", "Polyacryl"},
                                                     {"polypropylene", "Polypropylen"},
                                                     {"recycled polyamid", "Recycled Polyamide"},
                                                     {"metallised fibre", "Metallic Fibre"},
                                                     {"metallic fiber", "Metallic Fibre"},
                                                     {"metallized polyester", "Metallised Polyester"},
                                                     {"aluminum", "Aluminium"},
                                                     {"viscose", "Rayon"},
                                                     {"elasthane", "Elastane"},
                                                     {"elastan", "Elastane"},
                                                     {"flax", "Linen"},
                                                     {"yak", "Yack"},
                                                     {"camel hair", "Camelhair"},
                                                     {"tencel", "Lyocell"},
                                                     {"new wool", "Virgin Wool"}}};

constexpr std::array<Synonym, 15> kConstructionSynonyms = {{{"plain", "Plain weave"},
                                                            {"tabby", "Plain weave"},
                                                            {"jersey", "Single jersey"},
                                                            {"sateen", "Satin"},
                                                            {"double knit", "Doubleknit"},
                                                            {"double weave", "Doubleweave"},
                                                            {"double cloth", "Doubleweave"},
                                                            {"polar fleece", "Polarfleece"},
                                                            {"1x1 rib", "1 x 1 rib"},
                                                            {"2x2 rib", "2 x 2 rib"},
                                                            {"4x2 rib", "4 x 2 rib"},
                                                            {"1x1 flatknit", "1 x 1 flatknit"},
                                                            {"s twill", "Twill - left hand (S)"},
                                                            {"z twill", "Twill - right hand (Z)"},
                                                            {"rip stop", "Ripstop"}}};

constexpr std::array<std::string_view, 13> kKnits = {
    "1 x 1 flatknit", "1 x 1 rib", "2 x 2 rib", "4 x 2 rib",     "Doubleknit", "French terry", "Interlock",
    "Polarfleece",    "Raschel",   "Fleece",    "Single jersey", "Spacer",     "Tricot"};

constexpr std::array<std::string_view, 13> kWeaves = {"Canvas",
                                                      "Dobby",
                                                      "Doubleweave",
                                                      "Oxford",
                                                      "Plain weave",
                                                      "Poplin",
                                                      "Ripstop",
                                                      "Satin",
                                                      "TafFeta",
                                                      "Twill",
                                                      "Waffle",
                                                      "Twill - left hand (S)",
                                                      "Twill - right hand (Z)"};

/// Lower case, and one blank for everything between letters and digits.
std::string plain_words(std::string_view text) {
  std::string words;
  for (const char c : text) {
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool is_word = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9') ||
                         static_cast<unsigned char>(lower) >= 0x80;
    if (is_word) {
      words += lower;
    } else if (!words.empty() && words.back() != ' ') {
      words += ' ';
    }
  }
  if (!words.empty() && words.back() == ' ') words.pop_back();
  return words;
}

bool begins_with_words(std::string_view text, std::string_view words) {
  return text.starts_with(words) && (text.size() == words.size() || text[words.size()] == ' ');
}

bool ends_with_words(std::string_view text, std::string_view words) {
  return text.ends_with(words) &&
         (text.size() == words.size() || text[text.size() - words.size() - 1] == ' ');
}

/// The longest known word that the text ends or begins with.
std::optional<std::string> nearest(std::string_view text, std::span<const std::string_view> known,
                                   std::span<const Synonym> synonyms) {
  const std::string words = plain_words(text);
  std::size_t longest = 0;
  std::string_view best;
  const auto consider = [&](const std::string& key, std::string_view word) {
    if (key.size() <= longest || (!begins_with_words(words, key) && !ends_with_words(words, key))) return;
    longest = key.size();
    best = word;
  };
  for (const std::string_view word : known) consider(plain_words(word), word);
  for (const auto& [key, word] : synonyms) consider(std::string(key), word);
  if (longest == 0) return std::nullopt;
  return std::string(best);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = std::min(text.find_first_not_of(" \t"), text.size());
  text.remove_prefix(begin);
  return text.substr(0, text.find_last_not_of(" \t") + 1);
}

/// "80 % wool" or "wool 80%".
std::optional<FibrePart> fibre_part_of(std::string_view text) {
  const std::size_t percent = text.find('%');
  if (percent == std::string_view::npos) return std::nullopt;
  const std::string_view before = trimmed(text.substr(0, percent));
  const std::size_t number_at = before.find_last_not_of("0123456789.") + 1;
  const std::string_view digits = before.substr(number_at);
  double share = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), share);
  if (error != std::errc() || end != digits.data() + digits.size()) return std::nullopt;
  const std::string_view first = trimmed(before.substr(0, number_at));
  const std::string_view second = trimmed(text.substr(percent + 1));
  if (first.empty() == second.empty()) return std::nullopt;
  return FibrePart{share / 100, std::string(first.empty() ? second : first)};
}

}  // namespace

std::span<const std::string_view> u3m_fibres() {
  return kFibres;
}
std::span<const std::string_view> u3m_constructions() {
  return kConstructions;
}
std::span<const std::string_view> u3m_material_types() {
  return kMaterialTypes;
}

std::string_view u3m_material_type_of(std::string_view construction) {
  if (std::ranges::find(kKnits, construction) != kKnits.end()) return "Knit";
  return std::ranges::find(kWeaves, construction) != kWeaves.end() ? "Woven" : "";
}

std::optional<std::string> u3m_fibre(std::string_view words) {
  return nearest(words, kFibres, kFibreSynonyms);
}

std::optional<std::string> u3m_construction(std::string_view words) {
  return nearest(words, kConstructions, kConstructionSynonyms);
}

std::optional<std::vector<FibrePart>> fibres_of(std::string_view composition) {
  std::vector<FibrePart> parts;
  const std::string_view all = trimmed(composition);
  if (all.empty()) return std::nullopt;
  if (all.find_first_of("0123456789%,;") == std::string_view::npos) {
    return std::vector<FibrePart>{{1, std::string(all)}};
  }
  double sum = 0;
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t end = std::min(all.find_first_of(",;", begin), all.size());
    const auto part = fibre_part_of(all.substr(begin, end - begin));
    if (!part) return std::nullopt;
    sum += part->share;
    parts.push_back(*part);
    begin = end + 1;
  }
  if (std::abs(sum - 1) > 0.005 + 1e-9) return std::nullopt;
  for (FibrePart& part : parts) part.share /= sum;
  return parts;
}

}  // namespace weft::exchange
