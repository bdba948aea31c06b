// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/glossy_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "solver/in_double/pixelwise.h"
#include "solver/reflectance/lobe_block.h"
#include "solver/reflectance/measured_lobe.h"

namespace weft::solver {
namespace {

constexpr int kSteps = 8;
// One reading more than a normal and an albedo have unknowns.
constexpr int kLeastReadings = 4;

// A pixel of a tile that is being solved.
struct Pixel {
  int x = 0, y = 0;
  int used = 0;       // readings with a weight
  double albedo = 0;  // as the base left it
};

// Pixels of a tile, wherever they lie, side by side for the vector kernel.
struct Group {
  explicit Group(std::size_t lights) : block(lights), readings(lights * LobeBlock::kPixels) {}

  std::span<const LobeReading> of(std::size_t i) const {
    const std::size_t lights = block.lights().size();
    return {readings.data() + i * lights, lights};
  }
  void add(const Pixel& pixel, std::span<const LobeReading> of_pixel, Vec3 b) {
    std::ranges::copy(of_pixel,
                      readings.begin() + static_cast<std::ptrdiff_t>(pixels.size() * of_pixel.size()));
    block.put(pixels.size(), of_pixel);
    start.push_back(b);
    pixels.push_back(pixel);
  }
  bool is_full() const { return pixels.size() == LobeBlock::kPixels; }
  void clear() {
    pixels.clear();
    start.clear();
  }

  LobeBlock block;  // solved from the last start
  LobeBlock best{0};
  std::vector<LobeReading> readings;
  std::vector<Pixel> pixels;
  std::vector<Vec3> start;
};

// Variances of b along its normal, which is that of the albedo, and across it.
struct Variances {
  double along = 0, across = 0;
};
struct PixelVariances {
  Variances of_readings, of_lobe;
};

// `pulls` (pull_of) of lobes one sigma off.
PixelVariances variances_of(const LobeBlock& block, std::size_t i, Vec3 n,
                            std::span<const LobeBlock::Lanes3> pulls) {
  PixelSystem system;
  for (std::size_t e = 0; e < system.a.size(); ++e) system.a[e] = block.normal_matrix[e][i];
  const std::array<Vec3, 3> columns = {system.solved({1, 0, 0}), system.solved({0, 1, 0}),
                                       system.solved({0, 0, 1})};
  PixelVariances v;
  v.of_readings.along = n.x * dot(columns[0], n) + n.y * dot(columns[1], n) + n.z * dot(columns[2], n);
  v.of_readings.across = columns[0].x + columns[1].y + columns[2].z - v.of_readings.along;
  for (const LobeBlock::Lanes3& pull : pulls) {
    const Vec3 change = system.solved({pull.x[i], pull.y[i], pull.z[i]});
    const double along = dot(change, n);
    v.of_lobe.along += along * along;
    v.of_lobe.across += dot(change, change) - along * along;
  }
  return v;
}

double root_of_sum(double a, double b) {
  return std::sqrt(std::max(a + b, 0.0));
}

class Glossy : public Method {
 public:
  Glossy(const Method& base, std::vector<KnownLobe> lobes, Sight sight)
      : base_(base), lobes_(std::move(lobes)), sight_(sight) {}

  void solve(const TileInput& input, const TileOutput& output) const override {
    base_.solve(input, output);
    LobeReader reader(input, sight_);
    std::vector<LobeReading> readings(reader.count());
    Group from_base(reader.count()), from_others(reader.count());
    const auto finish_others = [&] {
      try_other_starts(from_others);
      write(input, output, from_others);
      from_others.clear();
    };
    const auto finish = [&] {
      solve_from_base(from_base);
      write(input, output, from_base);
      for (std::size_t i = 0; i < from_base.pixels.size(); ++i) {
        if (is_explained(from_base, i)) continue;
        from_others.add(from_base.pixels[i], from_base.of(i), from_base.best.b(i));
        if (from_others.is_full()) finish_others();
      }
      from_base.clear();
    };
    for (int y = 0; y < input.tile.height(); ++y) {
      for (int x = 0; x < input.tile.width(); ++x) {
        if (output.status(x, y) & (kNoSolution | kDark)) continue;
        reader.read(x, y, readings);
        const int used = used_of(readings);
        if (used < kLeastReadings) continue;
        const double albedo = albedo_of(input, output, x, y);
        from_base.add({x, y, used, albedo}, readings, albedo * normal_of(output, x, y));
        if (from_base.is_full()) finish();
      }
    }
    finish();
    finish_others();
  }

  bool wants_rgb() const override { return base_.wants_rgb(); }

  double reflected(const TileInput& input, const TileOutput& output, int x, int y, Vec3 light,
                   double lobe_share) const override {
    if ((output.status(x, y) & kGlossy) == 0) return base_.reflected(input, output, x, y, light, lobe_share);
    LobeReader reader(input, sight_);
    std::vector<LobeReading> readings(reader.count());
    reader.read(x, y, readings);
    const double yarn = (output.status(x, y) & kYarnAcross) != 0 ? kPi / 2 : 0;
    const double spoken = output.albedo[input.planes == 1 ? 0 : 1](x, y);
    const Lobe& lobe = lobes_[(output.status(x, y) & kSecondLobe) != 0 ? 1 : 0].lobe;
    return modelled(lobe, spoken * normal_of(output, x, y),
                    LitFrom(light, readings.front().from.view, lobe_share), yarn);
  }

 private:
  static Vec3 normal_of(const TileOutput& output, int x, int y) {
    return {output.normal[0](x, y), output.normal[1](x, y), output.normal[2](x, y)};
  }
  // Of RGB that of the weighted sum.
  static double albedo_of(const TileInput& input, const TileOutput& output, int x, int y) {
    if (input.planes == 1) return output.albedo[0](x, y);
    double albedo = 0;
    for (std::size_t p = 0; p < 3; ++p) albedo += input.plane_weights[p] * output.albedo[p](x, y);
    return albedo;
  }
  static bool is_explained(const Group& group, std::size_t i) {
    return 2 * group.best.cost[i] < kTryOthersFrom * std::max(1, group.pixels[i].used - 3);
  }

  // The starts of all pixels, by all lobes with both yarns; what costs less than the best so far takes its
  // place.
  void try_starts(Group& group, std::span<const Vec3> starts, bool is_first) const {
    for (std::size_t l = 0; l < lobes_.size(); ++l) {
      group.block.lobe.fill(static_cast<std::uint8_t>(l));
      for (const double yarn : {0.0, kPi / 2}) {
        if (yarn > 0 && lobes_[l].lobe.family != LobeFamily::kAnisotropicGgx) continue;
        for (std::size_t i = 0; i < group.pixels.size(); ++i) group.block.start(i, starts[i], yarn);
        fit_block(lobes_[l].lobe, group.block, kSteps);
        if (is_first && l == 0 && yarn == 0) {
          group.best = group.block;
          continue;
        }
        for (std::size_t i = 0; i < group.pixels.size(); ++i) {
          if (group.block.cost[i] < group.best.cost[i]) group.best.take(i, group.block);
        }
      }
    }
  }

  void solve_from_base(Group& group) const { try_starts(group, group.start, true); }

  void try_other_starts(Group& group) const {
    try_starts(group, group.start, true);
    std::vector<Vec3> starts(group.pixels.size());
    for (std::size_t s = 0; s < kOtherStarts; ++s) {
      for (std::size_t i = 0; i < starts.size(); ++i) {
        const double albedo = group.pixels[i].albedo;
        starts[i] = other_starts(group.of(i), albedo)[s];
      }
      try_starts(group, starts, false);
    }
  }

  void write(const TileInput& input, const TileOutput& output, Group& group) const {
    for (std::size_t l = 0; l < lobes_.size(); ++l) {
      if (!lobes_[l].lobe.shines()) continue;
      std::vector<LobeBlock::Lanes3> pulls;
      for (const Lobe& off : lobes_[l].one_sigma_off)
        pulls.push_back(pull_of(off, lobes_[l].lobe, group.best));
      for (std::size_t i = 0; i < group.pixels.size(); ++i) {
        if (group.best.lobe[i] != l) continue;
        const Vec3 b = group.best.b(i);
        if (!(length(b) > 0) || !std::isfinite(group.best.cost[i])) continue;
        write_pixel(input, output, group, i, pulls);
      }
    }
  }

  void write_pixel(const TileInput& input, const TileOutput& output, const Group& group, std::size_t i,
                   std::span<const LobeBlock::Lanes3> pulls) const {
    const int x = group.pixels[i].x, y = group.pixels[i].y;
    const Vec3 b = group.best.b(i);
    const double rho = length(b);
    const Vec3 n = (1 / rho) * b;
    const PixelVariances v = variances_of(group.best, i, n, pulls);
    output.normal[0](x, y) = static_cast<float>(n.x);
    output.normal[1](x, y) = static_cast<float>(n.y);
    output.normal[2](x, y) = static_cast<float>(n.z);
    const double sigma = degrees(root_of_sum(v.of_readings.across, v.of_lobe.across)) / rho;
    output.sigma_normal_deg(x, y) = static_cast<float>(std::min(sigma, double{kUnknownAngleDeg}));
    output.residual(x, y) = finite(group.best.residual[i] / rho);
    // What the lobe explains is no misfit any more.
    unsigned solved = kGlossy;
    if (group.best.yarn_y[i] > 0.5F) solved |= kYarnAcross;
    if (group.best.lobe[i] > 0) solved |= kSecondLobe;
    output.status(x, y) = static_cast<std::uint16_t>((output.status(x, y) & ~unsigned{kSpecular}) | solved);
    for (std::size_t p = 0; p < static_cast<std::size_t>(input.planes); ++p) {
      const double share = input.planes == 1 ? 1 : plane_share(input, group, i, b, x, y, p);
      output.albedo[p](x, y) = finite(rho * share);
      // A highlight has the colour of the light: what is wrong with it is as much in all channels.
      output.sigma_albedo[p](x, y) =
          finite(root_of_sum(v.of_readings.along * share * share, v.of_lobe.along));
    }
  }

  // Albedo of one plane of RGB over that of the weighted sum: what its readings leave once the lobe, which
  // has the colour of the light, is taken off.
  double plane_share(const TileInput& input, const Group& group, std::size_t i, Vec3 b, int x, int y,
                     std::size_t plane) const {
    const Lobe& lobe = lobe_of(group, i);
    const double yarn = std::atan2(group.best.yarn_y[i], group.best.yarn_x[i]);
    double of_plane = 0, of_all = 0;
    const auto readings = group.of(i);
    for (std::size_t k = 0; k < readings.size(); ++k) {
      const LobeReading& r = readings[k];
      if (r.weight == 0) continue;
      const std::size_t lights = input.field->count(), i_of_state = 3 * (k % lights) + plane;
      const double strength =
          input.field->at(k % lights, static_cast<int>(plane), input.tile.x0 + x, input.tile.y0 + y).strength;
      const auto& state = k < lights ? input.readings : input.parallel;
      const double reading = state[i_of_state](x, y) / strength;
      const Vec3 n = normalized(b);
      const double shine = std::max(0.0, dot(n, r.from.light)) * specular(lobe, n, r.from, yarn);
      const double diffuse = modelled(lobe, b, r.from, yarn) - shine;
      of_plane += r.weight * diffuse * (reading - shine);
      of_all += r.weight * diffuse * diffuse;
    }
    return of_all > 0 ? std::max(0.0, of_plane / of_all) : 1;
  }

  const Lobe& lobe_of(const Group& group, std::size_t i) const { return lobes_[group.best.lobe[i]].lobe; }

  const Method& base_;
  std::vector<KnownLobe> lobes_;
  Sight sight_;
};

}  // namespace

std::unique_ptr<Method> glossy_method(const Method& base, std::vector<KnownLobe> lobes, Sight sight) {
  return std::make_unique<Glossy>(base, std::move(lobes), sight);
}

}  // namespace weft::solver
