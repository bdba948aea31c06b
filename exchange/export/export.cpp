// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/export.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "exchange/export/documents.h"
#include "exchange/export/encode_files.h"
#include "exchange/export/export_json.h"
#include "exchange/export/layers.h"
#include "exchange/export/plan.h"
#include "exchange/export/prepare.h"
#include "exchange/export/textured.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

Error is_taken(const fs::path& folder, std::string why) {
  return {ErrorKind::kCannotCreate, "output folder is taken", folder.string(), std::move(why),
          "name another folder with -o, or remove it"};
}

// What lies where an export is to go: nothing, an export that may be replaced, or an error for anything else.
Result<std::optional<ExportFacts>> earlier_export(const fs::path& folder) {
  if (!is_there(folder)) return std::optional<ExportFacts>();
  if (!is_there(folder / kExportProduct.document)) {
    std::error_code failed;
    if (fs::is_directory(folder, failed) && fs::is_empty(folder, failed) && !failed)
      return std::optional<ExportFacts>();
    return is_taken(folder, "it holds something other than an export");
  }
  Result<ExportFacts> facts = read_export(folder);
  if (!facts) return std::move(facts).error();
  std::set<std::string> ours = {kExportProduct.document};
  for (const ExportedTexture& each : facts->files) ours.insert(each.file);
  for (const WrittenDocument& each : facts->documents) ours.insert(each.name);
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, failed)) {
    const std::string name = fs::relative(entry.path(), folder, failed).generic_string();
    if (!entry.is_directory() && !ours.contains(name))
      return is_taken(folder, fmt::format("beside an earlier export it holds {}", name));
  }
  if (failed) return cannot_read(folder, failed.value());
  return std::optional<ExportFacts>(std::move(*facts));
}

// Whether every file that the document names is there.
bool is_whole(const fs::path& folder, const ExportFacts& facts) {
  return std::ranges::all_of(facts.files,
                             [&](const ExportedTexture& each) {
                               return !each.inside.empty() || is_there(folder / each.file);
                             }) &&
         std::ranges::all_of(facts.documents,
                             [&](const WrittenDocument& each) { return is_there(folder / each.name); });
}

// An earlier export goes only once the new one is whole, and comes back where that cannot take its place.
Result<void> publish(PartialFolder& partial, const fs::path& target) {
  if (!is_there(target)) return partial.publish();
  const fs::path old =
      target.parent_path() / fmt::format(".{}.old-{}", target.filename().string(), ::getpid());
  std::error_code failed;
  fs::rename(target, old, failed);
  if (failed) return cannot_write(target, failed.value());
  Result<void> published = partial.publish();
  if (!published) {
    fs::rename(old, target, failed);
    return published;
  }
  fs::remove_all(old, failed);
  return {};
}

// One plan on its way to its folder.
struct Work {
  const PlannedExport* plan = nullptr;
  std::unique_ptr<PartialFolder> partial;
  ExportReport report;
};

// Textures of one number, which the documents say and no document names.
void drop_numbers(const std::vector<WrittenDocument>& documents, const fs::path& folder,
                  std::vector<EncodedFile>& files) {
  if (documents.empty()) return;
  std::vector<std::string> named;
  for (const WrittenDocument& document : documents)
    named.insert(named.end(), document.files.begin(), document.files.end());
  const auto is_dropped = [&](const EncodedFile& file) { return is_said_as_number(file, named); };
  for (const EncodedFile& file : files) {
    std::error_code ignored;
    if (is_dropped(file)) fs::remove(folder / file.name, ignored);
    if (is_dropped(file)) fs::remove((folder / file.name).parent_path(), ignored);  // where it is empty
  }
  std::erase_if(files, is_dropped);
}

Result<void> finish(Work& work, const MapFolder& folder, const Json& provenance,
                    const std::vector<EncodedFile>& files, const JobContext& context) {
  Stopwatch watch;
  const fs::path& aside = work.partial->path();
  Result<std::vector<WrittenDocument>> documents = write_documents(*work.plan, folder, files, aside);
  if (!documents) return std::move(documents).error();
  std::vector<EncodedFile> all = files;
  for (const PlannedDocument& planned : work.plan->documents) {
    if (planned.kind != exchange::DocumentKind::kLayers) continue;
    const Result<WrittenLayers> layers = write_layers(*work.plan, planned, folder, files, aside, context);
    if (!layers) return layers.error();
    all.insert(all.end(), layers->files.begin(), layers->files.end());
    documents->insert(documents->end(), layers->documents.begin(), layers->documents.end());
  }
  drop_numbers(*documents, aside, all);
  work.report.facts = export_facts(*work.plan, folder, provenance, all, *documents);
  if (Result<void> ok = write_json(aside / kExportProduct.document, json_of(work.report.facts)); !ok)
    return ok;
  work.report.seconds = watch.lap();
  for (const EncodedFile& file : files) work.report.seconds += file.seconds;
  return {};
}

Result<void> make_all(std::vector<Work>& works, const MapFolder& folder, const ExportOptions& options,
                      const JobContext& context) {
  std::vector<EncodeTarget> targets;
  std::vector<Work*> wanted;
  std::uint64_t bytes = 0;
  // Each knows which parents were not there before any of them.
  for (Work& work : works) {
    if (!work.report.was_there) work.partial = std::make_unique<PartialFolder>(work.plan->folder);
  }
  for (Work& work : works) {
    if (work.report.was_there) continue;
    bytes += most_bytes(*work.plan);
    if (Result<void> ok = begin(*work.partial, bytes); !ok) return ok;
    targets.push_back({work.plan, work.partial->path()});
    wanted.push_back(&work);
  }
  if (wanted.empty()) return {};
  const Result<Json> provenance = provenance_of(folder);
  if (!provenance) return provenance.error();
  const Result<std::vector<std::vector<EncodedFile>>> files =
      encode_files(folder, targets, options.is_dx10, context);
  if (!files) return files.error();
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (Result<void> ok = finish(*wanted[i], folder, *provenance, (*files)[i], context); !ok) return ok;
  }
  for (Work* work : wanted) {
    if (context.stop.stop_requested()) return interrupted();
    if (Result<void> ok = publish(*work->partial, work->plan->folder); !ok) return ok;
  }
  return {};
}

}  // namespace

Result<std::vector<ExportReport>> export_maps(const ExportOptions& asked, const JobContext& context) {
  const Result<PreparedExport> prepared = prepare_export(asked, context);
  if (!prepared) return prepared.error();
  std::vector<Work> works;
  for (const PlannedExport& plan : prepared->plans) {
    Result<std::optional<ExportFacts>> earlier = earlier_export(plan.folder);
    if (!earlier) return std::move(earlier).error();
    Work work = {.plan = &plan,
                 .partial = nullptr,
                 .report = {.folder = plan.folder, .source = source_of(prepared->folder)}};
    if (*earlier && (*earlier)->id == plan.id && is_whole(plan.folder, **earlier)) {
      work.report.was_there = true;
      work.report.facts = std::move(**earlier);
    }
    works.push_back(std::move(work));
  }
  if (Result<void> ok = make_all(works, prepared->folder, prepared->options, context); !ok)
    return std::move(ok).error();
  std::vector<ExportReport> reports;
  for (Work& work : works) reports.push_back(std::move(work.report));
  context.progress("encode", 1);
  return reports;
}

}  // namespace weft::app
