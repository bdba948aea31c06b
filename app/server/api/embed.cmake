# SPDX-License-Identifier: Apache-2.0
# cmake -DINPUT=scan.openapi.json -DFUNCTION=scan_description -DHEADER=app/server/api/descriptions.h
#   -DOUTPUT=scan_description.cpp -P embed.cmake
file(READ ${INPUT} text)
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"${HEADER}\"

namespace weft::app {

const char* ${FUNCTION}() {
  return R\"text(${text})text\";
}

}  // namespace weft::app
")
