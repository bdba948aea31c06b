// SPDX-License-Identifier: Apache-2.0
#include "solve/files/pictures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "core/base/parallel.h"
#include "core/image_io/image_io.h"

namespace weft::solve {

namespace fs = std::filesystem;

Result<void> write_png(const fs::path& file, const report::Picture& picture) {
  const std::array<View<const float>, 3> planes = {picture.plane(0), picture.plane(1), picture.plane(2)};
  return write_image(file, planes, {"R", "G", "B"}, {.type = SampleType::kUint8});
}

Result<TruthError> error_against(const fs::path& truth, const fs::path& normal, int threads) {
  std::array<std::optional<Result<LoadedImage>>, 2> read;
  parallel_for(read.size(), threads,
               [&](std::size_t i, int) { read[i] = read_image(i == 0 ? truth : normal); });
  const Result<LoadedImage>&real = *read[0], &solved = *read[1];
  if (!real) return real.error();
  if (!solved) return solved.error();
  const Size size = solved->info.size;
  if (real->info.size != size || real->planes.planes() < 3) {
    return Error{ErrorKind::kBadData, "truth does not fit the photographs", truth.string(),
                 fmt::format("{} x {} pixels instead of {} x {}", real->info.size.width,
                             real->info.size.height, size.width, size.height),
                 "simulate the session again"};
  }
  TruthError error = {{}, report::Downsampler(size, 1)};
  Image<float> all(size);
  parallel_for(static_cast<std::size_t>(size.height), threads, [&](std::size_t y, int) {
    const Rect line = {0, static_cast<int>(y), size.width, static_cast<int>(y) + 1};
    const auto row = [&](View<const float> plane) { return plane.crop(line); };
    const auto rows = [&](const LoadedImage& image) {
      return std::array<View<const float>, 3>{row(image.planes.plane(0)), row(image.planes.plane(1)),
                                              row(image.planes.plane(2))};
    };
    report::angular_error_deg(rows(*solved), rows(*real), all.plane().crop(line));
  });
  error.reduced_deg.add_rows(std::array{View<const float>(all.plane())});
  std::vector<float> angles;
  for (int y = 0; y < size.height; ++y) {
    std::copy_if(all.plane().row(y), all.plane().row(y) + size.width, std::back_inserter(angles),
                 [](float angle) { return std::isfinite(angle); });
  }
  error.normal = summarize(angles);
  return error;
}

Pictures::Pictures(Size size) : normal_(size, 3), albedo_(size, 3), status_(size) {}

void Pictures::add(const MapBand& band) {
  normal_.add_rows(band.normal, band.status);
  albedo_.add_rows(band.albedo);
  status_.add_rows(band.status);
}

Result<std::vector<std::string>> Pictures::write(const fs::path& folder, const std::string& title,
                                                 bool absolute_albedo, const TruthError* error,
                                                 int threads) const {
  const Image<float>&normal = normal_.averages(), &albedo = albedo_.averages();
  const double scale = absolute_albedo ? 1 : report::display_scale(albedo);
  struct Drawn {
    const char* name;
    const char* label;
    std::string note;
    std::function<report::Picture()> picture;
  };
  std::vector<Drawn> drawn = {
      {"albedo.png", "albedo", absolute_albedo ? "sRGB, absolute" : fmt::format("sRGB, x {:.3g}", scale),
       [&] { return report::albedo_picture(albedo, scale); }},
      {"normal.png", "normal", "OpenGL, green up", [&] { return report::normal_picture(normal); }},
      {"relit.png", "relit", "lamp from the upper left",
       [&] { return report::relit_picture(albedo, normal, scale); }}};
  if (error != nullptr) {
    drawn.push_back({"error.png", "error", fmt::format("mean {:.3f}°", error->normal.mean_deg), [&] {
                       const View<const float> reduced = error->reduced_deg.averages().plane();
                       return report::heat_picture(reduced, report::round_full_scale(reduced));
                     }});
  } else {
    drawn.push_back({"status_preview.png", "status", "", [&] { return status_.picture(); }});
  }
  std::vector<std::string> names;
  std::vector<report::Panel> panels;
  for (const Drawn& each : drawn) {
    names.emplace_back(each.name);
    panels.push_back({each.label, each.note, {}});
  }
  names.emplace_back("sheet.png");
  parallel_for(drawn.size(), threads, [&](std::size_t i, int) { panels[i].picture = drawn[i].picture(); });
  // The sheet is the largest, so it begins.
  std::vector<Result<void>> written(names.size());
  parallel_for(names.size(), threads, [&](std::size_t i, int) {
    const bool is_sheet = i == 0;
    written[i] = is_sheet ? write_png(folder / names.back(), report::contact_sheet(title, panels))
                          : write_png(folder / names[i - 1], panels[i - 1].picture);
  });
  for (Result<void>& ok : written) {
    if (!ok) return std::move(ok).error();
  }
  return names;
}

}  // namespace weft::solve
