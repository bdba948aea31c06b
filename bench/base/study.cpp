// SPDX-License-Identifier: Apache-2.0
#include "bench/base/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <utility>

#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/temporary_folder.h"

namespace weft::bench {
namespace {

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string cell_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number_integer()) return value.dump();
  if (!value.is_number()) return value.is_null() ? "" : value.dump();
  const double v = value.get<double>();
  return v == 0 || std::abs(v) >= 0.001 ? fmt::format("{:.4g}", v) : fmt::format("{:.2e}", v);
}

}  // namespace

Result<void> add_row(Rows& rows, Result<Json> row) {
  if (!row) return std::move(row).error();
  rows.push_back(std::move(*row));
  return {};
}

Result<std::string> run_weft(const std::vector<std::string>& arguments,
                             const std::filesystem::path& program) {
  constexpr double kLongest_s = 4 * 3600;
  const TemporaryFolder folder;
  const std::filesystem::path errors = folder.path() / "errors";
  std::vector<std::string> command = {program.string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  const auto weft = ChildProcess::start(command, {}, folder.path() / "said", errors);
  if (!weft) return weft.error();
  const std::optional<int> code = (*weft)->wait(kLongest_s);
  const std::string where = fmt::format("{}", fmt::join(command, " "));
  if (!code)
    return Error{ErrorKind::kTryAgain, "weft did not end", where, fmt::format("within {} s", kLongest_s), ""};
  if (*code == 0) return (*weft)->said();
  const Result<std::string> said = read_text(errors);
  const std::string why = (said ? *said : "") + (*weft)->said();
  return Error{ErrorKind::kInternal, fmt::format("weft ended with {}", *code), where, why.substr(0, 2000),
               "run the same command by hand"};
}

Json document_of(const Rows& rows) {
  return {{"machine", {{"processor", processor_name()}, {"threads", hardware_threads()}}}, {"rows", rows}};
}

std::string table_of(const Rows& rows) {
  std::vector<std::string> keys;
  for (const Json& row : rows) {
    for (const auto& [key, value] : row.items()) {
      if (std::find(keys.begin(), keys.end(), key) == keys.end()) keys.push_back(key);
    }
  }
  std::string table;
  std::vector<std::size_t> widths;
  for (const std::string& key : keys) {
    std::size_t width = key.size();
    for (const Json& row : rows) {
      if (row.contains(key)) width = std::max(width, cell_of(row[key]).size());
    }
    widths.push_back(width);
    table += fmt::format("{:>{}}  ", key, width);
  }
  for (const Json& row : rows) {
    table += '\n';
    for (std::size_t i = 0; i < keys.size(); ++i) {
      table += fmt::format("{:>{}}  ", row.contains(keys[i]) ? cell_of(row[keys[i]]) : "", widths[i]);
    }
  }
  return table;
}

}  // namespace weft::bench
