// SPDX-License-Identifier: Apache-2.0
#include "app/server/api/routes/tile_query.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace weft::app {
namespace {

constexpr double kMostStops = 20;
constexpr double kLargest = 1e9;

template <typename Number>
std::optional<Number> number_in(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

Error bad_query(const std::string& key, const std::string& rule) {
  return {ErrorKind::kUsage, "what is asked of the maps cannot be read", key, rule, "see openapi.json"};
}

Result<Vec3> direction_of(const std::string& text) {
  std::array<double, 3> xyz = {};
  std::string_view rest = text;
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const std::size_t comma = i < 2 ? rest.find(',') : rest.size();
    const std::optional<double> number =
        comma == std::string_view::npos ? std::nullopt : number_in<double>(rest.substr(0, comma));
    if (!number || !std::isfinite(*number) || std::abs(*number) > kLargest)
      return bad_query("light", "must be three numbers, x,y,z, towards the light");
    xyz[i] = *number;
    if (i < 2) rest.remove_prefix(comma + 1);
  }
  const double length = std::hypot(xyz[0], xyz[1], xyz[2]);
  if (!(length > 0)) return bad_query("light", "must not be 0,0,0");
  return Vec3{xyz[0] / length, xyz[1] / length, xyz[2] / length};
}

}  // namespace

const char* TileName::type() const {
  switch (form) {
    case Form::kRaw:
      return "application/octet-stream";
    case Form::kPng:
      return "image/png";
    case Form::kJpeg:
      return "image/jpeg";
  }
  return "";
}

Error no_such_tile(const std::string& where, const std::string& why) {
  return {ErrorKind::kNoInput, "there is no such tile", where, why,
          "see the solve for its layers and levels"};
}

Result<TileName> tile_name_of(const std::string& segment) {
  const std::size_t line = segment.find('_'), dot = segment.find('.');
  const Error none = no_such_tile(segment.substr(0, 40), "its name is COLUMN_ROW.raw, .png or .jpg");
  if (line == std::string::npos || dot == std::string::npos || dot < line) return none;
  const std::string_view text = segment;
  const std::optional<int> column = number_in<int>(text.substr(0, line));
  const std::optional<int> row = number_in<int>(text.substr(line + 1, dot - line - 1));
  if (!column || !row) return none;
  const std::string_view ending = text.substr(dot);
  if (ending == ".raw") return TileName{*column, *row, TileName::Form::kRaw};
  if (ending == ".png") return TileName{*column, *row, TileName::Form::kPng};
  if (ending == ".jpg") return TileName{*column, *row, TileName::Form::kJpeg};
  return none;
}

int level_of(const std::string& segment, int top) {
  if (segment == "top") return top;
  return number_in<int>(segment).value_or(-1);
}

Result<double> number_of(const Call& call, const char* key, double least, double most, double otherwise) {
  const auto text = call.query.find(key);
  if (text == call.query.end()) return otherwise;
  const std::optional<double> number = number_in<double>(text->second);
  if (number && *number >= least && *number <= most) return *number;
  return bad_query(key, fmt::format("must be from {:g} to {:g}", least, most));
}

Result<int> whole_number_of(const Call& call, const char* key, int least, int most) {
  const auto text = call.query.find(key);
  const std::optional<int> number = text == call.query.end() ? std::nullopt : number_in<int>(text->second);
  if (number && *number >= least && *number <= most) return *number;
  return bad_query(key, fmt::format("must be a whole number from {} to {}", least, most));
}

Result<Look> look_of(const Call& call, double gain) {
  Look look;
  const Result<double> stops = number_of(call, "exposure", -kMostStops, kMostStops, 0);
  if (!stops) return stops.error();
  const Result<double> least = number_of(call, "least", -kLargest, kLargest, 0);
  if (!least) return least.error();
  const Result<double> most = number_of(call, "most", -kLargest, kLargest, 1);
  if (!most) return most.error();
  if (!(*most > *least)) return bad_query("most", "must be above least");
  look.gain = gain * std::exp2(*stops);
  look.least = *least;
  look.most = *most;
  if (const auto light = call.query.find("light"); light != call.query.end()) {
    const Result<Vec3> direction = direction_of(light->second);
    if (!direction) return direction.error();
    look.light = *direction;
  }
  return look;
}

}  // namespace weft::app
