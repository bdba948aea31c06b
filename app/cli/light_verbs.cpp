// SPDX-License-Identifier: Apache-2.0
#include "app/cli/light_verbs.h"

#include "app/cli/verbs.h"

namespace weft::app {

std::vector<Verb> light_verbs() {
  return {copy_verb(), library_verb()};
}

}  // namespace weft::app
