// SPDX-License-Identifier: Apache-2.0
#include "solve/input/session_photos.h"

#include <utility>

#include "solve/input/photo_input.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

PhotoOptions photos_of(const SessionOptions& options, const std::vector<Shot>& lit, const Session& session) {
  PhotoOptions photos;
  photos.folder = session.folder / kPhotographsFolder;
  photos.light_file = photos.folder / kLightsFile;
  photos.reading = reading_of(options, session);
  photos.clipped = options.clipped;
  for (const Shot& shot : lit) photos.lights.push_back(shot.led);
  if (const Shot* dark = session.dark()) photos.dark = session.path_of(*dark);
  return photos;
}

Result<void> check_photograph(const Session& session, const Shot& shot, const fs::path& found,
                              const std::string& sha256) {
  const auto refuse = [&](std::string why) {
    return Error{ErrorKind::kBadData, "photograph is not the one that was imported",
                 session.path_of(shot).string(), std::move(why), "import the photographs again"};
  };
  if (found.lexically_normal() != session.path_of(shot).lexically_normal())
    return refuse("for its light " + std::string(kLightsFile) + " names " + found.filename().string());
  if (sha256 != shot.sha256)
    return refuse("its SHA-256 differs from session.json: it was changed, truncated or swapped");
  return {};
}

}  // namespace

PhotoReading reading_of(const SessionOptions& options, const Session& session) {
  return options.forgets_reading ? options.reading
                                 : said_after(options.reading, session.photographs.value_or(PhotoReading()));
}

Result<SolvePlan> plan_photographs(const SessionOptions& options, const std::vector<Shot>& lit,
                                   SolvePlan begun) {
  Session& session = begun.session;
  if (!options.calibration.empty()) {
    return Error{ErrorKind::kUsage, "photographs that no rig took have no calibration", begun.where,
                 "they are solved by the lights that were imported with them", "leave --calibration out"};
  }
  Result<SolvePlan> plan = plan_photos(photos_of(options, lit, session));
  if (!plan) return plan;
  for (std::size_t k = 0; k < lit.size(); ++k) {
    DistantPhotograph& photograph = plan->input.photographs[k];
    Result<void> ok =
        check_photograph(session, lit[k], plan->session.path_of(plan->lit[k]), photograph.sha256);
    if (!ok) return std::move(ok).error();
    photograph.file = plan->lit[k].file = lit[k].file;
    plan->lit[k].index = lit[k].index;
  }
  if (plan->dark) {
    const Shot& dark = *session.dark();
    Result<void> ok = check_photograph(session, dark, session.path_of(dark), plan->input.dark);
    if (!ok) return std::move(ok).error();
    plan->dark = dark;
  }
  plan->input.session = session.fabric;
  plan->where = std::move(begun.where);
  plan->session_name = std::move(begun.session_name);
  plan->solves = std::move(begun.solves);
  plan->truth = std::move(begun.truth);
  plan->warnings.insert(plan->warnings.begin(), begun.warnings.begin(), begun.warnings.end());
  plan->session = std::move(session);
  return plan;
}

}  // namespace weft::solve
