// SPDX-License-Identifier: Apache-2.0
#include "bench/oracles/mesh.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace weft::bench {
namespace {

constexpr int kMeshSamples = 6;
constexpr double kElectrons = 28000, kReadNoise = 3;

double wandering(double at_px, double pitch_px) {
  const double yarn = std::floor(at_px / pitch_px);
  return at_px - (yarn + 0.5) * pitch_px - 0.06 * pitch_px * std::sin(7.3 * yarn);
}

bool is_yarn(double at_px, const MeshScene& scene) {
  const double thickness = 1 + 0.1 * std::sin(3.1 * std::floor(at_px / scene.pitch_px));
  return std::abs(wandering(at_px, scene.pitch_px)) < scene.yarn_px / 2 * thickness;
}

struct Ring {
  double x_px, y_px, radius_px;
};

std::vector<Ring> rings_of(const MeshScene& scene, std::mt19937& random) {
  std::uniform_real_distribution<double> place(0, scene.side_px), radius(5, 14);
  std::vector<Ring> rings(scene.is_lace ? static_cast<std::size_t>(scene.side_px) / 10 : 0);
  for (Ring& ring : rings) ring = {place(random), place(random), radius(random)};
  return rings;
}

bool is_cloth(double x, double y, const MeshScene& scene, const std::vector<Ring>& rings) {
  bool cloth = is_yarn(x, scene) || is_yarn(y, scene);
  for (const Ring& ring : rings) {
    const double away = std::hypot(x - ring.x_px, y - ring.y_px);
    if (away < ring.radius_px) cloth = false;
    if (away >= ring.radius_px && away < ring.radius_px + scene.yarn_px) cloth = true;
  }
  return cloth;
}

// Weighted means along rows, the result transposed: twice of it blurs both ways.
Image<float> swept(const Image<float>& map, const std::vector<double>& weights) {
  const int reach = static_cast<int>(weights.size() / 2);
  Image<float> made({map.height(), map.width()});
  for (int y = 0; y < map.height(); ++y) {
    for (int x = 0; x < map.width(); ++x) {
      double sum = 0;
      for (int i = -reach; i <= reach; ++i) {
        sum += weights[static_cast<std::size_t>(i + reach)] *
               double{map(std::clamp(x + i, 0, map.width() - 1), y)};
      }
      made(y, x) = static_cast<float>(sum);
    }
  }
  return made;
}

// A Gaussian as wide as blur and disc together.
Image<float> blurred(const Image<float>& map, const MeshScene& scene) {
  const double sigma = kMeshSamples * std::hypot(scene.blur_px, scene.defocus_px / 4);
  const int reach = static_cast<int>(std::ceil(3.5 * sigma));
  std::vector<double> weights;
  double sum = 0;
  for (int i = -reach; i <= reach; ++i) sum += weights.emplace_back(std::exp(-i * i / (2 * sigma * sigma)));
  for (double& w : weights) w /= sum;
  return swept(swept(map, weights), weights);
}

Image<float> binned(const Image<float>& fine, int side) {
  Image<float> made({side, side});
  for (int y = 0; y < side * kMeshSamples; ++y) {
    for (int x = 0; x < side * kMeshSamples; ++x) {
      made(x / kMeshSamples, y / kMeshSamples) += fine(x, y) / (kMeshSamples * kMeshSamples);
    }
  }
  return made;
}

}  // namespace

RenderedMesh rendered(const MeshScene& scene) {
  std::mt19937 random(scene.seed);
  const std::vector<Ring> rings = rings_of(scene, random);
  const int fine = scene.side_px * kMeshSamples;
  Image<float> cloth({fine, fine});
  double covered = 0;
  for (int y = 0; y < fine; ++y) {
    for (int x = 0; x < fine; ++x) {
      const double u = (x + 0.5) / kMeshSamples, v = (y + 0.5) / kMeshSamples;
      cloth(x, y) = is_cloth(u, v, scene, rings) ? 1.0F : 0.0F;
      covered += double{cloth(x, y)};
    }
  }
  const double brightened = 1 / (1 - scene.thrown_back * covered / fine / fine / 2);
  RenderedMesh mesh = {binned(blurred(cloth, scene), scene.side_px),
                       Image<float>({scene.side_px, scene.side_px})};
  std::normal_distribution<double> normal(0, 1);
  for (int y = 0; y < scene.side_px; ++y) {
    for (int x = 0; x < scene.side_px; ++x) {
      const double a = double{mesh.coverage(x, y)}, t = brightened * (1 - a + scene.through_yarns * a);
      const double noise = std::sqrt(t * kElectrons + kReadNoise * kReadNoise) / kElectrons;
      mesh.share(x, y) = static_cast<float>(t + noise * normal(random));
    }
  }
  return mesh;
}

}  // namespace weft::bench
