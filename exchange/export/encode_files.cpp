// SPDX-License-Identifier: Apache-2.0
#include "exchange/export/encode_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "core/base/files.h"
#include "core/base/parallel.h"
#include "exchange/export/map_planes.h"
#include "exchange/export/texture_file.h"

namespace weft::exchange {
namespace {

namespace fs = std::filesystem;

// One texture to encode, and everywhere it goes: the first place is written, the others are copies.
struct Task {
  const FilledPreset* preset = nullptr;
  const TextureToWrite* texture = nullptr;
  std::vector<std::pair<std::size_t, std::size_t>> places = {};  ///< target, index in its preset
  double seconds = 0;                                            ///< to pack, encode and write it once
};

// What makes two textures alike, whatever preset asks for them.
std::string key_of(const FilledPreset& filled, const PresetFile& file) {
  const bool has_roughness = std::ranges::any_of(
      file.channels, [](const std::string& channel) { return channel.starts_with("roughness"); });
  return fmt::format(
      "{}x{} {} {} {} {} {} {}", filled.size.width, filled.size.height, fmt::join(file.channels, ","),
      words_of(file.stored), static_cast<int>(file.stored.color), file.stored.is_prman,
      static_cast<int>(file.direction), has_roughness ? static_cast<int>(filled.preset.roughness) : -1);
}

std::vector<Task> tasks_of(const std::vector<EncodeTarget>& targets) {
  std::vector<Task> tasks;
  std::map<std::string, std::size_t> by_key;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const FilledPreset& preset = *targets[t].preset;
    for (std::size_t i = 0; i < preset.textures.size(); ++i) {
      const auto [found, is_new] = by_key.emplace(key_of(preset, preset.textures[i].file), tasks.size());
      if (is_new) tasks.push_back({.preset = &preset, .texture = &preset.textures[i]});
      tasks[found->second].places.emplace_back(t, i);
    }
  }
  return tasks;
}

std::set<MapPlane> planes_of(const TextureToWrite& texture) {
  std::set<MapPlane> planes;
  for (const std::string& name : texture.file.channels) {
    const std::vector<MapPlane>& needed = channel_named(name)->planes;
    planes.insert(needed.begin(), needed.end());
  }
  return planes;
}

bool has_any(const PresetFile& file, std::initializer_list<const char*> channels) {
  return std::ranges::any_of(channels, [&](const char* channel) {
    return std::ranges::find(file.channels, channel) != file.channels.end();
  });
}

ExportedChannel exported_channel(const TextureInput& input, const ChannelLoss& loss) {
  const Channel& channel = *channel_named(loss.channel);
  ExportedChannel facts = {
      .name = loss.channel,
      .unit = channel.unit,
      .least = loss.least,
      .most = loss.most,
      .mean = loss.mean,
      .lost = {loss.mean_abs, loss.most_abs},
      .cut_share = static_cast<double>(loss.cut) / static_cast<double>(input.size.pixels())};
  if (input.file.stored.is_float()) return facts;
  const ChannelRange range = range_of(channel, input.facts);
  facts.at_0 = range.least;
  facts.at_1 = range.most;
  return facts;
}

// But for its name and its bytes.
ExportedTexture exported_texture(const TextureInput& input, Loss loss) {
  const PresetFile& file = input.file;
  ExportedTexture facts = {.size = input.size,
                           .levels = levels_of(file, input.size),
                           .encoding = words_of(file.stored),
                           .color = file.stored.color};
  if (has_any(file, {"normal.y", "detail.normal.y"}))
    facts.direction = kNormalDirectionNames[static_cast<std::size_t>(file.direction)];
  if (has_any(file, {"roughness", "roughness.least"}))
    facts.roughness = kRoughnessConventionNames[static_cast<std::size_t>(input.facts.roughness)];
  for (const ChannelLoss& channel : loss.channels) facts.channels.push_back(exported_channel(input, channel));
  facts.lost = std::move(loss);
  return facts;
}

// By the file as it reads back.
Result<Loss> loss_of(const fs::path& path, const TextureInput& input, int threads) {
  Result<Image<float>> read = read_texture(path, input, threads);
  if (!read) return std::move(read).error();
  Loss loss = measure_loss(input.file, input.planes, input.facts, std::move(*read));
  if (levels_of(input.file, input.size) == 1) {
    loss.by_distance =
        loss_by_distance(input.file, input.planes, input.facts, input.lobe, input.size, threads);
  }
  return loss;
}

class Encoder {
 public:
  Encoder(const MapFolder& folder, const std::vector<EncodeTarget>& targets, bool is_dx10,
          const JobContext& context)
      : folder_(folder), targets_(targets), is_dx10_(is_dx10), context_(context), tasks_(tasks_of(targets)) {
    for (const EncodeTarget& target : targets)
      encoded_.emplace_back().textures.resize(target.preset->textures.size());
  }

  Result<std::vector<EncodedTextures>> run();

 private:
  Result<void> run_together(const std::vector<Task*>& tasks, Size size);
  Result<void> run_one(Task& task, const MapPlanes& planes, const ChannelFacts& facts, int threads);
  Result<void> copy(const Task& task, const ExportedTexture& first);
  const std::string& name_at(std::pair<std::size_t, std::size_t> place) const {
    return targets_[place.first].preset->textures[place.second].name;
  }
  fs::path path_of(std::pair<std::size_t, std::size_t> place) const {
    return targets_[place.first].folder / name_at(place);
  }
  ExportedTexture& texture_at(std::pair<std::size_t, std::size_t> place) {
    return encoded_[place.first].textures[place.second];
  }
  bool fits_memory(const std::vector<Task*>& tasks, Size size) const;

  const MapFolder& folder_;
  const std::vector<EncodeTarget>& targets_;
  bool is_dx10_;
  const JobContext& context_;
  std::vector<Task> tasks_;
  std::vector<EncodedTextures> encoded_;
  std::atomic<int> done_ = 0;
};

bool Encoder::fits_memory(const std::vector<Task*>& tasks, Size size) const {
  std::set<MapPlane> all;
  for (const Task* task : tasks) all.merge(planes_of(*task->texture));
  const std::uint64_t planes =
      all.size() + 12 * static_cast<std::uint64_t>(resolved_threads(context_.threads));
  return planes * 4 * static_cast<std::uint64_t>(size.pixels()) < available_memory_bytes() / 3;
}

Result<void> Encoder::copy(const Task& task, const ExportedTexture& first) {
  for (std::size_t i = 1; i < task.places.size(); ++i) {
    const fs::path path = path_of(task.places[i]);
    if (Result<void> ok = make_writable_folder(path.parent_path()); !ok) return ok;
    std::error_code failed;
    fs::copy_file(path_of(task.places.front()), path, failed);
    if (failed) return cannot_write(path, failed.value());
    ExportedTexture& copied = texture_at(task.places[i]);
    copied = first;
    copied.file = name_at(task.places[i]);
  }
  return {};
}

Result<void> Encoder::run_one(Task& task, const MapPlanes& planes, const ChannelFacts& facts, int threads) {
  if (context_.stop.stop_requested()) return interrupted();
  const fs::path path = path_of(task.places.front());
  if (Result<void> ok = make_writable_folder(path.parent_path()); !ok) return ok;
  const PresetFile& file = task.texture->file;
  TextureInput input = {.file = file,
                        .planes = planes.planes(),
                        .facts = facts,
                        .lobe = planes.lobe(),
                        .size = task.preset->size,
                        .pitch_mm = folder_.is_size_known ? task.preset->pitch_mm : PixelPitch(),
                        .is_tile = folder_.is_tile,
                        .is_dx10 = is_dx10_,
                        .attributes = {{"weft." + folder_.kind, folder_.id}}};
  input.facts.roughness = task.preset->preset.roughness;
  input.facts.direction = file.direction;
  Stopwatch watch;
  if (Result<void> ok = write_texture(path, input, threads); !ok) return ok;
  task.seconds = watch.lap();
  Result<Loss> loss = loss_of(path, input, threads);
  if (!loss) return std::move(loss).error();
  ExportedTexture texture = exported_texture(input, std::move(*loss));
  texture.file = task.texture->name;
  Result<std::string> digest = sha256_of_file(path);
  if (!digest) return std::move(digest).error();
  texture.sha256 = std::move(*digest);
  std::error_code failed;
  texture.bytes = fs::file_size(path, failed);
  if (Result<void> ok = copy(task, texture); !ok) return ok;
  texture_at(task.places.front()) = std::move(texture);
  context_.progress("encode", static_cast<double>(++done_) / static_cast<double>(tasks_.size()));
  return {};
}

Result<void> Encoder::run_together(const std::vector<Task*>& tasks, Size size) {
  MapPlanes planes(folder_, size, context_.threads);
  if (!fits_memory(tasks, size)) {
    for (Task* task : tasks) {
      if (Result<void> ok = planes.load(planes_of(*task->texture)); !ok) return ok;
      const ChannelFacts facts = channel_facts(folder_, planes.planes());
      if (Result<void> ok = run_one(*task, planes, facts, context_.threads); !ok) return ok;
    }
    return {};
  }
  std::set<MapPlane> all;
  for (const Task* task : tasks) all.merge(planes_of(*task->texture));
  if (Result<void> ok = planes.load(all); !ok) return ok;
  const ChannelFacts facts = channel_facts(folder_, planes.planes());
  std::vector<std::optional<Error>> errors(tasks.size());
  const int threads = resolved_threads(context_.threads);
  parallel_for(tasks.size(), threads, [&](std::size_t i, int) {
    const int own = tasks.size() < static_cast<std::size_t>(threads) ? threads : 1;
    if (Result<void> ok = run_one(*tasks[i], planes, facts, own); !ok) errors[i] = ok.error();
  });
  for (const std::optional<Error>& error : errors) {
    if (error) return *error;
  }
  return {};
}

Result<std::vector<EncodedTextures>> Encoder::run() {
  std::vector<Size> sizes;
  for (const Task& task : tasks_) {
    if (std::ranges::find(sizes, task.preset->size) == sizes.end()) sizes.push_back(task.preset->size);
  }
  for (const Size size : sizes) {
    std::vector<Task*> together;
    for (Task& task : tasks_) {
      if (task.preset->size == size) together.push_back(&task);
    }
    if (Result<void> ok = run_together(together, size); !ok) return std::move(ok).error();
  }
  for (const Task& task : tasks_) encoded_[task.places.front().first].seconds += task.seconds;
  return std::move(encoded_);
}

}  // namespace

Result<std::vector<EncodedTextures>> encode_files(const MapFolder& folder,
                                                  const std::vector<EncodeTarget>& targets, bool is_dx10,
                                                  const JobContext& context) {
  return Encoder(folder, targets, is_dx10, context).run();
}

}  // namespace weft::exchange
