// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>

#include "app/server/view/pyramid.h"
#include "core/base/result.h"

namespace weft::app {

/// Pyramids that are looked at, each under a name of its content. What they keep lies in a folder a name,
/// within a budget: of what is over it, the folders that were opened longest ago are removed. Safe from any
/// thread; one pyramid is opened at a time, others are read meanwhile.
class ViewStore {
 public:
  explicit ViewStore(std::filesystem::path folder, std::uint64_t most_bytes = std::uint64_t{4} << 30);

  /// A layer of the maps of `maps`; `content` is the solve's id. Errors of Pyramid::open().
  Result<std::shared_ptr<Pyramid>> layer(const std::filesystem::path& maps, const std::string& content,
                                         const Layer& layer);
  /// A raw frame of this digest. Errors of Pyramid::open_raw().
  Result<std::shared_ptr<Pyramid>> frame(const std::filesystem::path& file, const std::string& sha256);

 private:
  struct Opened {
    std::string name;
    std::shared_ptr<Pyramid> pyramid;
  };
  template <typename Open>
  Result<std::shared_ptr<Pyramid>> find_or(const std::string& name, const std::string& content,
                                           const Open& open);
  std::shared_ptr<Pyramid> find(const std::string& name);
  void prune();

  const std::filesystem::path folder_;
  const std::uint64_t most_bytes_;
  std::mutex opened_mutex_, opening_mutex_;
  std::list<Opened> opened_;  ///< the last used first
};

}  // namespace weft::app
