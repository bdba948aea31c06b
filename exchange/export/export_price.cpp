// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/export_price.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/temporary_folder.h"
#include "core/describe/field_json.h"
#include "exchange/export/map_planes.h"
#include "exchange/export/texture_file.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

constexpr int kPiecePx = 512;
constexpr int kTrials = 2;  // the quicker one counts, as the first also warms caches

// A piece from the middle of the maps.
struct Piece {
  SourcePlanes planes;
  ChannelFacts facts;
  Size size;
  double times = 1;  ///< pixels of the cloth over those of the piece
};

Piece piece_of(const MapPlanes& maps, const MapFolder& folder) {
  Piece piece;
  piece.planes = maps.planes();
  piece.facts = channel_facts(folder, piece.planes);
  piece.size = {std::min(kPiecePx, folder.size.width), std::min(kPiecePx, folder.size.height)};
  const int x = (folder.size.width - piece.size.width) / 2, y = (folder.size.height - piece.size.height) / 2;
  for (SourcePlane& plane : piece.planes) {
    if (!plane.pixels.empty())
      plane.pixels = plane.pixels.crop({x, y, x + piece.size.width, y + piece.size.height});
  }
  piece.times = static_cast<double>(folder.size.pixels()) / static_cast<double>(piece.size.pixels());
  return piece;
}

// Writes and reads one file of the piece.
class Trials {
 public:
  explicit Trials(const Piece& piece) : piece_(piece) {}

  Result<ExportPrice> price(const PresetFile& file, RoughnessConvention roughness) {
    static const std::vector<std::string> kEndings = {".png", ".tif", ".exr", ".dds", ".tx"};
    const fs::path path =
        folder_.path() / ("trial" + kEndings[static_cast<std::size_t>(file.stored.encoding)]);
    TextureInput input = {.file = file, .planes = piece_.planes, .facts = piece_.facts, .size = piece_.size};
    input.facts.roughness = roughness;
    input.facts.direction = file.direction;
    ExportPrice price;
    price.stored = file.stored;
    for (int trial = 0; trial < kTrials; ++trial) {
      Stopwatch watch;
      if (Result<void> ok = write_texture(path, input, 1); !ok) return std::move(ok).error();
      const double seconds = piece_.times * watch.lap();
      price.seconds = trial == 0 ? seconds : std::min(price.seconds, seconds);
    }
    std::error_code failed;
    price.bytes = piece_.times * static_cast<double>(fs::file_size(path, failed));
    Result<Image<float>> read = read_texture(path, input, 1);
    if (!read) return std::move(read).error();
    price.loss = measure_loss(file, input.planes, input.facts, std::move(*read));
    return price;
  }

 private:
  const Piece& piece_;
  TemporaryFolder folder_;
};

bool has_normals(const PresetFile& file) {
  const auto has = [&](const char* name) {
    return std::ranges::find(file.channels, name) != file.channels.end();
  };
  return has("normal.x") && has("normal.y");
}

// The ways in which the encoding of a file may hold as many channels.
std::vector<Stored> ways_of(const PresetFile& file) {
  const std::size_t channels = file.channels.size();
  std::vector<Stored> ways;
  const auto add = [&](int bits, BlockFormat blocks) {
    Stored way = file.stored;
    way.bits = bits;
    way.blocks = blocks;
    ways.push_back(way);
  };
  switch (file.stored.encoding) {
    case Encoding::kPng:
    case Encoding::kTiff:
      for (const int bits : {8, 16}) add(bits, file.stored.blocks);
      break;
    case Encoding::kExr:
    case Encoding::kTx:
      for (const int bits : {16, 32}) add(bits, file.stored.blocks);
      break;
    case Encoding::kDds:
      if (channels == 2) add(8, BlockFormat::kBc5);
      if (channels == 3) add(8, BlockFormat::kBc1);
      if (channels >= 3) add(8, BlockFormat::kBc7);
      break;
  }
  return ways;
}

void add_planes(const PresetFile& file, std::set<MapPlane>& planes) {
  for (const std::string& name : file.channels) {
    const auto& of = channel_named(name)->planes;
    planes.insert(of.begin(), of.end());
  }
}

// What normals and albedo are in every format, to compare with.
std::vector<PresetFile> everything() {
  std::vector<PresetFile> files;
  const auto add = [&](std::vector<std::string> channels, Stored stored) {
    const bool is_color = channels.front() == "albedo.r";
    if (is_color) stored.color = stored.is_float() ? ColorSpace::kLinearColor : ColorSpace::kSrgb;
    PresetFile file;
    file.name = is_color ? "albedo" : "normals";
    file.channels = std::move(channels);
    file.stored = stored;
    files.push_back(std::move(file));
  };
  const std::vector<std::string> rgb = {"albedo.r", "albedo.g", "albedo.b"},
                                 xyz = {"normal.x", "normal.y", "normal.z"};
  for (const std::vector<std::string>& channels : {xyz, rgb}) {
    for (const Encoding encoding : {Encoding::kPng, Encoding::kTiff, Encoding::kExr}) {
      const std::vector<int> bits = encoding == Encoding::kExr ? std::vector{16, 32} : std::vector{8, 16};
      for (const int each : bits) add(channels, {.encoding = encoding, .bits = each});
    }
    for (const BlockFormat blocks : {BlockFormat::kBc1, BlockFormat::kBc7})
      add(channels, {.encoding = Encoding::kDds, .blocks = blocks});
  }
  add({"normal.x", "normal.y"}, {.encoding = Encoding::kDds, .blocks = BlockFormat::kBc5});
  return files;
}

// All planes that the presets need.
std::set<MapPlane> needed(const std::vector<FilledPreset>& presets) {
  std::set<MapPlane> planes;
  for (const FilledPreset& preset : presets) {
    for (const TextureToWrite& texture : preset.textures) add_planes(texture.file, planes);
  }
  return planes;
}

Result<void> choose_for(TextureToWrite& texture, const Preset& preset, double to_deg, Trials& trials) {
  std::optional<ExportPrice> best, kept;
  for (const Stored& way : ways_of(texture.file)) {
    PresetFile file = texture.file;
    file.stored = way;
    Result<ExportPrice> price = trials.price(file, preset.roughness);
    if (!price) return std::move(price).error();
    const double deg = price->loss.normal->mean_deg;
    if (!best || deg < best->loss.normal->mean_deg) best = *price;
    if (deg <= to_deg && (!kept || price->bytes < kept->bytes)) kept = *price;
  }
  if (kept) {
    texture.file.stored = kept->stored;
    return {};
  }
  return Error{ErrorKind::kBadData, "normals cannot be kept so well", "--to",
               fmt::format("{} of preset {} loses {:.2g} degrees at best, as {}", texture.name, preset.name,
                           best->loss.normal->mean_deg, words_of(best->stored)),
               "allow more, or choose a preset of 16 bits or floats: png16, tiff16, exr"};
}

// The ways to store one file of normals, the quickest first, and the one that is taken.
struct TimelyChoice {
  TextureToWrite* texture = nullptr;
  std::vector<ExportPrice> ways;
  std::size_t taken = 0;
};

double pixels_over(Size size, Size whole) {
  return static_cast<double>(size.pixels()) / static_cast<double>(whole.pixels());
}

Result<TimelyChoice> timely_choice(TextureToWrite& texture, const Preset& preset, double smaller,
                                   Trials& trials) {
  TimelyChoice choice;
  choice.texture = &texture;
  for (const Stored& way : ways_of(texture.file)) {
    PresetFile file = texture.file;
    file.stored = way;
    Result<ExportPrice> price = trials.price(file, preset.roughness);
    if (!price) return std::move(price).error();
    price->seconds *= smaller;
    choice.ways.push_back(std::move(*price));
  }
  std::ranges::sort(choice.ways, {}, &ExportPrice::seconds);
  return choice;
}

// Where a second buys most degrees, until none fits.
void spend(std::vector<TimelyChoice>& choices, double left_s) {
  for (;;) {
    TimelyChoice* bought = nullptr;
    std::size_t way = 0;
    double most = 0;
    for (TimelyChoice& choice : choices) {
      const ExportPrice& now = choice.ways[choice.taken];
      for (std::size_t i = choice.taken + 1; i < choice.ways.size(); ++i) {
        const double seconds = choice.ways[i].seconds - now.seconds;
        const double gain = now.loss.normal->mean_deg - choice.ways[i].loss.normal->mean_deg;
        const double rate = gain / std::max(seconds, 1e-9);
        if (seconds > left_s || gain <= 0 || rate <= most) continue;
        bought = &choice;
        way = i;
        most = rate;
      }
    }
    if (bought == nullptr) return;
    left_s -= bought->ways[way].seconds - bought->ways[bought->taken].seconds;
    bought->taken = way;
  }
}

Result<void> choose_within(PreparedExport& prepared, double within_s, Trials& trials,
                           const JobContext& context) {
  std::vector<TimelyChoice> choices;
  double quickest_s = 0;
  for (FilledPreset& preset : prepared.presets) {
    const double smaller = pixels_over(preset.size, prepared.folder.size);
    for (TextureToWrite& texture : preset.textures) {
      if (context.stop.stop_requested()) return interrupted();
      if (has_normals(texture.file)) {
        Result<TimelyChoice> choice = timely_choice(texture, preset.preset, smaller, trials);
        if (!choice) return std::move(choice).error();
        quickest_s += choice->ways.front().seconds;
        choices.push_back(std::move(*choice));
      } else {
        const Result<ExportPrice> price = trials.price(texture.file, preset.preset.roughness);
        if (!price) return price.error();
        quickest_s += smaller * price->seconds;
      }
    }
  }
  if (quickest_s > within_s) {
    return Error{ErrorKind::kUsage, "the textures cannot be written so quickly",
                 fmt::format("--within {:g} s", within_s),
                 fmt::format("the quickest take one thread {:.2g} s", quickest_s),
                 "allow more, or ask for fewer pixels by --size, or for fewer presets"};
  }
  spend(choices, within_s - quickest_s);
  for (const TimelyChoice& choice : choices) choice.texture->file.stored = choice.ways[choice.taken].stored;
  return {};
}

}  // namespace

Result<void> choose_bits(PreparedExport& prepared, const JobContext& context) {
  const std::optional<double> to_deg = prepared.options.to_deg, within_s = prepared.options.within_s;
  if (!to_deg && !within_s) return {};
  const MapFolder& folder = prepared.folder;
  MapPlanes maps(folder, folder.size, context.threads);
  if (Result<void> ok = maps.load(within_s ? needed(prepared.presets) : std::set{MapPlane::kNormalX}); !ok)
    return ok;
  const Piece piece = piece_of(maps, folder);
  Trials trials(piece);
  if (within_s) return choose_within(prepared, *within_s, trials, context);
  for (FilledPreset& preset : prepared.presets) {
    for (TextureToWrite& texture : preset.textures) {
      if (!has_normals(texture.file)) continue;
      if (context.stop.stop_requested()) return interrupted();
      Result<void> chosen = choose_for(texture, preset.preset, *to_deg, trials);
      if (!chosen) return chosen;
    }
  }
  return {};
}

Result<std::vector<ExportPrice>> price_exports(const ExportOptions& asked, const JobContext& context) {
  Result<PreparedExport> prepared = prepare_export(asked, context);
  if (!prepared) return std::move(prepared).error();
  if (Result<void> ok = choose_bits(*prepared, context); !ok) return std::move(ok).error();
  const MapFolder& folder = prepared->folder;
  MapPlanes maps(folder, folder.size, context.threads);
  std::set<MapPlane> planes = needed(prepared->presets);
  for (const PresetFile& file : everything()) add_planes(file, planes);
  if (Result<void> ok = maps.load(planes); !ok) return std::move(ok).error();
  const Piece piece = piece_of(maps, folder);
  Trials trials(piece);
  std::vector<ExportPrice> prices;
  for (const FilledPreset& preset : prepared->presets) {
    const double smaller = pixels_over(preset.size, folder.size);
    for (const TextureToWrite& texture : preset.textures) {
      if (context.stop.stop_requested()) return interrupted();
      Result<ExportPrice> price = trials.price(texture.file, preset.preset.roughness);
      if (!price) return std::move(price).error();
      if (levels_of(texture.file, folder.size) == 1) {
        ChannelFacts facts = piece.facts;
        facts.roughness = preset.preset.roughness;
        price->loss.by_distance =
            loss_by_distance(texture.file, maps.planes(), facts, maps.lobe(), folder.size, context.threads);
      }
      price->preset = preset.preset.name;
      price->file = texture.name;
      price->bytes *= smaller;
      price->seconds *= smaller;
      price->is_chosen =
          (prepared->options.to_deg || prepared->options.within_s) && has_normals(texture.file);
      prices.push_back(std::move(*price));
    }
  }
  for (const PresetFile& file : everything()) {
    if (context.stop.stop_requested()) return interrupted();
    Result<ExportPrice> price = trials.price(file, RoughnessConvention::kRoot);
    if (!price) return std::move(price).error();
    price->file = file.name;
    prices.push_back(std::move(*price));
  }
  return prices;
}

Json json_of(const std::vector<ExportPrice>& prices) {
  Json rows = Json::array();
  for (const ExportPrice& price : prices) {
    Json row = {
        {"file", price.file},       {"encoding", words_of(price.stored)}, {"bytes", price.bytes},
        {"seconds", price.seconds}, {"lost", object_of(price.loss)},      {"chosen", price.is_chosen}};
    if (!price.preset.empty()) row["preset"] = price.preset;
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace weft::exchange
