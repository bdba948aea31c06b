# SPDX-License-Identifier: Apache-2.0
# cmake -DINPUT=openapi.json -DOUTPUT=openapi_text.cpp -P embed.cmake
file(READ ${INPUT} text)
file(WRITE ${OUTPUT} "// SPDX-License-Identifier: Apache-2.0
#include \"app/daemon/rig_routes.h\"

namespace weft::app {

const char* openapi_text() {
  return R\"openapi(${text})openapi\";
}

}  // namespace weft::app
")
