// SPDX-License-Identifier: Apache-2.0
#include "material/assets/digests.h"

#include <sys/stat.h>

#include <cerrno>
#include <chrono>
#include <utility>

#include "core/base/files.h"
#include "core/base/json_document.h"

namespace weft::material {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDigestsSchema = "weft.digests";
// A file that was written just now may be written again within the clock's step.
constexpr std::int64_t kSettled_ns = 2'000'000'000;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace

DigestCache::DigestCache(fs::path file) : file_(std::move(file)) {
  if (file_.empty() || !is_there(file_)) return;
  const Result<Json> document = read_json(file_, kDigestsSchema, 1);
  if (!document || !document->contains("files") || !(*document)["files"].is_object()) return;
  for (const auto& [name, facts] : (*document)["files"].items()) {
    JsonFields fields(facts, name);
    Known known = {.size = 0, .inode = 0, .changed_ns = 0, .sha256 = fields.text("sha256")};
    if (!fields.status() || known.sha256.size() != 64) continue;
    known.size = facts.value("size", std::uint64_t{0});
    known.inode = facts.value("inode", std::uint64_t{0});
    known.changed_ns = facts.value("changed_ns", std::int64_t{0});
    known_[name] = std::move(known);
  }
}

Result<std::string> DigestCache::digest(const fs::path& file) {
  struct stat now = {};
  if (::stat(file.c_str(), &now) != 0) return cannot_read(file, errno);
  const std::int64_t changed_ns = std::int64_t{now.st_mtim.tv_sec} * 1'000'000'000 + now.st_mtim.tv_nsec;
  const auto size = static_cast<std::uint64_t>(now.st_size);
  const auto inode = static_cast<std::uint64_t>(now.st_ino);
  const auto found = known_.find(file.string());
  if (found != known_.end() && found->second.size == size && found->second.inode == inode &&
      found->second.changed_ns == changed_ns)
    return found->second.sha256;
  Result<std::string> sha256 = sha256_of_file(file);
  if (!sha256) return sha256;
  ++hashed_;
  if (now_ns() - changed_ns > kSettled_ns) {
    known_[file.string()] = {size, inode, changed_ns, *sha256};
    is_changed_ = true;
  }
  return sha256;
}

Result<void> DigestCache::save() const {
  if (file_.empty() || !is_changed_ || !is_there(file_.parent_path())) return {};
  Json files = Json::object();
  for (const auto& [name, known] : known_)
    files[name] = {{"size", known.size},
                   {"inode", known.inode},
                   {"changed_ns", known.changed_ns},
                   {"sha256", known.sha256}};
  return write_json(file_, {{"schema", std::string(kDigestsSchema) + "/1"}, {"files", std::move(files)}});
}

}  // namespace weft::material
