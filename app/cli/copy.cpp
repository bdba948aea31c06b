// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "capture/scan/copy_request.h"
#include "capture/scan/second_copy.h"

namespace weft::app {
namespace {

Result<int> copy(const capture::CopyRequest& arguments, const CommonArguments& common) {
  const Result<std::filesystem::path> copy = capture::copy_later(arguments.session, arguments.to);
  if (!copy) return copy.error();
  const auto one_disk = capture::warning_of_one_disk(arguments.session, *copy);
  if (one_disk) note("weft: " + *one_disk);
  if (common.json) {
    print_json({{"session", arguments.session.string()}, {"copy", copy->string()}});
  } else {
    print(copy->string());
  }
  return kDone;
}

Run add_copy(Options& options) {
  const auto a = std::make_shared<capture::CopyRequest>();
  add_options(options, *a);
  return [a](const CommonArguments& common) { return copy(*a, common); };
}

}  // namespace

Verb copy_verb() {
  return {"copy", "Make or verify the second copy of a finished session", add_copy};
}

}  // namespace weft::app
