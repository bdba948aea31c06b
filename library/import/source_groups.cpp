// SPDX-License-Identifier: Apache-2.0
#include "library/import/source_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/text.h"
#include "library/catalogue/session_name.h"
#include "library/import/led_decision.h"

namespace weft::library {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestGroupName = 80;  // bytes: a count may follow

/// A file of a group, before it is opened.
struct NamedFileOfGroup {
  SourceFile source;
  NameParts said;
};

struct NamedGroup {
  std::string name, fabric;
  fs::path root, folder;
  std::vector<NamedFileOfGroup> files;
};

std::string session_name_of(const std::string& text) {
  return file_name_of(text, "session", kLongestGroupName);
}

/// The folder above the parts of a path that the pattern speaks of.
fs::path above(const fs::path& file, std::size_t depth) {
  fs::path folder = file;
  for (std::size_t i = 0; i < depth; ++i) folder = folder.parent_path();
  return folder;
}

std::vector<NamedGroup> group_by_name(const std::vector<SourceFile>& files,
                                      const std::optional<NamePattern>& pattern,
                                      std::vector<LeftOver>& left_over) {
  using Key = std::tuple<fs::path, std::string, std::string>;
  std::map<Key, std::size_t> places;
  std::vector<NamedGroup> groups;
  const bool has_sessions = pattern && pattern->has("session");
  for (const SourceFile& file : files) {
    NameParts said;
    if (pattern) {
      // The folder that was named is a part that the pattern may speak of.
      std::optional<NameParts> found = pattern->match(file.file);
      if (!found) {
        left_over.push_back({file.file, "it does not follow the pattern"});
        continue;
      }
      said = std::move(*found);
    }
    const fs::path place = has_sessions ? above(file.file, pattern->depth()) : file.file.parent_path();
    const Key key = {place, said.session, said.fabric};
    const auto [at, is_new] = places.try_emplace(key, groups.size());
    if (is_new) {
      const std::string folder = file.file.parent_path().filename().string();
      std::string name = has_sessions ? said.session : said.fabric.empty() ? folder : said.fabric;
      groups.push_back({std::move(name), said.fabric, file.root, file.file.parent_path(), {}});
    }
    groups[at->second].files.push_back({file, std::move(said)});
  }
  return groups;
}

/// Names that are allowed, and each once: of two alike both are told apart by fabric, then by folder, then by
/// a count.
void name_apart(std::vector<NamedGroup>& groups) {
  const auto is_twice = [&](const std::string& name) {
    return std::ranges::count(groups, name, &NamedGroup::name) > 1;
  };
  for (NamedGroup& group : groups) group.name = session_name_of(group.name);
  const auto tell_apart = [&](const auto& more_of) {
    std::vector<std::string> names;
    for (const NamedGroup& group : groups) {
      const std::string more = more_of(group);
      names.push_back(is_twice(group.name) && !more.empty() && more != group.name ? session_name_of(more)
                                                                                  : group.name);
    }
    for (std::size_t i = 0; i < groups.size(); ++i) groups[i].name = std::move(names[i]);
  };
  tell_apart([](const NamedGroup& g) { return g.fabric.empty() ? "" : g.name + "_" + g.fabric; });
  tell_apart([](const NamedGroup& g) {
    std::string path = g.folder.lexically_relative(g.root.parent_path()).generic_string();
    if (g.folder.filename() != g.name) path += "_" + g.name;
    return path;
  });
  std::set<std::string> taken;
  for (NamedGroup& group : groups) {
    const std::string name = group.name;
    for (int i = 2; !taken.insert(group.name).second; ++i) group.name = fmt::format("{}_{}", name, i);
  }
}

/// Where a group ends and the next begins, as the first frames of each; frames are in order of time.
std::vector<std::size_t> starts_by_gap(const std::vector<SourceFrame>& frames, double gap_s) {
  std::vector<std::size_t> starts = {0};
  for (std::size_t i = 1; i < frames.size(); ++i)
    if (*frames[i].taken_s - *frames[i - 1].taken_s > gap_s) starts.push_back(i);
  return starts;
}

/// A group whose files have been opened, split where time has gaps.
std::vector<SourceGroup> split_by_time(SourceGroup whole, const GroupingOptions& options) {
  const bool has_sessions = options.pattern && options.pattern->has("session");
  const std::size_t files = whole.frames.size() + whole.unreadable.size();
  const auto order = order_of_times(whole.frames);
  if (has_sessions || !order || whole.frames.empty() || files <= options.leds + 1) return {std::move(whole)};
  std::vector<SourceFrame> frames;
  for (const std::size_t f : *order) frames.push_back(std::move(whole.frames[f]));
  const std::vector<std::size_t> starts = starts_by_gap(frames, options.gap_s);
  std::vector<SourceGroup> parts;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const std::size_t end = s + 1 < starts.size() ? starts[s + 1] : frames.size();
    SourceGroup& part =
        parts.emplace_back(SourceGroup{whole.name, whole.fabric, whole.root, whole.folder, {}, {}});
    if (starts.size() > 1) part.name += fmt::format("_{:02}", s + 1);
    for (std::size_t f = starts[s]; f < end; ++f) part.frames.push_back(std::move(frames[f]));
  }
  // A file that cannot be opened belongs where the one before it by name does.
  for (Error& error : whole.unreadable) {
    SourceGroup* owner = &parts.front();
    const SourceFrame* nearest = nullptr;
    for (SourceGroup& part : parts) {
      for (const SourceFrame& frame : part.frames) {
        const std::string name = frame.source.file.string();
        if (!stands_before(name, error.where)) continue;
        if (nearest != nullptr && !stands_before(nearest->source.file.string(), name)) continue;
        nearest = &frame;
        owner = &part;
      }
    }
    owner->unreadable.push_back(std::move(error));
  }
  return parts;
}

}  // namespace

Result<std::vector<SourceGroup>> group_frames(const std::vector<SourceFile>& files,
                                              const GroupingOptions& options, const JobContext& context,
                                              std::vector<LeftOver>& left_over) {
  std::vector<NamedGroup> named = group_by_name(files, options.pattern, left_over);
  name_apart(named);
  std::vector<std::pair<std::size_t, std::size_t>> places;
  for (std::size_t g = 0; g < named.size(); ++g)
    for (std::size_t f = 0; f < named[g].files.size(); ++f) places.emplace_back(g, f);
  std::vector<std::optional<Result<SourceFrame>>> looked(places.size());
  JobContext quiet = context;
  quiet.progress = [&](std::string_view, double share) { context.progress("look", share); };
  const auto look_at_one = [&](std::size_t i) -> Result<void> {
    const NamedFileOfGroup& file = named[places[i].first].files[places[i].second];
    looked[i] = look_at_frame(file.source, file.said);
    return {};
  };
  if (Result<void> ok = for_each_frame(places.size(), quiet, look_at_one); !ok) return std::move(ok).error();

  std::vector<SourceGroup> opened;
  for (NamedGroup& group : named)
    opened.push_back({std::move(group.name), std::move(group.fabric), group.root, group.folder, {}, {}});
  for (std::size_t i = 0; i < places.size(); ++i) {
    SourceGroup& group = opened[places[i].first];
    if (*looked[i]) {
      group.frames.push_back(**std::move(looked[i]));
    } else {
      Error error = std::move(*looked[i]).error();
      error.where = named[places[i].first].files[places[i].second].source.file.string();
      group.unreadable.push_back(std::move(error));
    }
  }
  std::vector<SourceGroup> groups;
  for (SourceGroup& group : opened)
    for (SourceGroup& part : split_by_time(std::move(group), options)) groups.push_back(std::move(part));
  return groups;
}

}  // namespace weft::library
