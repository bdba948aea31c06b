# SPDX-License-Identifier: Apache-2.0
# cmake -DFOLDER=material/templates -DOUTPUT=templates.cpp -P embed_templates.cmake
file(GLOB_RECURSE files RELATIVE ${FOLDER} ${FOLDER}/*.toml)
list(SORT files)
set(text "// SPDX-License-Identifier: Apache-2.0
#include \"material/assets/material_place.h\"

namespace weft::material {

const std::vector<ShippedMaterial>& shipped_materials() {
  static const std::vector<ShippedMaterial> materials = {
")
foreach(each ${files})
  file(READ ${FOLDER}/${each} toml)
  string(REGEX REPLACE "\\.toml$" "" name ${each})
  string(APPEND text "{\"${name}\", R\"text(${toml})text\"},\n")
endforeach()
file(WRITE ${OUTPUT} "${text}};\n  return materials;\n}\n\n}  // namespace weft::material\n")
