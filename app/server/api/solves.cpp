// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <variant>

#include "app/jobs/compare.h"
#include "app/jobs/view/layers.h"
#include "app/jobs/view/probes.h"
#include "app/jobs/view/tile_picture.h"
#include "app/server/api/api.h"
#include "app/server/api/descriptions.h"
#include "app/server/api/tile_query.h"
#include "core/calibration.h"
#include "core/files.h"
#include "core/iso_time.h"
#include "core/lights.h"
#include "core/solve.h"
#include "library/session_files.h"
#include "report/preview.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTruth = "truth";  // stands for a solve where the session is simulated
constexpr const char* kRelit = "relit";

/// A layer that two solves have together.
struct Difference {
  const char* name;
  const char* of;  // the layer of each
  Image<float> (*between)(const Image<float>& one, const Image<float>& other);
};
constexpr std::array<Difference, 2> kDifferences = {
    {{"difference", "normal", turned_deg}, {"albedo_difference", "albedo", off_percent}}};

/// The maps that a call asks about.
struct Viewed {
  Session session;
  fs::path folder;
  std::string content;              // names their bytes
  std::optional<SolveFacts> solve;  // none: the truth
  Layers layers;
};

Result<Viewed> viewed_of(const RigParts& parts, const std::string& name, const std::string& id) {
  Result<Session> session = parts.library.session(name);
  if (!session) return std::move(session).error();
  Viewed viewed;
  viewed.session = std::move(*session);
  if (id == kTruth) {
    viewed.folder = viewed.session.folder / kTruth;
    std::error_code error;
    const auto written = fs::last_write_time(viewed.folder / "normal.exr", error);
    viewed.content = "truth-" + sha256_of(fmt::format("{} {}", viewed.folder.string(),
                                                      written.time_since_epoch().count()));
  } else {
    const Result<Product> product = find_solve(viewed.session.folder, id);
    if (!product) {
      return Error{ErrorKind::kNoInput, "there is no such solve", id.substr(0, 40), product.error().what,
                   "see GET sessions/{name}/solves"};
    }
    const Result<std::optional<Json>> document = find_finished(*product);
    if (!document) return document.error();
    if (!*document) return Error{ErrorKind::kNoInput, "there is no such solve", id.substr(0, 40), "", ""};
    Result<SolveFacts> facts = solve_facts_from_json(**document);
    if (!facts) return std::move(facts).error();
    viewed.folder = product->folder;
    viewed.content = product->id;
    viewed.solve = std::move(*facts);
  }
  Result<Layers> layers = layers_of(viewed.folder);
  if (!layers) return std::move(layers).error();
  viewed.layers = std::move(*layers);
  return viewed;
}

Result<Viewed> viewed_of(const RigParts& parts, const Call& call) {
  return viewed_of(parts, call.segments.at(0), call.segments.at(1));
}

Result<std::shared_ptr<Pyramid>> pyramid_of(const RigParts& parts, const Viewed& viewed,
                                            const std::string& name) {
  const Layer* layer = viewed.layers.find(name);
  if (layer == nullptr) return no_such_tile(name.substr(0, 40), "these maps have no such layer");
  return parts.views.layer(viewed.folder, viewed.content, *layer);
}

OpenLayer opener_of(const RigParts& parts, const Viewed& viewed) {
  return [&](const Layer& layer) { return parts.views.layer(viewed.folder, viewed.content, layer); };
}

/// What an albedo of relative scale is multiplied by to be looked at.
Result<double> gain_of(const RigParts& parts, const Viewed& viewed) {
  if (!viewed.solve || viewed.solve->albedo_scale == AlbedoScale::kAbsolute) return 1.0;
  const Result<std::shared_ptr<Pyramid>> albedo = pyramid_of(parts, viewed, "albedo");
  if (!albedo) return albedo.error();
  const int top = (*albedo)->levels() - 1;
  const Result<Image<float>> whole = (*albedo)->read(top, *(*albedo)->tile(top, 0, 0));
  if (!whole) return whole.error();
  return report::display_scale(*whole);
}

/// How the maps lie on the cloth; none where nobody calibrated the camera.
struct Calibrated {
  Calibration calibration;
  Ground ground(const Viewed& viewed) const {
    const int each = std::max(1, calibration.camera->size.width / std::max(1, viewed.layers.size.width));
    return {calibration, each, viewed.session.cloth_height_mm};
  }
};
Result<Calibrated> calibration_of(const Viewed& viewed) {
  Result<Calibration> calibration = read_calibration(viewed.session.calibration_folder());
  if (!calibration) return std::move(calibration).error();
  if (calibration->camera) return Calibrated{std::move(*calibration)};
  return Error{ErrorKind::kBadData, "nothing is known of millimetres", viewed.session.folder.string(),
               "its calibration has no camera", "calibrate the camera with weft calibrate camera"};
}

/// Maps carry no dates: when their document was written.
std::string created(const fs::path& folder) {
  std::error_code ignored;
  const auto written = fs::last_write_time(folder / kSolveProduct.document, ignored);
  const auto since_1970 = std::chrono::file_clock::to_sys(written).time_since_epoch();
  return iso_time(std::chrono::duration<double>(since_1970).count());
}

/// Where the LEDs are that the session was scanned with; empty where nobody knows.
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

Json summary_of(const SolveFacts& solve, const fs::path& folder) {
  Json warnings = Json::array();
  for (const Verdict& verdict : solve.warnings) warnings.push_back(verdict.name);
  return {{"id", solve.id},
          {"created", created(folder)},
          {"bytes", library::bytes_below(folder)},
          {"method", solve.method},
          {"width", solve.size.width},
          {"height", solve.size.height},
          {"albedo_scale", solve.albedo_scale == AlbedoScale::kAbsolute ? "absolute" : "relative"},
          {"warnings", std::move(warnings)}};
}

Result<Reply> solves(const RigParts& parts, const Call& call) {
  const Result<Session> session = parts.library.session(call.segments.at(0));
  if (!session) return session.error();
  Json list = Json::array();
  for (const Product& product : list_solves(session->folder)) {
    const Result<std::optional<Json>> document = find_finished(product);
    if (!document || !*document) continue;
    const Result<SolveFacts> facts = solve_facts_from_json(**document);
    if (facts) list.push_back(summary_of(*facts, product.folder));
  }
  std::ranges::reverse(list);
  return json_reply(
      {{"solves", std::move(list)}, {"truth", is_there(session->folder / kTruth / "normal.exr")}});
}

Result<Reply> one_solve(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = viewed_of(parts, call);
  if (!viewed) return viewed.error();
  const Size size = viewed->layers.size;
  Json layers = Json::array();
  int levels = 1;
  for (int side = std::max(size.width, size.height); side > kTileSide; side = (side + 1) / 2) ++levels;
  for (const Layer& layer : viewed->layers.all) {
    Json bits = Json::array();
    for (const StatusName& bit : kStatusNames) {
      if (layer.kind == LayerKind::kFlags) bits.push_back(bit.name);
    }
    layers.push_back({{"name", layer.name},
                      {"kind", name_of(layer.kind)},
                      {"unit", layer.unit},
                      {"bits", std::move(bits)}});
  }
  Json document =
      viewed->solve
          ? summary_of(*viewed->solve, viewed->folder)
          : Json{{"id", kTruth},          {"method", kTruth},           {"width", size.width},
                 {"height", size.height}, {"albedo_scale", "absolute"}, {"warnings", Json::array()}};
  document["tile"] = kTileSide;
  document["levels"] = levels;
  document["layers"] = std::move(layers);
  const Result<double> gain = gain_of(parts, *viewed);
  if (!gain) return gain.error();
  document["display_gain"] = *gain;
  document["leds"] = leds_of(*viewed);
  document["mm_per_pixel"] = nullptr;
  document["cloth_height_mm"] = viewed->session.cloth_height_mm;
  if (const Result<Calibrated> calibrated = calibration_of(*viewed)) {
    const Ground ground = calibrated->ground(*viewed);
    const double x = 0.5 * size.width * ground.pixels_each, y = 0.5 * size.height * ground.pixels_each;
    const CameraModel& camera = *ground.calibration.camera;
    const Vec3 a = point_on_plane(camera, x, y, ground.height_mm);
    const Vec3 b = point_on_plane(camera, x + ground.pixels_each, y, ground.height_mm);
    document["mm_per_pixel"] = std::hypot(b.x - a.x, b.y - a.y);
  }
  return json_reply(document);
}

/// What the solver said of the scan and of itself: report.json, and what `reference` did.
Result<Reply> report_of_solve(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = viewed_of(parts, call);
  if (!viewed) return viewed.error();
  if (!viewed->solve) return Error{ErrorKind::kNoInput, "a truth has no report", kTruth, "", "name a solve"};
  Result<Json> report = read_json(viewed->folder / "report.json", "weft.solve-report", 1);
  if (!report) return std::move(report).error();
  (*report)["reference"] = viewed->solve->reference;
  (*report)["solved_by"] = viewed->solve->solved_by;
  return json_reply(*report);
}

/// The number of the bit that the query names; -1 where it names none.
Result<int> bit_of(const Call& call) {
  const auto wanted = call.query.find("bit");
  if (wanted == call.query.end()) return -1;
  for (std::size_t i = 0; i < kStatusNames.size(); ++i) {
    if (wanted->second == kStatusNames[i].name) return static_cast<int>(i);
  }
  return no_such_tile("bit", "no status is called so");
}

/// A call for one tile, read.
struct Asked {
  TileName name;
  std::string level;
  Look look;
  int bit = -1;

  Result<Image<float>> read(Pyramid& pyramid) const {
    const int number = level_of(level, pyramid.levels());
    const std::optional<Rect> part = pyramid.tile(number, name.column, name.row);
    if (!part)
      return no_such_tile(fmt::format("{}/{}_{}", level, name.column, name.row), "it is beyond the map");
    return pyramid.read(number, *part, bit);
  }
  Result<std::string> encode(LayerKind kind, const Image<float>& planes) const {
    if (name.form == TileName::Form::kRaw) return raw_tile(kind, planes);
    return picture_tile(kind, planes, look, name.picture());
  }
};

Result<std::string> relit(const RigParts& parts, const Viewed& viewed, const Asked& asked) {
  if (asked.name.form == TileName::Form::kRaw) return no_such_tile(kRelit, "it is a picture: .jpg or .png");
  const Result<std::shared_ptr<Pyramid>> normal = pyramid_of(parts, viewed, "normal");
  if (!normal) return normal.error();
  const Result<std::shared_ptr<Pyramid>> albedo = pyramid_of(parts, viewed, "albedo");
  if (!albedo) return albedo.error();
  const Result<Image<float>> n = asked.read(**normal), rho = asked.read(**albedo);
  if (!n) return n.error();
  if (!rho) return rho.error();
  return relit_tile(*n, *rho, asked.look, asked.name.picture());
}

Result<std::string> difference(const Difference& wanted, const RigParts& parts, const Viewed& viewed,
                               const Asked& asked, const Call& call) {
  const auto with = call.query.find("with");
  if (with == call.query.end()) return no_such_tile("with", "must name another solve");
  const std::size_t slash = with->second.find('/');
  const bool is_elsewhere = slash != std::string::npos;
  const Result<Viewed> other =
      viewed_of(parts, is_elsewhere ? with->second.substr(0, slash) : call.segments.at(0),
                with->second.substr(is_elsewhere ? slash + 1 : 0));
  if (!other) return other.error();
  if (!(other->layers.size == viewed.layers.size))
    return no_such_tile(with->second.substr(0, 40), "these maps have another size");
  const Result<std::shared_ptr<Pyramid>> a = pyramid_of(parts, viewed, wanted.of);
  if (!a) return a.error();
  const Result<std::shared_ptr<Pyramid>> b = pyramid_of(parts, *other, wanted.of);
  if (!b) return b.error();
  const Result<Image<float>> n = asked.read(**a), m = asked.read(**b);
  if (!n) return n.error();
  if (!m) return m.error();
  return asked.encode(LayerKind::kScalar, wanted.between(*n, *m));
}

Result<std::string> tile_bytes(const RigParts& parts, const Viewed& viewed, const Call& call) {
  const std::string& layer = call.segments.at(2);
  Asked asked;
  asked.level = call.segments.at(3);
  const Result<TileName> name = tile_name_of(call.segments.at(4));
  if (!name) return name.error();
  asked.name = *name;
  const Result<int> bit = bit_of(call);
  if (!bit) return bit.error();
  asked.bit = *bit;
  const bool is_shown = asked.name.form != TileName::Form::kRaw && (layer == "albedo" || layer == kRelit);
  const Result<double> gain = is_shown ? gain_of(parts, viewed) : Result<double>(1.0);
  if (!gain) return gain.error();
  const Result<Look> look = look_of(call, *gain);
  if (!look) return look.error();
  asked.look = *look;
  if (layer == kRelit) return relit(parts, viewed, asked);
  const auto wanted = std::ranges::find(kDifferences, layer, &Difference::name);
  if (wanted != kDifferences.end()) return difference(*wanted, parts, viewed, asked, call);
  const Result<std::shared_ptr<Pyramid>> pyramid = pyramid_of(parts, viewed, layer);
  if (!pyramid) return pyramid.error();
  const Result<Image<float>> planes = asked.read(**pyramid);
  if (!planes) return planes.error();
  return asked.encode((*pyramid)->layer().kind, *planes);
}

Result<Reply> tile(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = viewed_of(parts, call);
  if (!viewed) return viewed.error();
  Result<std::string> bytes = tile_bytes(parts, *viewed, call);
  if (!bytes) return std::move(bytes).error();
  Reply reply = {200, tile_name_of(call.segments.at(4))->type(), std::move(*bytes)};
  if (viewed->solve) reply.keeping = Keeping::kForever;
  return reply;
}

/// The pixel that x and y of the query name.
Result<Rect> pixel_in(const Call& call, Size size) {
  const Result<int> x = whole_number_of(call, "x", 0, size.width - 1);
  if (!x) return x.error();
  const Result<int> y = whole_number_of(call, "y", 0, size.height - 1);
  if (!y) return y.error();
  return Rect{*x, *y, *x + 1, *y + 1};
}

Result<Reply> pixel(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = viewed_of(parts, call);
  if (!viewed) return viewed.error();
  const Result<Rect> at = pixel_in(call, viewed->layers.size);
  if (!at) return at.error();
  Json document = {{"x", at->x0}, {"y", at->y0}, {"maps", Json::object()}, {"readings", nullptr}};
  for (const Layer& layer : viewed->layers.all) {
    const Result<std::shared_ptr<Pyramid>> pyramid = pyramid_of(parts, *viewed, layer.name);
    if (!pyramid) return pyramid.error();
    Json values = Json::array();
    if (layer.kind == LayerKind::kFlags) {
      for (std::size_t bit = 0; bit < kStatusNames.size(); ++bit) {
        const Result<Image<float>> flag = (*pyramid)->read(0, *at, static_cast<int>(bit));
        if (!flag) return flag.error();
        if ((*flag)(0, 0) > 0) values.push_back(kStatusNames[bit].name);
      }
    } else {
      const Result<Image<float>> planes = (*pyramid)->read(0, *at);
      if (!planes) return planes.error();
      for (int p = 0; p < planes->planes(); ++p) values.push_back((*planes)(0, 0, p));
    }
    document["maps"][layer.name] = std::move(values);
  }
  if (const Result<Calibrated> calibrated = calibration_of(*viewed)) {
    const Ground ground = calibrated->ground(*viewed);
    const double each = ground.pixels_each, middle = (each - 1) / 2;
    const Vec3 place = point_on_plane(*ground.calibration.camera, each * at->x0 + middle,
                                      each * at->y0 + middle, ground.height_mm);
    document["table_mm"] = {place.x, place.y, place.z};
  }
  if (!viewed->solve) return json_reply(document);
  const Result<std::optional<Json>> readings =
      parts.pixels.at(viewed->session.folder, *viewed->solve, at->x0, at->y0);
  if (!readings) return readings.error();
  if (*readings) document["readings"] = **readings;
  return json_reply(document, *readings ? 200 : kAccepted);
}

Result<Reply> region(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = viewed_of(parts, call);
  if (!viewed) return viewed.error();
  const Size size = viewed->layers.size;
  const Result<Rect> at = pixel_in(call, size);
  if (!at) return at.error();
  const Result<int> w = whole_number_of(call, "w", 1, size.width - at->x0);
  if (!w) return w.error();
  const Result<int> h = whole_number_of(call, "h", 1, size.height - at->y0);
  if (!h) return h.error();
  Result<Json> facts =
      region_facts(viewed->layers, opener_of(parts, *viewed), {at->x0, at->y0, at->x0 + *w, at->y0 + *h});
  if (!facts) return std::move(facts).error();
  return json_reply(*facts);
}

Result<Reply> line(const RigParts& parts, const Call& call) {
  const Result<Viewed> viewed = viewed_of(parts, call);
  if (!viewed) return viewed.error();
  const Size size = viewed->layers.size;
  Line asked;
  const std::array<std::pair<const char*, double*>, 4> ends = {
      {{"x0", &asked.x0}, {"y0", &asked.y0}, {"x1", &asked.x1}, {"y1", &asked.y1}}};
  for (const auto& [key, value] : ends) {
    const double most = key[0] == 'x' ? size.width - 1 : size.height - 1;
    const Result<double> number = number_of(call, key, 0, most, -1);
    if (!number) return number.error();
    if (*number < 0)
      return Error{ErrorKind::kUsage, "what is asked of the maps cannot be read", key, "must be there",
                   "see openapi.json"};
    *value = *number;
  }
  const Result<Calibrated> calibrated = calibration_of(*viewed);
  if (!calibrated) return calibrated.error();
  Result<Json> facts =
      line_facts(viewed->layers, opener_of(parts, *viewed), asked, calibrated->ground(*viewed));
  if (!facts) return std::move(facts).error();
  return json_reply(*facts);
}

/// a and b are NAME/ID.
Result<Reply> compare(const RigParts& parts, const Call& call) {
  std::array<Viewed, 2> both;
  const std::array<const char*, 2> keys = {"a", "b"};
  for (std::size_t i = 0; i < both.size(); ++i) {
    const auto text = call.query.find(keys[i]);
    const std::size_t slash = text == call.query.end() ? std::string::npos : text->second.find('/');
    if (slash == std::string::npos)
      return Error{ErrorKind::kUsage, "what is asked of the maps cannot be read", keys[i],
                   "must be SESSION/SOLVE", "see openapi.json"};
    Result<Viewed> viewed = viewed_of(parts, text->second.substr(0, slash), text->second.substr(slash + 1));
    if (!viewed) return std::move(viewed).error();
    both[i] = std::move(*viewed);
  }
  const auto file = [&](std::size_t i, const char* name) { return both[i].folder / name; };
  const Result<NormalComparison> normal = compare_normals(file(0, "normal.exr"), file(1, "normal.exr"), {});
  if (!normal) return normal.error();
  const Result<AlbedoComparison> albedo = compare_albedo(file(0, "albedo.exr"), file(1, "albedo.exr"), {});
  if (!albedo) return albedo.error();
  return json_reply(
      {{"normal",
        {{"pixels", normal->pixels},
         {"mean_deg", normal->mean_deg},
         {"median_deg", normal->median_deg},
         {"p95_deg", normal->p95_deg},
         {"max_deg", normal->max_deg}}},
       {"albedo",
        {{"pixels", albedo->pixels}, {"mean_rel", albedo->mean_rel}, {"bias_rel", albedo->bias_rel}}}});
}

}  // namespace

Resource solves_resource(const RigParts& parts) {
  const std::string of = "/api/v1/sessions/{name}/solves";
  const std::string one = of + "/{solve}";
  return {
      {{"GET", of, [&parts](const Call& call) { return solves(parts, call); }},
       {"GET", one, [&parts](const Call& call) { return one_solve(parts, call); }},
       {"GET", one + "/report", [&parts](const Call& call) { return report_of_solve(parts, call); }},
       {"GET", one + "/tiles/{layer}/{level}/{tile}",
        [&parts](const Call& call) { return tile(parts, call); }, false, Pool::kTiles},
       {"GET", one + "/pixel", [&parts](const Call& call) { return pixel(parts, call); }, false,
        Pool::kTiles},
       {"GET", one + "/region", [&parts](const Call& call) { return region(parts, call); }, false,
        Pool::kTiles},
       {"GET", one + "/line", [&parts](const Call& call) { return line(parts, call); }, false, Pool::kTiles},
       {"GET", "/api/v1/compare", [&parts](const Call& call) { return compare(parts, call); }, false,
        Pool::kTiles}},
      solves_description()};
}

}  // namespace weft::app
