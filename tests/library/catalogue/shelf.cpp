// SPDX-License-Identifier: Apache-2.0
#include "tests/library/catalogue/shelf.h"

#include <gtest/gtest.h>

#include "core/base/files.h"

namespace weft::library {

std::filesystem::path Shelf::put(const std::string& name, const Json& fields) const {
  Json session = {{"schema", "weft.session/1"},
                  {"fabric", "twill"},
                  {"cloth_height_mm", 0.5},
                  {"rig", "bench-1"},
                  {"calibration", "0123456789abcdef"},
                  {"state", "complete"},
                  {"shots",
                   {{{"index", 0},
                     {"led", 1},
                     {"role", "lit"},
                     {"file", "raw/00_led01.dng"},
                     {"exposure_us", 10000},
                     {"iso", 100},
                     {"f_number", 8},
                     {"time", "2026-11-01T10:00:00Z"}}}}};
  session.update(fields);
  std::filesystem::create_directories(folder_of(name));
  const Result<void> written = write_json(folder_of(name) / "session.json", session);
  EXPECT_TRUE(written) << (written ? "" : written.error().message());
  return folder_of(name);
}

void Shelf::solve(const std::string& name, const std::string& id, const Json& fields) const {
  const auto folder = folder_of(name) / "solve" / id;
  std::filesystem::create_directories(folder);
  Json solve = {{"schema", "weft.solve/1"}, {"id", id}};
  solve.update(fields);
  const Result<void> written = write_json(folder / "solve.json", solve);
  EXPECT_TRUE(written) << (written ? "" : written.error().message());
}

}  // namespace weft::library
