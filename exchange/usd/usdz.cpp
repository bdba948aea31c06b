// SPDX-License-Identifier: Apache-2.0
#include "exchange/archive/zip.h"
#include "exchange/image_kind.h"
#include "exchange/usd/usd.h"

namespace weft::exchange {

Result<std::string> usdz_of(const std::string& layer_name, const Document& layer, const FileBytes& files) {
  const auto bad = [](const std::string& where, const std::string& why, const std::string& remedy) {
    return Error{ErrorKind::kBadData, "the usdz package cannot be written", where, why, remedy};
  };
  if (!layer_name.ends_with(".usda")) {
    return bad(layer_name, "the first file of a package is a layer", "name it with .usda at its end");
  }
  std::vector<ZipEntry> entries = {{layer_name, layer.bytes}};
  for (const std::string& file : layer.files) {
    const auto found = files.find(file);
    if (found == files.end()) return bad(file, "its bytes were not given", "write it before the package");
    const auto kind = kind_of_image(found->second);
    if (!kind || *kind == ImageKind::kTiff) {
      return bad(file, "a package holds PNG, JPEG and EXR alone", "write it as PNG");
    }
    entries.push_back({file, found->second});
  }
  return zip_of(entries, ZipKind::kAligned);
}

}  // namespace weft::exchange
