// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/job_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "app/jobs/calibrate/camera.h"
#include "app/jobs/calibrate/check.h"
#include "app/jobs/calibrate/color.h"
#include "app/jobs/calibrate/grey.h"
#include "app/jobs/calibrate/lights.h"
#include "app/jobs/calibrate/patches.h"
#include "app/jobs/calibrate/response.h"
#include "app/jobs/calibrate/update.h"
#include "app/jobs/maps/recipe.h"
#include "app/jobs/planned_cloth.h"
#include "app/server/api/batch_body.h"
#include "app/server/api/library_materials.h"
#include "core/fields.h"
#include "core/files.h"
#include "core/number.h"
#include "library/current.h"
#include "library/session_files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestWord = 100;
constexpr std::size_t kLongestFolder = 200;
constexpr std::size_t kMostWords = 50;
constexpr std::size_t kLongestRecipe = 100000;  // what Linux takes as one argument is 131072
constexpr const char* kTorture = "torture";     // the session that its job makes
constexpr const char* kPlanPicture = "{files}/plan.svg";

Error unfit(const std::string& field, const std::string& rule) {
  return {ErrorKind::kUsage, "job cannot be read", field, rule, "see POST jobs in openapi.json"};
}

// What a field of the body holds.
enum class Holds {
  kWord,
  kNumber,
  kFlag,       // true: the option
  kWords,      // a list, which becomes words by commas
  kNumbers,    // likewise
  kRecipe,     // {"steps": [...]}, which becomes its text
  kSession,    // the name of one
  kMaterial,   // the key of one of the library
  kBuild,      // likewise, of which the newest build or that of `set` is meant
  kFile,       // one that is there, below the rig's folder
  kFolder,     // likewise
  kNewFolder,  // one that is not there yet
  kCount,      // a whole number
  kSeconds,    // a number, which becomes 3600s
  kOfBatch     // what batch_body.h reads
};

// A field of the body that becomes an argument of the verb.
struct JobField {
  const char* field;
  std::string option;  // empty: the argument itself
  Holds holds;
  bool is_needed = false;
  NumberRange range = {};               // of a number
  std::vector<std::string> words = {};  // that are allowed; none: all
  const char* unless = "";              // another field, which says it already
  int fewest = 0, most = 0;             // of numbers
};

struct JobKind {
  const char* name;
  std::vector<std::string> verb;
  std::vector<JobField> fields;
  bool names_rig = false;  // to the verb, where there is no calibration that says it
};

const JobField kSession = {"session", "", Holds::kSession, true};
JobField word(const char* field, const char* option, std::vector<std::string> words = {}) {
  return {field, option, Holds::kWord, false, {}, std::move(words)};
}
JobField number(const char* field, const char* option, const NumberRange& range) {
  return {field, option, Holds::kNumber, false, range};
}
JobField number(const char* field, const char* option, double least, double most) {
  return number(field, option, NumberRange{least, most});
}

// A preview will do.
const JobField kDraft = {"draft", "--draft", Holds::kFlag};

JobField count(const char* field, const char* option, const NumberRange& range) {
  return {field, option, Holds::kCount, false, range};
}

// The fields of a described verb, as a client says them.
class JobFields final : public Fields {
 public:
  std::vector<JobField> fields;

 private:
  void take(const Field& field, Value value) override {
    if (field.said == Said::kAtThisMachine) return;
    fields.push_back(row_of(field, held_by(field, value)));
    if (field.path != PathTo::kSessionOrSet) return;
    fields.back().is_needed = false;
    fields.push_back(fields.back());
    fields.back().field = "moved";
    fields.back().holds = Holds::kFolder;
  }
  void choose(const Field& field, Words words, std::size_t /*now*/,
              const std::function<void(std::size_t)>& /*choose*/) override {
    fields.push_back(row_of(field, Holds::kWord));
    fields.back().words = {words.begin(), words.end()};
  }

  // "-o,--output" is called by its long name.
  static JobField row_of(const Field& field, Holds holds) {
    const std::string option = option_of(field);
    JobField row = {field.name, option.substr(option.find(',') + 1), holds, field.need == Need::kMustSay,
                    field.range};
    row.words = field.words;
    row.fewest = field.fewest;
    row.most = field.most;
    return row;
  }
  static Holds held_by(const Field& field, const Value& value) {
    if (std::holds_alternative<bool*>(value)) return Holds::kFlag;
    if (std::holds_alternative<int*>(value) || std::holds_alternative<std::optional<int>*>(value))
      return Holds::kCount;
    if (std::holds_alternative<double*>(value) || std::holds_alternative<std::optional<double>*>(value))
      return Holds::kNumber;
    if (std::holds_alternative<std::vector<std::string>*>(value)) return Holds::kWords;
    if (std::holds_alternative<std::vector<double>*>(value) ||
        std::holds_alternative<std::vector<int>*>(value))
      return Holds::kNumbers;
    if (!std::holds_alternative<fs::path*>(value)) return Holds::kWord;
    switch (field.path) {
      case PathTo::kSession:
      case PathTo::kSessionOrSet:
        return Holds::kSession;
      case PathTo::kNewFolder:
        return Holds::kNewFolder;
      case PathTo::kFile:
        return Holds::kFile;
      case PathTo::kFolder:
      case PathTo::kAnything:
        break;
    }
    return Holds::kFolder;
  }
};

template <typename Described>
std::vector<JobField> fields_of() {
  Described described;
  JobFields walk;
  describe(walk, described);
  return walk.fields;
}

const std::vector<std::string> kLevels(library::kLevels.begin(), library::kLevels.end());

JobKind batch_plan_kind() {
  return {"batch_plan",
          {"batch", "plan"},
          {{"sessions", "", Holds::kOfBatch},
           {"find", "", Holds::kOfBatch},
           {"name", "", Holds::kOfBatch},
           word("quality", "--quality", kLevels),
           number("to_deg", "--to", 1e-6, 180),
           {"within_s", "--within", Holds::kSeconds, false, {1, 1e9}},
           number("least_change_deg", "--least-change", 1e-6, 180),
           count("sample", "--sample", {0, 100000}),
           {"calibration", "--calibration", Holds::kFolder}}};
}

JobKind batch_run_kind() {
  return {"batch_run",
          {"batch", "run", "--merge"},
          {{"batch", "", Holds::kOfBatch, true},
           count("at_once", "--jobs", {1, 64}),
           {"retry_failed", "--retry-failed", Holds::kFlag}}};
}

std::vector<std::string> plan_cloths() {
  std::vector<std::string> names;
  for (const NamedCloth& each : planned_cloths()) names.emplace_back(each.name);
  return names;
}

// What both verbs of maps take.
std::vector<JobField> maps_fields() {
  return {kSession,
          word("solve", "--solve"),
          kDraft,
          number("mm_per_pixel", "--mm-per-pixel", 1e-4, 100),
          {"preview", "--preview", Holds::kFlag},
          word("recipe", "--recipe", recipe_names()),
          {"steps", "--steps", Holds::kRecipe}};
}

// Of what and by which presets files are made.
std::vector<JobField> export_fields() {
  JobField set = word("set", "--maps");
  set.unless = "material";
  return {{"session", "", Holds::kSession},
          {"material", "", Holds::kBuild},
          set,
          kDraft,
          word("name", "--name"),
          {"presets", "--preset", Holds::kWords, true}};
}

std::vector<JobField> with_field(std::vector<JobField> fields, JobField field) {
  fields.push_back(std::move(field));
  return fields;
}

const std::vector<JobKind>& job_kinds() {
  static const std::vector<JobKind> kinds = {
      {"solve",
       {"solve"},
       {kSession,
        word("quality", "--quality", kLevels),
        word("method", "--method"),
        number("within_s", "--within", 1e-3, 1e9),
        number("to_deg", "--to", 1e-6, 180),
        {"calibration", "--calibration", Holds::kFolder}}},
      {"price", {"solve", "--explain", "--crops", kJobFiles}, {kSession}},
      {"rectify",
       {"rectify"},
       {kSession, word("solve", "--solve"), kDraft, number("mm_per_pixel", "--mm-per-pixel", 1e-4, 100),
        number("turn_deg", "--turn", -360, 360)}},
      {"maps", {"maps"}, with_field(maps_fields(), {"maps", "--maps", Holds::kWords})},
      {"finish", {"finish"}, maps_fields()},
      {"export", {"export"}, export_fields()},
      {"export_price", {"export", "--explain"}, export_fields()},
      {"material", {"material", "build"}, {{"material", "", Holds::kMaterial, true}}},
      {"copy", {"copy"}, {kSession}},
      {"torture", {"torture"}, {}},
      {"rig_plan",
       {"rig", "plan", "--picture", kPlanPicture},
       {word("cloth", "--cloth", plan_cloths()), number("roughness", "--roughness", 0.02, 1),
        number("f0", "--f0", 0, 0.6), number("albedo", "--albedo", 1e-3, 1),
        number("relief_deg", "--relief", 0, 60), word("aim", "--aim", {"all", "normal", "alpha", "f0"}),
        number("pace", "--pace", 0.1, 600)}},
      {"check", {"calibrate", "check"}, fields_of<CalibrateCheckOptions>()},
      {"calibrate_camera", {"calibrate", "camera"}, fields_of<CalibrateCameraOptions>(), true},
      {"calibrate_response", {"calibrate", "response"}, fields_of<CalibrateResponseOptions>(), true},
      {"calibrate_color", {"calibrate", "color"}, fields_of<CalibrateColorOptions>(), true},
      {"calibrate_lights", {"calibrate", "lights"}, fields_of<CalibrateLightsOptions>()},
      {"calibrate_grey", {"calibrate", "grey"}, fields_of<CalibrateGreyOptions>()},
      {"calibrate_patches", {"calibrate", "patches"}, fields_of<CalibratePatchesOptions>()},
      {"calibrate_update", {"calibrate", "update"}, fields_of<CalibrateUpdateOptions>()},
      batch_plan_kind(),
      batch_run_kind()};
  return kinds;
}

// Words never begin with a dash, so none of them is taken for an option, nor with a dot.
bool is_plain(std::string_view text) {
  return !text.empty() && text.size() <= kLongestWord && text[0] != '-' && text[0] != '.' &&
         std::ranges::all_of(
             text, [](unsigned char c) { return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.'; });
}

Result<std::string> word_in(const Json& body, const char* field) {
  const auto value = body.find(field);
  if (value == body.end() || !value->is_string()) return unfit(field, "must be a text");
  std::string text = value->get<std::string>();
  if (!is_plain(text)) return unfit(field, "must be a plain word");
  return text;
}

// Words between slashes, below a folder.
Result<fs::path> place_below(const fs::path& root, const Json& body, const char* field) {
  const auto value = body.find(field);
  if (value == body.end() || !value->is_string()) return unfit(field, "must be a text");
  const std::string& text = value->get_ref<const std::string&>();
  bool fits = text.size() <= kLongestFolder && !root.empty();
  for (std::string_view rest = text; fits; rest.remove_prefix(rest.find('/') + 1)) {
    fits = is_plain(rest.substr(0, rest.find('/')));
    if (rest.find('/') == std::string_view::npos) break;
  }
  if (!fits) return unfit(field, "must name a folder below that of the rig file: photographs/board");
  return root / text;
}

// Where no link leads out of the root.
Result<void> check_inside(const fs::path& folder, const fs::path& root, bool is_file = false) {
  std::error_code error;
  const bool is_it = is_file ? fs::is_regular_file(folder, error) : fs::is_directory(folder, error);
  if (is_it && library::lies_in(folder, root)) return {};
  return Error{ErrorKind::kNoInput, is_file ? "there is no such file" : "there is no such folder",
               folder.lexically_relative(root).string(), "it is looked for below the rig file's",
               "copy it there first"};
}

Result<fs::path> new_folder_below(const fs::path& root, const Json& body, const char* field) {
  Result<fs::path> folder = place_below(root, body, field);
  if (!folder) return folder;
  if (is_there(*folder)) {
    return Error{ErrorKind::kCannotCreate, "there is something of this name already",
                 folder->lexically_relative(root).string(), "", "name another folder"};
  }
  fs::path parent = folder->parent_path();
  while (!is_there(parent)) parent = parent.parent_path();
  if (Result<void> inside = check_inside(parent, root); !inside) return inside.error();
  const Result<void> made = make_writable_folder(folder->parent_path());
  return made ? folder : made.error();
}

Result<std::string> number_in(const Json& value, const JobField& field) {
  const double amount = value.is_number() ? value.get<double>() : field.range.least - 1;
  const bool is_whole = field.holds == Holds::kCount;
  const bool fits = field.range.holds(amount) && (!is_whole || amount == std::floor(amount));
  if (!fits) return unfit(field.field, rule_of(field.range, is_whole));
  if (is_whole) return fmt::format("{:.0f}", amount);
  return fmt::format("{}{}", amount, field.holds == Holds::kSeconds ? "s" : "");
}

Result<std::string> numbers_in(const Json& value, const JobField& field) {
  const auto fits = [&](const Json& each) {
    return each.is_number() && field.range.holds(each.get<double>());
  };
  const bool is_list = value.is_array() && value.size() >= static_cast<std::size_t>(field.fewest) &&
                       value.size() <= static_cast<std::size_t>(field.most) &&
                       std::ranges::all_of(value, fits);
  if (!is_list)
    return unfit(field.field, fmt::format("must be a list of {} to {} numbers", field.fewest, field.most));
  return fmt::format("{}", fmt::join(value.get<std::vector<double>>(), ","));
}

Result<std::string> words_in(const Json& value, const JobField& field) {
  const bool is_list = value.is_array() && !value.empty() && value.size() <= kMostWords;
  const bool fits = is_list && std::ranges::all_of(value, [](const Json& each) {
                      return each.is_string() && is_plain(each.get_ref<const std::string&>());
                    });
  if (!fits) return unfit(field.field, fmt::format("must be a list of 1 to {} plain words", kMostWords));
  return fmt::format("{}", fmt::join(value.get<std::vector<std::string>>(), ","));
}

// As the verb reads it, so that what is wrong is said before it runs.
Result<std::string> recipe_in(const Json& value, const JobField& field) {
  const Result<Recipe> recipe = recipe_from_json(value, field.field);
  if (!recipe) return unfit(recipe.error().where, recipe.error().why);
  std::string text = json_of(*recipe).dump();
  if (text.size() > kLongestRecipe) return unfit(field.field, "is too long");
  return text;
}

Result<std::string> material_in(const Json& body, const JobField& field, const JobPlaces& places,
                                JobSpec& spec) {
  const Json& key = body[field.field];
  if (!key.is_string()) return unfit(field.field, "must be the key of a material");
  spec.of = key.get<std::string>();
  if (field.holds == Holds::kMaterial) {
    const Result<MaterialPlace> place = places.material(spec.of);
    if (!place) return place.error();
    if (!place->is_shipped()) return place->file.string();
    // What comes with weft lies in no folder of the user's, and so is told where it is built.
    spec.arguments.insert(spec.arguments.end(), {"--output", builds_of(*place).string()});
    return place->name;
  }
  const Json set = body.value("set", Json(""));
  if (!set.is_string()) return unfit("set", "must be a text");
  const Result<fs::path> build = places.build(spec.of, set.get<std::string>());
  if (!build) return build.error();
  spec.needs.push_back(build->string());
  return build->string();
}

// What the field becomes; what the job needs of it is added to its needs.
Result<std::string> argument_of(const Json& body, const JobField& field, const JobPlaces& places,
                                JobSpec& spec) {
  if (field.holds == Holds::kNumber || field.holds == Holds::kCount || field.holds == Holds::kSeconds)
    return number_in(body[field.field], field);
  if (field.holds == Holds::kWords) return words_in(body[field.field], field);
  if (field.holds == Holds::kNumbers) return numbers_in(body[field.field], field);
  if (field.holds == Holds::kRecipe) return recipe_in(body[field.field], field);
  if (field.holds == Holds::kWord) {
    Result<std::string> text = word_in(body, field.field);
    if (text && !field.words.empty() && std::ranges::find(field.words, *text) == field.words.end())
      return unfit(field.field, fmt::format("must be one of {}", fmt::join(field.words, ", ")));
    return text;
  }
  if (field.holds == Holds::kMaterial || field.holds == Holds::kBuild)
    return material_in(body, field, places, spec);
  Result<fs::path> folder = fs::path();
  if (field.holds == Holds::kSession) {
    const Json& name = body[field.field];
    if (!name.is_string()) return unfit(field.field, "must be the name of a session");
    folder = places.session(name.get<std::string>());
  } else if (field.holds == Holds::kFile) {
    folder = place_below(places.folder, body, field.field);
    if (folder) {
      if (Result<void> inside = check_inside(*folder, places.folder, true); !inside)
        return std::move(inside).error();
    }
  } else {
    folder = field.holds == Holds::kFolder ? folder_below(places.folder, body, field.field)
                                           : new_folder_below(places.folder, body, field.field);
  }
  if (!folder) return std::move(folder).error();
  if (field.holds != Holds::kNewFolder) spec.needs.push_back(folder->string());
  const std::string_view option = field.option;
  if (option.empty() || option == "--session") spec.of = body[field.field].get<std::string>();
  return folder->string();
}

// The field's option and argument.
Result<void> add_field(const Json& body, const JobField& field, const JobPlaces& places, JobSpec& spec) {
  if (!body.contains(field.field)) {
    if (field.is_needed) return unfit(field.field, fmt::format("is needed by a {} job", spec.kind));
    return {};
  }
  if (*field.unless != '\0' && body.contains(field.unless)) return {};
  if (field.holds == Holds::kOfBatch) return {};
  if (field.holds == Holds::kFlag) {
    const Json& flag = body[field.field];
    if (!flag.is_boolean()) return unfit(field.field, "must be true or false");
    if (flag.get<bool>()) spec.arguments.emplace_back(field.option);
    return {};
  }
  Result<std::string> argument = argument_of(body, field, places, spec);
  if (!argument) return std::move(argument).error();
  if (!field.option.empty()) spec.arguments.emplace_back(field.option);
  spec.arguments.push_back(std::move(*argument));
  return {};
}

// What one field says of others.
Result<void> check_together(const std::string& kind, const Json& body) {
  const auto named = [&](const char* field) { return static_cast<int>(body.contains(field)); };
  if (kind == "check" && named("session") + named("input") + named("moved") != 1)
    return unfit("session", "either it or input or moved must be named");
  if (kind == "calibrate_update" && named("session") + named("moved") != 1)
    return unfit("session", "either it or moved must be named");
  if (kind.starts_with("export") && named("session") + named("material") != 1)
    return unfit("session", "either it or material must be named");
  if (named("recipe") + named("steps") > 1) return unfit("recipe", "either it or steps may be named");
  if (kind == "batch_plan" && named("sessions") + named("find") != 1)
    return unfit("sessions", "either it or find must be named");
  if (kind == "batch_plan" && named("quality") + named("to_deg") + named("within_s") > 1)
    return unfit("quality", "either it or to_deg or within_s may be named");
  const int wishes = (named("to_deg") + named("within_s") > 0) + named("quality") + named("method");
  if (kind == "solve" && wishes > 1)
    return unfit("quality", "either it or method or to_deg with within_s may be named");
  const bool is_chosen = kind == "batch_plan" && named("to_deg") + named("within_s") > 0;
  if (is_chosen && body.value("sample", Json()) == 0)
    return unfit("sample", "must be above 0 where levels are chosen by what was measured");
  if (kind == "rig_plan" && named("cloth") + named("roughness") > 1)
    return unfit("cloth", "either it or roughness may be named");
  if (kind == "rig_plan" && named("f0") > named("roughness"))
    return unfit("f0", "is that of a cloth of this roughness, which must be named");
  return {};
}

// What the daemon knows and its client does not say.
Result<void> add_places(JobSpec& spec, const JobPlaces& places) {
  const auto add = [&](std::initializer_list<std::string> words) {
    spec.arguments.insert(spec.arguments.end(), words);
  };
  if (spec.kind == "copy" && !places.copy.empty()) add({"--to", places.copy.string()});
  if (spec.kind == "torture") {
    spec.of = kTorture;
    add({"--output", (places.sessions / fmt::format("{}.weft", kTorture)).string()});
  }
  if (spec.kind == "rig_plan") {
    if (places.rig_file.empty())
      return Error{ErrorKind::kNoInput, "there is no rig to plan for", places.rig, "",
                   "serve one with --rig"};
    spec.of = places.rig;
    spec.needs.push_back(places.rig_file.string());
    add({places.rig_file.string()});
  }
  if (spec.kind == "batch_plan") return add_batch_plan(spec, places);
  if (spec.kind == "batch_run") return add_batch_run(spec, places);
  return {};
}

}  // namespace

Result<fs::path> folder_below(const fs::path& root, const Json& body, const char* field) {
  Result<fs::path> folder = place_below(root, body, field);
  if (!folder) return folder;
  const Result<void> inside = check_inside(*folder, root);
  return inside ? folder : inside.error();
}

Result<JobSpec> read_job_body(const Json& body, const JobPlaces& places) {
  const Result<std::string> name = word_in(body, "kind");
  if (!name) return name.error();
  const auto kind = std::ranges::find(job_kinds(), *name, &JobKind::name);
  if (kind == job_kinds().end()) {
    std::vector<std::string_view> names;
    for (const JobKind& each : job_kinds()) names.emplace_back(each.name);
    return unfit("kind", fmt::format("must be one of {}", fmt::join(names, ", ")));
  }
  JobSpec spec = {*name, "", kind->verb, "", ""};
  spec.wants = body;
  for (const char* told : {"kind", "request_id"}) spec.wants.erase(told);
  for (const auto& [key, value] : body.items()) {
    const auto is_it = [&key = key](const JobField& field) { return key == field.field; };
    const bool is_known = key == "kind" || key == "request_id" || std::ranges::any_of(kind->fields, is_it);
    if (!is_known) return unfit(key.substr(0, 40), fmt::format("is no field of a {} job", kind->name));
  }
  if (body.contains("request_id")) {
    Result<std::string> id = word_in(body, "request_id");
    if (!id) return std::move(id).error();
    spec.request_id = std::move(*id);
  }
  for (const JobField& field : kind->fields) {
    if (Result<void> added = add_field(body, field, places, spec); !added) return std::move(added).error();
  }
  if (Result<void> fits = check_together(*name, body); !fits) return std::move(fits).error();
  if (Result<void> added = add_places(spec, places); !added) return std::move(added).error();
  if (kind->names_rig && !body.contains("from"))
    spec.arguments.insert(spec.arguments.end(), {"--rig", places.rig});
  return spec;
}

}  // namespace weft::app
