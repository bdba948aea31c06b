// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/rig_options.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "calibration/guide/printed_target.h"
#include "capture/rig.h"
#include "core/base/files.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct TargetArguments {
  calibration::TargetRequest request;
  fs::path rig, print;
};

Result<int> print_it(const TargetArguments& a, const CommonArguments& common) {
  const Result<capture::Rig> rig = capture::read_rig(find_rig(a.rig));
  if (!rig) return rig.error();
  const Result<calibration::PrintedTarget> target = calibration::print_for_rig(a.request, *rig);
  if (!target) return target.error();
  fs::path pdf = calibration::pdf_of_target(*rig, target->name);
  if (!a.print.empty()) {
    pdf = a.print;
    if (Result<void> written = write_file(pdf, target->pdf); !written) return std::move(written).error();
  }
  if (common.json) {
    print_json({{"target", target->name},
                {"pdf", pdf.string()},
                {"says", target->says},
                {"remedy", target->remedy}});
    return kDone;
  }
  print(fmt::format("{}: {}\n  to print: {}", target->name, target->says, pdf.string()));
  note("To do: " + target->remedy + ".");
  return kDone;
}

Run add_target(Options& options) {
  const auto a = std::make_shared<TargetArguments>();
  add_options(options, a->request);
  add_rig_file(options, a->rig);
  options.add("--print", &a->print,
              "PDF to write, one page at its true size; default targets/NAME.pdf beside the rig file");
  return [a](const CommonArguments& common) { return print_it(*a, common); };
}

}  // namespace

Verb target_verb() {
  return {"target",
          "Print what a rig is calibrated with: a board, a white sheet, tags, a chart, a ball's stand",
          add_target};
}

}  // namespace weft::app
