// SPDX-License-Identifier: Apache-2.0
#include "tests/app/server/view/asked_session.h"

#include <fmt/format.h>

#include "simulator/scene/scene.h"
#include "simulator/simulate.h"

namespace weft::app {

void AskedSession::SetUpTestSuite() {
  folder_ = std::make_unique<TemporaryFolder>();
  const auto scene = simulator::parse_scene(
      fmt::format(
          "fabric = \"asked\"\n[camera]\nwidth = {}\nheight = {}\nmm_per_pixel = {}\n"
          "[geometry]\nfamily = \"deep\"\n[effects]\nnear_light = true\nrelief = true\nnoise = true\n",
          kFrame.width, kFrame.height, kMmPerPixel),
      "scene");
  ASSERT_TRUE(scene) << scene.error().message();
  std::filesystem::create_directories(root() / "scans");
  const auto made = simulator::simulate_session(*scene, session(), {});
  ASSERT_TRUE(made) << made.error().message();
  solve::SessionOptions input;
  input.folder = session();
  const Result<solve::SolveReport> report = solve::solve_session(input, {}, {});
  ASSERT_TRUE(report) << report.error().message();
  solve_ = report->facts;
  maps_ = report->folder;
}

}  // namespace weft::app
