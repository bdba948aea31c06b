// SPDX-License-Identifier: Apache-2.0
#include "solve/input/light_list.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/base/text.h"
#include "solve/input/light_json.h"
#include "solve/input/light_text.h"
#include "solve/input/npy_matrix.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{8} << 20, kMostOfViews = 4 * kMostBytes;
/// By which a unit length may be off as written with two digits.
constexpr double kUnit = 0.02;

/// Vectors beyond are no lights in any unit.
constexpr double kShortest = 1e-9, kLongest = 1e12;

using Matrix = std::vector<std::vector<double>>;

Error no_strength(const fs::path& file, std::size_t light, double strength) {
  return bad_lights(file, fmt::format("light {} has an intensity of {}", light + 1, strength));
}

Matrix transposed(const Matrix& matrix) {
  Matrix turned(matrix.front().size(), std::vector<double>(matrix.size()));
  for (std::size_t i = 0; i < matrix.size(); ++i)
    for (std::size_t j = 0; j < matrix[i].size(); ++j) turned[j][i] = matrix[i][j];
  return turned;
}

Result<void> take_strength(const std::vector<double>& numbers, const fs::path& file, LightList& list) {
  ListedLight& light = list.lights.back();
  for (std::size_t c = 0; c < 3; ++c) {
    light.strength_rgb[c] = numbers[numbers.size() == 1 ? 0 : c];
    if (!(light.strength_rgb[c] > 0)) return no_strength(file, list.lights.size() - 1, light.strength_rgb[c]);
  }
  list.have_strengths = true;
  return {};
}

// Rows of three numbers, or three rows.
Result<LightList> list_of_matrix(Matrix matrix, const fs::path& file, const char* kind) {
  LightList list = {.file = file, .kind = kind};
  if (matrix.empty()) return bad_lights(file, "there is no light in it");
  if (matrix.size() == 3 && matrix.front().size() > 3) {
    list.assumed.push_back(
        fmt::format("three rows of {} numbers: a light is a column", matrix.front().size()));
    matrix = transposed(matrix);
  }
  for (const std::vector<double>& row : matrix) {
    if (row.size() != 3) {
      return bad_lights(
          file, fmt::format("line {} is not three numbers: it has {}", list.lights.size() + 1, row.size()));
    }
    list.lights.push_back({.toward = {row[0], row[1], row[2]}});
  }
  return list;
}

/// What the fourth number of each line counts: 0, 1, 2 or 1, 2, 3.
bool is_counting(const LightRows& table) {
  const double first = table.rows.front().numbers[3];
  for (std::size_t k = 0; k < table.rows.size(); ++k)
    if (table.rows[k].numbers[3] != first + static_cast<double>(k)) return false;
  return (first == 0 || first == 1) && table.rows.size() > 1;
}

// Lines "file x y z", with a strength or three behind it.
Result<LightList> list_of_names(const LightRows& table, const fs::path& file) {
  LightList list = {.file = file, .kind = "table of names and lights"};
  const std::size_t width = table.rows.front().numbers.size();
  if (width != 3 && width != 4 && width != 6) {
    return bad_lights(file, fmt::format("line {} has {} numbers: three are read, four or six with a strength",
                                        table.rows.front().line, width));
  }
  const bool counts = width == 4 && is_counting(table);
  if (counts) list.assumed.emplace_back("four numbers a line: the fourth counts lines and is passed over");
  if (width == 4 && !counts)
    list.assumed.emplace_back("four numbers a line: the fourth is taken as the light's strength");
  if (width == 6)
    list.assumed.emplace_back("six numbers a line: the last three are taken as strengths R, G, B");
  for (const LightRow& row : table.rows) {
    if (row.name.empty()) return bad_lights(file, fmt::format("line {} names no photograph", row.line));
    const std::vector<double>& n = row.numbers;
    list.lights.push_back({.name = row.name, .toward = {n[0], n[1], n[2]}});
    if (width == 3 || counts) continue;
    if (Result<void> ok = take_strength({n.begin() + 3, n.end()}, file, list); !ok)
      return std::move(ok).error();
  }
  return list;
}

/// A table whose columns have names.
class HeadedTable {
 public:
  HeadedTable(const LightRows& table, const fs::path& file) : table_(table), file_(file) {}

  Result<LightList> read() const {
    LightList list = {.file = file_, .kind = "table with a heading"};
    const bool are_angles = !column("x");
    if (are_angles) {
      if (look_like_radians())
        return bad_lights(file_, "azimuth and elevation look like radians, where degrees are read");
      list.assumed.emplace_back("azimuth is from x to y, elevation above the table, both in degrees");
    }
    for (const LightRow& row : table_.rows) {
      list.lights.push_back({.name = row.name, .toward = are_angles ? by_angles(row) : by_axes(row)});
      std::vector<double> strength;
      if (column("r") && column("g") && column("b")) {
        strength = {at(row, "r"), at(row, "g"), at(row, "b")};
      } else if (column("strength")) {
        strength = {at(row, "strength")};
      }
      if (strength.empty()) continue;
      if (Result<void> ok = take_strength(strength, file_, list); !ok) return std::move(ok).error();
    }
    return list;
  }

 private:
  std::optional<std::size_t> column(const char* name) const {
    const auto found = std::ranges::find(table_.columns, name);
    if (found == table_.columns.end()) return std::nullopt;
    return static_cast<std::size_t>(found - table_.columns.begin());
  }
  double at(const LightRow& row, const char* name) const { return row.numbers[*column(name)]; }

  Vec3 by_axes(const LightRow& row) const { return {at(row, "x"), at(row, "y"), at(row, "z")}; }
  Vec3 by_angles(const LightRow& row) const {
    const double azimuth = radians(at(row, "azimuth")), elevation = radians(at(row, "elevation"));
    return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
            std::sin(elevation)};
  }
  bool look_like_radians() const {
    return std::ranges::all_of(table_.rows, [&](const LightRow& row) {
      return std::abs(at(row, "azimuth")) <= 2.01 * kPi && std::abs(at(row, "elevation")) <= 0.501 * kPi;
    });
  }

  const LightRows& table_;
  const fs::path& file_;
};

Matrix matrix_of(const LightRows& table) {
  Matrix matrix;
  for (const LightRow& row : table.rows) matrix.push_back(row.numbers);
  return matrix;
}

Result<LightList> list_of_text(std::string_view bytes, const fs::path& file) {
  Result<TextLines> text = lines_of(bytes, file);
  if (!text) return std::move(text).error();
  const Result<LightRows> table = rows_of(text->lines, file, text->assumed);
  if (!table) return table.error();
  const bool is_named = !table->rows.front().name.empty();
  Result<LightList> list = !table->columns.empty() ? HeadedTable(*table, file).read()
                           : is_named              ? list_of_names(*table, file)
                                      : list_of_matrix(matrix_of(*table), file, "list of directions");
  if (!list) return list;
  const bool is_lp = small_letters(file.extension().string()) == ".lp";
  if (is_lp) list->kind = "RTI light file";
  if (is_lp && !table->announced)
    text->assumed.push_back(
        fmt::format("the first line has no count: {} lights are listed", list->lights.size()));
  if (table->announced && *table->announced != list->lights.size()) {
    text->assumed.push_back(
        fmt::format("it announces {} photographs and lists {}", *table->announced, list->lights.size()));
  }
  list->assumed.insert(list->assumed.begin(), text->assumed.begin(), text->assumed.end());
  return list;
}

// Vectors that are not of unit length are positions.
Result<LightList> settle_lengths(LightList list) {
  double least = std::numeric_limits<double>::max(), most = 0;
  for (std::size_t k = 0; k < list.lights.size(); ++k) {
    const double long_ = length(list.lights[k].toward);
    if (!(long_ > kShortest))
      return bad_lights(list.file, fmt::format("light {}: a direction has no length", k + 1));
    if (!(long_ < kLongest)) return bad_lights(list.file, fmt::format("light {} is {} long", k + 1, long_));
    least = std::min(least, long_);
    most = std::max(most, long_);
  }
  if (list.lights.empty()) return bad_lights(list.file, "there is no light in it");
  const bool are_unit = std::abs(least - 1) <= kUnit && std::abs(most - 1) <= kUnit;
  list.are_positions = list.are_positions || !are_unit;
  if (list.are_positions) {
    list.assumed.push_back(fmt::format(
        "vectors {:.3g} to {:.3g} long are taken as positions, seen from the middle of the picture", least,
        most));
  } else {
    for (ListedLight& light : list.lights) light.toward = normalized(light.toward);
  }
  return list;
}

Result<Matrix> read_matrix(const fs::path& file, std::vector<std::string>& assumed) {
  const Result<std::string> bytes = read_text(file, kMostBytes);
  if (!bytes) return bytes.error();
  if (is_npy(*bytes)) return read_npy_matrix(*bytes, file);
  const Result<TextLines> text = lines_of(*bytes, file);
  if (!text) return text.error();
  const Result<LightRows> table = rows_of(text->lines, file, assumed);
  if (!table) return table.error();
  return matrix_of(*table);
}

// NAME.txt, .csv or .npy of a folder; empty where there is none.
fs::path companion(const fs::path& folder, const char* name) {
  for (const char* ending : {".txt", ".csv", ".npy"})
    if (is_there(folder / (name + std::string(ending)))) return folder / (name + std::string(ending));
  return {};
}

Result<std::vector<std::string>> read_names(const fs::path& file) {
  const Result<std::string> bytes = read_text(file, kMostBytes);
  if (!bytes) return bytes.error();
  Result<TextLines> text = lines_of(*bytes, file);
  if (!text) return std::move(text).error();
  std::vector<std::string> names;
  for (TextLine& line : text->lines) names.push_back(std::move(line.text));
  return names;
}

Error unequal(const LightList& list, std::size_t names, std::size_t strengths) {
  return bad_lights(list.file.parent_path(),
                    fmt::format("filenames.txt has {} lines, {} {}, light_intensities.txt {}", names,
                                list.file.filename().string(), list.lights.size(), strengths));
}

// What lies beside a list of directions: light_intensities.*, filenames.txt.
Result<void> take_companions(LightList& list) {
  const fs::path folder = list.file.parent_path(), names_file = folder / "filenames.txt",
                 strengths_file = companion(folder, "light_intensities");
  const std::size_t count = list.lights.size();
  std::vector<std::string> names;
  if (list.lights.front().name.empty() && is_there(names_file)) {
    Result<std::vector<std::string>> read = read_names(names_file);
    if (!read) return std::move(read).error();
    names = std::move(*read);
    if (names.size() != count) return unequal(list, names.size(), count);
  }
  if (!list.have_strengths && !strengths_file.empty()) {
    Result<Matrix> strengths = read_matrix(strengths_file, list.assumed);
    if (!strengths) return std::move(strengths).error();
    const auto fits = [&](const Matrix& m) {
      return m.size() == count && (m.front().size() == 1 || m.front().size() == 3);
    };
    if (!strengths->empty() && !fits(*strengths) && fits(transposed(*strengths))) {
      list.assumed.emplace_back("a column of light_intensities is a light");
      *strengths = transposed(*strengths);
    }
    if (strengths->size() != count)
      return unequal(list, names.empty() ? count : names.size(), strengths->size());
    if (!fits(*strengths)) return bad_lights(strengths_file, "line 1 is neither one number nor three");
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double strength = (*strengths)[k][(*strengths)[k].size() == 1 ? 0 : c];
        if (!(strength > 0)) return no_strength(strengths_file, k, strength);
        list.lights[k].strength_rgb[c] = strength;
      }
    }
    list.have_strengths = true;
  }
  for (std::size_t k = 0; k < names.size(); ++k) list.lights[k].name = std::move(names[k]);
  return {};
}

// The files of Meshroom's structure from motion in a folder, as people count.
std::vector<fs::path> sfm_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    if (small_letters(entry->path().extension().string()) == ".sfm") files.push_back(entry->path());
  }
  std::ranges::sort(files, [](const fs::path& a, const fs::path& b) {
    return stands_before(a.filename().string(), b.filename().string());
  });
  return files;
}

// Names by the .sfm beside lights of Meshroom's views. Several that name them otherwise are refused.
Result<void> take_views(LightList& list) {
  if (list.lights.front().view.empty() || !list.lights.front().name.empty()) return {};
  const std::vector<ListedLight> unnamed = list.lights;
  fs::path named_by;
  for (const fs::path& file : sfm_files_in(absolute_folder(list.file.parent_path()))) {
    const Result<std::string> bytes = read_text(file, kMostOfViews);
    if (!bytes) return bytes.error();
    LightList other = list;
    other.lights = unnamed;
    const Result<bool> has_all = name_views(*bytes, file, other);
    if (!has_all) return has_all.error();
    if (!*has_all) continue;
    const bool is_same =
        std::ranges::equal(list.lights, other.lights, {}, &ListedLight::name, &ListedLight::name);
    if (!named_by.empty() && !is_same) {
      return bad_lights(list.file, fmt::format("{} and {} name the photographs of its views differently",
                                               named_by.filename().string(), file.filename().string()));
    }
    list.lights = std::move(other.lights);
    named_by = file;
  }
  list.assumed.push_back(named_by.empty() ? "no .sfm beside it names the photographs of its views"
                                          : "views are named by " + named_by.filename().string());
  return {};
}

}  // namespace

Result<LightList> parse_light_list(std::string_view bytes, const fs::path& file) {
  if (bytes.starts_with("MATLAB") || bytes.starts_with("\x89HDF")) {
    return Error{ErrorKind::kBadData, "lights cannot be read", file.string(), "it is a binary file of MATLAB",
                 "save them as text, by save('lights.txt', 'L', '-ascii')"};
  }
  if (is_npy(bytes)) {
    Result<Matrix> matrix = read_npy_matrix(bytes, file);
    if (!matrix) return std::move(matrix).error();
    Result<LightList> list = list_of_matrix(std::move(*matrix), file, "array of NumPy");
    return list ? settle_lengths(std::move(*list)) : list;
  }
  std::string_view start = bytes;
  if (start.starts_with("\xEF\xBB\xBF")) start.remove_prefix(3);
  const std::size_t first = std::min(start.find_first_not_of(" \t\r\n"), start.size());
  const bool is_json = start.substr(first).starts_with('{') || start.substr(first).starts_with('[');
  Result<LightList> list = is_json ? read_light_json(start, file) : list_of_text(bytes, file);
  return list ? settle_lengths(std::move(*list)) : list;
}

Result<LightList> read_light_list(const fs::path& file) {
  const Result<std::string> bytes = read_text(file, kMostBytes);
  if (!bytes) return bytes.error();
  Result<LightList> list = parse_light_list(*bytes, file);
  if (!list) return list;
  const std::string ending = small_letters(file.extension().string());
  if (Result<void> ok = take_views(*list); !ok) return std::move(ok).error();
  const bool stands_alone = ending == ".lp" || ending == ".json" || ending == ".dome" || ending == ".relight";
  if (stands_alone) return list;
  if (Result<void> ok = take_companions(*list); !ok) return std::move(ok).error();
  return list;
}

Result<LightList> find_lights(const fs::path& file, const PhotographPlace& place) {
  std::error_code ignored;
  fs::path named = file;
  if (file.empty() || fs::is_directory(file, ignored)) {
    Result<fs::path> found = find_light_file(file.empty() ? place.folder : file);
    if (!found) return std::move(found).error();
    named = std::move(*found);
  }
  Result<LightList> list = read_light_list(named);
  if (!list) return list;
  if (file.empty() && absolute_folder(named.parent_path()) != absolute_folder(place.folder)) {
    list->assumed.push_back(fmt::format("lights are those of {} in {}", named.filename().string(),
                                        absolute_folder(named.parent_path()).filename().string()));
  }
  if (Result<void> ok = find_photographs(place, *list); !ok) return std::move(ok).error();
  return list;
}

std::string words_of(const LightList& list) {
  std::string words = fmt::format("{} lights, {}", list.lights.size(), list.kind);
  for (const std::string& assumed : list.assumed) words += "; " + assumed;
  return words;
}

}  // namespace weft::solve
