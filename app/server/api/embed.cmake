# SPDX-License-Identifier: Apache-2.0
# cmake -DINPUT=scan.openapi.json -DFUNCTION=scan_description -DOUTPUT=scan_description.cpp -P embed.cmake
file(READ ${INPUT} text)
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"app/server/api/descriptions.h\"

namespace weft::app {

const char* ${FUNCTION}() {
  return R\"text(${text})text\";
}

}  // namespace weft::app
")
