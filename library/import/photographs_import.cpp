// SPDX-License-Identifier: Apache-2.0
#include "library/import/photographs_import.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "calibration/run/balls.h"
#include "capture/raw/decode_raw.h"
#include "core/base/files.h"
#include "core/base/text.h"
#include "core/image_io/image_io.h"
#include "library/import/description.h"
#include "solve/input/photo_input.h"
#include "solve/input/photo_mask.h"
#include "solve/input/session_photos.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

std::string stored_name(const std::string& name, const fs::path& source) {
  return fmt::format("{}/{}{}", solve::kPhotographsFolder, name, small_letters(source.extension().string()));
}

Result<void> decode(const solve::SolvePlan& photos) {
  for (const fs::path& file : photos.files()) {
    if (photos.raw) {
      if (const Result<RawFrame> frame = capture::decode_raw(file); !frame) return frame.error();
    } else if (const Result<LoadedImage> image = read_image(file); !image) {
      return image.error();
    }
  }
  return {};
}

/// A session of these photographs, as it will be written.
void put_shots(const solve::SolvePlan& photos, ProposedPhotographs& planned) {
  Session& session = planned.session;
  const auto put = [&](const Shot& taken, ShotRole role, const std::string& name, const std::string& sha256) {
    const fs::path source = photos.session.path_of(taken);
    Shot shot;
    shot.index = static_cast<int>(session.shots.size());
    shot.led = role == ShotRole::kDark ? 0 : taken.led;
    shot.role = role;
    shot.file = stored_name(name, source);
    shot.sha256 = sha256;
    shot.exposure_us = taken.exposure_us;
    shot.iso = taken.exposure_us > 0 ? taken.iso : 0;
    shot.document = {{"source", source.filename().string()}};
    session.shots.push_back(std::move(shot));
    planned.files.push_back(source);
  };
  for (std::size_t k = 0; k < photos.lit.size(); ++k) {
    const std::string name = fmt::format("{:03}", k + 1);
    put(photos.lit[k], ShotRole::kLit, name, photos.input.photographs[k].sha256);
    planned.lights.lights[k].photograph = fs::path(session.shots.back().file).filename();
  }
  if (photos.dark) put(*photos.dark, ShotRole::kDark, "unlit", photos.input.dark);
}

/// What people say of them, in their folder or above it.
Result<void> describe_by(const SourceFolders& found, const fs::path& folder, const std::string& name,
                         ProposedPhotographs& planned) {
  const auto root = std::ranges::find_if(found.roots, [&](const fs::path& each) {
    return (folder / "").string().starts_with((each / "").string());
  });
  planned.descriptions =
      descriptions_of(found.descriptions, root == found.roots.end() ? folder : *root, folder, name);
  Session& session = planned.session;
  session.document["imported"] = {{"from", planned.source.string()}, {"by", planned.lights.kind}};
  ImportDescription said;
  for (const fs::path& file : planned.descriptions) {
    const Result<ImportDescription> more = read_description(file);
    if (!more) return more.error();
    said.take(*more);
  }
  if (!said.fabric.empty()) session.fabric = said.fabric;
  if (!said.metadata.empty()) session.document["metadata"] = said.metadata;
  return {};
}

Result<void> fill(const solve::PhotoOptions& options, ProposedPhotographs& planned) {
  Result<solve::LightList> lights =
      solve::find_lights(options.light_file, {options.folder, options.skips_missing});
  if (!lights) return std::move(lights).error();
  const Result<solve::SolvePlan> photos = solve::plan_photos(options);
  if (!photos) return photos.error();
  if (Result<void> ok = decode(*photos); !ok) return ok;
  planned.lights = std::move(*lights);
  planned.mask = photos->mask;
  planned.assumed = photos->assumed;
  planned.session.photographs = options.reading;
  put_shots(*photos, planned);
  return {};
}

// As they are written and read again: unit vectors are made of that length once more.
bool are_same(const std::vector<solve::ListedLight>& there, const std::vector<solve::ListedLight>& wanted) {
  constexpr double kRounding = 1e-12;
  return std::ranges::equal(there, wanted, [](const auto& a, const auto& b) {
    return length(a.toward - b.toward) <= kRounding * length(b.toward) && a.strength_rgb == b.strength_rgb;
  });
}

/// Whether the session that is there holds these photographs under these lights.
bool is_same(const Session& there, const ProposedPhotographs& planned) {
  const auto is_same_shot = [](const Shot& is, const Shot& shall) {
    return is.led == shall.led && is.role == shall.role && is.sha256 == shall.sha256;
  };
  if (there.is_of_rig() || !std::ranges::equal(there.shots, planned.session.shots, is_same_shot))
    return false;
  const Result<solve::LightList> lights =
      solve::read_light_list(there.folder / solve::kPhotographsFolder / solve::kLightsFile);
  return lights && are_same(lights->lights, planned.lights.lights);
}

void refuse(Error error, ProposedPhotographs& planned) {
  planned.state = ImportState::kRefused;
  planned.refusal = std::move(error);
}

void look_for_session(ProposedPhotographs& planned) {
  if (planned.refusal || !is_there(planned.session.folder)) return;
  const Result<Session> stored = read_session(planned.session.folder);
  if (stored && is_same(*stored, planned)) {
    planned.state = ImportState::kThere;
    return;
  }
  refuse(Error{ErrorKind::kCannotCreate, "another session of that name is there",
               planned.session.folder.string(), "sessions are never overwritten",
               "import into another archive with -o, or rename the folder"},
         planned);
}

/// `folder` has the photographs, and what people say of them.
ProposedPhotographs planned_by(const solve::PhotoOptions& options, const fs::path& folder,
                               const std::string& name, const SourceFolders& found, const fs::path& archive) {
  ProposedPhotographs planned;
  planned.source = options.light_file.empty() ? options.folder : options.light_file;
  planned.session.fabric = name;
  planned.session.folder = archive / (file_name_of(name, "photographs") + ".weft");
  Result<void> ok = fill(options, planned);
  if (ok) ok = describe_by(found, folder, name, planned);
  if (!ok) refuse(std::move(ok).error(), planned);
  return planned;
}

/// Each under a name of its own, and none over what is there.
void place(const fs::path& archive, std::vector<ProposedPhotographs>& all) {
  std::set<fs::path> taken;
  for (ProposedPhotographs& planned : all) {
    const std::string stem = planned.session.folder.stem().string();
    for (int i = 2; !taken.insert(planned.session.folder).second; ++i)
      planned.session.folder = archive / fmt::format("{}_{}.weft", stem, i);
    look_for_session(planned);
  }
}

}  // namespace

std::vector<ProposedPhotographs> plan_photographs(const SourceFolders& found, const ImportOptions& options,
                                                  const fs::path& archive) {
  std::vector<ProposedPhotographs> all;
  solve::PhotoOptions photos;
  photos.reading = options.reading;
  photos.dark = options.dark;
  photos.skips_missing = options.takes_missing;
  std::map<fs::path, int> lists_of_folder;
  for (const fs::path& file : found.light_files) ++lists_of_folder[file.parent_path()];
  for (const fs::path& file : found.light_files) {
    // RTIBuilder keeps its light files in a folder of that name.
    const bool is_rtibuilder = file.parent_path().filename() == "assembly-files";
    const fs::path folder = is_rtibuilder ? file.parent_path().parent_path() : file.parent_path();
    const bool is_alone = lists_of_folder[file.parent_path()] == 1;
    std::string name = folder.filename().string();
    if (!is_alone) name += "_" + file.stem().string();
    photos.light_file = file;
    all.push_back(planned_by(photos, folder, name, found, archive));
  }
  photos.light_file.clear();
  for (const fs::path& folder : found.photo_folders) {
    photos.folder = folder;
    all.push_back(planned_by(photos, folder, folder.filename().string(), found, archive));
  }
  place(archive, all);
  return all;
}

std::vector<ProposedPhotographs> plan_photographs_with_balls(const ImportOptions& options,
                                                             const fs::path& archive, const fs::path& aside) {
  std::vector<ProposedPhotographs> all;
  for (const fs::path& each : options.folders) {
    const fs::path folder = absolute_folder(each);
    const std::string name = folder.filename().string();
    const fs::path place_aside = aside / std::to_string(all.size());
    calibration::BallsOptions balls = options.balls.value();
    balls.photographs = folder;
    balls.output = place_aside / solve::kLightsFile;
    balls.mask_folder = place_aside;
    balls.transfer = options.reading.transfer;
    Result<void> ok = make_writable_folder(place_aside);
    const Result<calibration::BallsReport> report =
        ok ? calibration::lights_by_balls(balls) : Result<calibration::BallsReport>(ok.error());
    if (!report) {
      ProposedPhotographs& refused = all.emplace_back();
      refused.source = folder;
      refused.session.folder = archive / (file_name_of(name, "photographs") + ".weft");
      refuse(report.error(), refused);
      continue;
    }
    solve::PhotoOptions photos;
    photos.light_file = report->list.file;
    photos.mask = report->mask;
    if (photos.mask.empty()) {
      if (Result<fs::path> own = solve::find_mask(folder)) photos.mask = std::move(*own);
    }
    photos.dark = options.dark;
    photos.reading = options.reading;
    if (!photos.reading.mm_per_pixel) photos.reading.mm_per_pixel = report->mm_per_pixel;
    SourceFolders beside;
    if (Result<SourceFolders> found = look_into({each})) beside = *std::move(found);
    ProposedPhotographs& planned = all.emplace_back(planned_by(photos, folder, name, beside, archive));
    planned.source = folder;
    planned.session.document["imported"] = {{"from", folder.string()}, {"by", "ball"}};
    planned.picture = report->picture;
    std::ranges::copy(report->notes, std::back_inserter(planned.assumed));
  }
  place(archive, all);
  return all;
}

void drop_used(const std::vector<ProposedPhotographs>& planned, SourceFolders& found) {
  std::set<fs::path> used;
  for (const ProposedPhotographs& each : planned) {
    for (const fs::path& file : each.files) used.insert(file.lexically_normal());
    used.insert(each.mask.lexically_normal());
  }
  std::erase_if(found.frames, [&](const SourceFile& frame) { return used.contains(frame.file); });
  std::erase_if(found.left_over, [&](const LeftOver& left) { return used.contains(left.file); });
  std::set<fs::path> refused;
  for (const ProposedPhotographs& each : planned) {
    std::error_code ignored;
    if (each.refusal)
      refused.insert(fs::is_directory(each.source, ignored) ? each.source : each.source.parent_path());
  }
  const auto is_of_refused = [&](const fs::path& file) {
    fs::path folder = file.parent_path();
    for (; folder.has_relative_path(); folder = folder.parent_path())
      if (refused.contains(folder)) return true;
    return false;
  };
  for (const fs::path& file : found.beside_lights)
    if (!used.contains(file) && !is_of_refused(file))
      found.left_over.push_back({file, "no light file names it"});
}

}  // namespace weft::library
