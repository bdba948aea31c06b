// SPDX-License-Identifier: Apache-2.0
#include "capture/frames/picture_meaning.h"

#include <fmt/format.h>

#include <utility>

#include "capture/camera/photograph_facts.h"
#include "capture/raw/raw_info.h"
#include "core/image_io/image_io.h"

namespace weft::capture {
namespace {

std::string words_of(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return "8 bits";
    case SampleType::kUint16:
      return "16 bits";
    case SampleType::kHalf:
      return "half floats";
    case SampleType::kFloat:
      break;
  }
  return "floats";
}

Result<void> read_as_raw(PictureMeaning& picture) {
  const Result<RawInfo> raw = read_raw_info(picture.file);
  if (!raw) return raw.error();
  picture.is_raw = true;
  picture.size = raw->size;
  picture.samples = "counts";
  picture.channels = {"mosaic"};
  picture.transfer = Transfer::kLinear;
  picture.transfer_by = "a raw file";
  picture.orientation = 1;  // a body that looks straight down does not know how it is turned
  for (const std::string& opcode : raw->opcodes)
    picture.passed_over.push_back(opcode + ", which the file asks for: counts are taken without it");
  if (picture.model.empty()) picture.model = raw->shot.model;
  if (picture.exposure_us == 0) picture.exposure_us = raw->shot.exposure_us;
  if (picture.iso == 0) picture.iso = raw->shot.iso;
  if (picture.f_number == 0) picture.f_number = raw->shot.f_number;
  return {};
}

Result<void> read_as_image(PictureMeaning& picture) {
  Result<ImageFileInfo> info = read_image_info(picture.file);
  if (!info) return std::move(info).error();
  picture.format = info->format;
  picture.size = info->size;
  picture.samples = words_of(info->type);
  picture.channels = info->channels;
  picture.transfer = transfer_of(*info);
  picture.transfer_by = info->color_by;
  picture.origin = info->origin;
  picture.passed_over = info->remarks;
  if (Result<LightChannels> channels = light_channels(*info, picture.file.string()); !channels)
    picture.unfit = std::move(channels).error();
  return {};
}

}  // namespace

void describe(Fields& fields, PictureMeaning& p) {
  fields.value({"format", "Of the file"}, p.format);
  fields.value({"raw", "It is a mosaic of counts, as LibRaw reads it"}, p.is_raw);
  fields.value({"width", "Pixels, as it is stored"}, p.size.width);
  fields.value({"height", "Pixels, as it is stored"}, p.size.height);
  fields.value({"samples", "What they are"}, p.samples);
  fields.value({"channels", "As the file names them"}, p.channels);
  fields.choice({"transfer", "How they follow light; auto: by another curve"}, p.transfer, kTransferNames);
  fields.value({"transfer_by", "What says so; empty: nothing does"}, p.transfer_by);
  fields.value({"orientation", "How stored rows are to be shown, as of TIFF and EXIF; 1: as they are"},
               p.orientation);
  fields.value({"origin_x", "Where an EXR's pixels begin in their picture"}, p.origin[0]);
  fields.value({"origin_y", "Where an EXR's pixels begin in their picture"}, p.origin[1]);
  fields.value({"model", "Of the camera"}, p.model);
  fields.value({"lens", "Of the camera"}, p.lens);
  fields.value({"exposure_us", "Microseconds; 0: not said"}, p.exposure_us);
  fields.value({"iso", "Speed; 0: not said"}, p.iso);
  fields.value({"f_number", "Aperture; 0: not said"}, p.f_number);
  fields.value({"passed_over", "What is in the file and not used"}, p.passed_over);
}

Result<PictureMeaning> meaning_of_picture(const std::filesystem::path& file) {
  const Result<PhotographFacts> facts = read_photograph_facts(file);
  if (!facts) return facts.error();
  PictureMeaning picture;
  picture.file = file;
  picture.format = facts->ending;
  picture.orientation = facts->orientation;
  picture.model = facts->model;
  picture.lens = facts->lens;
  picture.exposure_us = facts->exposure_us;
  picture.iso = facts->iso;
  picture.f_number = facts->f_number;
  const bool is_raw = is_raw_ending(facts->ending) || is_unread_raw_ending(facts->ending);
  Result<void> read = is_raw ? read_as_raw(picture) : read_as_image(picture);
  if (!read) return std::move(read).error();
  return picture;
}

std::string transfer_words(const PictureMeaning& picture) {
  const std::string name = picture.transfer == Transfer::kSrgb     ? "sRGB"
                           : picture.transfer == Transfer::kLinear ? "linear"
                                                                   : "of another curve";
  if (!picture.transfer_by.empty()) return fmt::format("{}: {} says so", name, picture.transfer_by);
  if (picture.format == "jpeg") return name + ", as a JPEG is where nothing says otherwise";
  return fmt::format("{}, as {} are where nothing says otherwise", name, picture.samples);
}

}  // namespace weft::capture
