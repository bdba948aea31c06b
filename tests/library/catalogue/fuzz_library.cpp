// SPDX-License-Identifier: Apache-2.0
// libFuzzer program: any bytes as the words of a search, and as the document of what is said of a cloth.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "core/base/temporary_folder.h"
#include "library/catalogue/catalogue.h"
#include "library/catalogue/metadata.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace weft;
  static const TemporaryFolder folder;
  static Result<library::Catalogue> catalogue = library::Catalogue::open(folder.path() / "library.sqlite");
  if (!catalogue) std::abort();
  const std::string text(reinterpret_cast<const char*>(data), size);

  // Words are never a language: there are too many of them, or they are looked for.
  const Result<library::CataloguePage> page = catalogue->find({.words = text});
  if (!page && page.error().kind != ErrorKind::kUsage) std::abort();
  const Result<library::CataloguePage> filtered = catalogue->find({.id = text, .tag = text, .from = text});
  if (!filtered || filtered->total != 0) std::abort();

  const Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) return 0;
  const Result<library::Metadata> metadata = library::metadata_from_json(document, "metadata");
  if (metadata && metadata->tags.size() > library::kMostTags) std::abort();
  if (metadata && metadata->notes.size() > library::kLongestNotes) std::abort();
  // What a scan may begin with, the library can read.
  if (library::check_new_metadata(document) && !metadata) std::abort();
  return 0;
}
