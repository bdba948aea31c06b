// SPDX-License-Identifier: Apache-2.0
#include "library/run/accept_batch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "core/rig/session.h"
#include "library/catalogue/metadata.h"
#include "library/catalogue/prune.h"
#include "library/run/merge_batch.h"
#include "solve/session/current.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

bool is_named(const std::string& session, const std::vector<std::string>& names) {
  const fs::path path = session;
  return std::ranges::any_of(names, [&](const std::string& name) {
    return name == session || name == path.stem() || name == path.filename();
  });
}

Result<void> check_names(const BatchState& state, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    const bool is_there = std::ranges::any_of(
        state.rows, [&](const BatchRow& row) { return is_named(row.planned->session, {name}); });
    if (!is_there)
      return Error{ErrorKind::kUsage, "no such session", name, "the plan has none of this name",
                   "weft batch merge lists them"};
  }
  return {};
}

Accepted accept_one(const BatchRow& row, const AcceptBatchOptions& options) {
  Accepted accepted = {row.planned->session, row.planned->solve, row.planned->before, false, ""};
  if (!row.is_done()) {
    accepted.why = "it is not solved";
    return accepted;
  }
  accepted.solve = row.result->solve;
  if (row.result->change && !options.with_worse) {
    const std::vector<std::string> worse = regressions(*row.result->change);
    if (!worse.empty()) accepted.why = fmt::format("it became worse: {}", fmt::join(worse, "; "));
    if (!worse.empty()) return accepted;
  }
  const Result<Session> session = read_session(row.planned->session);
  if (!session) {
    accepted.why = session.error().message();
    return accepted;
  }
  const solve::SessionSolves solves = solve::solves_of(*session);
  const solve::ChoosableSolve* const current = solves.current_one();
  const bool is_current = current != nullptr && current->id == accepted.solve;
  if (is_current && solves.is_chosen) {
    accepted.why = "it is the current one already";
    return accepted;
  }
  if (!is_current && current != nullptr && current->id != row.planned->before) {
    accepted.why = fmt::format("its current solve is {} since the plan", current->id);
    return accepted;
  }
  accepted.is_moved = true;
  if (options.dry_run) return accepted;
  const Result<MetadataChange> changed =
      change_metadata(row.planned->session, {{"current_solve", accepted.solve}});
  if (changed) return accepted;
  accepted.is_moved = false;
  accepted.why = changed.error().message();
  return accepted;
}

Result<BatchState> read_own(const fs::path& plan) {
  Result<BatchState> state = read_batch(plan);
  if (!state || state->plan.header.output.empty()) return state;
  return Error{ErrorKind::kUsage, "solves lie beside the archive", state->plan.header.output,
               "a session's current solve is one of its own", "copy them into their sessions first"};
}

}  // namespace

Result<std::vector<Accepted>> accept_batch(const AcceptBatchOptions& options) {
  const Result<BatchState> state = read_own(options.plan);
  if (!state) return state.error();
  if (Result<void> ok = check_names(*state, options.sessions); !ok) return std::move(ok).error();
  std::vector<Accepted> all;
  for (const BatchRow& row : state->rows) {
    if (options.sessions.empty() || is_named(row.planned->session, options.sessions))
      all.push_back(accept_one(row, options));
  }
  return all;
}

Result<std::vector<Freed>> prune_batch(const fs::path& plan, int keep, bool yes) {
  const Result<BatchState> state = read_own(plan);
  if (!state) return state.error();
  std::vector<Freed> freed;
  for (const BatchRow& row : state->rows) {
    if (!row.is_done()) continue;
    const Result<Session> session = read_session(row.planned->session);
    if (!session || solve::current_solve(*session) != row.result->solve) continue;
    const Result<std::vector<Prunable>> solves = prunable(row.planned->session, keep);
    if (!solves) return solves.error();
    for (const Prunable& each : *solves) freed.push_back({row.planned->session, each.solve, each.bytes});
    if (!yes || solves->empty()) continue;
    if (Result<void> ok = prune(row.planned->session, *solves); !ok) return std::move(ok).error();
  }
  return freed;
}

}  // namespace weft::library
