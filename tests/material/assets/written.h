// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "material/assets/resolve.h"

namespace weft::material {

/// Materials in memory, in the folder /m: their texts without the line `schema`, by name.
using Written = std::map<std::string, std::string>;

inline MaterialSource source_of(const Written& files) {
  return {
      [&files](const std::string& written, const std::filesystem::path& folder) -> Result<MaterialPlace> {
        if (written.starts_with(kLibraryPrefix)) return find_material(written, {});
        const std::filesystem::path file = (folder.empty() ? std::filesystem::path("/m") : folder) / written;
        if (!files.contains(file.filename().string()))
          return Error{ErrorKind::kNoInput, "there is no such material", file.string(),
                       "no file has this name", ""};
        return MaterialPlace{file.string(), file};
      },
      [&files](const MaterialPlace& place) {
        return place.is_shipped()
                   ? read_material(place)
                   : parse_material(
                         "schema = \"weft.material/1\"\n" + files.at(place.file.filename().string()), place);
      }};
}

inline MaterialPlace written_place(const std::string& name) {
  return {"/m/" + name, "/m/" + name};
}

inline ResolvedMaterial resolved(const Written& files, const std::string& name) {
  Result<ResolvedMaterial> material = resolve_material(written_place(name), source_of(files));
  EXPECT_TRUE(material) << material.error().message();
  return material ? std::move(*material) : ResolvedMaterial();
}

/// The message; empty where it is not refused.
inline std::string refused(const Written& files, const std::string& name,
                           ErrorKind kind = ErrorKind::kBadData) {
  const Result<ResolvedMaterial> material = resolve_material(written_place(name), source_of(files));
  if (material) return "";
  EXPECT_EQ(material.error().kind, kind) << material.error().message();
  return material.error().message();
}

}  // namespace weft::material
