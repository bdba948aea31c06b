// SPDX-License-Identifier: Apache-2.0
#include <exception>
#include <new>

#include "app/cli/arguments.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verbs.h"

namespace weft::app {
namespace {

template <typename... Run>
struct Overload : Run... {
  using Run::operator()...;
};
template <typename... Run>
Overload(Run...) -> Overload<Run...>;

Result<int> run(const Arguments& arguments) {
  const CommonArguments& common = arguments.common;
  return std::visit(
      Overload{[&](const SimulateArguments& a) { return run_simulate(a, common); },
               [&](const CalibrateArguments& a) { return run_calibrate(a, common); },
               [&](const RectifyOptions& a) { return run_rectify(a, common); },
               [&](const SolveArguments& a) { return run_solve(a, common); },
               [&](const CompareArguments& a) { return run_compare(a, common); },
               [&](const BenchSolveArguments& a) { return run_bench_solve(a, common); },
               [&](const BenchNumericsArguments& a) { return run_bench_numerics(a, common); },
               [&](const BenchAccuracyArguments& a) { return run_bench_accuracy(a, common); },
               [&](const BenchExplainArguments& a) { return run_bench_explain(a, common); },
               [&](const BenchPhotosArguments& a) { return run_bench_photos(a, common); },
               [&](const BenchEffectsArguments& a) { return run_bench_effects(a, common); },
               [&](const BenchHeightArguments& a) { return run_bench_height(a, common); },
               [&](const BenchTransportArguments& a) { return run_bench_transport(a, common); },
               [&](const BenchRegistrationArguments& a) { return run_bench_registration(a, common); },
               [&](const BenchCalibrationArguments& a) { return run_bench_calibration(a, common); },
               [&](const BenchCaptureArguments& a) { return run_bench_capture(a, common); },
               [&](const ServeArguments& a) { return run_serve(a, common); },
               [&](const ScanArguments& a) { return run_scan(a, common); },
               [&](const RigArguments& a) { return run_rig(a, common); },
               [&](const DoctorArguments& a) { return run_doctor(a, common); },
               [&](const CopyArguments& a) { return run_copy(a, common); },
               [&](const DemoArguments& a) { return run_demo(a, common); }},
      arguments.verb);
}

// The one place where an error becomes words and an exit code.
int finish(Result<int> result) {
  if (Result<void> printed = flush_output(); result && !printed) result = std::move(printed).error();
  if (result) return *result;
  complain(result.error());
  return exit_code_of(result.error().kind);
}

int main_of(int argc, char** argv) {
  int exit_code = kDone;
  const std::optional<Arguments> arguments = parse_arguments(argc, argv, exit_code);
  if (!arguments) return exit_code;
  try {
    return finish(run(*arguments));
  } catch (const std::bad_alloc&) {
    return finish(Error{ErrorKind::kTryAgain, "out of memory", "", "",
                        "close other programs, or use a larger machine"});
  } catch (const std::exception& bug) {
    return finish(
        Error{ErrorKind::kInternal, "a bug in weft", "", bug.what(), "report it with the command you ran"});
  }
}

}  // namespace
}  // namespace weft::app

int main(int argc, char** argv) {
  return weft::app::main_of(argc, argv);
}
