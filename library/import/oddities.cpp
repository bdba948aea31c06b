// SPDX-License-Identifier: Apache-2.0
#include "library/import/oddities.h"

#include <fmt/format.h>

#include <map>
#include <tuple>
#include <utility>

#include "core/base/text.h"

namespace weft::library {
namespace {

constexpr std::size_t kNamesKept = 4;

class OddityCount {
 public:
  void add(OddityKind kind, const std::string& what, const std::string& remedy, std::string name) {
    const auto [place, is_new] = places_.try_emplace({kind, what, remedy}, all_.size());
    if (is_new) all_.push_back({kind, what, remedy, 0, {}});
    ImportOddity& oddity = all_[place->second];
    if (oddity.first.size() < kNamesKept) oddity.first.push_back(std::move(name));
    ++oddity.count;
  }
  std::vector<ImportOddity> counted() { return std::move(all_); }

 private:
  std::vector<ImportOddity> all_;
  std::map<std::tuple<OddityKind, std::string, std::string>, std::size_t> places_;
};

std::string name_of(const Session& session) {
  return session.folder.filename().string();
}

}  // namespace

std::vector<ImportOddity> oddities_of(const ImportProposal& plan) {
  OddityCount count;
  const auto refused = [&](const auto& all) {
    for (const auto& each : all)
      if (each.refusal)
        count.add(OddityKind::kRefused, each.refusal->what, each.refusal->remedy, name_of(each.session));
  };
  refused(plan.sessions);
  refused(plan.photographs);
  for (const ProposedSession& session : plan.sessions) {
    for (const ImportDoubt& doubt : session.warnings)
      if (!session.refusal) count.add(OddityKind::kDoubtful, doubt.kind, "", name_of(session.session));
  }
  for (const LeftOver& left : plan.left_over)
    count.add(OddityKind::kLeftOver, left.why, "", left.file.string());
  return count.counted();
}

std::string words_of(const ImportOddity& oddity) {
  const bool is_one = oddity.count == 1;
  const std::string names = first_few(oddity.first, oddity.count);
  switch (oddity.kind) {
    case OddityKind::kRefused:
      return fmt::format("{} session{} refused: {}: {}. To do: {}.", oddity.count, is_one ? " is" : "s are",
                         oddity.what, names, oddity.remedy);
    case OddityKind::kDoubtful:
      return fmt::format("{} session{} to be looked at: {}: {}.", oddity.count, is_one ? " is" : "s are",
                         oddity.what, names);
    case OddityKind::kLeftOver:
      break;
  }
  return fmt::format("{} file{} left over: {}: {}.", oddity.count, is_one ? " is" : "s are", oddity.what,
                     names);
}

}  // namespace weft::library
