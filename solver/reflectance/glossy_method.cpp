// SPDX-License-Identifier: Apache-2.0
#include "solver/reflectance/glossy_method.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/solve/status_blend.h"
#include "solver/in_double/pixelwise.h"
#include "solver/reflectance/blend.h"
#include "solver/reflectance/lobe_block.h"
#include "solver/reflectance/lobe_rows.h"
#include "solver/reflectance/measured_lobe.h"

namespace weft::solver {
namespace {

// One reading more than a normal and an albedo have unknowns.
constexpr float kLeastReadings = 4;
// Where a pixel begins again: at the first of other_starts, where it is, and at the others.
constexpr std::size_t kStages = 1 + kOtherStarts, kWhereItIs = 1;

double root_of_sum(double a, double b) {
  return std::sqrt(std::max(a + b, 0.0));
}

// A pixel of a tile that is being solved.
struct Pixel {
  int x = 0, y = 0;
  double albedo = 0;  // as the base left it, in the unit
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

// What was solved of a pixel, in the unit.
struct SolvedPixel {
  Pixel at;
  Vec3 b;
  double yarn = 0;      // from the lobe's axis
  Blend by, tint_off;   // the second with tints one sigma off
  double residual = 0;  // rms of reading less model
  unsigned how = 0;     // bits beside kGlossy
  BlendVariances variances;
};

const Lobe& off_tint(const KnownLobe& known) {
  return known.lobe.is_tinted() ? known.tint_off : known.lobe;
}
double tint_of(const Blend& blend, std::size_t plane) {
  return (1 - blend.second_share) * blend.first.tint[plane] + blend.second_share * blend.second.tint[plane];
}

// One tile.
class GlossyTile {
 public:
  GlossyTile(const std::vector<KnownLobe>& lobes, Sight sight, double unit, const TileInput& input,
             const TileOutput& output)
      : lobes_(lobes),
        unit_(unit),
        input_(input),
        output_(output),
        rows_(input, sight, unit),
        row_(rows_.count()) {
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
  // The albedo of RGB is that of the weighted sum.
  double albedo_of(int x, int y) const {
    if (input_.planes == 1) return output_.albedo[0](x, y) / unit_;
    double albedo = 0;
    for (std::size_t p = 0; p < 3; ++p) albedo += input_.plane_weights[p] * output_.albedo[p](x, y);
    return albedo / unit_;
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
      if (next_stage == kStages && !is_explained(group.block, i)) is_done[i] = !write_blended(group, i);
      if (is_done[i] || next_stage == kStages) continue;
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
      if (stage == kWhereItIs) {
        group.block.begin_at(i, group.block.b(i));
        continue;
      }
      for (std::size_t k = 0; k < readings_.size(); ++k) readings_[k] = group.block.reading(i, k);
      const std::size_t start = stage < kWhereItIs ? stage : stage - 1;
      group.block.begin_at(i, other_starts(readings_, group.pixels[i].albedo)[start]);
    }
    improve(group);
    finish(group, stage + 1);
    group.count = 0;
  }

  void write(const Group& group, const std::array<bool, LobeBlock::kPixels>& is_done) {
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
        if (by_lobe(i)) write_pixel(solved_by(l, group, i, variances));
      }
    }
  }

  SolvedPixel solved_by(std::size_t lobe, const Group& group, std::size_t i, const BlockVariances& v) {
    const bool is_across = group.block.across[i] > 0;
    for (std::size_t k = 0; input_.planes > 1 && k < readings_.size(); ++k)
      readings_[k] = group.block.reading(i, k);
    return {group.pixels[i],
            group.block.b(i),
            is_across ? kPi / 2 : 0,
            {lobes_[lobe].lobe, {}, 0},
            {off_tint(lobes_[lobe]), {}, 0},
            group.block.residual[i],
            (is_across ? unsigned{kYarnAcross} : 0U) | (lobe > 0 ? unsigned{kSecondLobe} : 0U),
            {v.along_of_readings[i], v.across_of_readings[i], v.along_of_lobe[i], v.across_of_lobe[i]}};
  }

  // A pixel that neither of two materials explains, as of both; whether that does.
  bool write_blended(const Group& group, std::size_t i) {
    const LobeBlock& block = group.block;
    if (lobes_.size() < 2 || block.used[i] < kLeastReadings + 1 || !(length(block.b(i)) > 0)) return false;
    for (std::size_t k = 0; k < readings_.size(); ++k) readings_[k] = block.reading(i, k);
    const Lobe &first = lobes_[0].lobe, &second = lobes_[1].lobe;
    std::optional<BlendFit> best;
    double yarn = 0;
    for (const double each : {0.0, kPi / 2}) {
      if (each > 0 && first.family != LobeFamily::kAnisotropicGgx &&
          second.family != LobeFamily::kAnisotropicGgx)
        continue;
      const BlendFit fit = fit_blend(first, second, readings_, block.b(i), each);
      if (best && !(fit.fit.cost < best->fit.cost)) continue;
      best = fit;
      yarn = each;
    }
    const Vec3 b = best->fit.b;
    if (best->second_parts % kBlendParts == 0 || !(length(b) > 0)) return false;
    if (!(best->fit.cost <= kBlendCosts * double{block.cost[i]})) return false;
    SolvedPixel pixel = {group.pixels[i],
                         b,
                         yarn,
                         {first, second, best->second_share},
                         {off_tint(lobes_[0]), off_tint(lobes_[1]), best->second_share},
                         0,
                         0,
                         {}};
    pixel.how = status_of_blend(best->second_parts) | (yarn > 0 ? unsigned{kYarnAcross} : 0U);
    double squares = 0;
    for (const LobeReading& r : readings_) {
      const double residual = r.x - modelled(pixel.by, b, r.from, yarn);
      squares += r.weight > 0 ? residual * residual : 0;
    }
    pixel.residual = std::sqrt(squares / block.used[i]);
    pixel.variances =
        variances_of(pixel.by, lobes_[0].one_sigma_off, lobes_[1].one_sigma_off, readings_, b, yarn);
    write_pixel(pixel);
    return true;
  }

  // Writes a pixel, in RGB with its readings in readings_.
  void write_pixel(const SolvedPixel& pixel) {
    const int x = pixel.at.x, y = pixel.at.y;
    const BlendVariances& v = pixel.variances;
    const double rho = length(pixel.b);
    const Vec3 n = (1 / rho) * pixel.b;
    output_.normal[0](x, y) = static_cast<float>(n.x);
    output_.normal[1](x, y) = static_cast<float>(n.y);
    output_.normal[2](x, y) = static_cast<float>(n.z);
    const double sigma = degrees(root_of_sum(v.across_of_readings, v.across_of_lobes)) / rho;
    output_.sigma_normal_deg(x, y) = static_cast<float>(std::min(sigma, double{kUnknownAngleDeg}));
    output_.residual(x, y) = finite(pixel.residual / rho);
    // What the lobe explains is no misfit any more.
    const unsigned before = output_.status(x, y) & ~unsigned{kSpecular};
    output_.status(x, y) = static_cast<std::uint16_t>(before | kGlossy | pixel.how);
    const bool is_tinted = pixel.by.first.is_tinted() || pixel.by.second.is_tinted();
    for (std::size_t p = 0; p < static_cast<std::size_t>(input_.planes); ++p) {
      if (input_.planes == 1) {
        output_.albedo[p](x, y) = finite(unit_ * rho);
        output_.sigma_albedo[p](x, y) = finite(unit_ * root_of_sum(v.along_of_readings, v.along_of_lobes));
        continue;
      }
      const double share = plane_share(pixel, pixel.by, p), tint = tint_of(pixel.by, p);
      // What is wrong with a highlight is as much in all channels, but for its tint.
      double of_lobes = v.along_of_lobes * tint * tint;
      if (is_tinted) of_lobes += std::pow(rho * (plane_share(pixel, pixel.tint_off, p) - share), 2);
      output_.albedo[p](x, y) = finite(unit_ * rho * share);
      output_.sigma_albedo[p](x, y) =
          finite(unit_ * root_of_sum(v.along_of_readings * share * share, of_lobes));
    }
  }

  // Albedo of one plane of RGB over that of the weighted sum: what its readings leave once the lobe, which
  // has the tint of its f0, is taken off.
  double plane_share(const SolvedPixel& pixel, const Blend& by, std::size_t plane) {
    of_plane_ = readings_;
    for (std::size_t k = 0; k < of_plane_.size(); ++k) {
      const std::size_t lights = input_.field->count(), i_of_state = 3 * (k % lights) + plane;
      const double strength = input_.field
                                  ->at(k % lights, static_cast<int>(plane), input_.tile.x0 + pixel.at.x,
                                       input_.tile.y0 + pixel.at.y)
                                  .strength;
      const auto& state = k < lights ? input_.readings : input_.parallel;
      of_plane_[k].x = state[i_of_state](pixel.at.x, pixel.at.y) / (unit_ * strength);
      of_plane_[k].from.channel = static_cast<int>(plane);
    }
    const std::optional<double> albedo = albedo_beneath(by, of_plane_, normalized(pixel.b), pixel.yarn);
    return albedo ? std::max(0.0, *albedo / length(pixel.b)) : 1;
  }

  const std::vector<KnownLobe>& lobes_;
  double unit_;
  const TileInput& input_;
  const TileOutput& output_;
  LobeRows rows_;
  Group row_;
  std::array<std::unique_ptr<Group>, kStages> again_;  // pixels that other starts are tried on
  std::vector<LobeReading> readings_, of_plane_;
};

class Glossy : public Method {
 public:
  Glossy(const Method& base, std::vector<KnownLobe> lobes, Sight sight, double unit)
      : base_(base), lobes_(std::move(lobes)), sight_(sight), unit_(unit) {}

  void solve(const TileInput& input, const TileOutput& output) const override {
    base_.solve(input, output);
    GlossyTile(lobes_, sight_, unit_, input, output).solve();
  }

  bool wants_rgb() const override { return base_.wants_rgb(); }

  double reflected(const TileInput& input, const TileOutput& output, int x, int y, Vec3 light,
                   double lobe_share) const override {
    if ((output.status(x, y) & kGlossy) == 0) return base_.reflected(input, output, x, y, light, lobe_share);
    LobeReader reader(input, sight_);
    std::vector<LobeReading> readings(reader.count());
    reader.read(x, y, readings);
    const unsigned status = output.status(x, y);
    const double yarn = (status & kYarnAcross) != 0 ? kPi / 2 : 0;
    const double spoken = output.albedo[input.planes == 1 ? 0 : 1](x, y) / unit_;
    const Blend lobes = {lobes_.front().lobe, lobes_[lobes_.size() < 2 ? 0 : 1].lobe,
                         second_share_of(status)};
    const Vec3 n = {output.normal[0](x, y), output.normal[1](x, y), output.normal[2](x, y)};
    LitFrom from(light, readings.front().from.view, lobe_share);
    from.channel = input.planes == 1 ? readings.front().from.channel : 1;
    return unit_ * modelled(lobes, spoken * n, from, yarn);
  }

 private:
  const Method& base_;
  std::vector<KnownLobe> lobes_;
  Sight sight_;
  double unit_;
};

}  // namespace

std::unique_ptr<Method> glossy_method(const Method& base, std::vector<KnownLobe> lobes, Sight sight,
                                      double unit) {
  return std::make_unique<Glossy>(base, std::move(lobes), sight, unit);
}

}  // namespace weft::solver
