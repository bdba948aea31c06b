// SPDX-License-Identifier: Apache-2.0
#include "material/assets/build_request.h"

#include "core/describe/described_fields.h"

namespace weft::material {

void describe(Fields& fields, BuildRequest& r) {
  fields.value({.name = "files",
                .says = "TOML files, or library:NAME",
                .need = kMustSay,
                .option = "material",
                .said = Said::kAtThisMachine},
               r.files);
  describe_output(fields, r.output,
                  "Folder that all built materials go into, by their ids; default build/ beside each file");
  describe_compression(fields, r.compose.compression);
  fields.value({.name = "pictures", .says = "No preview.png", .option = "!--no-pictures"},
               r.compose.has_pictures);
}

}  // namespace weft::material
