// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "exchange/usd/usda_text.h"

namespace weft::exchange {

namespace {

/// The parts of the preview surface: what it is told, and the texture shaders below.
class PreviewSurface {
 public:
  PreviewSurface(const TexturedMaterial& material, std::string path, Document& document)
      : material_(material), path_(std::move(path)), document_(document) {}

  void gather() {
    color();
    scalar("metallic", material_.metallic);
    scalar("occlusion", material_.occlusion);
    scalar("roughness", material_.roughness);
    if (material_.metallic == std::nullopt) inputs_.push_back("float inputs:metallic = 0");
    opacity();
    normal();
    reflectance();
    inputs_.push_back("int inputs:useSpecularWorkflow = 0");
    const auto leave_out = [&](bool is_there, const char* words) {
      if (is_there) document_.left_out.push_back(words);
    };
    leave_out(material_.sheen_color.has_value(), "sheen: UsdPreviewSurface has none");
    leave_out(material_.anisotropy.has_value(),
              "anisotropy: UsdPreviewSurface has none, roughness is that across the highlight");
    leave_out(material_.height_mm.has_value(), "height_mm: the normals show the relief");
  }

  void write(UsdaWriter& usda) const {
    usda.begin_block("def Shader \"surface\"");
    usda.line("uniform token info:id = \"UsdPreviewSurface\"");
    for (const std::string& input : inputs_) usda.line(input);
    usda.line("token outputs:surface");
    usda.end_block();
    if (textures_.empty()) return;
    usda.blank();
    usda.begin_block("def Shader \"st\"");
    usda.line("uniform token info:id = \"UsdPrimvarReader_float2\"");
    usda.line("float2 inputs:fallback = (0, 0)");
    usda.line("string inputs:varname = \"st\"");
    usda.line("float2 outputs:result");
    usda.end_block();
    for (const Shader& shader : textures_) write(usda, shader);
  }

 private:
  struct Shader {
    std::string name, output;
    const Texture* texture;
    std::vector<double> scale, bias;
  };

  void write(UsdaWriter& usda, const Shader& shader) const {
    const std::string wrap = material_.repeats ? "\"repeat\"" : "\"clamp\"";
    usda.blank();
    usda.begin_block("def Shader \"" + shader.name + "\"");
    usda.line("uniform token info:id = \"UsdUVTexture\"");
    if (shader.bias != std::vector<double>{0, 0, 0, 0}) {
      usda.line("float4 inputs:bias = " + usda_tuple(shader.bias));
    }
    usda.line("asset inputs:file = " + usda_asset(shader.texture->file));
    if (shader.scale != std::vector<double>{1, 1, 1, 1}) {
      usda.line("float4 inputs:scale = " + usda_tuple(shader.scale));
    }
    usda.line(std::string("token inputs:sourceColorSpace = ") +
              (shader.texture->is_srgb ? "\"sRGB\"" : "\"raw\""));
    usda.line("float2 inputs:st.connect = <" + path_ + "/st.outputs:result>");
    usda.line("token inputs:wrapS = " + wrap);
    usda.line("token inputs:wrapT = " + wrap);
    usda.line((shader.output == "rgb" ? "float3" : "float") + std::string(" outputs:") + shader.output);
    usda.end_block();
  }

  void connect(const std::string& input, const std::string& name, const Texture& texture,
               const std::vector<double>& scale, const std::vector<double>& bias) {
    if (std::ranges::find(document_.files, texture.file) == document_.files.end()) {
      document_.files.push_back(texture.file);
    }
    textures_.push_back({name, texture.channels, &texture, scale, bias});
    inputs_.push_back(input + ".connect = <" + path_ + "/" + name + ".outputs:" + texture.channels + ">");
  }

  void color() {
    const TexturedParameter& color = material_.base_color;
    const std::string input = "color3f inputs:diffuseColor";
    if (color.texture) {
      const double s = color.texture->scale, o = color.texture->offset;
      connect(input, "base_color", *color.texture, {s, s, s, 1}, {o, o, o, 0});
    } else {
      inputs_.push_back(input + " = " + usda_tuple({color.constant.begin(), color.constant.end()}));
    }
  }

  void scalar(const std::string& name, const std::optional<TexturedParameter>& parameter) {
    if (!parameter) return;
    const std::string input = "float inputs:" + name;
    if (parameter->texture) {
      const double s = parameter->texture->scale, o = parameter->texture->offset;
      connect(input, name, *parameter->texture, {s, s, s, s}, {o, o, o, o});
    } else {
      inputs_.push_back(input + " = " + number_text(parameter->constant[0]));
    }
  }

  void opacity() {
    scalar("opacity", material_.opacity);
    if (material_.opacity && material_.opacity->texture) {
      inputs_.push_back("float inputs:opacityThreshold = 0.5");
    }
  }

  void normal() {
    if (!material_.normal || !material_.normal->texture) return;
    connect("normal3f inputs:normal", "normal", *material_.normal->texture, {2, 2, 2, 1}, {-1, -1, -1, 0});
  }

  void reflectance() {
    if (!material_.f0) return;
    inputs_.push_back("float inputs:ior = " + number_text(ior_of_f0(material_.f0->constant[0])));
    if (material_.f0->texture) {
      document_.left_out.push_back("f0: UsdPreviewSurface has one index of refraction, that of the mean");
    }
  }

  const TexturedMaterial& material_;
  std::string path_;
  Document& document_;
  std::vector<std::string> inputs_;
  std::vector<Shader> textures_;
};

}  // namespace

void write_usda_material(UsdaWriter& usda, const TexturedMaterial& material, const std::string& path,
                         const std::string& materialx_file, Document& document) {
  PreviewSurface surface(material, path, document);
  surface.gather();
  const std::string name = path.substr(path.rfind('/') + 1);
  if (materialx_file.empty()) {
    usda.begin_block("def Material \"" + name + "\"");
  } else {
    usda.begin_list("def Material \"" + name + "\" (");
    usda.line("prepend references = " + usda_asset(materialx_file) + "</MaterialX/Materials/" +
              identifier_of(material.name) + ">");
    usda.end_list(")");
    usda.begin_list("{");
  }
  usda.line("token outputs:surface.connect = <" + path + "/surface.outputs:surface>");
  usda.blank();
  surface.write(usda);
  usda.end_block();
}

}  // namespace weft::exchange
