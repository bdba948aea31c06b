// SPDX-License-Identifier: Apache-2.0
#include "app/server/view/view_store.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace weft::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostOpened = 64;  // pyramids, each a file descriptor and a list of rows

struct Kept {
  fs::file_time_type used;
  fs::path folder;
  std::uint64_t bytes = 0;
};

std::vector<Kept> kept_in(const fs::path& folder) {
  std::vector<Kept> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    Kept kept = {entry.last_write_time(error), entry.path()};
    for (const auto& file : fs::directory_iterator(entry.path(), error)) kept.bytes += file.file_size(error);
    all.push_back(std::move(kept));
  }
  std::ranges::sort(all, std::ranges::greater{}, &Kept::used);
  return all;
}

}  // namespace

ViewStore::ViewStore(fs::path folder, std::uint64_t most_bytes)
    : folder_(std::move(folder)), most_bytes_(most_bytes) {}

Result<std::shared_ptr<Pyramid>> ViewStore::layer(const fs::path& maps, const std::string& content,
                                                  const Layer& layer) {
  return find_or(content + "/" + layer.name, content,
                 [&](const fs::path& kept) { return Pyramid::open(maps, layer, kept); });
}

Result<std::shared_ptr<Pyramid>> ViewStore::frame(const fs::path& file, const std::string& sha256) {
  return find_or(sha256, sha256, [&](const fs::path& kept) { return Pyramid::open_raw(file, kept); });
}

std::shared_ptr<Pyramid> ViewStore::find(const std::string& name) {
  const std::lock_guard lock(opened_mutex_);
  const auto found = std::ranges::find(opened_, name, &Opened::name);
  if (found == opened_.end()) return nullptr;
  opened_.splice(opened_.begin(), opened_, found);
  return found->pyramid;
}

template <typename Open>
Result<std::shared_ptr<Pyramid>> ViewStore::find_or(const std::string& name, const std::string& content,
                                                    const Open& open) {
  if (std::shared_ptr<Pyramid> found = find(name)) return found;
  const std::lock_guard opening(opening_mutex_);
  if (std::shared_ptr<Pyramid> found = find(name)) return found;
  Result<std::unique_ptr<Pyramid>> opened = open(folder_ / content);
  if (!opened) return std::move(opened).error();
  std::error_code ignored;  // there is no folder where nothing had to be kept
  fs::last_write_time(folder_ / content, fs::file_time_type::clock::now(), ignored);
  prune();
  const std::lock_guard lock(opened_mutex_);
  opened_.push_front({name, std::shared_ptr<Pyramid>(std::move(*opened))});
  if (opened_.size() > kMostOpened) opened_.pop_back();
  return opened_.front().pyramid;
}

/// The newest stays, however large it is. Pyramids whose folder goes make it again when they are read.
void ViewStore::prune() {
  std::uint64_t bytes = 0;
  bool is_newest = true;
  for (const Kept& kept : kept_in(folder_)) {
    bytes += kept.bytes;
    std::error_code ignored;
    if (bytes > most_bytes_ && !is_newest) fs::remove_all(kept.folder, ignored);
    is_newest = false;
  }
}

}  // namespace weft::app
