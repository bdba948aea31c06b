// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/glossy_method.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/in_double/pixelwise.h"
#include "solver/reflectance/measured_lobe.h"

namespace weft::solver {
namespace {

constexpr int kSteps = 8;

struct Pixel {
  PixelFit fit;
  double yarn = 0;
};

class Glossy : public Method {
 public:
  Glossy(const Method& base, const Lobe& lobe, Sight sight) : base_(base), lobe_(lobe), sight_(sight) {}

  void solve(const TileInput& input, const TileOutput& output) const override {
    base_.solve(input, output);
    std::vector<LobeReading> readings(input.field->count());
    LobeReader reader(input, sight_);
    for (int y = 0; y < input.tile.height(); ++y) {
      for (int x = 0; x < input.tile.width(); ++x) {
        if (output.status(x, y) & (kNoSolution | kDark)) continue;
        reader.read(x, y, readings);
        if (std::ranges::count_if(readings, [](const LobeReading& r) { return r.weight > 0; }) < 4) continue;
        write(input, readings, solve_pixel(input, output, readings, x, y), output, x, y);
      }
    }
  }

  bool wants_rgb() const override { return base_.wants_rgb(); }

  double reflected(const TileInput& input, const TileOutput& output, int x, int y,
                   Vec3 light) const override {
    if ((output.status(x, y) & kGlossy) == 0) return base_.reflected(input, output, x, y, light);
    std::vector<LobeReading> readings(input.field->count());
    LobeReader(input, sight_).read(x, y, readings);
    const Vec3 view = readings.front().from.view;
    const Vec3 b = albedo_of(input, output, x, y) * normal_of(output, x, y);
    return modelled(lobe_, b, LitFrom(light, view), yarn_of(b, readings).yarn);
  }

 private:
  static Vec3 normal_of(const TileOutput& output, int x, int y) {
    return {output.normal[0](x, y), output.normal[1](x, y), output.normal[2](x, y)};
  }
  static double albedo_of(const TileInput& input, const TileOutput& output, int x, int y) {
    double albedo = 0;
    for (std::size_t p = 0; p < static_cast<std::size_t>(input.planes); ++p)
      albedo += (input.planes == 1 ? 1 : input.plane_weights[p]) * output.albedo[p](x, y);
    return albedo;
  }
  bool has_yarn() const { return lobe_.family == LobeFamily::kAnisotropicGgx; }

  Pixel yarn_of(Vec3 b, std::span<const LobeReading> readings) const {
    Pixel best = {{b, cost_of(lobe_, readings, b, 0)}, 0};
    if (!has_yarn()) return best;
    const double weft = cost_of(lobe_, readings, b, kPi / 2);
    return weft < best.fit.cost ? Pixel{{b, weft}, kPi / 2} : best;
  }

  void try_from(Vec3 start, std::span<const LobeReading> readings, Pixel& best) const {
    for (const double yarn : {0.0, kPi / 2}) {
      if (yarn > 0 && !has_yarn()) continue;
      const PixelFit fit = fit_pixel(lobe_, readings, start, yarn, kSteps);
      if (fit.cost < best.fit.cost) best = {fit, yarn};
    }
  }

  Pixel solve_pixel(const TileInput& input, const TileOutput& output, std::span<const LobeReading> readings,
                    int x, int y) const {
    const double albedo = albedo_of(input, output, x, y);
    const Vec3 b = albedo * normal_of(output, x, y);
    Pixel best = {{b, std::numeric_limits<double>::infinity()}, 0};
    try_from(b, readings, best);
    const auto used = std::ranges::count_if(readings, [](const LobeReading& r) { return r.weight > 0; });
    if (2 * best.fit.cost < kTryOthersFrom * static_cast<double>(used - 3)) return best;
    for (const Vec3& start : other_starts(readings, albedo, albedo)) try_from(start, readings, best);
    return best;
  }

  void write(const TileInput& input, std::span<const LobeReading> readings, const Pixel& pixel,
             const TileOutput& output, int x, int y) const {
    const double rho = length(pixel.fit.b);
    const Vec3 n = (1 / rho) * pixel.fit.b;
    output.normal[0](x, y) = static_cast<float>(n.x);
    output.normal[1](x, y) = static_cast<float>(n.y);
    output.normal[2](x, y) = static_cast<float>(n.z);
    output.albedo[0](x, y) = finite(rho);
    output.status(x, y) = static_cast<std::uint16_t>(output.status(x, y) | kGlossy);
    (void)input;
    (void)readings;
  }

  const Method& base_;
  Lobe lobe_;
  Sight sight_;
};

}  // namespace

std::unique_ptr<Method> glossy_method(const Method& base, const Lobe& lobe, Sight sight) {
  return std::make_unique<Glossy>(base, lobe, sight);
}

}  // namespace weft::solver
