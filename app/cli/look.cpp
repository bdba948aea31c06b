// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "capture/camera/photograph_facts.h"
#include "capture/frames/picture_meaning.h"
#include "core/base/files.h"
#include "core/base/text.h"
#include "core/describe/field_json.h"
#include "core/rig/exposure_words.h"
#include "material/read/file_meaning.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct LookArguments {
  std::vector<std::filesystem::path> files;
};

// "NIKON D5100, 35 mm f/1.8, 12.5 ms, ISO 100, f/8"; empty where nothing is said.
std::string taken_in_words(const capture::PictureMeaning& picture) {
  std::vector<std::string> words;
  for (const std::string& text : {picture.model, picture.lens}) {
    if (!text.empty()) words.push_back(text);
  }
  if (picture.exposure_us > 0) words.push_back(exposure_words(picture.exposure_us));
  if (picture.iso > 0) words.push_back(fmt::format("ISO {:g}", picture.iso));
  if (picture.f_number > 0) words.push_back(fmt::format("f/{:g}", picture.f_number));
  return fmt::format("{}", fmt::join(words, ", "));
}

// What its channels hold as a map, where that is known.
std::vector<std::string> held_by(const std::filesystem::path& file) {
  std::vector<std::string> held;
  const Result<material::FileMeaning> map = material::meaning_of(file);
  if (!map) return held;
  for (const material::ChannelMeaning& channel : map->channels) {
    if (!channel.is.empty()) held.push_back(channel.is);
  }
  return held;
}

void print_words(const capture::PictureMeaning& picture) {
  print(fmt::format("{}: {}, {} x {}, {} of {}", picture.file.string(), picture.format, picture.size.width,
                    picture.size.height, picture.samples, fmt::join(picture.channels, ", ")));
  print("  light:   " + capture::transfer_words(picture));
  if (picture.orientation != 1) {
    print(fmt::format("  shown:   {} (orientation {})", orientation_words(picture.orientation),
                      picture.orientation));
  }
  if (picture.origin != std::array<int, 2>{})
    print(fmt::format("  window:  begins at {}, {} of its picture", picture.origin[0], picture.origin[1]));
  if (const std::string taken = taken_in_words(picture); !taken.empty()) print("  taken:   " + taken);
  if (const std::vector<std::string> held = held_by(picture.file); !held.empty())
    print(fmt::format("  holds:   {}", fmt::join(held, ", ")));
  for (const std::string& what : picture.passed_over) print("  unused:  " + what);
  if (picture.unfit) print("  not to be solved from: " + picture.unfit->why);
}

Json json_of_picture(const capture::PictureMeaning& picture) {
  Json document = object_of(picture);
  document["file"] = picture.file.string();
  document["holds"] = held_by(picture.file);
  document["unfit"] = picture.unfit ? Json(picture.unfit->why) : Json();
  return document;
}

// The files of a folder that are pictures by their names, as people count.
Result<std::vector<fs::path>> pictures_of(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
    const fs::path& file = entry->path();
    const std::string name = file.filename().string();
    const bool is_named_so = is_linear_image(file) || capture::is_raw_name(file);
    std::error_code ignored;
    if (is_named_so && !name.starts_with('.') && !entry->is_directory(ignored)) files.push_back(file);
  }
  if (failed) return cannot_read(folder, failed.value());
  std::ranges::sort(files, [](const fs::path& x, const fs::path& y) {
    return stands_before(x.filename().string(), y.filename().string());
  });
  if (!files.empty()) return files;
  return Error{ErrorKind::kNoInput, "there are no pictures", folder.string(),
               "no file in it has the ending of a photograph or a raw", "name the folder that has them"};
}

std::string line_of(const capture::PictureMeaning& picture) {
  std::string line =
      fmt::format("{} x {}, {} of {}; {}", picture.size.width, picture.size.height, picture.samples,
                  fmt::join(picture.channels, ", "), capture::transfer_words(picture));
  if (picture.orientation != 1) line += fmt::format("; shown {}", orientation_words(picture.orientation));
  if (const std::string taken = taken_in_words(picture); !taken.empty()) line += "; " + taken;
  if (picture.unfit) line += "; not to be solved from: " + picture.unfit->why;
  return line;
}

// A line each, also for one that cannot be read.
Result<void> look_into(const fs::path& folder, bool as_json, Json& pictures) {
  const Result<std::vector<fs::path>> files = pictures_of(folder);
  if (!files) return files.error();
  std::size_t width = 0;
  for (const fs::path& file : *files) width = std::max(width, file.filename().string().size());
  for (const fs::path& file : *files) {
    const Result<capture::PictureMeaning> picture = capture::meaning_of_picture(file);
    if (as_json) {
      pictures.push_back(picture ? json_of_picture(*picture)
                                 : Json{{"file", file.string()}, {"unfit", picture.error().why}});
    } else {
      print(fmt::format("{:{}}  {}", file.filename().string(), width,
                        picture ? line_of(*picture) : "cannot be read: " + picture.error().why));
    }
  }
  return {};
}

Result<int> look(const LookArguments& a, const CommonArguments& common) {
  Json pictures = Json::array();
  for (const fs::path& file : a.files) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored)) {
      if (Result<void> ok = look_into(file, common.json, pictures); !ok) return std::move(ok).error();
      continue;
    }
    const Result<capture::PictureMeaning> picture = capture::meaning_of_picture(file);
    if (!picture) return picture.error();
    if (common.json) {
      pictures.push_back(json_of_picture(*picture));
    } else {
      print_words(*picture);
    }
  }
  if (common.json) print_json({{"pictures", std::move(pictures)}});
  return kDone;
}

Run add_look(Options& options) {
  const auto a = std::make_shared<LookArguments>();
  options.add("files", &a->files, "Photographs, raws or maps; of a folder each picture in a line").required();
  return [a](const CommonArguments& common) { return look(*a, common); };
}

}  // namespace

Verb look_verb() {
  return {"look", "What picture files mean: how they follow light, which way up, how they were taken",
          add_look};
}

}  // namespace weft::app
