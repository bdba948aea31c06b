// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "bench/numerics/numerics.h"
#include "bench/oracles/quad_oracle.h"
#include "core/base/files.h"
#include "core/image_io/image_io.h"
#include "core/rig/light_field.h"
#include "core/solve/solve_record.h"
#include "report/drawing.h"
#include "report/preview.h"
#include "simulator/simulate.h"
#include "simulator/simulation_plan.h"
#include "solver/method.h"
#include "torture/plain_formula.h"

namespace weft::bench {
namespace {

namespace fs = std::filesystem;
using report::Colour;
using report::Picture;

constexpr const char* kPage = "measured/numerics.md";
constexpr int kZoom = 2, kTextScale = 2, kGap = 8;
constexpr Colour kWhite = {1, 1, 1}, kUnsolvedGrey = {0.45f, 0.45f, 0.45f};

/// What a pixel shows: a colour, or stripes where it has no place on the scale of colours.
struct Paint {
  Colour colour;
  bool striped = false;

  Colour at(int x, int y) const { return striped && (x + y) / 4 % 2 == 0 ? kWhite : colour; }
};
constexpr Paint kNoNumber = {kUnsolvedGrey, true};

/// A number on a scale of colours from `low` to `high` (log10).
Paint paint_of(double log10_value, double low, double high) {
  return {report::heat_colour((log10_value - low) / (high - low))};
}

Paint paint_of_error(double error_deg) {
  return std::isnan(error_deg) ? kNoNumber : paint_of(std::log10(std::max(error_deg, 1e-9)), -6, 2);
}

Paint paint_of_status(int status) {
  static constexpr std::array<std::pair<int, Colour>, 7> kColours = {
      {{kDark, {0.15f, 0.15f, 0.15f}},
       {kNoSolution | kSaturated, {0.75f, 0.1f, 0.1f}},
       {kNoSolution | kInvalidReading, {0.15f, 0.25f, 0.6f}},
       {kIllConditioned, {0.95f, 0.1f, 0.85f}},
       {kNoSolution, {0.45f, 0.45f, 0.45f}},
       {kSaturated, {0.98f, 0.7f, 0.6f}},
       {kInvalidReading, {0.65f, 0.78f, 0.98f}}}};
  for (const auto& [bits, colour] : kColours) {
    if ((status & bits) == bits) return {colour};
  }
  return {kWhite};
}

/// A scene's pixels, solved and judged.
struct Judged {
  Size size;
  std::vector<double> condition, plain_deg, ours_deg;  ///< NaN where there is none
  std::vector<int> status;

  explicit Judged(Size s)
      : size(s),
        condition(static_cast<std::size_t>(s.pixels()), NAN),
        plain_deg(condition),
        ours_deg(condition),
        status(condition.size()) {}
};

Result<Judged> judge(const fs::path& scene_file) {
  const Result<simulator::Scene> scene = simulator::read_scene(scene_file);
  if (!scene) return scene.error();
  const Result<simulator::SimulationPlan> plan = simulator::plan_of(*scene);
  if (!plan) return plan.error();
  const Rect frame = {0, 0, scene->camera.width, scene->camera.height};
  const Result<simulator::Rendering> rendering = simulator::render_readings(*scene, frame);
  if (!rendering) return rendering.error();
  const Size size = {frame.x1, frame.y1};
  const Result<LightField> field = LightField::make(plan->rig.leds, plan->rig.camera, size, 0);
  if (!field) return field.error();

  Image<float> readings(size, rendering->readings.planes()), maps(size, 11);
  Image<std::uint16_t> status(size);
  std::vector<View<const float>> views;
  for (int p = 0; p < readings.planes(); ++p) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x)
        readings(x, y, p) = static_cast<float>(rendering->readings(x, y, p));
    }
    views.emplace_back(readings.plane(p));
  }
  const auto map = [&](int p) { return maps.plane(p); };
  solver::fast_method()->solve({frame, 3, {}, views, &*field, std::nullopt}, {{map(0), map(1), map(2)},
                                                                              {map(3), map(4), map(5)},
                                                                              map(6),
                                                                              {map(7), map(8), map(9)},
                                                                              map(10),
                                                                              status.plane()});

  Judged judged(size);
  std::vector<solver::PixelRow> rows(field->count());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto i = static_cast<std::size_t>(y * size.width + x);
      for (std::size_t k = 0; k < rows.size(); ++k) {
        for (std::size_t c = 0; c < 3; ++c) {
          const LightField::Light light = field->at(k, static_cast<int>(c), x, y);
          rows[k].direction = light.direction;
          rows[k].strength[c] = light.strength;
          rows[k].reading[c] = views[3 * k + c](x, y);
        }
      }
      judged.status[i] = status(x, y);
      if ((status(x, y) & kNoSolution) != 0) continue;
      const test::OracleSolution exact = test::solve_in_quad(test::oracle_rows(rows, 3)),
                                 exact_red = test::solve_in_quad(test::oracle_rows(rows, 1));
      judged.condition[i] = exact.condition;
      judged.ours_deg[i] = angle_deg({maps(x, y, 0), maps(x, y, 1), maps(x, y, 2)}, exact.normal);
      if (const auto plain = torture::plain_normal<float>(rows))
        judged.plain_deg[i] = angle_deg(*plain, exact_red.normal);
    }
  }
  return judged;
}

/// The scale of colours with its ends, and what has no place on it.
Picture legend_of(int width, const char* least, const char* most) {
  constexpr int kLine = report::kGlyphHeight * kTextScale, kSecond = 2 * kLine + 3 * kGap;
  Picture legend = report::blank_picture({width, kSecond + kLine + kGap});
  for (int x = 0; x < width; ++x) {
    report::fill(legend, {x, kGap, x + 1, kGap + kLine}, report::heat_colour(x / (width - 1.0)));
  }
  const auto text = [&](int x, int y, const char* words) {
    report::draw_text(legend, x, y, words, report::kInk, kTextScale);
  };
  text(0, kLine + 2 * kGap, least);
  text(width - report::text_width(most, kTextScale), kLine + 2 * kGap, most);
  int left = 0;
  for (const auto& [paint, words] :
       {std::pair{Paint{kUnsolvedGrey}, "no solution"}, {kNoNumber, "no number"}}) {
    for (int y = kSecond; y < kSecond + kLine; ++y) {
      for (int x = left; x < left + 2 * kLine; ++x)
        report::fill(legend, {x, y, x + 1, y + 1}, paint.at(x, y));
    }
    text(left + 2 * kLine + kGap, kSecond, words);
    left += width / 2;
  }
  return legend;
}

Picture picture_of(Size size, const std::function<Paint(std::size_t)>& paint_at) {
  Picture picture = report::blank_picture({size.width * kZoom, size.height * kZoom});
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const Paint paint = paint_at(static_cast<std::size_t>(y / kZoom * size.width + x / kZoom));
      report::fill(picture, {x, y, x + 1, y + 1}, paint.at(x, y));
    }
  }
  return picture;
}

Picture with_legend(const Picture& picture, const char* least, const char* most) {
  const Picture legend = legend_of(picture.width(), least, most);
  Picture both = report::blank_picture({picture.width(), picture.height() + legend.height()});
  report::paste(both, 0, 0, picture);
  report::paste(both, 0, picture.height(), legend);
  return both;
}

Result<void> write_pictures(const fs::path& folder, const Judged& judged) {
  const auto where_solved = [&](std::size_t i, Paint paint) {
    return (judged.status[i] & kNoSolution) != 0 ? Paint{kUnsolvedGrey} : paint;
  };
  const auto of_condition = [&](std::size_t i) {
    return where_solved(i, paint_of(std::log10(judged.condition[i]), 0, 8));
  };
  const auto of_status = [&](std::size_t i) { return paint_of_status(judged.status[i]); };
  const auto of_errors = [&](const std::vector<double>& errors) {
    const Picture picture =
        picture_of(judged.size, [&](std::size_t i) { return where_solved(i, paint_of_error(errors[i])); });
    return with_legend(picture, "1e-6°", "100°");
  };
  const auto write = [&](const char* name, const Picture& picture) {
    const std::array<View<const float>, 3> planes = {picture.plane(0), picture.plane(1), picture.plane(2)};
    return write_image(folder / name, planes, {"R", "G", "B"}, {.type = SampleType::kUint8});
  };
  const Picture condition = with_legend(picture_of(judged.size, of_condition), "1", "1e8");
  if (Result<void> ok = write("numerics_condition.png", condition); !ok) return ok;
  if (Result<void> ok = write("numerics_status.png", picture_of(judged.size, of_status)); !ok) return ok;
  if (Result<void> ok = write("numerics_plain.png", of_errors(judged.plain_deg)); !ok) return ok;
  return write("numerics_ours.png", of_errors(judged.ours_deg));
}

std::string cell_of(const Json& value) {
  if (value.is_null()) return "none";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "";
  if (value.is_string()) return value.get<std::string>();
  const double v = value.get<double>();
  return v == 0 || (std::abs(v) >= 0.01 && std::abs(v) < 1e4) ? fmt::format("{:.3g}", v)
                                                              : fmt::format("{:.1e}", v);
}

struct Column {
  const char* key;
  const char* heading;
};

std::string markdown_of(const Rows& rows, const std::vector<Column>& columns) {
  std::string head = "|", rule = "|", body;
  for (const Column& c : columns) {
    head += fmt::format(" {} |", c.heading);
    rule += "---|";
  }
  for (const Json& row : rows) {
    body += "|";
    for (const Column& c : columns) body += fmt::format(" {} |", cell_of(row[c.key]));
    body += "\n";
  }
  return head + "\n" + rule + "\n" + body;
}

/// Puts text between "<!-- NAME -->" and "<!-- end NAME -->".
Result<void> replace_between_marks(std::string& page, const std::string& name, const std::string& text) {
  const std::string begin = "<!-- " + name + " -->\n", end = "<!-- end " + name + " -->";
  const std::size_t from = page.find(begin), to = page.find(end);
  if (from == std::string::npos || to == std::string::npos || to < from) {
    return Error{ErrorKind::kBadData, "page has no place for the table", kPage,
                 fmt::format("the marks of \"{}\" are not there", name), "restore the page"};
  }
  page.replace(from + begin.size(), to - from - begin.size(), text);
  return {};
}

Rows every_decade(const Rows& curve) {
  Rows decades;
  for (std::size_t i = 3; i < curve.size(); i += 4) decades.push_back(curve[i]);
  return decades;
}

Result<void> write_page(const fs::path& file, const Rows& cases, const Rows& curve) {
  const Result<std::string> text = read_text(file);
  if (!text) return text.error();
  std::string page = *text;
  const std::string case_table = markdown_of(cases, {{"case", "case"},
                                                     {"what", "what"},
                                                     {"plain_float32_deg", "formula in float32, °"},
                                                     {"plain_double_deg", "in double, °"},
                                                     {"ours_deg", "`fast`, °"},
                                                     {"flags", "flags"},
                                                     {"float32", "float32, %"},
                                                     {"double_normal_equations", "double, %"},
                                                     {"double_qr", "QR, %"},
                                                     {"double_svd", "SVD, %"},
                                                     {"unsolved", "none, %"}});
  const std::string curve_table =
      markdown_of(every_decade(curve), {{"condition", "condition"},
                                        {"float32_normal_equations_deg", "normal equations, float32"},
                                        {"float32_qr_deg", "QR, float32"},
                                        {"float32_svd_deg", "SVD, float32"},
                                        {"double_normal_equations_deg", "normal equations, double"},
                                        {"double_svd_deg", "SVD, double"},
                                        {"ours_deg", "`fast`"},
                                        {"flagged", "flagged"}});
  if (Result<void> ok = replace_between_marks(page, "cases", case_table); !ok) return ok;
  if (Result<void> ok = replace_between_marks(page, "curve", curve_table); !ok) return ok;
  return write_file(file, page);
}

}  // namespace

Result<void> write_numerics_docs(const fs::path& docs, const fs::path& scenes) {
  const Rows curve = numerics_curve();
  if (Result<void> ok = write_page(docs / kPage, numerics_cases(), curve); !ok) return ok;
  if (Result<void> ok = write_file(docs / "numerics_curve.svg", numerics_plot(curve)); !ok) return ok;
  if (Result<void> ok = write_file(docs / "numerics_curve.json", document_of(curve)["rows"].dump(1) + "\n");
      !ok)
    return ok;
  const Result<Judged> torture = judge(scenes / "torture.toml");
  if (!torture) return torture.error();
  return write_pictures(docs / "pictures", *torture);
}

}  // namespace weft::bench
