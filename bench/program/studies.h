// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options.h"
#include "app/cli/verb.h"
#include "bench/base/study.h"

namespace weft::bench {

/// One of some studies and what is asked of it: what the options of a verb are read into.
struct StudyChoice {
  std::vector<Study> studies;
  std::string part;          ///< the name of one
  std::deque<bool> by_flag;  ///< one each; none: the first
  StudyOptions options;
};
using Choice = std::shared_ptr<StudyChoice>;

/// --part names one of them; else it is the first.
Choice by_part(app::Options& options, std::vector<Study> studies);
/// The first, or one of the others by a flag of its name, which is then among `instead`. Of one study: that.
Choice by_flag(app::Options& options, std::vector<Study> studies,
               std::vector<app::Option>* instead = nullptr);
void exclude_each_other(const std::vector<app::Option>& options);

/// Measures it, with progress, and prints the rows as a table or with --json as a document.
app::Run run_of(const Choice& choice);

/// The verbs of `weft bench`, in the order of its help.
std::vector<app::Verb> verbs();

// Those with a file each.
app::Verb accuracy_verb();
app::Verb explain_verb();
app::Verb photos_verb();
app::Verb cloths_verb();
app::Verb forecast_verb();
app::Verb sanity_verb();
app::Verb frames_verb();
app::Verb capture_verb();
app::Verb page_verb();

}  // namespace weft::bench
