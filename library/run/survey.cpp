// SPDX-License-Identifier: Apache-2.0
#include "library/run/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include "core/base/files.h"
#include "core/base/parallel.h"
#include "core/base/product.h"
#include "core/rig/calibration.h"
#include "core/solve/solve.h"
#include "library/run/lean.h"
#include "solve/input/load.h"
#include "solve/run/solve_session.h"
#include "solve/session/current.h"
#include "solver/method.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

// Bytes a pixel of the maps that stay, as docs/formats.md has them.
double map_bytes(const BatchProduct& product) {
  double bytes = 0;
  for (const auto& [name, each] : std::map<std::string, double>{{"normal", product.half ? 6 : 12},
                                                                {"albedo", 6},
                                                                {"sigma", 32},
                                                                {"residual", 2},
                                                                {"status", 0.5}}) {
    if (product.keep.empty() || std::ranges::find(product.keep, name) != product.keep.end()) bytes += each;
  }
  return bytes;
}

// Each calibration is read once, by the first that asks.
class Calibrations {
 public:
  const Result<Calibration>& of(const std::string& id, const fs::path& folder) {
    Slot* slot = nullptr;
    {
      const std::lock_guard lock(mutex_);
      std::unique_ptr<Slot>& found = slots_[id];
      if (!found) found = std::make_unique<Slot>();
      slot = found.get();
    }
    std::call_once(slot->once, [&] { slot->calibration.emplace(read_calibration(folder)); });
    return *slot->calibration;
  }

 private:
  struct Slot {
    std::once_flag once;
    std::optional<Result<Calibration>> calibration;
  };
  std::mutex mutex_;
  std::map<std::string, std::unique_ptr<Slot>> slots_;
};

// The calibration that is named for the rig of a session; none: its own.
const NamedCalibration* named_for(const Session& session, const BatchHeader& header) {
  const auto found = std::ranges::find(header.calibrations, session.rig, &NamedCalibration::rig);
  return found == header.calibrations.end() ? nullptr : &*found;
}

// How the current solve was made, in one text.
std::string words_of_solve(const fs::path& folder) {
  const Result<Json> document = read_json(folder / kSolveProduct.document, kSolveProduct.schema, 1);
  if (!document) return "unreadable";
  const Json input = document->value("input", Json::object());
  return fmt::format("{} {} {}", document->value("method", Json()).dump(),
                     document->value("solver_version", Json()).dump(),
                     input.is_object() ? input.value("calibration", Json()).dump() : "");
}

Result<std::uint64_t> bytes_of_frames(const solve::SolvePlan& plan) {
  std::uint64_t bytes = 0;
  for (const fs::path& file : plan.files()) {
    std::error_code failed;
    bytes += fs::file_size(file, failed);
    if (failed) return cannot_read(file, failed.value());
  }
  return bytes;
}

void add_levels(solve::SolvePlan& plan, const SurveyOptions& options, Candidate& candidate) {
  const fs::path parent = solve_parent(options.header, candidate.input.folder.string());
  const BatchProduct& product = options.header.product;
  for (const solver::MethodName& method : solver::method_names()) {
    if (!method.level) continue;
    plan.extent = method.extent;
    LevelOfSession level;
    solve::SolveOptions solve;
    solve.method = method.name;
    solve.compression = compression_of(product);
    level.solve = lean_id(solve::id_of_solve(plan, solve), product);
    level.is_there = is_there(parent / level.solve / kSolveProduct.document);
    level.memory_bytes = with_room(solve::memory_needed(plan, resolved_threads(options.threads)));
    level.pixels_share = method.extent == solver::Extent::kHalfSize ? 0.25 : 1;
    level.write_bytes = static_cast<std::uint64_t>(level.pixels_share * map_bytes(product) *
                                                   static_cast<double>(plan.size.pixels()));
    candidate.levels.push_back(std::move(level));
  }
}

// By the calibration that is named for its rig, or its own.
Result<solve::SolvePlan> plan_of_rig(const Session& session, const SurveyOptions& options,
                                     Calibrations& calibrations, Candidate& candidate) {
  const NamedCalibration* const named = named_for(session, options.header);
  if (named != nullptr) candidate.input.calibration = named->folder;
  const std::string id = named != nullptr ? named->id : session.calibration_id;
  const Result<Calibration>& calibration =
      calibrations.of(id, named != nullptr ? fs::path(named->folder) : session.calibration_folder());
  if (!calibration) return calibration.error();
  if (calibration->id != id) {
    return Error{ErrorKind::kBadData, "calibration is not the one of the session",
                 session.calibration_folder().string(),
                 fmt::format("its id is {:.12}, session.json names {:.12}", calibration->id, id),
                 "restore the session's calibration folder, or name another with --calibration"};
  }
  return solve::plan_unopened(candidate.input, *calibration);
}

Result<void> look_into(const SurveyOptions& options, Calibrations& calibrations, Candidate& candidate) {
  const fs::path& folder = candidate.input.folder;
  const Result<Session> session = read_session(folder);
  if (!session) return session.error();
  Result<solve::SolvePlan> plan = session->is_of_rig()
                                      ? plan_of_rig(*session, options, calibrations, candidate)
                                      : solve::plan_session(candidate.input);
  if (!plan) return std::move(plan).error();
  const Result<std::uint64_t> bytes = bytes_of_frames(*plan);
  if (!bytes) return bytes.error();
  candidate.read_bytes = *bytes;
  candidate.digest = digest_of_session(session->document);
  candidate.rig = session->rig;
  candidate.before = solve::current_solve(*session);
  candidate.size = plan->size;
  candidate.traits = {session->fabric, plan->calibration.id,
                      candidate.before.empty() ? "" : words_of_solve(folder / "solve" / candidate.before),
                      static_cast<double>(plan->size.pixels()) / 1e6,
                      static_cast<int>(plan->frames().size())};
  add_levels(*plan, options, candidate);
  return {};
}

// Sessions at and below a folder; links are not followed.
Result<void> walk(const fs::path& folder, std::vector<fs::path>& found) {
  if (is_there(folder / "session.json")) {
    found.push_back(folder);
    return {};
  }
  std::error_code failed;
  std::vector<fs::path> below;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    std::error_code ignored;
    const bool is_own = entry->is_directory(ignored) && !entry->is_symlink(ignored);
    if (is_own && !entry->path().filename().native().starts_with('.')) below.push_back(entry->path());
  }
  if (failed) return cannot_read(folder, failed.value());
  std::ranges::sort(below);
  for (const fs::path& each : below) {
    if (Result<void> ok = walk(each, found); !ok) return ok;
  }
  return {};
}

}  // namespace

std::uint64_t with_room(std::uint64_t bytes) {
  return bytes + bytes / 4 + (std::uint64_t{200} << 20);
}

std::vector<std::string> level_names() {
  std::vector<std::string> names;
  for (const solver::MethodName& method : solver::method_names()) {
    if (method.level) names.emplace_back(method.name);
  }
  return names;
}

Result<std::vector<fs::path>> sessions_below(const std::vector<std::string>& folders) {
  std::vector<fs::path> found, once;
  for (const std::string& folder : folders) {
    const fs::path path = absolute_folder(folder);
    if (!is_there(path)) return cannot_read(path, ENOENT);
    if (Result<void> ok = walk(path, found); !ok) return std::move(ok).error();
  }
  std::set<fs::path> seen;
  for (fs::path& each : found) {
    if (seen.insert(each).second) once.push_back(std::move(each));
  }
  return once;
}

Result<std::vector<Candidate>> survey(const std::vector<fs::path>& sessions, const SurveyOptions& options,
                                      const JobContext& context) {
  std::vector<Candidate> candidates(sessions.size());
  Calibrations calibrations;
  std::atomic<std::size_t> done = 0;
  std::mutex mutex;
  parallel_for(sessions.size(), context.threads, [&](std::size_t i, int) {
    if (context.stop.stop_requested()) return;
    candidates[i].input.folder = sessions[i];
    if (Result<void> looked = look_into(options, calibrations, candidates[i]); !looked)
      candidates[i].error = std::move(looked).error();
    const std::size_t ready = ++done;
    if (ready % 16 != 0 && ready != sessions.size()) return;
    const std::lock_guard lock(mutex);
    context.progress("look", static_cast<double>(ready) / static_cast<double>(sessions.size()));
  });
  if (context.stop.stop_requested()) return interrupted();
  return candidates;
}

Result<std::vector<NamedCalibration>> read_named(const std::vector<fs::path>& folders) {
  std::vector<NamedCalibration> named;
  for (const fs::path& folder : folders) {
    const fs::path path = absolute_folder(folder);
    const Result<Calibration> calibration = read_calibration(path);
    if (!calibration) return calibration.error();
    const std::string& rig = calibration->subject.rig;
    if (std::ranges::find(named, rig, &NamedCalibration::rig) != named.end()) {
      return Error{ErrorKind::kUsage, "two calibrations are of one rig", path.string(),
                   fmt::format("another one is of \"{}\" too", rig), "name one of each rig"};
    }
    named.push_back({path.string(), calibration->id, rig});
  }
  return named;
}

}  // namespace weft::library
