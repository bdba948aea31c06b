// SPDX-License-Identifier: Apache-2.0
#include "solve/input/light_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/number.h"
#include "core/base/text.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestShown = 40;
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string shown(std::string_view text) {
  return fmt::format("\"{}\"", text.substr(0, kLongestShown));
}

Error bad_number(const fs::path& file, int line, std::string_view word) {
  return {ErrorKind::kBadData, "lights cannot be read", file.string(),
          fmt::format("line {} has not three numbers: {}", line, why_no_number(word)),
          "write finite numbers with a point, as in 0.5 or 5e-1; docs/formats.md has the layout"};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == text.npos) return {};
  return text.substr(begin, text.find_last_not_of(" \t") - begin + 1);
}

void append_utf8(char32_t code, std::string& text) {
  const auto byte = [&](char32_t bits) { text += static_cast<char>(bits); };
  if (code < 0x80) {
    byte(code);
  } else if (code < 0x800) {
    byte(0xC0 | code >> 6);
    byte(0x80 | (code & 0x3F));
  } else if (code < 0x10000) {
    byte(0xE0 | code >> 12);
    byte(0x80 | (code >> 6 & 0x3F));
    byte(0x80 | (code & 0x3F));
  } else {
    byte(0xF0 | code >> 18);
    byte(0x80 | (code >> 12 & 0x3F));
    byte(0x80 | (code >> 6 & 0x3F));
    byte(0x80 | (code & 0x3F));
  }
}

// UTF-16 with the low or the high byte first; nothing where half a pair stands alone.
std::optional<std::string> from_utf16(std::string_view bytes, bool low_first) {
  if (bytes.size() % 2 != 0) return std::nullopt;
  const auto unit = [&](std::size_t i) {
    const auto a = static_cast<unsigned char>(bytes[i]), b = static_cast<unsigned char>(bytes[i + 1]);
    return static_cast<char32_t>(low_first ? a | b << 8 : b | a << 8);
  };
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    char32_t code = unit(i);
    if (code >= 0xDC00 && code <= 0xDFFF) return std::nullopt;
    if (code >= 0xD800 && code <= 0xDBFF) {
      if (i + 2 >= bytes.size()) return std::nullopt;
      const char32_t low = unit(i += 2);
      if (low < 0xDC00 || low > 0xDFFF) return std::nullopt;
      code = 0x10000 + ((code - 0xD800) << 10) + (low - 0xDC00);
    }
    append_utf8(code, text);
  }
  return text;
}

// Which byte of each pair is 0 where a text of ASCII is in UTF-16 without a mark; nothing where none is.
std::optional<bool> is_unmarked_utf16(std::string_view bytes) {
  std::array<std::size_t, 2> zeros = {};
  for (std::size_t i = 0; i < bytes.size(); ++i) zeros[i % 2] += bytes[i] == '\0' ? 1U : 0U;
  const std::size_t most = bytes.size() / 2;
  for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
    if (most > 0 && zeros[side] == most && zeros[1 - side] == 0) return side == 1;
  return std::nullopt;
}

// The bytes as UTF-8, and what was assumed of them.
std::optional<std::string> decoded(std::string_view bytes, std::vector<std::string>& assumed) {
  const bool low_first = bytes.starts_with("\xFF\xFE");
  if (low_first || bytes.starts_with("\xFE\xFF")) {
    assumed.emplace_back("it is UTF-16 with a byte order mark");
    return from_utf16(bytes.substr(2), low_first);
  }
  if (bytes.starts_with(kByteOrderMark)) {
    assumed.emplace_back("a byte order mark was passed over");
    return std::string(bytes.substr(kByteOrderMark.size()));
  }
  if (const std::optional<bool> low = is_unmarked_utf16(bytes)) {
    assumed.emplace_back("it is UTF-16 without a byte order mark");
    return from_utf16(bytes, *low);
  }
  return std::string(bytes);
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with(';') || line.starts_with('%') || line.starts_with("//");
}

// What parts the words of a line; a blank stands for runs of blanks and tabs.
struct Word {
  std::string text;
  std::size_t begin = 0, end = 0;  // in the line, with quotes
};

bool parts(char c, char parted) {
  return c == parted || (parted == ' ' && c == '\t');
}

// The words of a line; quotes hold what parts words, and fall away. Blanks and tabs part once, however many.
std::vector<Word> words_of_row(std::string_view line, char parted) {
  std::vector<Word> words;
  bool is_quoted = false;
  std::size_t begin = 0;
  const auto end_word = [&](std::size_t end) {
    std::string_view text = trimmed(line.substr(begin, end - begin));
    const bool is_kept = !text.empty() || (parted != ' ' && parted != '\t');
    for (const char quote : {'"', '\''})
      if (text.size() >= 2 && text.front() == quote && text.back() == quote)
        text = text.substr(1, text.size() - 2);
    if (is_kept) words.push_back({std::string(text), begin, end});
    begin = end + 1;
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"' && (is_quoted || line.find('"', i + 1) != line.npos)) is_quoted = !is_quoted;
    if (!is_quoted && parts(line[i], parted)) end_word(i);
  }
  end_word(line.size());
  while (!words.empty() && words.back().text.empty()) words.pop_back();
  return words;
}

std::size_t count_of(std::string_view text, char c) {
  return static_cast<std::size_t>(std::ranges::count(text, c));
}

// Two commas or more in the last word, or behind words.
bool is_parted_by_commas(std::string_view line) {
  const std::size_t last = line.find_last_of(" \t");
  if (count_of(last == line.npos ? line : line.substr(last), ',') >= 2) return true;
  std::size_t behind = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    if (line[i] == ',' && (line[i + 1] == ' ' || line[i + 1] == '\t')) ++behind;
  return behind >= 2;
}

char parted_by(const std::vector<TextLine>& lines, std::size_t first) {
  const auto all = [&](auto holds) {
    return std::all_of(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.end(), holds);
  };
  if (all([](const TextLine& line) { return line.text.find(';') != std::string::npos; })) return ';';
  if (all([](const TextLine& line) { return is_parted_by_commas(line.text); })) return ',';
  if (all([](const TextLine& line) { return count_of(line.text, '\t') >= 2; })) return '\t';
  return ' ';
}

// A number with a decimal comma, with a point instead; empty where it is none.
std::string pointed(std::string_view word) {
  if (count_of(word, ',') != 1 || word.find('.') != word.npos) return {};
  std::string text(word);
  text[text.find(',')] = '.';
  return as_number(text) ? text : std::string();
}

// The one name of a column that weft knows, or empty.
std::string column_of(std::string_view written) {
  struct Column {
    const char* name;
    std::vector<std::string_view> written;
  };
  static const std::vector<Column> kColumns = {
      {"file", {"file", "filename", "file_name", "name", "image", "photo", "photograph", "picture"}},
      {"x", {"x", "lx", "dx", "dir_x", "light_x", "x_lamp"}},
      {"y", {"y", "ly", "dy", "dir_y", "light_y", "y_lamp"}},
      {"z", {"z", "lz", "dz", "dir_z", "light_z", "z_lamp"}},
      {"azimuth", {"azimuth", "azimut", "azi", "az", "azimuth_deg", "azimuth (deg)", "azimuth [deg]"}},
      {"elevation",
       {"elevation", "elev", "el", "altitude", "elevation_deg", "elevation (deg)", "elevation [deg]"}},
      {"r", {"r", "red", "ir", "intensity_r"}},
      {"g", {"g", "green", "ig", "intensity_g"}},
      {"b", {"b", "blue", "ib", "intensity_b"}},
      {"strength", {"strength", "intensity", "power", "brightness"}}};
  const std::string small = small_letters(written);
  for (const Column& column : kColumns)
    if (std::ranges::find(column.written, small) != column.written.end()) return column.name;
  const bool is_angle = small.starts_with("azi") || small.starts_with("elev");
  return is_angle && small.find("rad") != small.npos ? "radians" : "";
}

struct WordRow {
  const TextLine* line;
  std::vector<Word> words;
};

/// Reads the rows of one table.
class Table {
 public:
  Table(const fs::path& file, std::vector<std::string>& assumed) : file_(file), assumed_(assumed) {}

  Result<LightRows> read(const std::vector<TextLine>& lines) {
    if (lines.empty()) return bad_lights(file_, "there is nothing in it");
    std::size_t first = take_count(lines);
    parted_ = parted_by(lines, first);
    for (const TextLine& line : lines) {
      std::vector<Word> words = words_of_row(line.text, parted_);
      if (!words.empty()) words_.push_back({&line, std::move(words)});
    }
    if (Result<void> ok = take_heading(first); !ok) return std::move(ok).error();
    words_.erase(words_.begin(), words_.begin() + static_cast<std::ptrdiff_t>(first));
    if (words_.empty()) return bad_lights(file_, "there is no line of numbers in it");
    if (Result<void> ok = settle_commas(); !ok) return std::move(ok).error();
    if (Result<void> ok = check_first(); !ok) return std::move(ok).error();
    is_named_ = !number_in(words_.front().words.front().text);
    for (const WordRow& row : words_) {
      Result<void> ok = heading_.empty() ? take_row(row) : take_by_heading(row);
      if (!ok) return std::move(ok).error();
    }
    return check_widths();
  }

 private:
  // A whole number alone in the first line, where the second has more.
  std::size_t take_count(const std::vector<TextLine>& lines) {
    if (lines.size() < 2 || as_number(lines[1].text) || !pointed(lines[1].text).empty()) return 0;
    table_.announced = as_whole_number<std::size_t>(lines[0].text);
    return table_.announced ? 1 : 0;
  }

  Result<void> take_heading(std::size_t& first) {
    if (first >= words_.size()) return {};
    const std::vector<Word>& words = words_[first].words;
    std::vector<std::string> passed_over;
    for (const Word& word : words) {
      if (as_number(word.text)) {
        heading_.clear();
        return {};
      }
      heading_.push_back(column_of(word.text));
      if (heading_.back() == "radians")
        return bad_lights(file_, fmt::format("{} is in radians, where degrees are read", shown(word.text)));
      if (heading_.back().empty() && !word.text.empty()) passed_over.push_back(word.text);
    }
    const auto has = [&](const char* name) { return std::ranges::count(heading_, name) == 1; };
    if (!(has("x") && has("y") && has("z")) && !(has("azimuth") && has("elevation"))) {
      heading_.clear();
      return {};
    }
    for (const std::string& name : heading_)
      if (!name.empty() && name != "file") table_.columns.push_back(name);
    if (!passed_over.empty())
      assumed_.push_back(fmt::format("columns passed over: {}", fmt::join(passed_over, ", ")));
    ++first;
    return {};
  }

  std::optional<double> number_in(const std::string& word) const {
    if (!has_decimal_commas_) return as_number(word);
    const std::string with_point = pointed(word);
    return as_number(with_point.empty() ? word : with_point);
  }

  // Whether numbers have decimal commas. Some with and some without are neither.
  Result<void> settle_commas() {
    std::size_t with = 0, whole = 0, others = 0;
    std::string first;
    int line = 0;
    for (const WordRow& row : words_) {
      for (auto word = row.words.rbegin(); word != row.words.rend(); ++word) {
        if (!pointed(word->text).empty()) {
          ++with;
          if (first.empty()) std::tie(first, line) = std::pair(word->text, row.line->number);
        } else if (as_number(word->text)) {
          const bool is_whole = word->text.find_first_of(".eE") == std::string::npos;
          ++(is_whole ? whole : others);
        } else if (heading_.empty()) {
          break;
        }
      }
    }
    if (with == 0) return {};
    const bool cannot_part = parted_ == ';' || parted_ == '\t';
    if (others > 0 || (whole > 0 && !cannot_part)) return bad_number(file_, line, first);
    has_decimal_commas_ = true;
    assumed_.emplace_back("decimal commas");
    return {};
  }

  // A first line that is no row stands where a count is read.
  Result<void> check_first() const {
    if (!heading_.empty() || table_.announced || words_.size() < 2) return {};
    const std::vector<Word>& words = words_.front().words;
    if (words.size() == words_[1].words.size() || numbers_behind(words) >= 3) return {};
    return bad_lights(file_, fmt::format("the first line is not the number of photographs: {}",
                                         shown(words_.front().line->text)));
  }

  std::size_t numbers_behind(const std::vector<Word>& words) const {
    std::size_t from = words.size();
    while (from > 0 && number_in(words[from - 1].text)) --from;
    return words.size() - from;
  }

  Result<void> take_row(const WordRow& row) {
    const std::vector<Word>& words = row.words;
    const int line = row.line->number;
    LightRow taken = {.line = line};
    const std::size_t from = words.size() - numbers_behind(words);
    for (std::size_t i = from; i < words.size(); ++i) taken.numbers.push_back(*number_in(words[i].text));
    if (!is_named_) {
      if (from == 0) return take(std::move(taken));
      return words.size() == 3 ? bad_number(file_, line, words[from - 1].text)
                               : bad_lights(file_, fmt::format("line {} is not three numbers", line));
    }
    if (from > 0 && taken.numbers.size() >= 3) {
      taken.name =
          from == 1 ? words[0].text
                    : std::string(trimmed(std::string_view(row.line->text).substr(0, words[from - 1].end)));
      return take(std::move(taken));
    }
    if (words.size() < 4 || from == 0)
      return bad_lights(file_, fmt::format("line {}: \"{}\" is not \"file x y z\"", line, row.line->text));
    return bad_number(file_, line, words[from - 1].text);
  }

  // As the heading names the words. A name that is not quoted may hold blanks.
  Result<void> take_by_heading(const WordRow& row) {
    std::vector<Word> words = row.words;
    if (parted_ == ' ' && heading_.front() == "file" && words.size() > heading_.size()) {
      const std::size_t more = words.size() - heading_.size();
      words[more].text = row.line->text.substr(0, words[more].end);
      words.erase(words.begin(), words.begin() + static_cast<std::ptrdiff_t>(more));
    }
    const int line = row.line->number;
    if (words.size() > heading_.size()) {
      return bad_lights(
          file_, fmt::format("line {} has {} words, the heading {}", line, words.size(), heading_.size()));
    }
    LightRow taken = {.line = line};
    for (std::size_t i = 0; i < heading_.size(); ++i) {
      if (heading_[i].empty()) continue;
      const std::string word = i < words.size() ? words[i].text : "";
      if (heading_[i] == "file") {
        taken.name = word;
        continue;
      }
      const std::optional<double> number = number_in(word);
      if (!number) return bad_number(file_, line, word);
      taken.numbers.push_back(*number);
    }
    return take(std::move(taken));
  }

  Result<void> take(LightRow row) {
    table_.rows.push_back(std::move(row));
    return {};
  }

  Result<LightRows> check_widths() {
    const std::size_t width = table_.rows.front().numbers.size();
    bool is_whole = true;
    for (const LightRow& row : table_.rows) {
      if (row.numbers.size() != width) {
        return bad_lights(file_,
                          fmt::format("line {} is not {} numbers, as those before: it has {}", row.line,
                                      width == 3 ? "three" : std::to_string(width), row.numbers.size()));
      }
      for (const double number : row.numbers) is_whole = is_whole && number == std::trunc(number);
    }
    if (parted_ == ',' && width == 6 && is_whole) {
      return bad_lights(file_,
                        fmt::format("line {} may be three numbers with decimal commas or six whole ones",
                                    table_.rows.front().line));
    }
    return std::move(table_);
  }

  const fs::path& file_;
  std::vector<std::string>& assumed_;
  char parted_ = ' ';
  bool has_decimal_commas_ = false, is_named_ = false;
  std::vector<std::string> heading_;  // a known name a column, or empty
  std::vector<WordRow> words_;
  LightRows table_;
};

}  // namespace

Error bad_lights(const fs::path& file, std::string why) {
  return {ErrorKind::kBadData, "lights cannot be read", file.string(), std::move(why),
          "see docs/formats.md for the layout"};
}

Result<TextLines> lines_of(std::string_view bytes, const fs::path& file) {
  TextLines text;
  const std::optional<std::string> plain = decoded(bytes, text.assumed);
  const auto is_control = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\t' && c != '\n' && c != '\r') || byte == 0x7F;
  };
  if (!plain || std::ranges::any_of(*plain, is_control)) return bad_lights(file, "it is no text");
  int number = 1;
  for (std::size_t begin = 0; begin <= plain->size(); ++number) {
    const std::size_t end = std::min(plain->find_first_of("\r\n", begin), plain->size());
    const std::string_view line = trimmed(std::string_view(*plain).substr(begin, end - begin));
    if (!line.empty() && !is_comment(line)) text.lines.push_back({number, std::string(line)});
    begin = end + (plain->compare(end, 2, "\r\n") == 0 ? 2 : 1);
  }
  return text;
}

Result<LightRows> rows_of(const std::vector<TextLine>& lines, const fs::path& file,
                          std::vector<std::string>& assumed) {
  return Table(file, assumed).read(lines);
}

}  // namespace weft::solve
