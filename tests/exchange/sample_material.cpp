// SPDX-License-Identifier: Apache-2.0
#include "tests/exchange/sample_material.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/image/color_spaces.h"
#include "tests/exchange/png_bytes.h"

namespace weft::exchange {

namespace {

constexpr double kAmplitude_mm = 0.08, kSheenScale = 0.25;

/// What the cloth is at a point of its repeat, u to the right and v downwards, from 0 to 1.
struct Point {
  double u, v;
  double phase_x() const { return 8 * std::numbers::pi * u; }
  double phase_y() const { return 8 * std::numbers::pi * v; }
  double relief() const { return std::cos(phase_x()) * std::cos(phase_y()); }
  std::array<double, 3> normal(std::array<double, 2> size_mm) const {
    const double rise = kAmplitude_mm * 8 * std::numbers::pi;
    const double slope_x = -rise * std::sin(phase_x()) * std::cos(phase_y()) / size_mm[0];
    const double slope_y = rise * std::cos(phase_x()) * std::sin(phase_y()) / size_mm[1];  // y is up
    const double length = std::sqrt(1 + slope_x * slope_x + slope_y * slope_y);
    return {-slope_x / length, -slope_y / length, 1 / length};
  }
  std::array<double, 3> albedo() const {
    return {0.4 + 0.1 * relief(), 0.2 + 0.05 * relief(), 0.1 + 0.02 * relief()};
  }
  double roughness() const { return 0.55 + 0.15 * relief(); }
  double occlusion() const { return 0.85 + 0.15 * relief(); }
  double opacity() const { return relief() < -0.97 ? 0 : 1; }
  double strength() const { return 0.5 + 0.25 * relief(); }
  double angle() const { return relief() > 0 ? 0 : std::numbers::pi / 2; }
  double sheen() const { return 0.6 + 0.4 * relief(); }
};

using Sample = std::function<void(const Point&, std::vector<double>&)>;

std::string picture_of(Size size, int channels, int bits, const Sample& sample) {
  std::vector<double> samples;
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      sample({(x + 0.5) / size.width, (y + 0.5) / size.height}, samples);
    }
  }
  return png_bytes(size, channels, bits, samples);
}

void append_srgb(std::vector<double>& samples, const std::array<double, 3>& linear) {
  const Rgb display = srgb_of_rec709({linear[0], linear[1], linear[2]});
  samples.insert(samples.end(), display.begin(), display.end());
}

class SampleMaker {
 public:
  explicit SampleMaker(const SampleOptions& options) : options_(options) {
    made_.material = constant_material();
    made_.material.size_mm = options.size_mm;
  }

  SampleMaterial make() {
    const bool is_packed = options_.packing == Packing::kGltf;
    put_base(is_packed && options_.has_opacity);
    put_relief();
    TexturedMaterial& material = made_.material;
    if (is_packed) {
      put("orm.png", 3, 8, [](const Point& p, auto& s) {
        s.insert(s.end(), {p.occlusion(), p.roughness(), 0});
      });
      material.roughness->texture = texture("orm.png", "g");
      material.occlusion->texture = texture("orm.png", "r");
    } else {
      put("roughness.png", 1, 8, [](const Point& p, auto& s) { s.push_back(p.roughness()); });
      put("occlusion.png", 1, 8, [](const Point& p, auto& s) { s.push_back(p.occlusion()); });
      material.roughness->texture = texture("roughness.png", "r");
      material.occlusion->texture = texture("occlusion.png", "r");
    }
    if (!options_.has_opacity) material.opacity.reset();
    if (options_.has_sheen) {
      put_sheen(is_packed);
    } else {
      material.sheen_color.reset();
      material.sheen_roughness.reset();
      material.anisotropy.reset();
      material.anisotropy_direction.reset();
    }
    if (options_.has_f0_texture) {
      put("f0.png", 4, 8, [](const Point& p, auto& s) {
        s.insert(s.end(), {0, 0, 0, 0.75 + 0.25 * p.relief()});
      });
      material.f0->texture = texture("f0.png", "a");
      material.f0->texture->scale = 0.05;
    }
    return std::move(made_);
  }

 private:
  void put(const std::string& name, int channels, int bits, const Sample& sample) {
    made_.files["textures/" + name] = picture_of(options_.size, channels, bits, sample);
  }

  Texture texture(const std::string& name, const std::string& channels, int bits = 8) const {
    return {"textures/" + name, options_.size, bits, channels, false, 1, 0};
  }

  void put_base(bool has_alpha) {
    TexturedMaterial& material = made_.material;
    put("base.png", has_alpha ? 4 : 3, 8, [&](const Point& p, auto& s) {
      append_srgb(s, p.albedo());
      if (has_alpha) s.push_back(p.opacity());
    });
    material.base_color.texture = texture("base.png", "rgb");
    material.base_color.texture->is_srgb = true;
    if (has_alpha) {
      material.opacity->texture = texture("base.png", "a");
    } else if (options_.has_opacity) {
      put("opacity.png", 1, 8, [](const Point& p, auto& s) { s.push_back(p.opacity()); });
      material.opacity->texture = texture("opacity.png", "r");
    }
  }

  void put_relief() {
    TexturedMaterial& material = made_.material;
    const auto size_mm = options_.size_mm.value_or(std::array<double, 2>{8, 8});
    put("normal.png", 3, options_.bits, [&](const Point& p, auto& s) {
      for (const double each : p.normal(size_mm)) s.push_back(each / 2 + 0.5);
    });
    material.normal->texture = texture("normal.png", "rgb", options_.bits);
    put("height.png", 1, 16, [](const Point& p, auto& s) { s.push_back(p.relief() / 2 + 0.5); });
    material.height_mm->texture = texture("height.png", "r", 16);
    material.height_mm->texture->scale = 2 * kAmplitude_mm;
    material.height_mm->texture->offset = -kAmplitude_mm;
  }

  void put_sheen(bool is_packed) {
    TexturedMaterial& material = made_.material;
    put("sheen.png", 3, 8, [](const Point& p, auto& s) {
      append_srgb(s, {p.sheen(), p.sheen(), p.sheen()});
    });
    material.sheen_color->texture = texture("sheen.png", "rgb");
    material.sheen_color->texture->is_srgb = true;
    material.sheen_color->texture->scale = kSheenScale;
    put("sheen_roughness.png", is_packed ? 4 : 1, 8, [&](const Point& p, auto& s) {
      if (is_packed) s.insert(s.end(), {0, 0, 0});
      s.push_back(0.5 + 0.1 * p.relief());
    });
    material.sheen_roughness->texture = texture("sheen_roughness.png", is_packed ? "a" : "r");
    put("anisotropy.png", 3, 8, [](const Point& p, auto& s) {
      s.insert(s.end(), {std::cos(p.angle()) / 2 + 0.5, std::sin(p.angle()) / 2 + 0.5, p.strength()});
    });
    material.anisotropy->texture = texture("anisotropy.png", "b");
    material.anisotropy_direction->texture = texture("anisotropy.png", "rg");
  }

  SampleOptions options_;
  SampleMaterial made_;
};

}  // namespace

TexturedMaterial constant_material() {
  TexturedMaterial material;
  material.name = "Plain weave, \"indigo\" & white";
  material.size_mm = {{8, 8}};
  material.repeats = true;
  material.base_color.constant = {0.4, 0.2, 0.1};
  material.base_color.source = "measured";
  material.normal = TexturedParameter{{}, {0, 0, 1}, "measured"};
  material.height_mm = TexturedParameter{{}, {0, 0, 0}, "derived"};
  material.roughness = TexturedParameter{{}, {0.55, 0, 0}, "assumed"};
  material.occlusion = TexturedParameter{{}, {0.85, 0, 0}, "derived"};
  material.opacity = TexturedParameter{{}, {1, 0, 0}, "measured"};
  material.f0 = TexturedParameter{{}, {0.04, 0, 0}, "assumed"};
  material.metallic = TexturedParameter{{}, {0, 0, 0}, "assumed"};
  material.anisotropy = TexturedParameter{{}, {0.5, 0, 0}, "derived"};
  material.anisotropy_direction = TexturedParameter{{}, {0.6, 0.8, 0}, "derived"};
  material.sheen_color = TexturedParameter{{}, {0.15, 0.15, 0.15}, "assumed"};
  material.sheen_roughness = TexturedParameter{{}, {0.5, 0, 0}, "assumed"};
  material.provenance = {{"session", "indigo.weft"}, {"source.roughness", "assumed"}};
  return material;
}

SampleMaterial sample_material(const SampleOptions& options) {
  return SampleMaker(options).make();
}

}  // namespace weft::exchange
