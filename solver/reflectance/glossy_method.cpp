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
#include "solver/reflectance/lobe_rows.h"
#include "solver/reflectance/measured_lobe.h"

namespace weft::solver {
namespace {

// One reading more than a normal and an albedo have unknowns.
constexpr float kLeastReadings = 4;
// Where a pixel begins again: where it is, then other_starts.
constexpr std::size_t kStages = 1 + kOtherStarts;

double root_of_sum(double a, double b) {
  return std::sqrt(std::max(a + b, 0.0));
}

// A pixel of a tile that is being solved.
struct Pixel {
  int x = 0, y = 0;
  double albedo = 0;  // as the base left it
};

// Pixels of a tile, wherever they lie, side by side for the vector kernel.
struct Group {
  explicit Group(std::size_t lights) : block(lights) {}

  void add(const Pixel& pixel, const LobeBlock& other, std::size_t i) {
    block.copy(count, other, i);
    pixels[count++] = pixel;
  }

  LobeBlock block;
  std::array<Pixel, LobeBlock::kPixels> pixels;
  std::size_t count = 0;
};

// One tile.
class GlossyTile {
 public:
  GlossyTile(const std::vector<KnownLobe>& lobes, Sight sight, const TileInput& input,
             const TileOutput& output)
      : lobes_(lobes), input_(input), output_(output), rows_(input, sight), row_(rows_.count()) {
    readings_.resize(rows_.count());
  }

  void solve() {
    for (int y = 0; y < input_.tile.height(); ++y) {
      rows_.go_to_row(y);
      for (int x = 0; x < input_.tile.width(); x += kRowGroup) solve_row_group(x, y);
    }
    for (std::size_t stage = 0; stage < again_.size(); ++stage) {
      if (again_[stage]) begin_again(stage);
    }
  }

 private:
  static bool is_explained(const LobeBlock& block, std::size_t i) {
    return 2 * double{block.cost[i]} < kTryOthersFrom * std::max(1.0, double{block.used[i]} - 3);
  }
  Vec3 normal_of(int x, int y) const {
    return {output_.normal[0](x, y), output_.normal[1](x, y), output_.normal[2](x, y)};
  }
  // Of RGB that of the weighted sum.
  double albedo_of(int x, int y) const {
    if (input_.planes == 1) return output_.albedo[0](x, y);
    double albedo = 0;
    for (std::size_t p = 0; p < 3; ++p) albedo += input_.plane_weights[p] * output_.albedo[p](x, y);
    return albedo;
  }

  void solve_row_group(int x, int y) {
    row_.count = static_cast<std::size_t>(std::min(kRowGroup, input_.tile.width() - x));
    rows_.read(x, row_.block);
    bool any = false;
    for (std::size_t i = 0; i < row_.count; ++i) {
      Pixel& pixel = row_.pixels[i];
      pixel = {x + static_cast<int>(i), y, albedo_of(x + static_cast<int>(i), y)};
      row_.block.begin_at(i, pixel.albedo * normal_of(pixel.x, y));
      if ((output_.status(pixel.x, y) & (kNoSolution | kDark)) != 0) row_.block.leave_out(i);
      any |= row_.block.used[i] >= kLeastReadings;
    }
    if (!any) return;
    improve(row_);
    finish(row_, 0);
  }

  void improve(Group& group) const {
    for (std::size_t l = 0; l < lobes_.size(); ++l)
      improve_block(lobes_[l].lobe, l, group.block, group.count);
  }

  // Writes the pixels whose readings are explained, and passes the others on to a stage, if there is one
  // left.
  void finish(Group& group, std::size_t next_stage) {
    std::array<bool, LobeBlock::kPixels> is_done = {};
    for (std::size_t i = 0; i < group.count; ++i) {
      if (group.block.used[i] < kLeastReadings) continue;
      is_done[i] = next_stage == kStages || is_explained(group.block, i);
      if (is_done[i]) continue;
      if (!again_[next_stage]) again_[next_stage] = std::make_unique<Group>(rows_.count());
      Group& next = *again_[next_stage];
      next.add(group.pixels[i], group.block, i);
      if (next.count == LobeBlock::kPixels) begin_again(next_stage);
    }
    write(group, is_done);
  }

  void begin_again(std::size_t stage) {
    Group& group = *again_[stage];
    for (std::size_t i = 0; i < group.count; ++i) {
      if (stage == 0) {
        group.block.begin_at(i, group.block.b(i));
        continue;
      }
      for (std::size_t k = 0; k < readings_.size(); ++k) readings_[k] = group.block.reading(i, k);
      group.block.begin_at(i, other_starts(readings_, group.pixels[i].albedo)[stage - 1]);
    }
    improve(group);
    finish(group, stage + 1);
    group.count = 0;
  }

  void write(const Group& group, const std::array<bool, LobeBlock::kPixels>& is_done) const {
    for (std::size_t l = 0; l < lobes_.size(); ++l) {
      const auto by_lobe = [&](std::size_t i) {
        return is_done[i] && group.block.lobe[i] == static_cast<float>(l) &&
               std::isfinite(group.block.cost[i]) && length(group.block.b(i)) > 0;
      };
      bool any = false;
      for (std::size_t i = 0; i < group.count; ++i) any = any || by_lobe(i);
      if (!lobes_[l].lobe.shines() || !any) continue;
      BlockVariances variances;
      std::vector<Lobe> off = lobes_[l].one_sigma_off;
      if (lobes_[l].lobe.is_tinted()) off.push_back(lobes_[l].tint_off);
      write_variances(lobes_[l].lobe, off, group.block, group.count, variances);
      for (std::size_t i = 0; i < group.count; ++i) {
        if (by_lobe(i)) write_pixel(group, i, variances);
      }
    }
  }

  void write_pixel(const Group& group, std::size_t i, const BlockVariances& v) const {
    const int x = group.pixels[i].x, y = group.pixels[i].y;
    const Vec3 b = group.block.b(i);
    const double rho = length(b);
    const Vec3 n = (1 / rho) * b;
    output_.normal[0](x, y) = static_cast<float>(n.x);
    output_.normal[1](x, y) = static_cast<float>(n.y);
    output_.normal[2](x, y) = static_cast<float>(n.z);
    const double sigma = degrees(root_of_sum(v.across_of_readings[i], v.across_of_lobe[i])) / rho;
    output_.sigma_normal_deg(x, y) = static_cast<float>(std::min(sigma, double{kUnknownAngleDeg}));
    output_.residual(x, y) = finite(group.block.residual[i] / rho);
    // What the lobe explains is no misfit any more.
    unsigned solved = kGlossy;
    if (group.block.across[i] > 0) solved |= kYarnAcross;
    if (group.block.lobe[i] > 0) solved |= kSecondLobe;
    output_.status(x, y) = static_cast<std::uint16_t>((output_.status(x, y) & ~unsigned{kSpecular}) | solved);
    const KnownLobe& known = lobes_[static_cast<std::size_t>(group.block.lobe[i])];
    for (std::size_t p = 0; p < static_cast<std::size_t>(input_.planes); ++p) {
      const double share = input_.planes == 1 ? 1 : plane_share(known.lobe, group, i, p);
      // What is wrong with a highlight is as much in all channels, but for its tint.
      const double tint = input_.planes == 1 ? 1 : known.lobe.tint[p];
      double of_lobe = v.along_of_lobe[i] * tint * tint;
      if (input_.planes != 1 && known.lobe.is_tinted())
        of_lobe += std::pow(rho * (plane_share(known.tint_off, group, i, p) - share), 2);
      output_.albedo[p](x, y) = finite(rho * share);
      output_.sigma_albedo[p](x, y) = finite(root_of_sum(v.along_of_readings[i] * share * share, of_lobe));
    }
  }

  // Albedo of one plane of RGB over that of the weighted sum: what its readings leave once the lobe, which
  // has the tint of its f0, is taken off.
  double plane_share(const Lobe& lobe, const Group& group, std::size_t i, std::size_t plane) const {
    const int x = group.pixels[i].x, y = group.pixels[i].y;
    const Vec3 b = group.block.b(i), n = normalized(b);
    const double yarn = group.block.across[i] > 0 ? kPi / 2 : 0;
    double of_plane = 0, of_all = 0;
    for (std::size_t k = 0; k < readings_.size(); ++k) {
      LobeReading r = group.block.reading(i, k);
      if (r.weight == 0) continue;
      r.from.channel = static_cast<int>(plane);
      const std::size_t lights = input_.field->count(), i_of_state = 3 * (k % lights) + plane;
      const double strength =
          input_.field->at(k % lights, static_cast<int>(plane), input_.tile.x0 + x, input_.tile.y0 + y)
              .strength;
      const auto& state = k < lights ? input_.readings : input_.parallel;
      const double reading = state[i_of_state](x, y) / strength;
      const double shine = std::max(0.0, dot(n, r.from.light)) * specular(lobe, n, r.from, yarn);
      const double diffuse = modelled(lobe, b, r.from, yarn) - shine;
      of_plane += r.weight * diffuse * (reading - shine);
      of_all += r.weight * diffuse * diffuse;
    }
    return of_all > 0 ? std::max(0.0, of_plane / of_all) : 1;
  }

  const std::vector<KnownLobe>& lobes_;
  const TileInput& input_;
  const TileOutput& output_;
  LobeRows rows_;
  Group row_;
  std::array<std::unique_ptr<Group>, kStages> again_;  // pixels that other starts are tried on
  std::vector<LobeReading> readings_;
};

class Glossy : public Method {
 public:
  Glossy(const Method& base, std::vector<KnownLobe> lobes, Sight sight)
      : base_(base), lobes_(std::move(lobes)), sight_(sight) {}

  void solve(const TileInput& input, const TileOutput& output) const override {
    base_.solve(input, output);
    GlossyTile(lobes_, sight_, input, output).solve();
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
    const Vec3 n = {output.normal[0](x, y), output.normal[1](x, y), output.normal[2](x, y)};
    LitFrom from(light, readings.front().from.view, lobe_share);
    from.channel = input.planes == 1 ? readings.front().from.channel : 1;
    return modelled(lobe, spoken * n, from, yarn);
  }

 private:
  const Method& base_;
  std::vector<KnownLobe> lobes_;
  Sight sight_;
};

}  // namespace

std::unique_ptr<Method> glossy_method(const Method& base, std::vector<KnownLobe> lobes, Sight sight) {
  return std::make_unique<Glossy>(base, std::move(lobes), sight);
}

}  // namespace weft::solver
