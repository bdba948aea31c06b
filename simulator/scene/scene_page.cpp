// SPDX-License-Identifier: Apache-2.0
#include "simulator/scene/scene_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <ranges>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "simulator/scene/scene_keys.h"

namespace weft::simulator {
namespace {

struct KeyRow {
  std::string name, unit, usual, range, says;
  std::vector<std::size_t> kinds = {};  ///< that have the key

  bool is_alike(const KeyRow& o) const {
    return std::tie(name, unit, usual, range, says) == std::tie(o.name, o.unit, o.usual, o.range, o.says);
  }
};

/// The keys of one section.
struct KeyTable {
  std::string heading, says;
  std::string kind_key = {};            ///< on which it depends what keys there are
  std::vector<std::string> kinds = {};  ///< its values
  std::vector<KeyRow> rows = {};
};

std::string in_ticks(const std::string& text) {
  return fmt::format("`\"{}\"`", text);
}

template <typename Value>
std::string one_of(const Names<Value>& names) {
  std::vector<std::string> words;
  for (const auto& [name, value] : names) words.push_back(in_ticks(name));
  return fmt::format("{}", fmt::join(words, ", "));
}

/// As people write them: 0.08, 20000, 1e9.
std::string words_of(double number) {
  std::string words = fmt::format("{:g}", number);
  if (const std::size_t e = words.find("e+"); e != words.npos)
    words.erase(e + 1, words[e + 2] == '0' ? 2 : 1);
  return words;
}

std::string words_of(std::integral auto number) {
  return fmt::format("{}", number);
}

std::string words_of(const std::string& text) {
  return in_ticks(text);
}

std::string words_of(const std::ranges::range auto& numbers) {
  std::vector<std::string> words;
  for (const double number : numbers) words.push_back(words_of(number));
  return fmt::format("[{}]", fmt::join(words, ", "));
}

template <typename Value>
std::string words_of(const std::optional<Value>& value) {
  return value ? words_of(*value) : "none";
}

std::string words_of(const Range& range) {
  return fmt::format("{} to {}", words_of(range.least), words_of(range.most));
}

/// Collects the keys of one table; its functions are those of SceneReader. A table whose keys depend on a
/// kind is walked once for each.
class KeyCollector {
 public:
  KeyCollector(std::vector<KeyTable>& tables, std::size_t table, std::size_t kind, std::string path)
      : tables_(&tables), table_(table), kind_(kind), path_(std::move(path)) {}

  template <typename Value>
  void number(const SceneKey& key, const Value& value, Range allowed) {
    add(key, words_of(value), words_of(allowed));
  }
  template <typename Value>
  void integer(const SceneKey& key, const Value& value, std::int64_t least, std::int64_t most) {
    const bool is_open = most >= std::numeric_limits<int>::max();
    add(key, words_of(value), is_open ? fmt::format("from {}", least) : fmt::format("{} to {}", least, most));
  }
  void flag(const SceneKey& key, bool value) { add(key, fmt::format("{}", value), "true, false"); }
  template <typename Value>
  void text(const SceneKey& key, const Value& value) {
    add(key, words_of(value), "text");
  }
  template <typename Value>
  void choice(const SceneKey& key, const Value& value, const std::type_identity_t<Names<Value>>& names) {
    const auto now = std::ranges::find(names, value, &Names<Value>::value_type::second);
    add(key, in_ticks(now->first), one_of(names));
  }
  template <typename Value>
  void choice(const SceneKey& key, const std::optional<Value>&,
              const std::type_identity_t<Names<Value>>& names) {
    add(key, "none", one_of(names));
  }
  template <typename Value>
  void kind(const SceneKey& key, Value& value, const std::type_identity_t<Names<Value>>& names) {
    choice(key, value, names);
    table().kind_key = key.name;
    if (table().kinds.empty())
      for (const auto& [name, each] : names) table().kinds.emplace_back(name);
    value = names[kind_].second;
  }
  void rgb(const SceneKey& key, const std::optional<Rgb>& value, Range allowed) {
    const bool is_grey = value && (*value)[0] == (*value)[1] && (*value)[1] == (*value)[2];
    add(key, is_grey ? words_of((*value)[0]) : words_of(value), words_of(allowed));
  }
  void vec3(const SceneKey& key, const std::optional<Vec3>& value, Range allowed) {
    add(key, value ? words_of(std::array{value->x, value->y, value->z}) : "none", words_of(allowed));
  }
  template <typename Values>
  void numbers(const SceneKey& key, const Values& values, Range allowed) {
    add(key, words_of(values), words_of(allowed));
  }
  void file(const SceneKey& key, const std::optional<std::string>&) { add(key, "none", "a file"); }
  void picture(const SceneKey& key, const std::string&, const std::shared_ptr<const Image<float>>&) {
    add(key, "none", "a file");
  }
  template <typename Value>
  void spectrum(const SceneKey& key, const Value&) {
    add(key, "none", "a spectrum");
  }
  template <typename Values>
  void spectra(const SceneKey& key, const Values& values) {
    add(key, "none", fmt::format("{} spectra", values.size()));
  }
  void chart(const SceneKey& key, const std::vector<Spectrum>&, int count) {
    add(key, "none", fmt::format("a folder, {} spectra", count));
  }
  void automatic(const SceneKey& key, const SceneKey& to, const std::optional<double>&, Range allowed) {
    add(key, "none", "");
    add(to, in_ticks(fmt::format("{} sigma", kAutomaticSigma)), words_of(allowed));
  }

  template <typename Settings>
  void section(const char* key, const char* says, const Settings& settings) {
    collect(*tables_, fmt::format("[{}{}]", path_, key), says, fmt::format("{}{}.", path_, key), settings);
  }
  template <typename Settings>
  void optional_section(const char* key, const char* says, const Settings& settings) {
    section(key, says, settings);
  }
  template <typename Settings>
  void list(const char* key, const char* says, const std::vector<Settings>&) {
    collect(*tables_, fmt::format("[[{}{}]]", path_, key), says, fmt::format("{}{}.", path_, key),
            Settings());
  }
  void flags(const char* key, const char* says, const EffectSettings& effects) {
    section(key, says, effects);
  }
  void require(bool, const char*, const char*) {}
  template <typename Value>
  void require(const Result<Value>&, const char*) {}

  /// A section is met again with each kind of the one that it stands in.
  template <typename Settings>
  static void collect(std::vector<KeyTable>& tables, const std::string& heading, const char* says,
                      const std::string& path, const Settings& settings) {
    if (std::ranges::find(tables, heading, &KeyTable::heading) != tables.end()) return;
    const std::size_t table = tables.size();
    tables.push_back({heading, says});
    std::size_t kind = 0;
    do {
      KeyCollector collector(tables, table, kind, path);
      Settings copy = settings;
      walk(collector, copy);
    } while (++kind < tables[table].kinds.size());
  }

 private:
  KeyTable& table() { return (*tables_)[table_]; }

  void add(const SceneKey& key, const std::string& usual, const std::string& range) {
    KeyRow row = {key.name, key.unit, key.unsaid.empty() ? usual : key.unsaid, range, key.says};
    std::vector<KeyRow>& rows = table().rows;
    auto alike = std::ranges::find_if(rows, [&](const KeyRow& each) { return each.is_alike(row); });
    if (alike == rows.end()) alike = rows.insert(rows.end(), std::move(row));
    alike->kinds.push_back(kind_);
  }

  std::vector<KeyTable>* tables_;
  std::size_t table_;
  std::size_t kind_;
  std::string path_;
};

/// Which kinds have a key that not all have.
std::string kinds_of(const KeyRow& row, const KeyTable& table) {
  if (row.kinds.size() == table.kinds.size()) return "";
  std::vector<std::string> words;
  for (const std::size_t kind : row.kinds) words.push_back("`" + table.kinds[kind] + "`");
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string text_of(KeyTable table) {
  const bool has_kinds = !table.kinds.empty();
  std::ranges::stable_partition(table.rows,
                                [&](const KeyRow& row) { return row.kinds.size() == table.kinds.size(); });
  std::string text = fmt::format(
      "\n## {}\n\n{}.\n\n| key |{} unit | default | range | meaning |\n|---|{}---|---|---|---|\n",
      table.heading, table.says, has_kinds ? " " + table.kind_key + " |" : "", has_kinds ? "---|" : "");
  for (const KeyRow& row : table.rows) {
    text += fmt::format("| `{}` |{} {} | {} | {} | {} |\n", row.name,
                        has_kinds ? " " + kinds_of(row, table) + " |" : "", row.unit, row.usual, row.range,
                        row.says);
  }
  return text;
}

}  // namespace

std::string scene_page() {
  std::vector<KeyTable> tables;
  KeyCollector::collect(tables, "Outside of all sections", "What holds for the whole scene", "", Scene());
  std::string page =
      "# Keys of scenes\n\nMade by `weft schema --page scenes` from what reads, checks and writes scenes. "
      "[Scenes](../scenes.md) says what a scene is, which keys contradict each other, and names examples. A "
      "range has both of its ends. A colour is `[r, g, b]` or one number for grey. A spectrum is the name of "
      "a [table](../../testdata/spectra/README.md), or 36 numbers from 0 to 1 for 380 to 730 nm. A file is "
      "relative to the folder of the scene. Where a column `kind` or `model` names some, no other has that "
      "key.\n";
  for (const KeyTable& table : tables) page += text_of(table);
  page.pop_back();
  return page;
}

}  // namespace weft::simulator
