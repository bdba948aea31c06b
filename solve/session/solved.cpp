// SPDX-License-Identifier: Apache-2.0
#include "solve/session/solved.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>
#include <vector>

#include "core/base/files.h"
#include "core/base/product.h"
#include "core/solve/solve.h"
#include "solve/session/session_lock.h"

namespace weft::solve {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSessionDocument = "session.json";
constexpr const char* kPixel = "mm_per_pixel";

bool is_pixel(const Json& mm) {
  return mm.is_number() && mm.get<double>() >= kPixelOfPhotographs_mm.least &&
         mm.get<double>() <= kPixelOfPhotographs_mm.most;
}

// ./NAME-solve/<id> is called NAME.
std::string name_of_solve(const fs::path& folder, const std::string& id) {
  constexpr std::string_view kEnding = "-solve";
  const fs::path path = absolute_folder(folder);
  const std::string parent = path.parent_path().filename().string();
  if (path.filename() == id && parent.ends_with(kEnding))
    return parent.substr(0, parent.size() - kEnding.size());
  return path.filename().string();
}

// The photographs that a solve.json names; none of a session's.
std::vector<Shot> photographs_in(const SolveFacts& facts) {
  std::vector<Shot> shots;
  if (!facts.input) return shots;
  for (const DistantPhotograph& each : facts.input->photographs) {
    const int index = static_cast<int>(shots.size());
    Shot shot;
    shot.index = index;
    shot.led = index + 1;
    shot.file = each.file;
    shot.sha256 = each.sha256;
    shot.document = Json::object();
    shots.push_back(std::move(shot));
  }
  return shots;
}

Error is_of_solves(const fs::path& folder, const std::vector<Product>& solves) {
  return {ErrorKind::kUsage, "this folder is no solve", folder.string(),
          fmt::format("it holds {} of photographs, each in a folder of its own", solves.size()),
          fmt::format("name one of these, as {}", solves.back().folder.string())};
}

}  // namespace

Result<Session> read_solved(const fs::path& folder) {
  const fs::path file = folder / kSolveProduct.document;
  if (is_there(folder / kSessionDocument)) return read_session(folder);
  if (!is_there(file)) {
    const std::vector<Product> solves = list_products(kSolveProduct, folder);
    return solves.empty() ? read_session(folder) : Result<Session>(is_of_solves(folder, solves));
  }
  const Result<Json> document = read_json(file, kSolveProduct.schema, 1);
  if (!document) return document.error();
  const Result<SolveFacts> facts = solve_facts_from_json(*document, file.string());
  if (!facts) return facts.error();
  Session session;
  session.folder = folder;
  session.fabric = name_of_solve(folder, facts->id);
  session.shots = photographs_in(*facts);
  if (session.shots.empty()) {
    return Error{ErrorKind::kUsage, "this is one solve of a session", folder.string(),
                 "maps are made of the session that it lies in",
                 fmt::format("name the session, and of its solves this one with --solve {}", facts->id)};
  }
  session.document = Json::object();
  session.photographs.emplace();
  if (const auto mm = document->find(kPixel); mm != document->end()) {
    if (!is_pixel(*mm)) {
      return Error{ErrorKind::kBadData, "the size of a pixel is none", file.string(),
                   fmt::format("{} is {}", kPixel, mm->dump()),
                   fmt::format("write mm there, {:g} to {:g}, or take it out", kPixelOfPhotographs_mm.least,
                               kPixelOfPhotographs_mm.most)};
    }
    session.photographs->mm_per_pixel = mm->get<double>();
  }
  return session;
}

bool is_lone_solve(const Session& session) {
  return !session.is_of_rig() && !is_there(session.folder / kSessionDocument);
}

std::optional<PhotographedPixel> photographed_pixel(const Session& session) {
  if (session.is_of_rig()) return {};
  const std::optional<double>& mm = session.photographs->mm_per_pixel;
  return PhotographedPixel{mm.value_or(kAssumedMmPerPixel), mm.has_value()};
}

namespace {

Result<void> keep_in_solve(const fs::path& folder, double mm) {
  const fs::path file = folder / kSolveProduct.document;
  Result<Json> document = read_json(file, kSolveProduct.schema, 1);
  if (!document) return std::move(document).error();
  (*document)[kPixel] = mm;
  return write_json(file, *document);
}

}  // namespace

Result<void> keep_reading(const fs::path& folder, const PhotoReading& reading) {
  Result<Session> session = read_session(folder);
  if (!session) return std::move(session).error();
  if (session->photographs == reading) return {};
  const Result<Descriptor> lock = lock_session(folder);
  if (!lock) return lock.error();
  session = read_session(folder);
  if (!session) return std::move(session).error();
  session->photographs = reading;
  return write_session(*session);
}

Result<void> keep_pixel(const fs::path& folder, std::optional<double>& mm_per_pixel) {
  if (!mm_per_pixel) return {};
  const Result<Session> session = read_solved(folder);
  if (!session) return session.error();
  const std::optional<PhotographedPixel> pixel = photographed_pixel(*session);
  if (!pixel) return {};
  const double said = *std::exchange(mm_per_pixel, std::nullopt);
  if (pixel->is_known && pixel->mm == said) return {};
  if (is_lone_solve(*session)) return keep_in_solve(folder, said);
  PhotoReading reading = *session->photographs;
  reading.mm_per_pixel = said;
  return keep_reading(folder, reading);
}

std::string size_words(const SourceFacts& source) {
  if (source.is_size_known) return "";
  return fmt::format("the size is not known: {:.4g} mm a pixel is assumed; --mm-per-pixel says it",
                     source.pixel_mm.value_or(kAssumedMmPerPixel));
}

std::string why_other_size(const Session& session, const SourceFacts& source) {
  const std::optional<PhotographedPixel> pixel = photographed_pixel(session);
  if (!pixel || !pixel->is_known || (source.pixel_mm == pixel->mm && source.is_size_known)) return "";
  return fmt::format("a pixel of the photographs is {:.4g} mm, and they were made with {:.4g} mm", pixel->mm,
                     source.pixel_mm.value_or(kAssumedMmPerPixel));
}

void describe_size(Fields& fields, SourceFacts& source, const Json& document) {
  const bool is_said = document.is_object() && document.contains("size_known");
  fields.value({"photograph_mm_per_pixel", "Of photographs without a calibrated camera: theirs", kAboveZero},
               source.pixel_mm);
  fields.only_if(is_said || !source.is_size_known, [&] {
    fields.value({"size_known", "False: nobody said it, and millimetres are assumed"}, source.is_size_known);
  });
}

}  // namespace weft::solve
