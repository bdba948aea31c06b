// SPDX-License-Identifier: Apache-2.0
// exchange-samples OUT: a file or more of every format, for programs that read them.
#include <cstdio>
#include <filesystem>
#include <string>

#include "core/base/files.h"
#include "core/base/sha256.h"
#include "exchange/gltf/glb.h"
#include "exchange/materialx/materialx.h"
#include "exchange/u3m/u3m.h"
#include "exchange/usd/usd.h"
#include "tests/exchange/sample_material.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

/// Writes below one folder and remembers whether all went well.
class SampleFolder {
 public:
  explicit SampleFolder(fs::path folder) : folder_(std::move(folder)) {}

  void write(const std::string& name, const Result<std::string>& bytes) {
    if (!bytes) return complain(name, bytes.error());
    const fs::path file = folder_ / name;
    std::error_code ignored;
    fs::create_directories(file.parent_path(), ignored);
    if (const auto written = write_file(file, *bytes); !written) complain(name, written.error());
  }

  void write(const std::string& name, const Result<Document>& document) {
    write(name, document ? Result<std::string>(document->bytes) : Result<std::string>(document.error()));
  }

  void write_files(const std::string& below, const SampleMaterial& sample) {
    for (const auto& [name, bytes] : sample.files) write(below + "/" + name, Result<std::string>(bytes));
  }

  bool is_whole() const { return is_whole_; }

 private:
  void complain(const std::string& name, const Error& error) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), error.message().c_str());
    is_whole_ = false;
  }

  fs::path folder_;
  bool is_whole_ = true;
};

void write_gltf(SampleFolder& folder) {
  const SampleMaterial full = sample_material();
  folder.write("gltf/full.glb", glb_of(full.material, full.bytes(), {{10, 5}, AlphaMode::kMask}));
  folder.write("gltf/blend.glb", glb_of(full.material, full.bytes(), {{1, 1}, AlphaMode::kBlend}));
  SampleOptions options;
  options.has_f0_texture = true;
  const SampleMaterial specular = sample_material(options);
  folder.write("gltf/specular.glb", glb_of(specular.material, specular.bytes()));
  options = {};
  options.has_sheen = options.has_opacity = false;
  for (const int bits : {8, 16}) {
    options.bits = bits;
    const SampleMaterial plain = sample_material(options);
    folder.write("gltf/plain" + std::to_string(bits) + ".glb", glb_of(plain.material, plain.bytes()));
  }
  options.size_mm.reset();
  const SampleMaterial unknown = sample_material(options);
  folder.write("gltf/unknown_size.glb", glb_of(unknown.material, unknown.bytes()));
  folder.write("gltf/constants.glb", glb_of(constant_material(), {}));
}

void write_materialx(SampleFolder& folder, const SampleMaterial& sample) {
  folder.write_files("materialx", sample);
  using Models = std::vector<SurfaceModel>;
  const std::array<std::pair<const char*, Models>, 4> sets = {
      {{"all", {SurfaceModel::kOpenPbr, SurfaceModel::kStandardSurface, SurfaceModel::kGltfPbr}},
       {"open_pbr", {SurfaceModel::kOpenPbr}},
       {"standard_surface", {SurfaceModel::kStandardSurface}},
       {"gltf_pbr", {SurfaceModel::kGltfPbr}}}};
  TexturedMaterial no_size = constant_material();
  no_size.size_mm.reset();
  for (const auto& [name, models] : sets) {
    MaterialXOptions options;
    options.models = models;
    folder.write("materialx/" + std::string(name) + ".mtlx", materialx_of(sample.material, options));
    folder.write("materialx/" + std::string(name) + "_constants.mtlx", materialx_of(no_size, options));
    options.has_displacement = true;
    folder.write("materialx/" + std::string(name) + "_displaced.mtlx",
                 materialx_of(sample.material, options));
    TexturedMaterial dusty = constant_material();
    dusty.name = "dust";
    dusty.size_mm = {{20, 30}};
    const std::vector<TexturedMaterial> layers = {sample.material, dusty, sample.material, dusty};
    folder.write("materialx/" + std::string(name) + "_mixed_by_vertex_color.mtlx",
                 materialx_mix_of("layered cloth", layers, {}, options));
    RuntimeWeights weights;
    weights.texture = Texture{"textures/anisotropy.png", {64, 64}, 8, "rgb", false, 1, 0};
    folder.write("materialx/" + std::string(name) + "_mixed_by_map.mtlx",
                 materialx_mix_of("layered cloth", layers, weights, options));
  }
}

void write_usd(SampleFolder& folder, const SampleMaterial& sample) {
  folder.write_files("usd", sample);
  const auto plain = usda_of(sample.material);
  folder.write("usd/cloth.usda", plain);
  folder.write("usd/ten.usda", usda_of(sample.material, {{10, 5}, ""}));
  folder.write("usd/beside.usda", usda_of(sample.material, {{1, 1}, "cloth.mtlx"}));
  folder.write("usd/cloth.mtlx", materialx_of(sample.material));
  folder.write("usd/constants.usda", usda_of(constant_material()));
  if (plain) folder.write("usd/cloth.usdz", usdz_of("cloth.usda", *plain, sample.bytes()));
}

void write_u3m(SampleFolder& folder, const SampleMaterial& sample) {
  folder.write_files("u3m", sample);
  U3mOptions options;
  options.description = "two lines\nof notes";
  options.created = "2026-11-21T14:25:01Z";
  options.modified = "2026-11-21T15:25:01+01:00";
  options.digest = sha256_of("a sample");
  options.physics = {0.4, 140, {{0.6, "cotton"}, {0.25, "polyamide"}, {0.15, "nettle"}}, "twill 2/1"};
  const auto document = u3m_of(sample.material, options);
  folder.write("u3m/cloth.u3m", document);
  options.physics = {};
  folder.write("u3m/constants.u3m", u3m_of(constant_material(), options));
  if (document) folder.write("u3m/cloth.u3ma", u3ma_of("cloth.u3m", *document, sample.bytes()));
}

int run(const fs::path& out) {
  SampleFolder folder(out);
  SampleOptions options;
  options.packing = Packing::kSeparate;
  const SampleMaterial sample = sample_material(options);
  write_gltf(folder);
  write_materialx(folder, sample);
  write_usd(folder, sample);
  write_u3m(folder, sample);
  return folder.is_whole() ? 0 : 1;
}

}  // namespace
}  // namespace weft::exchange

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: exchange-samples OUT\n");
    return 64;
  }
  return weft::exchange::run(arguments[1]);
}
