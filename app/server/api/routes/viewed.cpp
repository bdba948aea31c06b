// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/viewed.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include "app/server/api/bodies/library_materials.h"
#include "app/server/api/routes/tile_query.h"
#include "core/base/iso_time.h"
#include "core/base/sha256.h"
#include "core/describe/field_json.h"
#include "core/rig/camera.h"
#include "core/rig/lights.h"
#include "library/catalogue/session_files.h"
#include "material/assets/build.h"
#include "material/run/maps.h"
#include "material/run/session_sets.h"
#include "report/preview.h"
#include "solve/session/current.h"
#include "solve/session/solved.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr double kNowhere = 1e6;  // pixels, beyond any picture

Error no_such_maps(const char* what, const std::string& id, const std::string& why) {
  return {ErrorKind::kNoInput, what, id.substr(0, 40), why, "see the list of those that the session has"};
}

// Its document where it is complete.
Result<Json> finished(const Result<Product>& product, const char* what, const std::string& id) {
  if (!product) return no_such_maps(what, id, product.error().what);
  Result<std::optional<Json>> document = find_finished(*product);
  if (!document) return std::move(document).error();
  if (!*document) return no_such_maps(what, id, "");
  return std::move(**document);
}

// None where the solve is gone.
std::optional<SolveFacts> solve_facts_of(const Session& session, const std::string& id) {
  if (id.empty()) return {};
  const Result<Json> document = finished(find_solve(session.folder, id), "there is no such solve", id);
  if (!document) return {};
  Result<SolveFacts> facts = solve_facts_from_json(*document);
  return facts ? std::optional(std::move(*facts)) : std::nullopt;
}

Result<void> add_layers(Viewed& viewed) {
  Result<Layers> layers = viewed.set ? layers_of_set(viewed.folder, *viewed.set) : layers_of(viewed.folder);
  if (!layers) return std::move(layers).error();
  viewed.layers = std::move(*layers);
  return {};
}

// What is named by its inputs has no date: its truth may be simulated anew.
std::string content_of_truth(const fs::path& folder) {
  std::error_code error;
  const auto written = fs::last_write_time(folder / "normal.exr", error);
  return "truth-" + sha256_of(fmt::format("{} {}", folder.string(), written.time_since_epoch().count()));
}

// Where the LEDs are that the session was scanned with; empty where nobody knows.
Json leds_of(const Viewed& viewed) {
  Json leds = Json::array();
  const Result<Calibration> calibration = read_calibration(viewed.session.calibration_folder());
  if (!calibration || !calibration->lights) return leds;
  const auto* near = std::get_if<NearLights>(&*calibration->lights);
  if (near == nullptr) return leds;
  for (const NearLight& led : near->leds)
    leds.push_back({{"led", leds.size() + 1},
                    {"position_mm", {led.position_mm.x, led.position_mm.y, led.position_mm.z}}});
  return leds;
}

// What stands for all maps, whatever they are.
Json common_json(const Viewed& viewed) {
  Json warnings = Json::array();
  if (viewed.set) {
    warnings = names_in(*viewed.set, "verdicts");
  } else if (viewed.solve) {
    for (const Verdict& verdict : viewed.solve->warnings) warnings.push_back(verdict.name);
  }
  Json document = {{"id", viewed.id},
                   {"method", viewed.solve ? viewed.solve->method : kTruth},
                   {"width", viewed.layers.size.width},
                   {"height", viewed.layers.size.height},
                   {"albedo_scale", has_relative_albedo(viewed) ? "relative" : "absolute"},
                   {"warnings", std::move(warnings)}};
  if (viewed.document.empty()) return document;
  document["created"] = written_at(viewed.folder / viewed.document);
  document["bytes"] = library::bytes_below(viewed.folder);
  return document;
}

Json layers_json(const Layers& layers) {
  Json list = Json::array();
  for (const Layer& layer : layers.all) {
    Json bits = Json::array();
    for (const StatusName& bit : kStatusNames) {
      if (layer.kind == LayerKind::kFlags) bits.push_back(bit.name);
    }
    list.push_back({{"name", layer.name},
                    {"kind", name_of(layer.kind)},
                    {"unit", layer.unit},
                    {"bits", std::move(bits)}});
  }
  return list;
}

// Why the solve, or what was made of one, is not what would be made today.
Json stale_of(const Viewed& viewed) {
  if (viewed.is_build) {
    Json stale = Json::array();
    for (const Json& scan : viewed.set->value("scans", Json::array())) {
      if (!scan.is_object()) continue;
      for (const Json& why : scan.value("stale", Json::array())) stale.push_back(why);
    }
    return stale;
  }
  const solve::SessionSolves solves = solve::solves_of(viewed.session);
  if (viewed.set) return why_stale(solves, material::text_at(*viewed.set, "solve"));
  const solve::ChoosableSolve* const solve = solves.find(viewed.id);
  const bool is_outdated = solve != nullptr && !solve->outdated.empty();
  return is_outdated ? Json::array({solve->outdated}) : Json::array();
}

// What of the table lies in the picture, a quarter of its side around each tag too: it needs a white margin.
std::vector<Rect> beside_cloth(const Calibration& calibration, int pixels_each) {
  std::vector<Rect> all;
  const auto add = [&](const std::vector<std::array<double, 2>>& corners, double margin) {
    double left = kNowhere, top = kNowhere, right = -kNowhere, bottom = -kNowhere;
    for (const auto& [x, y] : corners) {
      left = std::min(left, x), right = std::max(right, x);
      top = std::min(top, y), bottom = std::max(bottom, y);
    }
    const double wide = margin * (right - left), high = margin * (bottom - top);
    const auto whole = [&](double pixel) {
      return static_cast<int>(std::clamp(pixel, -kNowhere, kNowhere) / pixels_each);
    };
    all.push_back({whole(left - wide), whole(top - high), whole(right + wide), whole(bottom + high)});
  };
  for (const Fiducial& tag : calibration.fiducials) {
    std::vector<std::array<double, 2>> corners;
    for (const Vec3& corner : tag.corners_mm) {
      const Vec3 at = project(*calibration.camera, corner);
      corners.push_back({at.x, at.y});
    }
    add(corners, 0.25);
  }
  for (const WhitePatch& patch : calibration.patches) add(patch.polygon_px, 0);
  return all;
}

// Those that a set was made of.
Result<Viewed> rectified_maps(Viewed viewed, const Product& product, Json document) {
  const Result<material::RectifyFacts> facts =
      read_fields<material::RectifyFacts>(document, product.kind.document);
  if (!facts) return facts.error();
  viewed.mm_per_pixel = facts->mm_per_pixel;
  viewed.folder = product.folder;
  viewed.id = product.id;
  viewed.content = "rectified-" + product.id;
  viewed.document = product.kind.document;
  viewed.solve = solve_facts_of(viewed.session, facts->source.solve);
  Result<Layers> layers = layers_of(viewed.folder);
  if (!layers) return std::move(layers).error();
  viewed.layers = std::move(*layers);
  viewed.set = std::move(document);
  return viewed;
}

}  // namespace

double mm_per_pixel_of(const Viewed& viewed) {
  if (viewed.set && viewed.mm_per_pixel <= 0) return 0;
  const Result<Lying> lying = lying_of(viewed);
  if (!lying) return 0;
  const Ground ground = lying->ground(viewed);
  const double x = 0.5 * viewed.layers.size.width, y = 0.5 * viewed.layers.size.height;
  const Vec3 a = place_on(ground, x, y), b = place_on(ground, x + 1, y);
  return std::hypot(b.x - a.x, b.y - a.y);
}

Result<Rect> swatch_part_of(const RigParts& parts, const Viewed& viewed) {
  SeenCloth cloth = {.size = viewed.layers.size, .mm_per_pixel = mm_per_pixel_of(viewed)};
  const Result<Lying> lying = lying_of(viewed);
  if (lying && lying->calibration)
    cloth.beside = beside_cloth(*lying->calibration, lying->ground(viewed).pixels_each);
  if (viewed.layers.find("sigma") == nullptr) return swatch_part(cloth, {});
  const Result<std::shared_ptr<Pyramid>> sigma = pyramid_of(parts, viewed, "sigma");
  if (!sigma) return sigma.error();
  const Result<Image<float>> samples = samples_of(**sigma);
  if (!samples) return samples.error();
  return swatch_part(cloth, samples->plane());
}

Result<Viewed> find_solve_maps(const RigParts& parts, const std::string& name, const std::string& id) {
  Result<Session> session = parts.library.session(name);
  if (!session) return std::move(session).error();
  Viewed viewed;
  viewed.session = std::move(*session);
  viewed.id = id;
  if (id == kTruth) {
    viewed.folder = viewed.session.folder / kTruth;
    viewed.content = content_of_truth(viewed.folder);
  } else {
    const Result<Product> product = find_solve(viewed.session.folder, id);
    const Result<Json> document = finished(product, "there is no such solve", id);
    if (!document) return document.error();
    Result<SolveFacts> facts = solve_facts_from_json(*document);
    if (!facts) return std::move(facts).error();
    viewed.folder = product->folder;
    viewed.id = viewed.content = product->id;
    viewed.document = product->kind.document;
    viewed.solve = std::move(*facts);
  }
  if (const auto pixel = solve::photographed_pixel(viewed.session); pixel && pixel->is_known)
    viewed.mm_per_pixel = pixel->mm;
  if (Result<void> ok = add_layers(viewed); !ok) return std::move(ok).error();
  return viewed;
}

Result<Viewed> find_map_set(const RigParts& parts, const std::string& name, const std::string& id) {
  Result<Session> session = parts.library.session(name);
  if (!session) return std::move(session).error();
  Viewed viewed;
  viewed.session = std::move(*session);
  Result<Product> product =
      find_product(material::kRectifiedProduct, viewed.session.folder / "rectified", id);
  const bool is_set = !product;
  if (is_set) product = find_product(material::kMapsProduct, map_sets_of(viewed.session), id);
  Result<Json> document = finished(product, "there is no such set of maps", id);
  if (!document) return std::move(document).error();
  if (!is_set) return rectified_maps(std::move(viewed), *product, std::move(*document));
  const Result<material::MapSetFacts> facts =
      read_fields<material::MapSetFacts>(*document, material::kMapsProduct.document);
  if (!facts) return facts.error();
  viewed.mm_per_pixel = facts->mm_per_pixel;
  viewed.folder = product->folder;
  viewed.id = product->id;
  viewed.content = "maps-" + product->id;
  viewed.document = product->kind.document;
  viewed.set = std::move(*document);
  viewed.solve = solve_facts_of(viewed.session, facts->source.solve);
  if (Result<void> ok = add_layers(viewed); !ok) return std::move(ok).error();
  return viewed;
}

Result<Viewed> find_built_maps(const RigParts&, const std::string& material, const std::string& id) {
  const Result<Product> product = find_build(material, id);
  Result<Json> document = finished(product, "there is no such build", id);
  if (!document) return std::move(document).error();
  JsonFields fields(*document, material::kMaterialProduct.document);
  Viewed viewed;
  viewed.mm_per_pixel = fields.optional_number("mm_per_pixel").value_or(0);
  const Size size = {fields.integer("width"), fields.integer("height")};
  if (Result<void> ok = fields.status(); !ok) return std::move(ok).error();
  viewed.folder = product->folder;
  viewed.id = product->id;
  viewed.content = "material-" + product->id;
  viewed.document = product->kind.document;
  viewed.set = std::move(*document);
  viewed.is_build = true;
  if (Result<void> ok = add_layers(viewed); !ok && ok.error().kind != ErrorKind::kNoInput)
    return std::move(ok).error();
  if (viewed.layers.all.empty()) viewed.layers.size = size;
  return viewed;
}

Result<std::shared_ptr<Pyramid>> pyramid_of(const RigParts& parts, const Viewed& viewed,
                                            const std::string& name) {
  const Layer* layer = viewed.layers.find(name);
  if (layer == nullptr) return no_such_tile(name.substr(0, 40), "these maps have no such layer");
  return parts.views.layer(viewed.folder, viewed.content, *layer);
}

bool has_relative_albedo(const Viewed& viewed) {
  if (viewed.solve) return viewed.solve->albedo_scale == AlbedoScale::kRelative;
  return viewed.set && !viewed.is_build;
}

Result<double> gain_of(const RigParts& parts, const Viewed& viewed) {
  if (!has_relative_albedo(viewed)) return 1.0;
  const Result<std::shared_ptr<Pyramid>> albedo = pyramid_of(parts, viewed, "albedo");
  if (!albedo) return albedo.error();
  const int top = (*albedo)->top();
  const Result<Image<float>> whole = (*albedo)->read(top, *(*albedo)->tile(top, 0, 0));
  if (!whole) return whole.error();
  return report::display_scale(*whole);
}

Ground Lying::ground(const Viewed& viewed) const {
  if (!calibration) return {.mm_per_pixel = viewed.mm_per_pixel};
  const int each = std::max(1, calibration->camera->size.width / std::max(1, viewed.layers.size.width));
  return {.calibration = &*calibration, .pixels_each = each, .height_mm = viewed.session.cloth_height_mm};
}

Result<Lying> lying_of(const Viewed& viewed) {
  if (viewed.set || !viewed.session.is_of_rig()) return Lying{};
  Result<Calibration> calibration = read_calibration(viewed.session.calibration_folder());
  if (!calibration) return std::move(calibration).error();
  if (calibration->camera) {
    const Session& session = viewed.session;
    calibration->camera = seen_from(session.pose, session.cloth_height_mm, *calibration->camera);
    return Lying{std::move(*calibration)};
  }
  return Error{ErrorKind::kBadData, "nothing is known of millimetres", viewed.session.folder.string(),
               "its calibration has no camera", "calibrate the camera with weft calibrate camera"};
}

Json names_in(const Json& document, const char* key) {
  Json names = Json::array();
  const auto list = document.find(key);
  if (list == document.end()) return names;
  for (const Json& each : *list) {
    if (each.is_object() && each.contains("name") && each["name"].is_string()) names.push_back(each["name"]);
  }
  return names;
}

fs::path map_sets_of(const Session& session) {
  return session.folder / "maps";
}

std::string written_at(const fs::path& document) {
  std::error_code ignored;
  const auto written = fs::last_write_time(document, ignored);
  const auto since_1970 = std::chrono::file_clock::to_sys(written).time_since_epoch();
  return iso_time(std::chrono::duration<double>(since_1970).count());
}

Result<Json> viewed_json(const RigParts& parts, const Viewed& viewed) {
  const Size size = viewed.layers.size;
  const Result<double> gain = gain_of(parts, viewed);
  if (!gain) return gain.error();
  const Result<Rect> swatch = swatch_part_of(parts, viewed);
  if (!swatch) return swatch.error();
  Json document = common_json(viewed);
  document["tile"] = kTileSide;
  document["levels"] = levels_of(size);
  document["layers"] = layers_json(viewed.layers);
  document["display_gain"] = *gain;
  document["leds"] = leds_of(viewed);
  const double mm_per_pixel = mm_per_pixel_of(viewed);
  document["mm_per_pixel"] = mm_per_pixel > 0 ? Json(mm_per_pixel) : Json();
  document["stale"] = stale_of(viewed);
  document["cloth_height_mm"] = viewed.session.cloth_height_mm;
  document["swatch"] = {{"x", swatch->x0}, {"y", swatch->y0}, {"side", swatch->width()}};
  if (viewed.set) document["set"] = *viewed.set;
  return document;
}

}  // namespace weft::app
