// SPDX-License-Identifier: Apache-2.0
#include "calibration/run/accept.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>
#include <system_error>
#include <utility>
#include <variant>

#include "calibration/run/last_check.h"
#include "capture/rig.h"
#include "core/base/files.h"

namespace weft::calibration {
namespace {

namespace fs = std::filesystem;

Error not_acceptable(const fs::path& calibration, std::string why, std::string remedy) {
  return {ErrorKind::kBadData, "the calibration cannot be the rig's", calibration.string(), std::move(why),
          std::move(remedy)};
}

std::vector<std::string> without(std::vector<std::string> parts, const std::vector<std::string>& others) {
  std::erase_if(parts, [&](const std::string& part) { return std::ranges::count(others, part) > 0; });
  return parts;
}

Result<void> check_usable(const Calibration& calibration, const fs::path& folder) {
  if (calibration.camera && calibration.response && calibration.lights) return {};
  return not_acceptable(folder, fmt::format("it has only {}", fmt::join(parts_of(calibration), ", ")),
                        "measure what is missing: weft calibrate --help");
}

Result<void> check_same_rig(const Calibration& before, const Calibration& after, const fs::path& folder) {
  const CalibrationSubject &a = before.subject, &b = after.subject;
  const bool same_body = a.camera_model == b.camera_model && a.camera_serial == b.camera_serial;
  const bool same_size = !before.camera || before.camera->size == after.camera->size;
  if (same_body && a.f_number == b.f_number && same_size) return {};
  return not_acceptable(folder,
                        fmt::format("it is of {} {} at f/{:g}, the rig has {} {} at f/{:g}", b.camera_model,
                                    b.camera_serial, b.f_number, a.camera_model, a.camera_serial, a.f_number),
                        "name a calibration of this rig's camera");
}

std::string warning_of(const fs::path& folder, const std::string& id) {
  const std::optional<LastCheck> check = last_check_of(folder, id);
  if (!check) return "nobody has checked it: weft capture check, weft calibrate check";
  return check->passed ? "" : fmt::format("the check of {} did not pass", check->date);
}

/// The text with a [scan] calibration of this value.
std::string with_calibration(const std::string& text, const std::string& value) {
  static const std::regex section(R"(^\s*\[.*)"), scan(R"(^\s*\[\s*scan\s*\]\s*(#.*)?$)"),
      key(R"(^\s*calibration\s*=.*$)");
  const std::string line = fmt::format("calibration = \"{}\"", value);
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string each; std::getline(in, each);) lines.push_back(each);
  std::size_t in_scan = lines.size();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (std::regex_match(lines[i], scan)) {
      in_scan = i;
    } else if (in_scan < i && std::regex_match(lines[i], section)) {
      break;
    } else if (in_scan < i && std::regex_match(lines[i], key)) {
      lines[i] = line;
      return fmt::format("{}\n", fmt::join(lines, "\n"));
    }
  }
  if (in_scan == lines.size()) {
    lines.insert(lines.end(), {"", "[scan]", line});
  } else {
    lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(in_scan) + 1, line);
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

}  // namespace

std::vector<std::string> parts_of(const Calibration& calibration) {
  std::vector<std::string> parts;
  if (calibration.camera) parts.emplace_back("camera");
  if (calibration.response) parts.emplace_back("response");
  if (calibration.lights) parts.emplace_back("lights");
  if (calibration.color) parts.emplace_back("color");
  return parts;
}

Result<CalibrationChange> change_between(const fs::path& from, const fs::path& to) {
  const Result<Calibration> after = read_calibration(to);
  if (!after) return after.error();
  if (Result<void> ok = check_usable(*after, to); !ok) return ok.error();
  CalibrationChange change;
  change.new_id = after->id;
  change.warning = warning_of(to, after->id);
  if (from.empty()) {
    change.gained = parts_of(*after);
    return change;
  }
  const Result<Calibration> before = read_calibration(from);
  if (!before) return before.error();
  if (Result<void> ok = check_same_rig(*before, *after, to); !ok) return ok.error();
  change.old_id = before->id;
  change.gained = without(parts_of(*after), parts_of(*before));
  change.lost = without(parts_of(*before), parts_of(*after));
  const auto* old_lights = before->lights ? std::get_if<NearLights>(&*before->lights) : nullptr;
  const auto* new_lights = std::get_if<NearLights>(&*after->lights);
  const bool are_comparable = before->camera && old_lights != nullptr && new_lights != nullptr &&
                              old_lights->leds.size() == new_lights->leds.size();
  if (are_comparable) change.maps = cost_of(*before->camera, *old_lights, *after->camera, *new_lights);
  return change;
}

Json json_of(const CalibrationChange& change) {
  Json maps;
  if (change.maps) {
    maps = {{"mean_deg", change.maps->mean_deg},
            {"worst_deg", change.maps->worst_deg},
            {"albedo_factor", 1 / change.maps->albedo_factor},
            {"albedo_unevenness", change.maps->albedo_unevenness}};
  }
  return {{"from", change.old_id},   {"to", change.new_id}, {"maps", std::move(maps)},
          {"gained", change.gained}, {"lost", change.lost}, {"warning", change.warning}};
}

std::vector<std::string> words_of(const CalibrationChange& change) {
  std::vector<std::string> lines;
  if (change.maps) {
    lines.push_back(fmt::format("normals turn by {:.2g} degrees on average, {:.2g} at worst",
                                change.maps->mean_deg, change.maps->worst_deg));
    lines.push_back(
        fmt::format("albedo becomes {:.3g} times what it was, uneven by {:.2g} percent over the frame",
                    1 / change.maps->albedo_factor, 100 * change.maps->albedo_unevenness));
  } else {
    lines.emplace_back(
        "what maps become cannot be told: the rig had no camera or no near lights to compare by");
  }
  if (!change.gained.empty()) lines.push_back(fmt::format("it gains {}", fmt::join(change.gained, ", ")));
  if (!change.lost.empty()) lines.push_back(fmt::format("it loses {}", fmt::join(change.lost, ", ")));
  return lines;
}

Result<void> name_calibration(const fs::path& rig_file, const fs::path& calibration) {
  const Result<std::string> text = read_text(rig_file);
  if (!text) return text.error();
  const fs::path folder = absolute_folder(calibration);
  const fs::path beside = folder.lexically_relative(
      absolute_folder(rig_file.parent_path().empty() ? "." : rig_file.parent_path()));
  const bool is_inside = !beside.empty() && *beside.begin() != "..";
  fs::path aside = rig_file;
  aside += ".new";
  if (Result<void> ok = write_file(aside, with_calibration(*text, (is_inside ? beside : folder).string()));
      !ok)
    return ok;
  const Result<capture::Rig> read = capture::read_rig(aside);
  std::error_code failed;
  const bool is_meant = read && absolute_folder(read->scan.calibration) == folder;
  if (is_meant) {
    fs::rename(aside, rig_file, failed);
    if (!failed) return sync_path(rig_file.parent_path().empty() ? "." : rig_file.parent_path());
  }
  fs::remove(aside, failed);
  return Error{ErrorKind::kBadData, "the rig file cannot be changed", rig_file.string(),
               read ? "its line of the calibration was not found" : read.error().message(),
               fmt::format("write calibration = \"{}\" under [scan] by hand", folder.string())};
}

}  // namespace weft::calibration
