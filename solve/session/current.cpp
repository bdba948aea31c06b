// SPDX-License-Identifier: Apache-2.0
#include "solve/session/current.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <tuple>
#include <utility>

#include "core/base/iso_time.h"
#include "core/base/product.h"
#include "core/solve/solve.h"
#include "solve/session/left_out_shots.h"
#include "solve/session/solved.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

// The session without what a person left out.
Session of_today(Session session) {
  const std::vector<int> indices = left_out(session);
  std::erase_if(session.shots,
                [&](const Shot& shot) { return std::ranges::find(indices, shot.index) != indices.end(); });
  return session;
}

std::string text_in(const Json& document, const char* key) {
  const Json value = document.value(key, Json());
  return value.is_string() ? value.get<std::string>() : std::string();
}

// Photographs that a solve names, as session.json holds them.
struct UsedShot {
  std::string file, sha256;  // file: empty of the dark one of photographs that no rig took
  std::optional<int> led;    // none of those
};

std::vector<UsedShot> used_shots(const Json& solve) {
  std::vector<UsedShot> used;
  for (const char* name : {"/input/shots", "/input/photographs"}) {
    const Json::json_pointer list(name);
    if (!solve.contains(list) || !solve[list].is_array()) continue;
    for (const Json& shot : solve[list]) {
      if (!shot.is_object()) continue;
      const Json led = shot.value("led", Json());
      used.push_back({text_in(shot, "file"), text_in(shot, "sha256"),
                      led.is_number_integer() ? std::optional(led.get<int>()) : std::nullopt});
    }
  }
  if (const Json::json_pointer dark("/input/dark"); solve.contains(dark) && solve[dark].is_string())
    used.push_back({"", solve[dark].get<std::string>(), {}});
  return used;
}

bool is_of(const UsedShot& used, const Shot& shot) {
  return used.file.empty() ? used.sha256 == shot.sha256 : used.file == shot.file;
}

bool is_among(const std::vector<UsedShot>& used, const Shot& shot) {
  return std::ranges::any_of(
      used, [&](const UsedShot& each) { return is_of(each, shot) && each.sha256 == shot.sha256; });
}

std::string name_of_led(int led) {
  return led == 0 ? std::string("the dark photograph") : fmt::format("LED {}", led);
}

// Whether two shots of one LED are alike enough to be solved together.
bool is_alike(const Shot& shot, const Shot& lit) {
  return !shot.superseded_by && shot.polariser == lit.polariser && shot.iso == lit.iso;
}

// Whether a solve that has `used` would have this photograph too. Whether the exposure of a bracket was ever
// measured is the calibration's to say: those of an exposure that is used were.
bool is_wanted(const Session& today, const std::vector<const Shot*>& lit, const std::vector<UsedShot>& used,
               const Shot& shot) {
  const auto same_led = std::ranges::find(lit, shot.led, &Shot::led);
  if (same_led == lit.end()) return shot.role == ShotRole::kDark && &shot == today.dark();
  if (std::ranges::find(lit, &shot) != lit.end()) return true;
  if (shot.role == ShotRole::kRepeat || shot.role == ShotRole::kBlade)
    return is_alike(shot, **same_led) && shot.exposure_us == (*same_led)->exposure_us;
  if (shot.role == ShotRole::kBracket) {
    return is_alike(shot, **same_led) && std::ranges::any_of(today.shots, [&](const Shot& other) {
             return other.role == ShotRole::kBracket && other.exposure_us == shot.exposure_us &&
                    is_among(used, other);
           });
  }
  const bool is_of_pair =
      shot.role == ShotRole::kLit && !shot.superseded_by && (*same_led)->polariser == Polariser::kCrossed;
  return is_of_pair && today.lit(Polariser::kParallel).size() >= lit.size();
}

// Why a solve took photographs that no rig took otherwise than a person has it today; empty: it did not.
std::string why_read_otherwise(const PhotoReading& reading, const Json& input) {
  const auto other = [](const char* what, const std::string& now, const std::string& then) {
    return now == then ? std::string()
                       : fmt::format("{} is {} now, and it was solved with {}", what, now, then);
  };
  const std::string flip = text_in(input, "flip");
  std::string why = other("--flip", name_of(reading.flip), flip.empty() ? name_of(LightFlip::kNone) : flip);
  if (why.empty() && reading.transfer != Transfer::kAuto)
    why = other("--transfer", name_of(reading.transfer), text_in(input, "transfer"));
  const Json ambient = input.value("ambient", Json());
  if (why.empty())
    why = other("--ambient", fmt::format("{}", reading.ambient),
                fmt::format("{}", ambient.is_number() ? ambient.get<double>() : 0.0));
  return why;
}

// Why it was not solved from today's photographs; empty: it was.
std::string why_outdated(const Session& session, const Session& today, const Json& solve) {
  const std::vector<UsedShot> used = used_shots(solve);
  if (used.empty()) return "";  // of a document that does not say
  for (const UsedShot& each : used) {
    const auto shot =
        std::ranges::find_if(session.shots, [&](const Shot& candidate) { return is_of(each, candidate); });
    if (shot == session.shots.end() || shot->sha256 != each.sha256)
      return fmt::format("{} is another file than it was solved from",
                         each.file.empty() ? "the dark photograph" : each.file);
    const std::string led = name_of_led(each.led.value_or(shot->led));
    if (each.led && shot->led != *each.led)
      return fmt::format("{} is of {} now, and it was solved as of {}", each.file, name_of_led(shot->led),
                         led);
    if (shot->superseded_by) return fmt::format("{} was photographed again since", led);
    if (std::ranges::find(today.shots, shot->index, &Shot::index) == today.shots.end())
      return fmt::format("{} is left out now, and it was solved with it", each.file);
  }
  const std::vector<const Shot*> crossed = today.lit(Polariser::kCrossed);
  const std::vector<const Shot*> lit = crossed.empty() ? today.lit() : crossed;
  for (const Shot& shot : today.shots) {
    if (is_wanted(today, lit, used, shot) && !is_among(used, shot))
      return fmt::format("it was solved without {}, the photograph of {}", shot.file, name_of_led(shot.led));
  }
  const Json input = solve.value("input", Json());
  const bool is_told = input.is_object() && !session.is_of_rig() && !is_lone_solve(session);
  return is_told ? why_read_otherwise(*session.photographs, input) : "";
}

std::string written_at(const fs::path& file) {
  std::error_code ignored;
  const auto written = std::chrono::file_clock::to_sys(fs::last_write_time(file, ignored));
  return iso_time(std::chrono::duration<double>(written.time_since_epoch()).count());
}

std::vector<ChoosableSolve> choosable(const Session& session, const Session& today) {
  std::vector<ChoosableSolve> solves;
  for (const Product& product : list_solves(session.folder)) {
    const fs::path file = product.folder / kSolveProduct.document;
    const Result<Json> document = read_json(file, kSolveProduct.schema, 1);
    if (!document) continue;
    const Json kept = document->value("kept", Json());
    solves.push_back({.id = product.id,
                      .folder = product.folder,
                      .level = text_in(*document, "method"),
                      .written = written_at(file),
                      .outdated = why_outdated(session, today, *document),
                      .is_waiting = !text_in(*document, "plan").empty(),
                      .is_whole = !kept.is_array() || kept.empty()});
  }
  return solves;
}

// The height of the level alone: a method of comparison stands between preview and fast.
int height_of(const ChoosableSolve& solve) {
  const auto* level = std::ranges::find(kLevels, solve.level);
  if (level == kLevels.end()) return 1;
  return level == kLevels.begin() ? 0 : static_cast<int>(level - kLevels.begin()) + 1;
}

// What is chosen by, the most important first.
auto order_of(const ChoosableSolve& solve) {
  const bool is_settled = !solve.is_waiting && !solve.is_preview();
  return std::tuple(solve.outdated.empty(), solve.is_whole, is_settled, height_of(solve));
}

// What session.json names, as long as that stands.
std::optional<std::size_t> chosen_by_person(const Session& session, const std::vector<ChoosableSolve>& all) {
  const auto found = std::ranges::find(all, text_in(session.document, "current_solve"), &ChoosableSolve::id);
  if (found == all.end()) return {};
  const std::string chosen_for = text_in(session.document, "current_solve_for");
  // Older documents do not say which photographs it was chosen for.
  const bool stands =
      chosen_for.empty() ? found->outdated.empty() : chosen_for == digest_of_photographs(session);
  return stands ? std::optional(static_cast<std::size_t>(found - all.begin())) : std::nullopt;
}

Error nothing_to_make_maps_of(ErrorKind kind, const SessionSolves& solves, std::string why,
                              std::string remedy) {
  return {kind, "there is no solve to make maps of", solves.session.string(), std::move(why),
          std::move(remedy)};
}

Error is_outdated(const SessionSolves& solves, const ChoosableSolve& solve) {
  const std::string level =
      height_of(solve) > 1 ? solve.level : std::string(solve.is_preview() ? "standard" : "fast");
  return nothing_to_make_maps_of(
      ErrorKind::kNoInput, solves,
      fmt::format("none is of today's photographs; of {}: {}", words_of(solve), solve.outdated),
      fmt::format("solve it again with {}, or take that one with --solve {}", command_to_solve(solves, level),
                  solve.id));
}

Error is_only_preview(const SessionSolves& solves, const ChoosableSolve& preview, bool is_named) {
  const ChoosableSolve& best = solves.all[*solves.best];
  const std::string otherwise = "; --draft makes maps of the preview";
  if (!best.is_preview()) {
    return nothing_to_make_maps_of(
        is_named ? ErrorKind::kUsage : ErrorKind::kNoInput, solves,
        fmt::format("{} was {}, and a preview has half the size and no masks", words_of(preview),
                    is_named ? "named" : "chosen"),
        fmt::format("take {} with --solve {}{}", words_of(best), best.id, otherwise));
  }
  const std::string only =
      fmt::format("there is only {}, of half the size and without masks", words_of(preview));
  return nothing_to_make_maps_of(
      is_named ? ErrorKind::kUsage : ErrorKind::kNoInput, solves,
      preview.outdated.empty() ? "of today's photographs " + only : only + ", and " + preview.outdated,
      fmt::format("solve it with {}{}{}", command_to_solve(solves, "standard"),
                  solves.is_chosen && !is_named ? ", and name that solve with --solve" : "", otherwise));
}

}  // namespace

std::string words_of(const ChoosableSolve& solve) {
  return fmt::format("the {} solve {} of {}", solve.level, solve.id, solve.written);
}

const ChoosableSolve* SessionSolves::find(const std::string& id) const {
  const auto found = std::ranges::find(all, id, &ChoosableSolve::id);
  return found == all.end() ? nullptr : &*found;
}

const ChoosableSolve* SessionSolves::current_one() const {
  return current ? &all[*current] : nullptr;
}

SessionSolves solves_of(const Session& session) {
  SessionSolves solves = {.session = session.folder,
                          .is_lone = is_lone_solve(session),
                          .all = choosable(session, of_today(session))};
  for (std::size_t i = 0; i < solves.all.size(); ++i) {
    if (!solves.best || order_of(solves.all[i]) >= order_of(solves.all[*solves.best])) solves.best = i;
  }
  solves.current = chosen_by_person(session, solves.all);
  solves.is_chosen = solves.current.has_value();
  if (!solves.current) solves.current = solves.best;
  return solves;
}

std::string command_to_solve(const SessionSolves& solves, const std::string& level) {
  return fmt::format("weft solve {} --quality {}",
                     solves.is_lone ? "--photos FOLDER" : solves.session.string(), level);
}

std::string current_solve(const Session& session) {
  const SessionSolves solves = solves_of(session);
  return solves.current ? solves.all[*solves.current].id : std::string();
}

std::string digest_of_photographs(const Session& session) {
  Json shots = Json::array();
  for (const Shot& shot : of_today(session).shots) {
    if (shot.superseded_by || shot.role == ShotRole::kBelow) continue;
    shots.push_back({{"led", shot.led},
                     {"role", name_of(shot.role)},
                     {"polariser", name_of(shot.polariser)},
                     {"file", shot.file},
                     {"sha256", shot.sha256}});
  }
  return product_id(shots);
}

std::vector<std::string> why_stale(const SessionSolves& solves, const std::string& id) {
  const ChoosableSolve* const solve = solves.find(id);
  if (solve == nullptr) return {fmt::format("the solve {} is not in its session any more", id)};
  std::vector<std::string> why;
  if (!solve->outdated.empty()) why.push_back(solve->outdated);
  const ChoosableSolve& current = *solves.current_one();
  const ChoosableSolve& best = solves.all[*solves.best];
  if (current.id != id) {
    why.push_back(fmt::format("{} is the current one", words_of(current)));
  } else if (best.id != id && order_of(best) > order_of(*solve)) {
    why.push_back(fmt::format("{} is better, but a person chose this one", words_of(best)));
  }
  return why;
}

Result<ChoosableSolve> solve_for_maps(const SessionSolves& solves, const std::string& id, bool draft) {
  const bool is_named = !id.empty();
  const ChoosableSolve* const solve = is_named ? solves.find(id) : solves.current_one();
  if (solve == nullptr && is_named) {
    return Error{ErrorKind::kNoInput, fmt::format("there is no complete {}", kSolveProduct.noun),
                 (solves.session / "solve" / id).string(), "it holds no solve.json",
                 "leave --solve out, or solve with " + command_to_solve(solves, "standard")};
  }
  if (solve == nullptr) {
    return nothing_to_make_maps_of(ErrorKind::kNoInput, solves, "it was not solved",
                                   "solve it with " + command_to_solve(solves, "standard"));
  }
  const bool is_asked_for = is_named || solves.is_chosen;
  if (!solve->outdated.empty() && !is_asked_for) return is_outdated(solves, *solve);
  if (!solve->is_whole) {
    return nothing_to_make_maps_of(ErrorKind::kNoInput, solves,
                                   fmt::format("not all maps of {} were kept", words_of(*solve)),
                                   "solve it whole with " + command_to_solve(solves, solve->level));
  }
  if (solve->is_preview() && !draft) return is_only_preview(solves, *solve, is_named);
  return *solve;
}

SourceFacts source_of(const ChoosableSolve& solve, std::vector<std::string> stale) {
  return {.solve = solve.id, .level = solve.level, .is_draft = solve.is_preview(), .stale = std::move(stale)};
}

}  // namespace weft::solve
