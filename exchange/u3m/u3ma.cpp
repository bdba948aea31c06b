// SPDX-License-Identifier: Apache-2.0
#include "exchange/archive/zip.h"
#include "exchange/image_kind.h"
#include "exchange/u3m/u3m.h"

namespace weft::exchange {

Result<std::string> u3ma_of(const std::string& name, const Document& document, const FileBytes& files) {
  const auto bad = [](const std::string& where, const std::string& why, const std::string& remedy) {
    return Error{ErrorKind::kBadData, "the U3MA archive cannot be written", where, why, remedy};
  };
  if (!name.ends_with(".u3m") || name.find('/') != std::string::npos) {
    return bad(name, "an archive holds one document whose name ends in .u3m", "name it so");
  }
  std::vector<ZipEntry> entries = {{name, document.bytes}};
  for (const std::string& file : document.files) {
    const auto found = files.find(file);
    if (found == files.end()) return bad(file, "its bytes were not given", "write it before the archive");
    const auto kind = kind_of_image(found->second);
    if (!kind || kind != kind_of_file_name(file) || *kind == ImageKind::kExr) {
      return bad(file, "it is no PNG, JPEG or TIFF as its name says", "write it as PNG");
    }
    entries.push_back({file, found->second});
  }
  return zip_of(entries, ZipKind::kStrict);
}

}  // namespace weft::exchange
