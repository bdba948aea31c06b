// SPDX-License-Identifier: Apache-2.0
#include "bench/effects/studies.h"

#include <fmt/format.h>

#include <array>
#include <utility>
#include <vector>

#include "bench/effects/examples.h"
#include "core/image_io/image_io.h"
#include "core/parallel.h"
#include "core/raw_frame.h"
#include "report/preview.h"
#include "simulator/build_passes.h"

namespace weft::bench {
namespace {

using namespace simulator;
using report::Picture;

/// Light by cell of four photosites: planes R, G, B, white-balanced, 1 is full scale.
struct Shown {
  Image<float> light;
  double seconds = 0;
};

Result<Shown> frame_of(const Scene& scene, int led, int threads) {
  const Result<SceneRig> rig = rig_of(scene);
  if (!rig) return rig.error();
  Result<PassList> passes = build_passes(scene, *rig, Output::kCounts);
  if (!passes) return passes.error();
  const Size size = rig->camera.size;
  Shown shown = {Image<float>({size.width / 2, size.height / 2}, 3), 0};
  constexpr CfaPattern kCfa;
  constexpr std::array<double, 3> kShare = {1, 0.5, 1};  // of a photosite in its cell: two are green
  const Sensor& sensor = rig->sensor;
  PassRunner runner(std::move(*passes), {.threads = threads});
  Result<void> ran;
  shown.seconds = least_seconds(1, [&] {
    ran = runner.run(
        {0, 0, size.width, size.height}, {&led, 1}, {}, [](const Tile&) {},
        [&](const Tile& tile) {
          for_each_pixel(tile.rect, [&](std::size_t i, int x, int y) {
            const int c = kCfa.channel_at(x, y);
            const auto channel = static_cast<std::size_t>(c);
            const double signal = (tile.counts[i] - sensor.black) / (sensor.white - sensor.black);
            shown.light(x / 2, y / 2, c) +=
                static_cast<float>(kShare[channel] * signal / scene.lights.white_balance[channel]);
          });
        });
  });
  if (!ran) return ran.error();
  return shown;
}

/// level(i of a plane and pixel) for all three planes, in sRGB.
template <typename Level>
Picture picture_of(Size size, const Level& level) {
  Picture picture(size, 3);
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) picture(x, y, c) = report::srgb_from_linear(level(x, y, c));
    }
  }
  return picture;
}

Result<void> write_sheet(const std::filesystem::path& file, const Example& example, const Image<float>& off,
                         const Image<float>& on) {
  const Size size = {on.width(), on.height()};
  const auto brighten = static_cast<float>(example.brighten);
  const auto lit = [&](const Image<float>& light) {
    return picture_of(size, [&](int x, int y, int c) { return brighten * light(x, y, c); });
  };
  std::vector<report::Panel> panels;
  panels.push_back({"off", "", lit(off)});
  panels.push_back({"on", example.shows, lit(on)});
  if (example.difference > 0) {
    constexpr float kMiddle = 0.2F;
    const auto times = static_cast<float>(example.difference);
    panels.push_back({fmt::format("difference × {:g}", example.difference), "grey: none",
                      picture_of(size, [&](int x, int y, int c) {
                        return kMiddle + times * (on(x, y, c) - off(x, y, c));
                      })});
  }
  const Picture sheet = report::contact_sheet(example.effect, panels, static_cast<int>(panels.size()));
  return write_image(file, std::array<View<const float>, 3>{sheet.plane(0), sheet.plane(1), sheet.plane(2)},
                     {"R", "G", "B"}, {.type = SampleType::kUint8});
}

}  // namespace

/// Writes effects_NAME.png for every effect into `folder`, which is made: a small scene without the effect
/// and with it, and where that is little to see their difference, so many times enlarged, about middle grey.
/// A pixel of the picture is a cell of four photosites, white-balanced, in sRGB. Returns a row a picture with
/// its file, and its time over all pixels drawn; `ratio` is that over the scene without the effect.
Result<Rows> effects_gallery(const std::filesystem::path& folder, int threads) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) {
    return Error{ErrorKind::kCannotCreate, "cannot make the folder of pictures", folder.string(),
                 failed.message(), "choose another folder"};
  }
  Rows rows;
  for (const Example& example : effect_examples()) {
    const Result<Shown> off = frame_of(example.without, example.led, threads);
    if (!off) return off.error();
    const Result<Shown> on = frame_of(example.with, example.led, threads);
    if (!on) return on.error();
    const std::filesystem::path file = folder / ("effects_" + example.effect + ".png");
    if (Result<void> ok = write_sheet(file, example, off->light, on->light); !ok) return ok.error();
    const double photosites = 4.0 * on->light.width() * on->light.height();
    rows.push_back({{"effect", example.effect},
                    {"ns_per_pixel", on->seconds * 1e9 / photosites},
                    {"threads", resolved_threads(threads)},
                    {"ratio", on->seconds / off->seconds},
                    {"shows", example.shows},
                    {"file", file.string()}});
  }
  return rows;
}

}  // namespace weft::bench
