// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "app/cli/arguments.h"
#include "core/result.h"

// One function a verb: runs it, prints its result, and returns the exit code of a success.

namespace weft::app {

Result<int> run_simulate(const SimulateArguments& arguments, const CommonArguments& common);
Result<int> run_calibrate(const CalibrateArguments& arguments, const CommonArguments& common);
Result<int> run_rectify(const RectifyOptions& options, const CommonArguments& common);
Result<int> run_solve(const SolveArguments& arguments, const CommonArguments& common);
Result<int> run_compare(const CompareArguments& arguments, const CommonArguments& common);
Result<int> run_bench_solve(const BenchSolveArguments& arguments, const CommonArguments& common);
Result<int> run_bench_accuracy(const BenchAccuracyArguments& arguments, const CommonArguments& common);
Result<int> run_bench_explain(const BenchExplainArguments& arguments, const CommonArguments& common);
Result<int> run_bench_photos(const BenchPhotosArguments& arguments, const CommonArguments& common);
Result<int> run_bench_numerics(const BenchNumericsArguments& arguments, const CommonArguments& common);
Result<int> run_bench_effects(const BenchEffectsArguments& arguments, const CommonArguments& common);
Result<int> run_bench_height(const BenchHeightArguments& arguments, const CommonArguments& common);
Result<int> run_bench_transport(const BenchTransportArguments& arguments, const CommonArguments& common);
Result<int> run_bench_registration(const BenchRegistrationArguments& arguments,
                                   const CommonArguments& common);
Result<int> run_bench_calibration(const BenchCalibrationArguments& arguments, const CommonArguments& common);
Result<int> run_bench_capture(const BenchCaptureArguments& arguments, const CommonArguments& common);
Result<int> run_serve(const ServeArguments& arguments, const CommonArguments& common);
Result<int> run_scan(const ScanArguments& arguments, const CommonArguments& common);
Result<int> run_rig(const RigArguments& arguments, const CommonArguments& common);
Result<int> run_doctor(const DoctorArguments& arguments, const CommonArguments& common);
Result<int> run_copy(const CopyArguments& arguments, const CommonArguments& common);
Result<int> run_demo(const DemoArguments& arguments, const CommonArguments& common);

}  // namespace weft::app
