// SPDX-License-Identifier: Apache-2.0
#include "tests/capture/scan/scan_bench.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/raw/decode_raw.h"
#include "capture/scan/scan_plan.h"
#include "core/base/files.h"

namespace weft::test {
namespace {

namespace fs = std::filesystem;

const SimulatedCloth& cloth() {
  static const SimulatedCloth one(small_scene());
  return one;
}

fs::path fresh_folder() {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(testing::TempDir()) / "weft_scan" /
                          fmt::format("{}.{}", info->test_suite_name(), info->name());
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

double mean_difference(const RawFrame& a, const RawFrame& b) {
  double sum = 0;
  for (int y = 0; y < a.counts.height(); ++y) {
    for (int x = 0; x < a.counts.width(); ++x) sum += std::abs(a.counts(x, y) - b.counts(x, y));
  }
  return sum / static_cast<double>(a.counts.size().pixels());
}

}  // namespace

ScanBench::ScanBench() : folder(fresh_folder()), rig(cloth()) {
  Calibration calibration = cloth().calibration();
  if (calibration.response) calibration.response->iso = request.exposure.iso;
  const Result<Calibration> written = write_calibration(folder / "calibration", calibration);
  EXPECT_TRUE(written) << written.error().message();
  request.session = folder / "cloth.weft";
  request.fabric = "plain weave";
  request.rig = cloth().calibration().subject.rig;
  request.calibration = folder / "calibration";
  request.exposure.exposure_us =
      capture::nearest_time_us(rig.camera().shutter_times_us().value(), 0.8 * cloth().scene_exposure_us());
}

Result<capture::ScanOutcome> ScanBench::scan() {
  kept.clear();
  refused.clear();
  statuses.clear();
  capture::ScanEvents events;
  events.status = [&](const capture::ScanStatus& status) {
    statuses.push_back(status);
    on_status(status);
  };
  events.kept = [&](const capture::KeptFrame& frame) { kept.push_back(frame); };
  events.refused = [&](const capture::RefusedFrame& frame) { refused.push_back(frame); };
  return capture::scan(request, rig.lamps(), rig.camera(), events, control, options);
}

std::string ScanBench::objection() const {
  const Result<Session> session = read_session(request.session);
  if (!session) return session.error().message();
  if (session->state != "complete") return "state is " + session->state;
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(session->folder / "raw"))
    files.push_back(entry.path().filename());
  if (files.size() != session->shots.size()) {
    return fmt::format("{} files of {} frames", files.size(), session->shots.size());
  }
  if (is_there(session->folder / "incoming")) return "incoming/ is left";
  for (const Shot& shot : session->shots) {
    const Result<std::string> digest = sha256_of_file(session->path_of(shot));
    if (!digest || *digest != shot.sha256) return shot.file + " is not what session.json says";
    const Result<RawFrame> frame = capture::decode_raw(session->path_of(shot));
    if (!frame) return frame.error().message();
    Lighting lighting;
    if (shot.led > 0) lighting.leds[shot.led] = 1;
    const RawFrame right = cloth().photograph(lighting, shot.exposure_us, 999);
    // Two takes differ by their noise: under 60 counts at full scale; two LEDs by hundreds.
    const double off = mean_difference(*frame, right);
    if (off > 90) return fmt::format("{} differs from LED {} by {:.0f} counts", shot.file, shot.led, off);
  }
  return "";
}

}  // namespace weft::test
