// SPDX-License-Identifier: Apache-2.0
#include "solver/normals/seed.h"

#include <Eigen/SVD>
#include <cmath>
#include <vector>

#include "solver/in_double/pixelwise.h"
#include "solver/method.h"

namespace weft::solver {
namespace {

// Rows of one system: (n . l) k_d = I' with I' = I / i, the light's intensity divided out (eq. 25).
struct System {
  Eigen::MatrixXd l;
  Eigen::VectorXd intensity;
  Eigen::Index rows = 0;

  explicit System(std::size_t lights)
      : l(static_cast<Eigen::Index>(lights), 3), intensity(static_cast<Eigen::Index>(lights)) {}
  void add(Vec3 direction, double value) {
    if (!std::isfinite(value)) return;
    l.row(rows) << direction.x, direction.y, direction.z;
    intensity(rows++) = value;
  }
};

// N of one system; false where the rows do not span three dimensions.
bool solve_system(const System& system, Vec3& n) {
  if (system.rows < 3) return false;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(system.l.topRows(system.rows),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
  if (svd.rank() < 3) return false;
  const Eigen::Vector3d solution = svd.solve(system.intensity.head(system.rows));
  n = {solution.x(), solution.y(), solution.z()};
  return length(n) > 0 && std::isfinite(length(n));
}

class Seed : public Method {
 public:
  bool wants_rgb() const override { return true; }

  void solve(const TileInput& input, const TileOutput& output) const override {
    std::vector<PixelRow> rows(input.field->count());
    for (int y = 0; y < input.tile.height(); ++y) {
      for (int x = 0; x < input.tile.width(); ++x) {
        gather(input, x, y, rows);
        write(solve_seed_pixel(rows), rows, output, x, y);
      }
    }
  }

 private:
  static void gather(const TileInput& input, int x, int y, std::vector<PixelRow>& rows) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      for (std::size_t c = 0; c < 3; ++c) {
        const LightField::Light light =
            input.field->at(k, static_cast<int>(c), input.tile.x0 + x, input.tile.y0 + y);
        rows[k].direction = light.direction;
        rows[k].strength[c] = light.strength;
        rows[k].reading[c] = input.readings[k * 3 + c](x, y);
      }
    }
  }

  // The paper has neither sigma nor status: facts that every method owes (TileOutput) come from the
  // double-precision reference of the same least squares.
  static void write(const SeedPixel& seed, const std::vector<PixelRow>& rows, const TileOutput& output, int x,
                    int y) {
    const PixelSolution facts = solve_pixel(rows, {3, false, std::nullopt});
    const bool solved = seed.solved[3];
    const Vec3 n = solved ? normalized(seed.n[3]) : facts.normal;
    output.normal[0](x, y) = static_cast<float>(n.x);
    output.normal[1](x, y) = static_cast<float>(n.y);
    output.normal[2](x, y) = static_cast<float>(n.z);
    for (std::size_t c = 0; c < 3; ++c) {
      output.albedo[c](x, y) = finite(solved && seed.solved[c] ? length(seed.n[c]) : facts.albedo[c]);
      output.sigma_albedo[c](x, y) = finite(facts.sigma_albedo[c]);
    }
    output.sigma_normal_deg(x, y) = static_cast<float>(facts.sigma_normal_deg);
    output.residual(x, y) = finite(facts.residual);
    output.status(x, y) = facts.status;
    if (output.tally != nullptr) ++(solved ? output.tally->by_svd : output.tally->unsolved);
  }
};

}  // namespace

SeedPixel solve_seed_pixel(std::span<const PixelRow> rows) {
  System luminance(rows.size());
  SeedPixel pixel;
  for (const PixelRow& row : rows) {
    double value = 0;
    for (std::size_t c = 0; c < 3; ++c) value += kLuminance[c] * row.reading[c] / row.strength[c];
    luminance.add(row.direction, value);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    System channel(rows.size());
    for (const PixelRow& row : rows) channel.add(row.direction, row.reading[c] / row.strength[c]);
    pixel.solved[c] = solve_system(channel, pixel.n[c]);
  }
  pixel.solved[3] = solve_system(luminance, pixel.n[3]);
  return pixel;
}

std::unique_ptr<Method> seed_method() {
  return std::make_unique<Seed>();
}

}  // namespace weft::solver
