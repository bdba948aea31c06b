// SPDX-License-Identifier: Apache-2.0
#include "library/import/import_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "capture/rig.h"
#include "core/base/files.h"
#include "core/base/text.h"
#include "core/describe/error_json.h"
#include "library/import/capture_order.h"
#include "library/import/description.h"
#include "library/import/import_checks.h"
#include "library/import/oddities.h"
#include "library/import/photographs_import.h"
#include "library/import/source_groups.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

/// Where an import goes and by what, once everything is named.
struct ImportPlace {
  fs::path archive, calibration;
  std::string rig;
  double cloth_height_mm = 0;
};

Result<ImportPlace> place_of(const ImportOptions& options) {
  ImportPlace place = {options.archive, options.calibration, "", 0};
  if (!options.rig.empty()) {
    const Result<capture::Rig> rig = capture::read_rig(options.rig);
    if (!rig) return rig.error();
    place.rig = rig->name;
    place.cloth_height_mm = rig->scan.cloth_height_mm;
    if (place.calibration.empty()) place.calibration = capture::calibration_now(*rig);
    if (place.archive.empty()) place.archive = rig->scan.sessions;
  }
  if (options.cloth_height_mm) place.cloth_height_mm = *options.cloth_height_mm;
  if (place.archive.empty()) {
    return Error{ErrorKind::kUsage, "nothing says where sessions go", "-o", "",
                 "name a folder with -o, or a rig with --rig"};
  }
  place.archive = absolute_folder(place.archive);
  return place;
}

Result<Calibration> calibration_for(const ImportPlace& place) {
  if (place.calibration.empty()) {
    return Error{
        ErrorKind::kUsage, "nothing names a calibration", "--calibration", "",
        "name the calibration of the rig that took the photographs, or the rig with --rig; photographs "
        "that no rig took need a light file beside them, or --ball"};
  }
  Result<Calibration> calibration = read_calibration(place.calibration);
  if (!calibration) return calibration;
  const auto refuse = [&](std::string why) {
    return Error{ErrorKind::kBadData, "calibration cannot be imported by", place.calibration.string(),
                 std::move(why), "finish the calibration of the rig first (weft calibrate)"};
  };
  if (!calibration->lights) return refuse("it has no lights.json");
  if (!calibration->camera) return refuse("it has no camera.json");
  if (!calibration->response) return refuse("it has no response.json");
  if (!place.rig.empty() && place.rig != calibration->subject.rig) {
    return refuse(
        fmt::format("it is of rig \"{}\", the rig file of \"{}\"", calibration->subject.rig, place.rig));
  }
  return calibration;
}

Result<ImportDescription> described(const std::vector<fs::path>& files) {
  ImportDescription said;
  for (const fs::path& file : files) {
    const Result<ImportDescription> more = read_description(file);
    if (!more) return more.error();
    said.take(*more);
  }
  return said;
}

/// Frames in order of capture.
std::vector<SourceFrame> in_order(std::vector<SourceFrame> frames, FrameOrder by) {
  std::vector<std::size_t> order = order_of_names(frames);
  if (const auto times = order_of_times(frames); times && by != FrameOrder::kName) order = *times;
  std::vector<SourceFrame> ordered;
  for (const std::size_t f : order) ordered.push_back(std::move(frames[f]));
  return ordered;
}

/// One group after the other becomes a planned session.
class SessionPlanner {
 public:
  SessionPlanner(const ImportOptions& options, const ImportPlace& place, const Calibration& calibration,
                 const SourceFolders& found, const JobContext& context)
      : options_(options), place_(place), calibration_(calibration), found_(found), context_(context) {}

  /// The error is that of the caller's stop token.
  Result<ProposedSession> planned(SourceGroup group, bool is_numbered, double from, double to) {
    ProposedSession plan;
    plan.source = group.folder;
    plan.session.folder = place_.archive / (group.name + ".weft");
    plan.session.fabric = group.fabric.empty() ? group.name : group.fabric;
    plan.session.rig = calibration_.subject.rig;
    plan.session.calibration_id = calibration_.id;
    const std::vector<fs::path> descriptions =
        descriptions_of(found_.descriptions, group.root, group.folder, group.name);
    used_.insert(descriptions.begin(), descriptions.end());
    Result<void> done = fill(plan, std::move(group), descriptions, is_numbered, from, to);
    if (done) return plan;
    if (done.error().kind == ErrorKind::kInterrupted) return std::move(done).error();
    plan.state = ImportState::kRefused;
    plan.refusal = std::move(done).error();
    if (plan.refusal->where.empty()) plan.refusal->where = plan.source.string();
    return plan;
  }

  /// Descriptions that spoke of any session.
  const std::set<fs::path>& used() const { return used_; }

 private:
  Result<void> fill(ProposedSession& plan, SourceGroup group, const std::vector<fs::path>& descriptions,
                    bool is_numbered, double from, double to) {
    plan.frames = in_order(std::move(group.frames), options_.order);
    plan.warnings = std::move(group.doubts);
    if (Result<void> ok = check_readable(group.unreadable); !ok) return ok;
    const Result<ImportDescription> said = described(descriptions);
    if (!said) return said.error();
    if (!said->fabric.empty()) plan.session.fabric = said->fabric;
    plan.session.cloth_height_mm = said->cloth_height_mm.value_or(place_.cloth_height_mm);
    if (Result<void> ok = check_alike(plan.frames); !ok) return ok;
    const Result<CommonSetting> setting = setting_of(plan.frames, *said, calibration_);
    if (!setting) return setting.error();
    put_shots(plan, *setting);
    if (Result<void> ok = check_calibration(calibration_, plan.session, plan.frames.front()); !ok) return ok;
    if (Result<void> ok = decide(plan, is_numbered, from, to); !ok) return ok;
    put_leds(plan);
    put_document(plan, *said);
    return look_for_session(plan);
  }

  static void put_shots(ProposedSession& plan, const CommonSetting& setting) {
    for (const SourceFrame& frame : plan.frames) {
      Shot shot;
      shot.index = static_cast<int>(plan.session.shots.size());
      shot.exposure_us = setting.exposure_us;
      shot.iso = setting.iso;
      shot.f_number = setting.f_number;
      shot.time = time_words(frame);
      plan.session.shots.push_back(std::move(shot));
    }
  }

  Result<void> decide(ProposedSession& plan, bool is_numbered, double from, double to) {
    const Result<capture::PatchLights> model =
        capture::PatchLights::make(calibration_, plan.session.cloth_height_mm);
    if (!model) return model.error();
    std::vector<std::vector<double>> light(plan.frames.size());
    JobContext part = context_;
    part.progress = [&](std::string_view, double share) {
      context_.progress("read", from + share * (to - from));
    };
    const auto read_one = [&](std::size_t f) -> Result<void> {
      Result<std::vector<double>> seen = light_of(plan.frames[f], model->grid, model->scale);
      if (!seen) return std::move(seen).error();
      light[f] = std::move(*seen);
      return {};
    };
    // More frames than a session can have are refused unread.
    const bool is_read = is_numbered || plan.frames.size() <= model->leds.size() + 1;
    if (Result<void> ok = for_each_frame(is_read ? plan.frames.size() : 0, part, read_one); !ok) return ok;
    plan.decision = decide_leds(plan.frames, light, *model,
                                {options_.order, is_numbered, options_.takes_missing, context_.stop});
    if (context_.stop.stop_requested()) return interrupted();
    std::ranges::copy(plan.decision.warnings, std::back_inserter(plan.warnings));
    if (plan.decision.refusal) return *plan.decision.refusal;
    if (!plan.decision.order.empty()) put_in_order(plan);
    return {};
  }

  /// Frames, and all that is decided of them, in the order that was decided.
  static void put_in_order(ProposedSession& plan) {
    LedDecision& decision = plan.decision;
    const std::vector<std::size_t> order = std::exchange(decision.order, {});
    const auto ordered = [&](auto& all) {
      auto before = std::exchange(all, {});
      for (const std::size_t f : order) all.push_back(std::move(before[f]));
    };
    ordered(plan.frames);
    ordered(decision.leds);
    ordered(decision.sure);
    for (LedOpinion& opinion : decision.opinions) ordered(opinion.leds);
    for (std::size_t f = 0; f < order.size(); ++f) plan.session.shots[f].time = time_words(plan.frames[f]);
  }

  static void put_leds(ProposedSession& plan) {
    for (std::size_t f = 0; f < plan.frames.size(); ++f) {
      Shot& shot = plan.session.shots[f];
      shot.led = plan.decision.leds[f];
      shot.role = shot.led == 0 ? ShotRole::kDark : ShotRole::kLit;
      std::string ending = plan.frames[f].source.file.extension().string();
      for (char& c : ending) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      shot.file = fmt::format("raw/{:02}_led{:02}{}", shot.index, shot.led, ending);
      // In the order that other sessions have; the values are those of the shot.
      shot.document = {{"index", 0}, {"led", 0}, {"role", ""}, {"file", ""}, {"sha256", ""}};
      for (const char* key : {"exposure_us", "iso", "f_number"}) shot.document[key] = 0;
      shot.document["source"] = plan.frames[f].label;
    }
  }

  void put_document(ProposedSession& plan, const ImportDescription& said) const {
    Json& document = plan.session.document;
    document = Json::object();
    document["schema"] = "weft.session/1.5";
    document["imported"] = {{"from", plan.source.string()}, {"by", plan.decision.by}};
    if (const auto& light = plan.decision.light; light && !plan.decision.light_says.empty()) {
      document["imported"]["misfit"] = light->misfit;
      if (!light->second.empty()) document["imported"]["second_misfit"] = light->second_misfit;
    }
    if (!said.metadata.empty()) document["metadata"] = said.metadata;
    for (const ImportDoubt& doubt : plan.warnings) document["warnings"].push_back(doubt.words);
  }

  /// What lies where the session is to go.
  Result<void> look_for_session(ProposedSession& plan) const {
    const fs::path& folder = plan.session.folder;
    const Result<bool> there = look_for(folder);
    if (!there) return there.error();
    if (!*there) return {};
    const Result<Session> stored = read_session(folder);
    const Result<bool> same = stored ? is_same_session(*stored, plan.session, plan.frames) : false;
    if (!same) return same.error();
    if (!*same) {
      return Error{ErrorKind::kCannotCreate, "another session of that name is there", folder.string(),
                   "sessions are never overwritten",
                   "import into another archive with -o, or rename the folder"};
    }
    plan.state = ImportState::kThere;
    if (stored->calibration_id != calibration_.id) {
      plan.warnings.push_back({"another calibration imported it",
                               "it was imported by another calibration: solve it with --calibration"});
    }
    return {};
  }

  const ImportOptions& options_;
  const ImportPlace& place_;
  const Calibration& calibration_;
  const SourceFolders& found_;
  const JobContext& context_;
  std::set<fs::path> used_;
};

/// Hard links do not reach other disks: said before anything is made.
Result<void> check_disks(const ImportProposal& plan) {
  if (plan.link != FrameLink::kHard) return {};
  const auto refuse = [&](const fs::path& file) {
    return Error{ErrorKind::kCannotCreate, "hard links do not reach another disk", file.string(),
                 fmt::format("{} is not on its disk", plan.archive.string()),
                 "take --link copy, or --link symbolic where the photographs will stay where they are"};
  };
  for (const ProposedSession& session : plan.sessions) {
    if (session.state != ImportState::kNew) continue;
    for (const SourceFrame& frame : session.frames)
      if (!are_on_one_disk(frame.source.file, plan.archive)) return refuse(frame.source.file);
  }
  for (const ProposedPhotographs& photographs : plan.photographs) {
    if (photographs.state != ImportState::kNew) continue;
    for (const fs::path& file : photographs.files)
      if (!are_on_one_disk(file, plan.archive)) return refuse(file);
  }
  return {};
}

/// One session a target: whoever comes second is refused.
void refuse_twins(ImportProposal& plan) {
  std::map<std::string, fs::path> sources;  // by target
  for (const ProposedPhotographs& each : plan.photographs)
    sources.emplace(each.session.folder.string(), each.source);
  for (ProposedSession& session : plan.sessions) {
    const auto [first, is_new] = sources.emplace(session.session.folder.string(), session.source);
    if (is_new || session.refusal) continue;
    session.state = ImportState::kRefused;
    session.refusal = Error{ErrorKind::kBadData, "two sessions would have one name", session.source.string(),
                            fmt::format("{} has it too", first->second.string()),
                            "rename one of the folders, or write {session} in --pattern"};
  }
}

Result<GroupingOptions> grouping_by(const ImportOptions& options) {
  GroupingOptions grouping = {{}, options.gap_s, 0};
  if (options.pattern.empty()) return grouping;
  Result<NamePattern> pattern = NamePattern::parse(options.pattern);
  if (!pattern) return std::move(pattern).error();
  grouping.pattern = std::move(*pattern);
  return grouping;
}

Result<void> plan_sessions(const ImportOptions& options, const ImportPlace& place, GroupingOptions grouping,
                           SourceFolders& found, const JobContext& context, ImportProposal& plan,
                           std::set<fs::path>& described) {
  if (found.frames.empty()) return {};
  // Without a rig they may be photographs whose lights nobody could read.
  if (place.calibration.empty() && !found.unread_lights.empty()) return found.unread_lights.front();
  const Result<Calibration> calibration = calibration_for(place);
  if (!calibration) return calibration.error();
  plan.calibration = absolute_folder(place.calibration);
  plan.calibration_id = calibration->id;
  plan.rig = calibration->subject.rig;
  grouping.leds = light_count(*calibration->lights);
  Result<std::vector<SourceGroup>> groups = group_frames(found.frames, grouping, context, found.left_over);
  if (!groups) return std::move(groups).error();
  const bool is_numbered = grouping.pattern && grouping.pattern->has("led");
  SessionPlanner planner(options, place, *calibration, found, context);
  const auto share = [&](std::size_t g) {
    return static_cast<double>(g) / static_cast<double>(groups->size());
  };
  for (std::size_t g = 0; g < groups->size(); ++g) {
    Result<ProposedSession> session =
        planner.planned(std::move((*groups)[g]), is_numbered, share(g), share(g + 1));
    if (!session) return std::move(session).error();
    plan.sessions.push_back(std::move(*session));
  }
  refuse_twins(plan);
  described.insert(planner.used().begin(), planner.used().end());
  return {};
}

Json json_of_frame(const ProposedSession& session, std::size_t f) {
  const SourceFrame& frame = session.frames[f];
  const bool is_decided = f < session.decision.leds.size();
  const auto& sure = session.decision.sure;
  Json json = {{"file", frame.source.file.string()},
               {"taken", frame.taken_s ? Json(time_words(frame)) : Json()},
               {"led", is_decided ? Json(session.decision.leds[f]) : Json()},
               {"by", is_decided ? Json(session.decision.by) : Json()},
               {"sure", f < sure.size() && sure[f] ? Json(*sure[f]) : Json()}};
  for (const LedOpinion& opinion : session.decision.opinions) json["opinions"][opinion.by] = opinion.leds[f];
  return json;
}

}  // namespace

std::size_t ImportProposal::count(ImportState state) const {
  return static_cast<std::size_t>(std::ranges::count(sessions, state, &ProposedSession::state) +
                                  std::ranges::count(photographs, state, &ProposedPhotographs::state));
}

std::optional<Error> ImportProposal::first_refusal() const {
  for (const ProposedSession& session : sessions)
    if (session.refusal) return session.refusal;
  for (const ProposedPhotographs& each : photographs)
    if (each.refusal) return each.refusal;
  return {};
}

Result<ImportProposal> plan_import(const ImportOptions& options, const JobContext& context) {
  const Result<ImportPlace> place = place_of(options);
  if (!place) return place.error();
  Result<GroupingOptions> grouping = grouping_by(options);
  if (!grouping) return std::move(grouping).error();
  ImportProposal plan;
  plan.archive = place->archive;
  plan.link = options.link;
  if (options.balls) {
    const auto aside = std::make_shared<const TemporaryFolder>();
    plan.photographs = plan_photographs_with_balls(options, plan.archive, aside->path());
    plan.aside = aside;
    if (Result<void> ok = check_disks(plan); !ok) return std::move(ok).error();
    return plan;
  }
  Result<SourceFolders> found = look_into(options.folders);
  if (!found) return std::move(found).error();
  if (found->frames.empty() && found->light_files.empty() && found->photo_folders.empty()) {
    return Error{ErrorKind::kNoInput, "there are no photographs", options.folders.front().string(),
                 found->left_over.empty() ? "the folder is empty"
                                          : "no file in it is a raw, TIFF or EXR frame or has lights",
                 "name the folder of the raw files; where a ball lies in photographs, say --ball"};
  }
  plan.photographs = plan_photographs(*found, options, plan.archive);
  drop_used(plan.photographs, *found);
  std::set<fs::path> described;
  for (const ProposedPhotographs& each : plan.photographs)
    described.insert(each.descriptions.begin(), each.descriptions.end());
  Result<void> planned =
      plan_sessions(options, *place, *std::move(grouping), *found, context, plan, described);
  if (!planned) return std::move(planned).error();
  for (const fs::path& file : found->descriptions)
    if (!described.contains(file)) found->left_over.push_back({file, "it speaks of no session"});
  plan.left_over = std::move(found->left_over);
  if (Result<void> ok = check_disks(plan); !ok) return std::move(ok).error();
  return plan;
}

Json json_of(const ImportProposal& plan) {
  const auto state_of = [](ImportState state) { return kImportStateNames[static_cast<std::size_t>(state)]; };
  const auto error_of = [](const std::optional<Error>& error) { return error ? json_of(*error) : Json(); };
  Json sessions = Json::array(), photographs = Json::array(), left_over = Json::array(),
       oddities = Json::array();
  for (const ProposedSession& session : plan.sessions) {
    Json frames = Json::array();
    for (std::size_t f = 0; f < session.frames.size(); ++f) frames.push_back(json_of_frame(session, f));
    Json warnings = Json::array();
    for (const ImportDoubt& doubt : session.warnings) warnings.push_back(doubt.words);
    sessions.push_back({{"session", session.session.folder.string()},
                        {"state", state_of(session.state)},
                        {"source", session.source.string()},
                        {"fabric", session.session.fabric},
                        {"by", session.decision.by},
                        {"light", session.decision.light_says},
                        {"frames", std::move(frames)},
                        {"warnings", std::move(warnings)},
                        {"error", error_of(session.refusal)}});
  }
  for (const ProposedPhotographs& each : plan.photographs) {
    photographs.push_back({{"session", each.session.folder.string()},
                           {"state", state_of(each.state)},
                           {"source", each.source.string()},
                           {"fabric", each.session.fabric},
                           {"photographs", each.lights.lights.size()},
                           {"assumed", each.assumed},
                           {"error", error_of(each.refusal)}});
  }
  for (const LeftOver& file : plan.left_over)
    left_over.push_back({{"file", file.file.string()}, {"why", file.why}});
  for (const ImportOddity& oddity : oddities_of(plan)) {
    oddities.push_back({{"kind", kOddityNames[static_cast<std::size_t>(oddity.kind)]},
                        {"what", oddity.what},
                        {"count", oddity.count},
                        {"first", oddity.first},
                        {"says", words_of(oddity)}});
  }
  return {{"archive", plan.archive.string()},      {"rig", plan.rig},
          {"calibration", plan.calibration_id},    {"sessions", std::move(sessions)},
          {"photographs", std::move(photographs)}, {"left_over", std::move(left_over)},
          {"oddities", std::move(oddities)}};
}

}  // namespace weft::library
