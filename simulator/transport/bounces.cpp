// SPDX-License-Identifier: Apache-2.0
#include "simulator/transport/bounces.h"

#include <fmt/format.h>

#include <cmath>
#include <new>

namespace weft::simulator {
namespace {

Error refused(std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "interreflection cannot be computed", "bounces", std::move(why),
          std::move(remedy)};
}

void aim_from_surface(const HeightMesh& mesh, std::span<const Vec3> normals, Rect pixels,
                      const RaySettings& settings, RayBatch& rays) {
  const auto rays_a_pixel = static_cast<std::size_t>(settings.rays);
  rays.resize(static_cast<std::size_t>(pixels.pixels()) * rays_a_pixel);
  std::size_t first = 0;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x, first += rays_a_pixel) {
      aim_by_cosine(settings, scramble_of(settings.seed, x, y, settings.stream), mesh.ray_start_mm(x, y),
                    normals[mesh.vertex(x, y)], first, rays);
    }
  }
}

bool all_finite(std::span<const Rgb> values) {
  for (const Rgb& v : values) {
    if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) return false;
  }
  return true;
}

}  // namespace

RayBatch bounce_rays(const HeightMesh& mesh, std::span<const Vec3> normals, Rect pixels,
                     const RaySettings& settings) {
  RayBatch rays;
  aim_from_surface(mesh, normals, pixels, settings, rays);
  return rays;
}

Bounces::Bounces(Rect mesh_area, Rect pixels, int rays)
    : mesh_area_(mesh_area),
      pixels_(pixels),
      rays_(static_cast<std::size_t>(rays)),
      met_(static_cast<std::size_t>(pixels.pixels()) * rays_) {}

Result<Bounces> Bounces::trace(const HeightMesh& mesh, std::span<const Vec3> normals, Rect pixels,
                               const RaySettings& settings) try {
  if (auto checked = check_rays(settings); !checked) return checked.error();
  if (auto checked = check_covered(mesh, pixels); !checked) return checked.error();
  if (normals.size() != mesh.vertices()) {
    return refused(fmt::format("{} normals for {} vertices", normals.size(), mesh.vertices()),
                   "give a normal for every vertex");
  }
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (std::abs(length(normals[i]) - 1) <= 1e-3) continue;
    return refused(fmt::format("normal {} is ({}, {}, {})", i, normals[i].x, normals[i].y, normals[i].z),
                   "give finite normals of unit length");
  }
  Bounces bounces(mesh.area(), pixels, settings.rays);
  RayBatch rays;
  std::span<std::uint32_t> rest = bounces.met_;
  for_each_run(pixels, settings.rays, [&](Rect run) {
    aim_from_surface(mesh, normals, run, settings, rays);
    mesh.find_nearest_vertices(rays, rest.first(rays.size()));
    rest = rest.subspan(rays.size());
  });
  return bounces;
} catch (const std::bad_alloc&) {
  return Error{ErrorKind::kTryAgain, "interreflection cannot be computed", "bounces", "out of memory",
               "use smaller tiles, fewer threads or fewer rays"};
}

std::span<const std::uint32_t> Bounces::met(int x, int y) const {
  const std::size_t pixel =
      static_cast<std::size_t>(y - pixels_.y0) * static_cast<std::size_t>(pixels_.width()) +
      static_cast<std::size_t>(x - pixels_.x0);
  return std::span(met_).subspan(pixel * rays_, rays_);
}

Image<float> Bounces::openness() const {
  Image<float> share({pixels_.width(), pixels_.height()});
  for (int y = pixels_.y0; y < pixels_.y1; ++y) {
    for (int x = pixels_.x0; x < pixels_.x1; ++x) {
      int left = 0;
      for (const std::uint32_t vertex : met(x, y)) left += vertex == kLeft;
      share(x - pixels_.x0, y - pixels_.y0) = static_cast<float>(left) / static_cast<float>(rays_);
    }
  }
  return share;
}

Result<std::vector<Rgb>> Bounces::gather(std::span<const Rgb> irradiance, std::span<const Rgb> albedo) const {
  const auto vertices = static_cast<std::size_t>(mesh_area_.pixels());
  if (irradiance.size() != vertices || albedo.size() != vertices) {
    return refused(fmt::format("{} irradiances and {} albedos for {} vertices", irradiance.size(),
                               albedo.size(), vertices),
                   "give both for every vertex");
  }
  std::vector<Rgb> radiosity(vertices);
  for (std::size_t i = 0; i < vertices; ++i) {
    for (std::size_t c = 0; c < 3; ++c) radiosity[i][c] = albedo[i][c] * irradiance[i][c];
  }
  if (!all_finite(radiosity)) {
    return refused("an irradiance or an albedo is not finite", "give finite values");
  }
  std::vector<Rgb> arriving(vertices);
  for (int y = pixels_.y0; y < pixels_.y1; ++y) {
    for (int x = pixels_.x0; x < pixels_.x1; ++x) {
      Rgb sum = {};
      for (const std::uint32_t vertex : met(x, y)) {
        if (vertex >= kDark) continue;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += radiosity[vertex][c];
      }
      const std::size_t here =
          static_cast<std::size_t>(y - mesh_area_.y0) * static_cast<std::size_t>(mesh_area_.width()) +
          static_cast<std::size_t>(x - mesh_area_.x0);
      for (std::size_t c = 0; c < 3; ++c) arriving[here][c] = sum[c] / static_cast<double>(rays_);
    }
  }
  return arriving;
}

Result<std::vector<Rgb>> Bounces::gather_bounces(std::span<const Rgb> irradiance, std::span<const Rgb> albedo,
                                                 int bounces) const {
  std::vector<Rgb> total(irradiance.size());
  std::vector<Rgb> last(irradiance.begin(), irradiance.end());
  for (int bounce = 0; bounce < bounces; ++bounce) {
    auto next = gather(last, albedo);
    if (!next) return next.error();
    last = *std::move(next);
    for (std::size_t i = 0; i < total.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) total[i][c] += last[i][c];
    }
  }
  return total;
}

}  // namespace weft::simulator
