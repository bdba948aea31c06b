// SPDX-License-Identifier: Apache-2.0
#include "material/run/finishing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/percent.h"
#include "core/base/vec.h"
#include "material/filtering/detail.h"
#include "material/finish/color_correction.h"
#include "material/finish/crop.h"
#include "material/finish/part.h"
#include "material/finish/repair.h"
#include "material/finish/straighten.h"
#include "material/finish/tile.h"
#include "material/lattice/lattice.h"
#include "material/maps/flatten.h"
#include "material/run/surface_files.h"
#include "report/preview.h"

namespace weft::material {
namespace {

using report::Picture;

constexpr int kYarnsShown = 28, kYarnsApart = 4, kSide = 720;
constexpr report::Colour kAcross{1.0F, 0.3F, 0.2F}, kUp{0.2F, 0.7F, 1.0F};

// Some yarns around the middle.
Rect middle_of(const Surface& surface, const Lattice& lattice) {
  const Size size = surface.size();
  const int side = static_cast<int>(kYarnsShown * std::max(lattice.yarn_x_px, lattice.yarn_y_px));
  const int w = std::min(side, size.width), h = std::min(side, size.height);
  const int x0 = (size.width - w) / 2, y0 = (size.height - h) / 2;
  return {x0, y0, x0 + w, y0 + h};
}

Picture relit(const Surface& surface, Rect part) {
  Image<float> slope({part.width(), part.height()}, 2), albedo(slope.size(), 3);
  for (int y = 0; y < part.height(); ++y) {
    for (int x = 0; x < part.width(); ++x) {
      for (int p = 0; p < 2; ++p) slope(x, y, p) = surface.slope(part.x0 + x, part.y0 + y, p);
      for (int p = 0; p < 3; ++p)
        albedo(x, y, p) = surface.albedo(part.x0 + x, part.y0 + y, std::min(p, surface.albedo.planes() - 1));
    }
  }
  return report::relit_picture(albedo, normals_of(slope), report::display_scale(albedo));
}

// Each pixel of the picture stands for one of `of`, `times` as large or small.
Picture resized(const Picture& of, double times) {
  const Size size = {static_cast<int>(times * of.width()), static_cast<int>(times * of.height())};
  Picture out(size, of.planes());
  for (int p = 0; p < of.planes(); ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x)
        out(x, y, p) = of(static_cast<int>(x / times), static_cast<int>(y / times), p);
    }
  }
  return out;
}

// Lines along a way, `apart` pixels of the picture from each other, one through its middle.
void draw_lines(Picture& picture, Vec2 way, double apart, report::Colour colour) {
  constexpr double kHalfWidth = 1.2;
  const Vec2 along = (1 / length(way)) * way;
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const Vec2 from_middle = {x - picture.width() / 2.0, picture.height() / 2.0 - y};
      if (std::abs(std::remainder(cross(along, from_middle), apart)) < kHalfWidth)
        report::fill(picture, {x, y, x + 1, y + 1}, colour);
    }
  }
}

// The middle of a cloth, relit, with lines as its yarns lie by a lattice of kRepeat, four yarns apart: so
// that a person sees whether those are its yarns.
Picture yarn_picture(const Surface& surface, const Lattice& lattice) {
  const Rect part = middle_of(surface, lattice);
  const double times = static_cast<double>(kSide) / std::max(part.width(), part.height());
  Picture picture = resized(relit(surface, part), times);
  draw_lines(picture, lattice.axes.a, kYarnsApart * times * lattice.yarn_y_px, kAcross);
  draw_lines(picture, lattice.axes.b, kYarnsApart * times * lattice.yarn_x_px, kUp);
  return picture;
}

// The way back from a grid that was cut and straightened to the one that it began as.
class WayBack {
 public:
  void cut(int left, int top) {
    steps_.push_back({{}, {}, static_cast<double>(left), static_cast<double>(top)});
  }
  void straighten(Lookup lookup, Size old) { steps_.push_back({std::move(lookup), old, 0, 0}); }

  FinishedPlace of(Size size) const {
    const double w = size.width, h = size.height;
    FinishedPlace place = {.centre_px = at(w / 2, h / 2)};
    const std::array<std::array<double, 2>, 4> corners = {at(0, 0), at(w, 0), at(w, h), at(0, h)};
    for (std::size_t i = 0; i < 8; ++i) place.corners_px[i] = corners[i / 2][i % 2];
    return place;
  }

 private:
  struct Step {
    Lookup lookup;  // empty: a cut
    Size old;
    double left = 0, top = 0;
  };

  // Places are between edges of pixels: the first one lies from 0 to 1.
  std::array<double, 2> at(double x, double y) const {
    for (auto step = steps_.rbegin(); step != steps_.rend(); ++step) {
      if (step->old.pixels() == 0) {
        x += step->left;
        y += step->top;
        continue;
      }
      const Vec2 place = step->lookup.at(x - 0.5, y - 0.5).at;
      x = step->old.width / 2.0 + place.x;
      y = step->old.height / 2.0 - place.y;
    }
    return {x, y};
  }

  std::vector<Step> steps_;
};

// The shortest repeats along the yarns, y down; of ribs the one across them.
Json repeat_of(const Lattice& lattice) {
  const auto [a, b] = lattice.axes;
  const double mm = lattice.mm_per_pixel;
  Json repeat = {{"across_px", {a.x, -a.y}}, {"across_mm", mm * length(a)}};
  if (lattice.kind != LatticeKind::kRepeat) return repeat;
  repeat.update({{"up_px", {b.x, -b.y}},
                 {"up_mm", mm * length(b)},
                 {"angle_deg", degrees(std::atan2(cross(a, b), dot(a, b)))}});
  return repeat;
}

// Whether a step says places from the left upper corner.
bool names_places(const RecipeStep& step) {
  return step.name == "crop" || step.name == "repair";
}

bool works_by_repeats(const RecipeStep& step) {
  return step.name == "straighten" || step.name == "tile" || step.name == "detail";
}

// By material::FlattenMethod.
constexpr std::array<const char*, 3> kFlattenNames = {"polynomial", "corners", "high-pass"};

// Steps between a cloth and its end, each with what those before it found.
class Finisher {
 public:
  Finisher(Surface& surface, const FinishingInput& input, const JobContext& context)
      : surface_(surface), input_(input), context_(context) {}

  Result<Json> run(const Recipe& recipe, std::size_t at) {
    const RecipeStep& step = recipe.steps[at];
    const bool names_later =
        std::any_of(recipe.steps.begin() + static_cast<std::ptrdiff_t>(at), recipe.steps.end(), names_places);
    // What is straightened is cut once its repeat was found, which the whole cloth tells.
    if (works_by_repeats(step) && step.name != "straighten" && !names_later) take_part({});
    may_cut_ = !names_later;
    if (step.name == "flatten") return flatten(step.options);
    if (step.name == "straighten") return straighten(recipe, at);
    if (step.name == "crop") return crop(recipe, at);
    if (step.name == "tile") return tile();
    if (step.name == "repair") return repair(step.options);
    if (step.name == "color") return color(step.options);
    if (step.name == "scale") return scale(step.options);
    return detail();
  }

  // What is known of all steps together.
  FinishingFacts finish() {
    take_part({});
    facts.place = back_.of(surface_.size());
    return std::move(facts);
  }

  FinishingFacts facts;

 private:
  // A preview goes on with the middle of the cloth, at least as large as this.
  void take_part(Size least) {
    const Size whole = surface_.size();
    const bool is_large = input_.most_px > 0 && whole.pixels() > input_.most_px;
    if (!is_large || is_part_ || surface_.is_tile) return;
    is_part_ = true;
    const double side = std::sqrt(static_cast<double>(input_.most_px));
    const auto held = [](double wanted, int at_least, int all) {
      return std::min(std::max(static_cast<int>(wanted), at_least), all);
    };
    const int h = held(std::max(side, static_cast<double>(input_.most_px) / whole.width), least.height,
                       whole.height),
              w = held(static_cast<double>(input_.most_px) / h, least.width, whole.width);
    if (w == whole.width && h == whole.height) return;
    const Rect part = {(whole.width - w) / 2, (whole.height - h) / 2, (whole.width + w) / 2,
                       (whole.height + h) / 2};
    const double mm = surface_.mm_per_pixel;
    facts.part_mm = {mm * w, mm * h, mm * whole.width, mm * whole.height};
    back_.cut(part.x0, part.y0);
    surface_ = part_of(surface_, part);
  }

  // What so many repeats, the joint of their ends and the turn take.
  static Size room_of(const Lattice& lattice, const std::array<int, 2>& repeats) {
    constexpr double kJoint_px = 64;
    const auto [a, b] = lattice.axes;
    const double x = (repeats[0] + 2) + kJoint_px / length(a), y = (repeats[1] + 2) + kJoint_px / length(b);
    return {static_cast<int>(x * std::abs(a.x) + y * std::abs(b.x)),
            static_cast<int>(x * std::abs(a.y) + y * std::abs(b.y))};
  }

  // The repeats of the tile that comes after; a straightened cloth is scaled so that so many are whole
  // pixels.
  static std::array<int, 2> repeats_wanted(const Recipe& recipe, std::size_t from) {
    for (std::size_t i = from; i < recipe.steps.size(); ++i) {
      if (recipe.steps[i].name != "tile") continue;
      const auto repeats = recipe.steps[i].options["repeats"].get<std::array<double, 2>>();
      return {static_cast<int>(repeats[0]), static_cast<int>(repeats[1])};
    }
    return {0, 0};
  }

  // Looked for once in the cloth as it stands, or again as somebody says that its yarns lie.
  Result<void> find_lattice(const SaidYarns& said = {}) {
    const bool is_said = said.turn_deg || said.x_px > 0 || said.y_px > 0;
    if (lattice_ && !is_said) return {};
    Result<Lattice> lattice = material::find_lattice(surface_, {.said = said, .threads = context_.threads});
    if (!lattice) return std::move(lattice).error();
    lattice_ = *lattice;
    facts.yarn_px =
        lattice->kind == LatticeKind::kRepeat ? std::min(lattice->yarn_x_px, lattice->yarn_y_px) : 0;
    return {};
  }

  void warn(std::string name, std::string text, std::string remedy) {
    facts.verdicts.push_back({std::move(name), std::move(text), std::move(remedy)});
  }

  Result<Json> flatten(const Json& options) {
    FlattenOptions flatten;
    const auto method = std::ranges::find(kFlattenNames, options["by"].get<std::string>());
    flatten.method = static_cast<FlattenMethod>(method - kFlattenNames.begin());
    flatten.degree = options["degree"].get<int>();
    flatten.cut_mm = options["cut_mm"].get<double>();
    flatten.mm_per_pixel = surface_.mm_per_pixel;
    flatten.sigma_deg = options["always"].get<bool>() ? 0 : input_.slow_sigma_deg;
    flatten.threads = context_.threads;
    if (flatten.method == FlattenMethod::kRepeat) {
      if (Result<void> ok = find_lattice(); !ok) return std::move(ok).error();
      const Cell& cell = lattice_->colour;
      if (lattice_->kind == LatticeKind::kRepeat)
        flatten.repeat = Repeat{cell.a.x, -cell.a.y, cell.b.x, -cell.b.y};
      else
        flatten.method = FlattenMethod::kHann;
    }
    const Result<SlowSlopes> slow =
        slow_slopes(surface_.slope.plane(0), surface_.slope.plane(1), surface_.status.plane(), flatten);
    if (!slow) return slow.error();
    material::flatten(*slow, surface_.status.plane(), surface_.slope.plane(0), surface_.slope.plane(1),
                      context_.threads);
    if (slow->acts) facts.removed = removed_slopes(*slow, context_.threads);
    return Json{{"acts", slow->acts},
                {"method", kFlattenNames[static_cast<std::size_t>(slow->method)]},
                {"degree_found", slow->degree},
                {"tilt_deg", slow->tilt_deg},
                {"range_deg", slow->range_deg},
                {"bow_mm", slow->bow_mm},
                {"sigma_deg", flatten.sigma_deg}};
  }

  Result<Json> straighten(const Recipe& recipe, std::size_t at) {
    const Json& said = recipe.steps[at].options;
    SaidYarns yarns;
    if (!said["turn_deg"].is_null()) yarns.turn_deg = said["turn_deg"].get<double>();
    yarns.x_px = said["yarn_px"][0].get<double>();
    yarns.y_px = said["yarn_px"][1].get<double>();
    if (Result<void> ok = find_lattice(yarns); !ok) return std::move(ok).error();
    Json found = {{"acts", false}, {"kind", name_of(lattice_->kind)}};
    const bool is_one_way = lattice_->kind == LatticeKind::kOneWay;
    if (is_one_way || lattice_->kind == LatticeKind::kRepeat) found["repeat"] = repeat_of(*lattice_);
    if (lattice_->kind != LatticeKind::kRepeat) {
      warn("NO_REPEAT", fmt::format("the cloth was not straightened: {}", words_of(lattice_->kind)),
           "nothing, if it has none; else scan more of it");
      is_left_turned_ = true;
      return found;
    }
    found.update({{"turn_deg", lattice_->turn_x_deg},
                  {"skew_deg", lattice_->turn_y_deg - lattice_->turn_x_deg},
                  {"yarn_px", {lattice_->yarn_x_px, lattice_->yarn_y_px}},
                  {"yarn_share", lattice_->yarn_share},
                  {"colours_repeat", lattice_->colours_repeat},
                  {"strength", lattice_->strength}});
    if (!yarns.turn_deg && is_to_be_asked(*lattice_)) {
      found["picture"] = ask(at);
      return found;
    }
    StraightenOptions options;
    const std::array<int, 2> repeats = repeats_wanted(recipe, at);
    options.repeats_x = repeats[0];
    options.repeats_y = repeats[1];
    options.threads = context_.threads;
    if (may_cut_) take_part(room_of(*lattice_, repeats));
    const Size old = surface_.size();
    Result<Straightened> straight = material::straighten(surface_, *lattice_, options);
    if (!straight) return std::move(straight).error();
    found.update({{"acts", true},
                  {"repeats", {straight->repeats_x, straight->repeats_y}},
                  {"period_px", {straight->period_px.width, straight->period_px.height}},
                  {"mm_per_pixel", {straight->mm_per_pixel_x, straight->mm_per_pixel_y}},
                  {"largest_pull_mm", straight->largest_pull_mm},
                  {"rms_pull_mm", straight->rms_pull_mm}});
    tile_ = tile_of(*straight);
    back_.straighten(std::move(straight->lookup), old);
    surface_ = std::move(straight->surface);
    lattice_.reset();
    is_left_turned_ = false;
    return found;
  }

  // Shows where the yarns seem to lie, and asks for a word; the picture's name.
  std::string ask(std::size_t at) {
    const std::string file = fmt::format("straighten_{}.png", at + 1);
    facts.pictures.push_back({file, yarn_picture(surface_, *lattice_)});
    const auto hundredths = [](double value) { return std::round(100 * value) / 100 + 0.0; };  // no -0.00
    const double turn_deg = hundredths(lattice_->turn_x_deg),
                 skew_deg = hundredths(lattice_->turn_y_deg - lattice_->turn_x_deg);
    warn("TURN_ASKED",
         fmt::format(
             "the cloth was not straightened: its yarns seem to be turned by {:.2f} degrees and sheared by "
             "{:.2f}, and beyond {:g} and {:g} those may be diagonals",
             turn_deg, skew_deg, kMostTurn_deg, kMostSkew_deg),
         fmt::format(
             "look at {}; where its lines lie along the yarns give the recipe straighten = {{ turn_deg = "
             "{:.2f}, yarn_px = [{:.2f}, {:.2f}] }}, else what is true",
             file, turn_deg, lattice_->yarn_x_px, lattice_->yarn_y_px));
    is_left_turned_ = true;
    return file;
  }

  Result<Json> tile() {
    TilingOptions options = tile_.value_or(TilingOptions());
    options.threads = context_.threads;
    if (!tile_)
      warn("NOT_STRAIGHTENED", "the tile is cut where the cloth is closest to itself, without its repeat",
           is_left_turned_ ? "do what is said of straightening"
                           : "put the step straighten before the step tile");
    Result<Tile> cut = material::tile(surface_, options);
    if (!cut) return std::move(cut).error();
    const auto seam = [](const Seam& s) {
      return Json{{"overlap_px", s.overlap_px},
                  {"wrap_step_slope", s.wrap_step_slope},
                  {"wrap_step_albedo", s.wrap_step_albedo},
                  {"wrap_step_height", s.wrap_step_height},
                  {"gradient_slope", s.gradient_slope},
                  {"gradient_albedo", s.gradient_albedo},
                  {"residual", s.residual},
                  {"curl", s.curl}};
    };
    Json found = {{"has_repeat", cut->has_repeat},
                  {"from_px", {cut->x0, cut->y0}},
                  {"places", cut->places},
                  {"seam_x", seam(cut->x)},
                  {"seam_y", seam(cut->y)},
                  {"relief_mm", cut->relief_mm},
                  {"normal_p99_deg", cut->normal_p99_deg}};
    for (const auto& [axis, s] : {std::pair{"upright", cut->x}, {"level", cut->y}}) judge(axis, s);
    back_.cut(cut->x0, cut->y0);
    surface_ = std::move(cut->surface);
    tile_.reset();
    return found;
  }

  Result<Json> crop(const Recipe& recipe, std::size_t at) {
    const Json& options = recipe.steps[at].options;
    const double mm = surface_.mm_per_pixel;
    CropOptions crop = {options["left_mm"], options["top_mm"], options["width_mm"], options["height_mm"]};
    if (crop.width_mm == 0) crop.width_mm = mm * surface_.size().width - crop.left_mm;
    if (crop.height_mm == 0) crop.height_mm = mm * surface_.size().height - crop.top_mm;
    Result<Cropped> cropped = material::crop(surface_, crop);
    if (!cropped) return std::move(cropped).error();
    const Rect& part = cropped->part_px;
    back_.cut(part.x0, part.y0);
    surface_ = std::move(cropped->surface);
    lattice_.reset();
    if (tile_ && repeats_wanted(recipe, at) == std::array<int, 2>{}) tile_->period_px = {};
    return Json{{"from_px", {part.x0, part.y0}}, {"size_px", {part.width(), part.height()}}};
  }

  // The repeats that spots are filled from: of a straightened cloth upright, else as they are found.
  Result<Cell> cell() {
    if (tile_) return Cell{{tile_->repeat_x_px, 0}, {0, tile_->repeat_y_px}};
    if (Result<void> ok = find_lattice(); !ok) return std::move(ok).error();
    if (lattice_->kind == LatticeKind::kRepeat) return lattice_->axes;
    return Error{ErrorKind::kBadData, "spots are filled from other repeats", "repair",
                 std::string(words_of(lattice_->kind)), "crop the spots away"};
  }

  Result<Json> repair(const Json& options) {
    if (options["spots"].empty()) return Json{{"filled", Json::array()}};
    const Result<Cell> cell = this->cell();
    if (!cell) return cell.error();
    RepairOptions repair;
    repair.cell = *cell;
    repair.threads = context_.threads;
    for (const Json& spot : options["spots"]) {
      Spot place;
      place.x_mm = spot["x_mm"];
      place.y_mm = spot["y_mm"];
      place.radius_mm = spot["radius_mm"];
      repair.spots.push_back(place);
    }
    Result<Repaired> repaired = material::repair(std::move(surface_), repair);
    if (!repaired) return std::move(repaired).error();
    surface_ = std::move(repaired->surface);
    Json filled = Json::array();
    for (const Filled& each : repaired->filled) {
      filled.push_back({{"repeats", {each.repeats_a, each.repeats_b}},
                        {"source_px", {each.spot.source_px->x, each.spot.source_px->y}},
                        {"mismatch", each.mismatch},
                        {"pixels", each.pixels}});
    }
    return Json{{"filled", std::move(filled)}};
  }

  Result<Json> color(const Json& options) {
    ColorOptions color;
    color.white_gains = options["gain"].get<std::array<double, 3>>();
    color.exposure = std::exp2(options["exposure"].get<double>());
    Result<Colored> colored = material::color(std::move(surface_), color);
    if (!colored) return std::move(colored).error();
    surface_ = std::move(colored->surface);
    if (colored->share_above_white > 0)
      warn("ALBEDO_ABOVE_WHITE",
           fmt::format("{} percent of the pixels have an albedo over 1",
                       percent_words(colored->share_above_white)),
           "take a smaller exposure");
    return Json{{"share_above_white", colored->share_above_white}};
  }

  Result<Json> scale(const Json& options) {
    const double before = surface_.mm_per_pixel, after = options["mm_per_pixel"];
    if (after == 0) return Json{{"times", 1}};
    Result<Surface> scaled = material::scale(std::move(surface_), after);
    if (!scaled) return std::move(scaled).error();
    surface_ = std::move(*scaled);
    return Json{{"times", after / before}};
  }

  Result<Json> detail() {
    DetailOptions options;
    if (tile_) options.repeat = {tile_->repeat_x_px, tile_->repeat_y_px};
    options.threads = context_.threads;
    Result<DetailLayer> layer = detail_layer(surface_, {}, options);
    if (!layer) return std::move(layer).error();
    surface_.slope = std::move(layer->slope);
    surface_.albedo = std::move(layer->albedo);
    facts.is_detail = true;
    return Json{{"slope_taken_out", {layer->facts.slope_x, layer->facts.slope_y}},
                {"mean_taken_out", layer->facts.albedo},
                {"share_of_frame", layer->facts.share_of_frame}};
  }

  // A joint that is sharper or softer than the cloth around it is seen.
  void judge(std::string_view axis, const Seam& seam) {
    const auto is_seen = [](double energy) { return energy < kLeastEnergy || energy > kMostEnergy; };
    if (!is_seen(seam.gradient_slope) && !is_seen(seam.gradient_albedo)) return;
    warn("SEAM_SEEN",
         fmt::format("the {} joint has {:.2f} of the cloth's gradient energy in its slopes and {:.2f} in its "
                     "albedo; {} to {} is not seen",
                     axis, seam.gradient_slope, seam.gradient_albedo, kLeastEnergy, kMostEnergy),
         tile_             ? "ask the step tile for another number of repeats"
         : is_left_turned_ ? "do what is said of straightening"
                           : "put the step straighten before the step tile");
  }

  static constexpr double kLeastEnergy = 0.9, kMostEnergy = 1.1;

  Surface& surface_;
  const FinishingInput& input_;
  const JobContext& context_;
  std::optional<Lattice> lattice_;
  std::optional<TilingOptions> tile_;  // of a cloth that was straightened
  bool is_left_turned_ = false;        // straightening was told to, and said why not
  WayBack back_;
  bool may_cut_ = false;  // no step from this one on says places
  bool is_part_ = false;  // it was cut for a preview
};

}  // namespace

Result<FinishingFacts> finish_surface(Surface& surface, const Recipe& recipe, const FinishingInput& input,
                                      const JobContext& context) {
  Finisher finisher(surface, input, context);
  for (std::size_t i = 0; i < recipe.steps.size(); ++i) {
    if (context.stop.stop_requested()) return interrupted();
    context.progress("finish", static_cast<double>(i) / static_cast<double>(recipe.steps.size()));
    Result<Json> found = finisher.run(recipe, i);
    if (!found) {
      Error error = std::move(found).error();
      error.where = fmt::format("step {} ({}): {}", i + 1, recipe.steps[i].name, error.where);
      return error;
    }
    finisher.facts.steps.push_back(std::move(*found));
  }
  context.progress("finish", 1);
  return finisher.finish();
}

}  // namespace weft::material
