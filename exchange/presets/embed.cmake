# SPDX-License-Identifier: Apache-2.0
# cmake -DINPUTS="a.toml;b.toml" -DOUTPUT=shipped_presets.cpp -P embed.cmake
set(rows "")
foreach(input ${INPUTS})
  get_filename_component(name ${input} NAME_WE)
  file(READ ${input} text)
  string(APPEND rows "      {\"${name}\", R\"text(${text})text\"},\n")
endforeach()
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"exchange/presets/preset.h\"

namespace weft::exchange {

const std::vector<ShippedPreset>& shipped_presets() {
  static const std::vector<ShippedPreset> presets = {
${rows}  };
  return presets;
}

}  // namespace weft::exchange
")
