// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/server/api/routes/tile_query.h"
#include "app/server/api/routes/viewed.h"
#include "app/server/view/tile_picture.h"
#include "material/read/compare.h"

namespace weft::app {
namespace {

constexpr const char* kRelit = "relit";

// A layer that two solves have together.
struct Difference {
  const char* name;
  const char* of;  // the layer of each
  Image<float> (*between)(const Image<float>& one, const Image<float>& other);
};
constexpr std::array<Difference, 2> kDifferences = {
    {{"difference", "normal", turned_deg}, {"albedo_difference", "albedo", off_percent}}};

OpenLayer opener_of(const RigParts& parts, const Viewed& viewed) {
  return [&](const Layer& layer) { return parts.views.layer(viewed.folder, viewed.content, layer); };
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
    const int number = level_of(level, pyramid.top());
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
                               const Asked& asked, const Call& call, FindMaps find) {
  const auto with = call.query.find("with");
  if (with == call.query.end()) return no_such_tile("with", "must name another solve");
  const std::size_t slash = with->second.find('/');
  const bool is_elsewhere = slash != std::string::npos;
  const Result<Viewed> other = find(parts, is_elsewhere ? with->second.substr(0, slash) : call.segments.at(0),
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

Result<std::string> tile_bytes(const RigParts& parts, const Viewed& viewed, const Call& call, FindMaps find) {
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
  if (wanted != kDifferences.end()) return difference(*wanted, parts, viewed, asked, call, find);
  const Result<std::shared_ptr<Pyramid>> pyramid = pyramid_of(parts, viewed, layer);
  if (!pyramid) return pyramid.error();
  const Result<Image<float>> planes = asked.read(**pyramid);
  if (!planes) return planes.error();
  return asked.encode((*pyramid)->layer().kind, *planes);
}

Result<Reply> tile(const RigParts& parts, const Viewed& viewed, const Call& call, FindMaps find) {
  Result<std::string> bytes = tile_bytes(parts, viewed, call, find);
  if (!bytes) return std::move(bytes).error();
  Reply reply = {200, tile_name_of(call.segments.at(4))->type(), std::move(*bytes)};
  if (viewed.id != kTruth) reply.keeping = Keeping::kForever;
  return reply;
}

/// The cloth as the library shows it.
Result<Reply> swatch(const RigParts& parts, const Viewed& viewed, const Call&) {
  const auto draw = [&]() -> Result<Image<float>> {
    const Result<Rect> part = swatch_part_of(parts, viewed);
    if (!part) return part.error();
    const Result<std::shared_ptr<Pyramid>> normal = pyramid_of(parts, viewed, "normal");
    if (!normal) return normal.error();
    const Result<std::shared_ptr<Pyramid>> albedo = pyramid_of(parts, viewed, "albedo");
    if (!albedo) return albedo.error();
    return swatch_picture(**normal, **albedo, *part, has_relative_albedo(viewed));
  };
  Result<std::string> bytes = parts.swatches.find_or(viewed.content, draw);
  if (!bytes) return std::move(bytes).error();
  Reply reply = {200, "image/jpeg", std::move(*bytes)};
  if (viewed.id != kTruth) reply.keeping = Keeping::kForever;
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

Result<Reply> pixel(const RigParts& parts, const Viewed& viewed, const Call& call) {
  const Result<Rect> at = pixel_in(call, viewed.layers.size);
  if (!at) return at.error();
  Json document = {{"x", at->x0}, {"y", at->y0}, {"maps", Json::object()}, {"readings", nullptr}};
  for (const Layer& layer : viewed.layers.all) {
    const Result<std::shared_ptr<Pyramid>> pyramid = pyramid_of(parts, viewed, layer.name);
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
  if (viewed.set) return json_reply(document);
  if (const Result<Lying> lying = lying_of(viewed)) {
    const Vec3 place = place_on(lying->ground(viewed), at->x0, at->y0);
    document["table_mm"] = {place.x, place.y, place.z};
  }
  if (!viewed.is_solve()) return json_reply(document);
  const Result<std::optional<Json>> readings =
      parts.pixels.at(viewed.session.folder, *viewed.solve, at->x0, at->y0);
  if (!readings) return readings.error();
  if (*readings) document["readings"] = **readings;
  return json_reply(document, *readings ? 200 : kAccepted);
}

Result<Reply> region(const RigParts& parts, const Viewed& viewed, const Call& call) {
  const Size size = viewed.layers.size;
  const Result<Rect> at = pixel_in(call, size);
  if (!at) return at.error();
  const Result<int> w = whole_number_of(call, "w", 1, size.width - at->x0);
  if (!w) return w.error();
  const Result<int> h = whole_number_of(call, "h", 1, size.height - at->y0);
  if (!h) return h.error();
  Result<Json> facts =
      region_facts(viewed.layers, opener_of(parts, viewed), {at->x0, at->y0, at->x0 + *w, at->y0 + *h});
  if (!facts) return std::move(facts).error();
  return json_reply(*facts);
}

Result<Reply> line(const RigParts& parts, const Viewed& viewed, const Call& call) {
  const Size size = viewed.layers.size;
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
  const Result<Lying> lying = lying_of(viewed);
  if (!lying) return lying.error();
  Result<Json> facts = line_facts(viewed.layers, opener_of(parts, viewed), asked, lying->ground(viewed));
  if (!facts) return std::move(facts).error();
  return json_reply(*facts);
}

}  // namespace

std::vector<Route> view_routes(const RigParts& parts, const std::string& one, FindMaps find) {
  const auto asked = [&parts, &one, find](const char* what, auto answer) {
    const auto handle = [&parts, find, answer](const Call& call) -> Result<Reply> {
      const Result<Viewed> viewed = find(parts, call.segments.at(0), call.segments.at(1));
      if (!viewed) return viewed.error();
      return answer(parts, *viewed, call);
    };
    return Route{"GET", one + what, handle, false, Pool::kTiles};
  };
  const auto cut = [find](const RigParts& all, const Viewed& viewed, const Call& call) {
    return tile(all, viewed, call, find);
  };
  return {asked("/tiles/{layer}/{level}/{tile}", cut), asked("/swatch.jpg", swatch), asked("/pixel", pixel),
          asked("/region", region), asked("/line", line)};
}

}  // namespace weft::app
