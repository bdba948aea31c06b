# SPDX-License-Identifier: Apache-2.0
# cmake -DSOURCE=. -DOUTPUT=commit.cpp -P commit.cmake: the commit that SOURCE stands at as a function of
# app/cli/commit.h, "" where it is no clone. The file is written only when it says something else than before.
execute_process(
  COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
  OUTPUT_VARIABLE commit ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(failed)
  set(commit "")
endif()
# A tarball that lies inside somebody else's clone.
if(NOT EXISTS ${SOURCE}/.git)
  set(commit "")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT "// SPDX-License-Identifier: Apache-2.0
#include \"app/cli/commit.h\"

namespace weft::app {

const char* commit() {
  return \"@commit@\";
}

}  // namespace weft::app
")
