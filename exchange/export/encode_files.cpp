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

namespace weft::app {
namespace {

namespace fs = std::filesystem;
using exchange::Plane;

// One texture to encode, and everywhere it goes: the first place is written, the others are copies.
struct Task {
  const PlannedExport* plan = nullptr;
  const PlannedFile* planned = nullptr;
  std::vector<std::pair<std::size_t, std::size_t>> places;  ///< target, index in its plan
};

// What makes two textures alike, whatever preset asks for them.
std::string key_of(const PlannedExport& plan, const exchange::PresetFile& file) {
  const bool has_roughness = std::ranges::any_of(
      file.channels, [](const std::string& channel) { return channel.starts_with("roughness"); });
  return fmt::format(
      "{}x{} {} {} {} {} {} {}", plan.size.width, plan.size.height, fmt::join(file.channels, ","),
      words_of(file.stored), static_cast<int>(file.stored.color), file.stored.is_prman,
      static_cast<int>(file.direction), has_roughness ? static_cast<int>(plan.preset.roughness) : -1);
}

std::vector<Task> tasks_of(const std::vector<EncodeTarget>& targets) {
  std::vector<Task> tasks;
  std::map<std::string, std::size_t> by_key;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    const PlannedExport& plan = *targets[t].plan;
    for (std::size_t i = 0; i < plan.files.size(); ++i) {
      const auto [found, is_new] = by_key.emplace(key_of(plan, plan.files[i].file), tasks.size());
      if (is_new) tasks.push_back({&plan, &plan.files[i], {}});
      tasks[found->second].places.emplace_back(t, i);
    }
  }
  return tasks;
}

std::set<Plane> planes_of(const PlannedFile& planned) {
  std::set<Plane> planes;
  for (const std::string& name : planned.file.channels) {
    const std::vector<Plane>& needed = exchange::channel_named(name)->planes;
    planes.insert(needed.begin(), needed.end());
  }
  return planes;
}

class Encoder {
 public:
  Encoder(const MapFolder& folder, const std::vector<EncodeTarget>& targets, bool is_dx10,
          const JobContext& context)
      : folder_(folder), targets_(targets), is_dx10_(is_dx10), context_(context), tasks_(tasks_of(targets)) {
    for (const EncodeTarget& target : targets) encoded_.emplace_back(target.plan->files.size());
  }

  Result<std::vector<std::vector<EncodedFile>>> run();

 private:
  Result<void> run_together(const std::vector<const Task*>& tasks, Size size);
  Result<void> run_one(const Task& task, const MapPlanes& planes, const exchange::ChannelFacts& facts,
                       int threads);
  Result<void> copy(const Task& task, const EncodedFile& first);
  fs::path path_of(std::pair<std::size_t, std::size_t> place) const {
    return targets_[place.first].folder / targets_[place.first].plan->files[place.second].name;
  }
  bool fits_memory(const std::vector<const Task*>& tasks, Size size) const;

  const MapFolder& folder_;
  const std::vector<EncodeTarget>& targets_;
  bool is_dx10_;
  const JobContext& context_;
  std::vector<Task> tasks_;
  std::vector<std::vector<EncodedFile>> encoded_;
  std::atomic<int> done_ = 0;
};

bool Encoder::fits_memory(const std::vector<const Task*>& tasks, Size size) const {
  std::set<Plane> all;
  for (const Task* task : tasks) all.merge(planes_of(*task->planned));
  const std::uint64_t planes =
      all.size() + 12 * static_cast<std::uint64_t>(resolved_threads(context_.threads));
  return planes * 4 * static_cast<std::uint64_t>(size.pixels()) < available_memory_bytes() / 3;
}

Result<void> Encoder::copy(const Task& task, const EncodedFile& first) {
  for (std::size_t i = 1; i < task.places.size(); ++i) {
    const auto [target, index] = task.places[i];
    const fs::path path = path_of(task.places[i]);
    if (Result<void> ok = make_writable_folder(path.parent_path()); !ok) return ok;
    std::error_code failed;
    fs::copy_file(path_of(task.places.front()), path, failed);
    if (failed) return cannot_write(path, failed.value());
    EncodedFile& copied = encoded_[target][index];
    copied = first;
    copied.file = targets_[target].plan->files[index].file;
    copied.name = targets_[target].plan->files[index].name;
    copied.seconds = 0;
  }
  return {};
}

Result<void> Encoder::run_one(const Task& task, const MapPlanes& planes, const exchange::ChannelFacts& facts,
                              int threads) {
  if (context_.stop.stop_requested()) return interrupted();
  const fs::path path = path_of(task.places.front());
  if (Result<void> ok = make_writable_folder(path.parent_path()); !ok) return ok;
  EncodedFile encoded = {.file = task.planned->file, .name = task.planned->name, .size = task.plan->size};
  encoded.facts = facts;
  encoded.facts.roughness = task.plan->preset.roughness;
  encoded.facts.direction = task.planned->file.direction;
  encoded.levels = levels_of(encoded.file, encoded.size);
  const TextureInput input = {.file = encoded.file,
                              .planes = planes.planes(),
                              .facts = encoded.facts,
                              .lobe = planes.lobe(),
                              .size = encoded.size,
                              .pitch_mm = task.plan->pitch_mm,
                              .is_tile = folder_.is_tile,
                              .is_dx10 = is_dx10_,
                              .attributes = {{"weft." + folder_.kind, folder_.id}}};
  Stopwatch watch;
  if (Result<void> ok = write_texture(path, input, threads); !ok) return ok;
  encoded.seconds = watch.lap();
  Result<Image<float>> read = read_texture(path, input, threads);
  if (!read) return std::move(read).error();
  encoded.loss = exchange::measure_loss(encoded.file, input.planes, input.facts, std::move(*read));
  if (encoded.levels == 1) {
    encoded.loss.by_distance = exchange::loss_by_distance(encoded.file, input.planes, input.facts, input.lobe,
                                                          encoded.size, threads);
  }
  Result<std::string> digest = sha256_of_file(path);
  if (!digest) return std::move(digest).error();
  encoded.sha256 = std::move(*digest);
  std::error_code failed;
  encoded.bytes = fs::file_size(path, failed);
  if (Result<void> ok = copy(task, encoded); !ok) return ok;
  const auto [target, index] = task.places.front();
  encoded_[target][index] = std::move(encoded);
  context_.progress("encode", static_cast<double>(++done_) / static_cast<double>(tasks_.size()));
  return {};
}

Result<void> Encoder::run_together(const std::vector<const Task*>& tasks, Size size) {
  MapPlanes planes(folder_, size, context_.threads);
  if (!fits_memory(tasks, size)) {
    for (const Task* task : tasks) {
      if (Result<void> ok = planes.load(planes_of(*task->planned)); !ok) return ok;
      const exchange::ChannelFacts facts = channel_facts(folder_, planes.planes());
      if (Result<void> ok = run_one(*task, planes, facts, context_.threads); !ok) return ok;
    }
    return {};
  }
  std::set<Plane> all;
  for (const Task* task : tasks) all.merge(planes_of(*task->planned));
  if (Result<void> ok = planes.load(all); !ok) return ok;
  const exchange::ChannelFacts facts = channel_facts(folder_, planes.planes());
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

Result<std::vector<std::vector<EncodedFile>>> Encoder::run() {
  std::vector<Size> sizes;
  for (const Task& task : tasks_) {
    if (std::ranges::find(sizes, task.plan->size) == sizes.end()) sizes.push_back(task.plan->size);
  }
  for (const Size size : sizes) {
    std::vector<const Task*> together;
    for (const Task& task : tasks_) {
      if (task.plan->size == size) together.push_back(&task);
    }
    if (Result<void> ok = run_together(together, size); !ok) return std::move(ok).error();
  }
  return std::move(encoded_);
}

}  // namespace

Result<std::vector<std::vector<EncodedFile>>> encode_files(const MapFolder& folder,
                                                           const std::vector<EncodeTarget>& targets,
                                                           bool is_dx10, const JobContext& context) {
  return Encoder(folder, targets, is_dx10, context).run();
}

}  // namespace weft::app
