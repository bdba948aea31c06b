// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/exit_code.h"
#include "app/cli/options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "capture/frames/picture_meaning.h"
#include "core/describe/field_json.h"
#include "core/rig/exposure_words.h"
#include "material/read/file_meaning.h"

namespace weft::app {
namespace {

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

Result<int> look(const LookArguments& a, const CommonArguments& common) {
  Json pictures = Json::array();
  for (const std::filesystem::path& file : a.files) {
    const Result<capture::PictureMeaning> picture = capture::meaning_of_picture(file);
    if (!picture) return picture.error();
    if (!common.json) {
      print_words(*picture);
      continue;
    }
    Json document = object_of(*picture);
    document["file"] = file.string();
    document["holds"] = held_by(file);
    document["unfit"] = picture->unfit ? Json(picture->unfit->why) : Json();
    pictures.push_back(std::move(document));
  }
  if (common.json) print_json({{"pictures", std::move(pictures)}});
  return kDone;
}

Run add_look(Options& options) {
  const auto a = std::make_shared<LookArguments>();
  options.add("files", &a->files, "Photographs, raws or maps").required();
  return [a](const CommonArguments& common) { return look(*a, common); };
}

}  // namespace

Verb look_verb() {
  return {"look", "What picture files mean: how they follow light, which way up, how they were taken",
          add_look};
}

}  // namespace weft::app
