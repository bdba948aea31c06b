// SPDX-License-Identifier: Apache-2.0
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"
#include "capture/scan/second_copy.h"

namespace weft::app {

Result<int> run_copy(const CopyArguments& arguments, const CommonArguments& common) {
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

}  // namespace weft::app
