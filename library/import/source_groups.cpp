// SPDX-License-Identifier: Apache-2.0
#include "library/import/source_groups.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/text.h"
#include "library/catalogue/session_name.h"
#include "library/import/capture_order.h"

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
  for (NamedGroup& group : groups) group.name = session_name_of(group.name);
  const auto tell_apart = [&](const auto& more_of) {
    std::map<std::string, int> count;
    for (const NamedGroup& group : groups) ++count[group.name];
    const auto is_twice = [&](const std::string& name) { return count[name] > 1; };
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

/// Frames in the order in which they are walked through, and where they are parted.
struct Walked {
  std::vector<SourceFrame> frames;
  std::vector<std::size_t> starts;            ///< the first frame of each part, and the end of all
  std::map<std::size_t, ImportDoubt> doubts;  ///< by the frame that they are of
};

std::vector<SourceFrame> in_this_order(std::vector<SourceFrame> frames,
                                       const std::vector<std::size_t>& order) {
  std::vector<SourceFrame> ordered;
  ordered.reserve(frames.size());
  for (const std::size_t f : order) ordered.push_back(std::move(frames[f]));
  return ordered;
}

/// Parted where time has a gap or runs back.
Walked parted(std::vector<SourceFrame> frames, double gap_s) {
  Walked walked = {std::move(frames), {0}, {}};
  std::optional<std::size_t> last;
  for (std::size_t i = 0; i < walked.frames.size(); ++i) {
    const SourceFrame& frame = walked.frames[i];
    if (!frame.taken_s) continue;
    const double after_s = last ? *frame.taken_s - *walked.frames[*last].taken_s : 0;
    if (after_s > gap_s || after_s < 0) walked.starts.push_back(i);
    if (after_s < 0) {
      walked.doubts.emplace(i, ImportDoubt{"the camera's clock was set back before the session",
                                           words_of(ClockStep{*last, i, -after_s}, walked.frames) +
                                               ", while its counter went on"});
    }
    last = i;
  }
  walked.starts.push_back(walked.frames.size());
  return walked;
}

/// Puts together what a clock that was set parted in the midst of a session, where the counter went on.
void join_by_count(std::size_t leds, double gap_s, Walked& walked) {
  std::vector<std::size_t>& starts = walked.starts;
  for (std::size_t s = 0; s + 2 < starts.size(); ++s) {
    const std::size_t a = starts[s + 1] - starts[s], b = starts[s + 2] - starts[s + 1];
    const bool is_whole = a + b == leds || a + b == leds + 1;
    if (!is_whole || (a >= leds && b >= leds)) continue;
    const std::size_t after = starts[s + 1];
    starts.erase(starts.begin() + static_cast<std::ptrdiff_t>(s) + 1);
    if (walked.doubts.erase(after) > 0) continue;  // its times and names disagree: that is told of it
    walked.doubts.emplace(
        after,
        ImportDoubt{"the camera's clock was set in its midst",
                    fmt::format("between {} and {} lie over {:g} s, and the camera counted on: one session",
                                walked.frames[after - 1].label, walked.frames[after].label, gap_s)});
  }
}

/// A file that cannot be opened belongs where the one before it by name does.
void hand_out(std::vector<Error> unreadable, std::vector<SourceGroup>& parts) {
  std::vector<std::pair<std::string, SourceGroup*>> owners;
  for (SourceGroup& part : parts)
    for (const SourceFrame& frame : part.frames) owners.emplace_back(frame.source.file.string(), &part);
  const auto by_name = [](const std::string& a, const std::string& b) { return stands_before(a, b); };
  std::ranges::sort(owners, by_name, [](const auto& owner) { return owner.first; });
  for (Error& error : unreadable) {
    const auto next =
        std::ranges::lower_bound(owners, error.where, by_name, [](const auto& owner) { return owner.first; });
    SourceGroup& owner = next == owners.begin() ? parts.front() : *std::prev(next)->second;
    owner.unreadable.push_back(std::move(error));
  }
}

/// A group whose files have been opened, split where time has gaps.
std::vector<SourceGroup> split_by_time(SourceGroup whole, const GroupingOptions& options) {
  const bool has_sessions = options.pattern && options.pattern->has("session");
  const std::size_t files = whole.frames.size() + whole.unreadable.size();
  if (has_sessions || whole.frames.empty() || files <= options.leds + 1) return {std::move(whole)};
  const std::optional<CountedOrder> counted = counted_order(whole.frames);
  const std::optional<std::vector<std::size_t>> timed = order_of_times(whole.frames);
  if (!counted && !timed) return {std::move(whole)};
  Walked walked =
      parted(in_this_order(std::move(whole.frames), counted ? counted->order : *timed), options.gap_s);
  if (counted) join_by_count(options.leds, options.gap_s, walked);
  std::vector<SourceGroup> parts;
  for (std::size_t s = 0; s + 1 < walked.starts.size(); ++s) {
    SourceGroup& part =
        parts.emplace_back(SourceGroup{whole.name, whole.fabric, whole.root, whole.folder, {}, {}, {}});
    if (walked.starts.size() > 2) part.name += fmt::format("_{:02}", s + 1);
    for (std::size_t f = walked.starts[s]; f < walked.starts[s + 1]; ++f) {
      if (const auto doubt = walked.doubts.find(f); doubt != walked.doubts.end())
        part.doubts.push_back(doubt->second);
      part.frames.push_back(std::move(walked.frames[f]));
    }
  }
  if (!whole.unreadable.empty()) hand_out(std::move(whole.unreadable), parts);
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
    opened.push_back({std::move(group.name), std::move(group.fabric), group.root, group.folder, {}, {}, {}});
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
