// SPDX-License-Identifier: Apache-2.0
#include "app/jobs/solve.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "app/jobs/map_files.h"
#include "app/jobs/pictures.h"
#include "app/jobs/report.h"
#include "core/files.h"
#include "core/image_io/image_io.h"
#include "pipeline/albedo_color.h"
#include "pipeline/bands.h"
#include "pipeline/frame.h"
#include "pipeline/shifts.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSchema = "weft.solve";

// Counts of pixels by status, gathered band by band.
class StatusCounts {
 public:
  void add(View<const std::uint16_t> status) {
    for (int y = 0; y < status.height(); ++y) {
      const std::uint16_t* row = status.row(y);
      for (int x = 0; x < status.width(); ++x) ++seen_[row[x] & 0xff];
    }
  }
  std::int64_t with(StatusBit bit) const {
    std::int64_t sum = 0;
    for (std::size_t s = 0; s < seen_.size(); ++s) {
      if (s & bit) sum += seen_[s];
    }
    return sum;
  }

 private:
  std::array<std::int64_t, 256> seen_ = {};
};

// Where the maps go and by which name.
struct Place {
  std::string id;
  fs::path folder;
};

// The id says what went in; nothing about this machine or this run.
std::string id_of(const Json& input, const SolveOptions& options) {
  const Json all = {{"input", input},
                    {"method", options.method},
                    {"compression", options.compression},
                    {"solver_version", kSolverVersion}};
  return sha256_of(all.dump()).substr(0, 16);
}

Result<solver::MethodName> find_method(const std::string& name) {
  const auto names = solver::method_names();
  const auto found = std::find_if(names.begin(), names.end(), [&](const auto& m) { return name == m.name; });
  if (found != names.end()) return *found;
  return Error{ErrorKind::kUsage, "no such method", name, "", "see weft solve --help for their names"};
}

// A complete solve of the same inputs, if the folder holds one; an error if it holds anything else.
Result<std::optional<Json>> find_finished(const Place& place) {
  if (!is_there(place.folder)) return std::optional<Json>();
  const fs::path file = place.folder / "solve.json";
  if (is_there(file)) {
    Result<Json> document = read_json(file, kSchema, 1);
    if (!document) return std::move(document).error();
    if (JsonFields(*document, file.string()).text_or("id", "") == place.id)
      return std::optional<Json>(std::move(*document));
  }
  return Error{ErrorKind::kCannotCreate, "output folder is taken", place.folder.string(),
               "it holds something other than this solve", "name another folder with -o, or remove it"};
}

// Room for the maps, before any work is done.
Result<void> check_disk(const fs::path& folder, Size size) {
  constexpr std::uint64_t kBytesAPixel =
      32;  // normal 12, albedo 6, sigma 8, residual 2, status and pictures 4
  const std::uint64_t needed = static_cast<std::uint64_t>(size.pixels()) * kBytesAPixel;
  const std::uint64_t free = free_disk_bytes(folder);
  if (free >= needed) return {};
  return Error{ErrorKind::kInputOutput, "not enough disk space", folder.string(),
               fmt::format("{} MB are needed, {} MB are free", needed >> 20, free >> 20),
               "free disk space or choose another disk with -o"};
}

// One solve, whatever it starts from.
struct Input {
  std::string title;
  Json description;  // all that the id depends on besides the options
  Size size;
  fs::path default_parent;  // of the output
  fs::path truth;           // normal.exr of a simulated session, or empty
  std::vector<int> picked;  // numbers of photographs picked from a list
  std::function<Result<Photographs>()> load;
};

// What solve.json says.
struct Facts {
  const std::string& id;
  const SolveOptions& options;
  const Input& input;
  Size size;
  const StatusCounts& counts;
  std::string albedo_scale;
  const char* color;
  std::size_t lights;
  std::vector<std::string> pictures;
  std::optional<NormalComparison> error;  // against the truth, where there is one
  std::vector<report::Verdict> verdicts;
  FrameFacts frame;
  Json registration;
  Json conditions;
};

Json document_of(const Facts& facts) {
  Json status = Json::object();
  for (const StatusName& s : kStatusNames) status[s.name] = facts.counts.with(s.bit);
  const Size size = facts.size;
  Json document = {{"schema", std::string(kSchema) + "/1"},
                   {"id", facts.id},
                   {"solver_version", kSolverVersion},
                   {"method", facts.options.method},
                   {"compression", facts.options.compression},
                   {"input", facts.input.description},
                   {"lights", facts.lights},
                   {"width", size.width},
                   {"height", size.height},
                   {"albedo_scale", facts.albedo_scale},
                   {"color", facts.color},
                   {"pixels", size.pixels() - facts.counts.with(kNoSolution)},
                   {"status", std::move(status)},
                   {"solved_by", json_of(facts.frame.tally)},
                   {"conditions", facts.conditions},
                   {"registration", facts.registration},
                   {"warnings", json_of(facts.verdicts)},
                   {"pictures", facts.pictures}};
  if (!facts.frame.gates.is_null()) document["gates"] = facts.frame.gates;
  if (!facts.frame.reference.is_null()) document["reference"] = facts.frame.reference;
  if (facts.error) {
    document["error"] = {{"mean_deg", facts.error->mean_deg},
                         {"median_deg", facts.error->median_deg},
                         {"p95_deg", facts.error->p95_deg},
                         {"max_deg", facts.error->max_deg}};
  }
  return document;
}

// Writes the pictures beside the maps, with their error where there is a truth.
Result<void> draw(const Pictures& pictures, const Input& input, const fs::path& folder, Facts& facts) {
  std::optional<TruthError> error;
  if (!input.truth.empty() && facts.size == input.size) {
    Result<TruthError> measured = error_against(input.truth, folder / "normal.exr");
    if (!measured) return std::move(measured).error();
    error = std::move(*measured);
    facts.error = error->normal;
  }
  Result<std::vector<std::string>> names =
      pictures.write(folder, input.title, facts.albedo_scale == "absolute", error ? &*error : nullptr);
  if (!names) return std::move(names).error();
  facts.pictures = std::move(*names);
  return {};
}

Result<SolveReport> run(const solver::MethodName& method_name, const Input& input,
                        const SolveOptions& options, const JobContext& context) {
  Stopwatch total, watch;
  Place place;
  place.id = id_of(input.description, options);
  place.folder = fs::absolute(options.output.empty() ? input.default_parent / place.id : options.output)
                     .lexically_normal();
  Result<std::optional<Json>> finished = find_finished(place);
  if (!finished) return std::move(finished).error();
  if (*finished) return SolveReport{place.folder, true, std::move(**finished), {}};

  PartialFolder partial(place.folder);
  if (Result<void> room = check_disk(place.folder.parent_path(), input.size); !room)
    return std::move(room).error();
  if (Result<void> made = make_writable_folder(partial.path()); !made) return std::move(made).error();
  SolveReport report;
  report.folder = place.folder;
  Result<Photographs> photographs = input.load();
  if (!photographs) return std::move(photographs).error();
  report.seconds.read = watch.lap();

  const bool half = method_name.extent == solver::Extent::kHalfSize;
  Json registration = Json::array();
  if (half) {
    photographs = half_size(*photographs, context.threads);
    if (!photographs) return std::move(photographs).error();
  } else {
    const Result<SessionShifts> shifts = register_shots(*photographs, context);
    if (!shifts) return shifts.error();
    registration = registration_document(*shifts, photographs->leds);
  }
  std::optional<CalibrationChannels> calibration;
  if (photographs->light_covariance) {
    Result<CalibrationChannels> made = CalibrationChannels::make(*photographs, context.threads);
    if (!made) return std::move(made).error();
    calibration.emplace(std::move(*made));
  }
  const Size size = photographs->size;
  std::optional<AlbedoColor> color;
  if (photographs->color) color.emplace(*photographs->color, size.width, context.threads);
  std::vector<std::string> shares;
  if (calibration || (color && color->has_covariance())) shares = {"R", "G", "B"};
  if (calibration) shares.push_back("normal_deg");
  Result<MapFiles> files = MapFiles::open(partial.path(), size, options.compression, shares);
  if (!files) return std::move(files).error();
  report.seconds.prepare = watch.lap();

  StatusCounts counts;
  Pictures pictures(size);
  MapSummary maps(size);
  const Result<FrameFacts> solved = solve_frame(
      *photographs, method_name, options.tile, context, [&](const MapBand& camera_band) -> Result<void> {
        std::vector<View<const float>> share;
        if (calibration) {
          const auto channels = calibration->of(camera_band);
          share.assign(channels.begin(), channels.end());
        }
        const MapBand band = color ? color->of(camera_band, share) : camera_band;
        counts.add(band.status);
        maps.add(band, calibration ? share.back() : View<const float>());
        if (options.previews) pictures.add(band);
        return files->write(band, share);
      });
  if (!solved) return solved.error();
  report.seconds.solve = watch.lap() - solved->waited_seconds;
  Facts facts = {place.id,
                 options,
                 input,
                 size,
                 counts,
                 photographs->albedo_scale,
                 color ? "rec709" : "camera",
                 photographs->count(),
                 {},
                 {},
                 {},
                 *solved,
                 std::move(registration),
                 photographs->conditions};
  const PhotographsSummary summary = summarize_photographs(*photographs, input.picked, context);
  report.seconds.report = watch.lap();
  photographs = Photographs();  // their memory is needed for nothing more

  if (Result<void> ok = files->finish(); !ok) return std::move(ok).error();
  report.seconds.write = solved->waited_seconds + watch.lap();
  if (options.previews) {
    Result<void> drawn = draw(pictures, input, partial.path(), facts);
    if (!drawn) return std::move(drawn).error();
  }
  report.seconds.pictures = watch.lap();

  // What leaves no shadow out takes much for a highlight.
  const bool tells_highlights = method_name.is_quality && !half;
  facts.verdicts = verdicts_of(summary, tells_highlights ? static_cast<double>(counts.with(kSpecular)) /
                                                               static_cast<double>(size.pixels())
                                                         : 0.0);
  report.document = document_of(facts);
  if (Result<void> ok = write_json(partial.path() / "solve.json", report.document); !ok)
    return std::move(ok).error();
  const Json seconds = {{"read", report.seconds.read},         {"prepare", report.seconds.prepare},
                        {"solve", report.seconds.solve},       {"write", report.seconds.write},
                        {"pictures", report.seconds.pictures}, {"report", report.seconds.report}};
  const Json page = report_document(input.title, report.document, summary, maps, seconds);
  if (Result<void> ok = write_report(partial.path(), page); !ok) return std::move(ok).error();
  report.seconds.report += watch.lap();
  if (context.stop.stop_requested()) return interrupted();
  if (Result<void> ok = partial.publish(); !ok) return std::move(ok).error();
  report.seconds.sync = watch.lap();
  report.seconds.total = total.lap();
  return report;
}

}  // namespace

Result<SolveReport> solve_session(const SessionOptions& input, const SolveOptions& options,
                                  const JobContext& context) {
  const Result<solver::MethodName> method = find_method(options.method);
  if (!method) return method.error();
  Result<SessionPlan> plan = plan_session(input);
  if (!plan) return std::move(plan).error();
  const fs::path truth = plan->session.folder / "truth" / "normal.exr";
  return run(*method,
             {.title = plan->session.fabric,
              .description = plan->description,
              .size = plan->size,
              .default_parent = plan->session.folder / "solve",
              .truth = is_there(truth) ? truth : fs::path(),
              .picked = {},
              .load = [&] { return load_session(*plan, context); }},
             options, context);
}

Result<SolveReport> solve_photos(const PhotoOptions& input, const SolveOptions& options,
                                 const JobContext& context) {
  const Result<solver::MethodName> method = find_method(options.method);
  if (!method) return method.error();
  PhotoOptions photos = input;
  photos.clipped = method->keeps_clipped ? Clipped::kKeep : Clipped::kMark;
  Result<PhotoPlan> plan = plan_photos(photos);
  if (!plan) return std::move(plan).error();
  const fs::path source =
      fs::absolute(input.light_file.empty() ? input.folder : input.light_file).lexically_normal();
  const fs::path name = source.has_filename() ? source.stem() : source.parent_path().filename();
  return run(*method,
             {.title = name.string(),
              .description = plan->description,
              .size = plan->size,
              .default_parent = fs::current_path() / (name.string() + "-solve"),
              .truth = {},
              .picked = input.lights,
              .load = [&] { return load_photos(*plan, context); }},
             options, context);
}

}  // namespace weft::app
