// SPDX-License-Identifier: Apache-2.0
#include "solve/files/pictures.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "core/image_io/image_io.h"

namespace weft::solve {

namespace fs = std::filesystem;

Result<void> write_png(const fs::path& file, const report::Picture& picture) {
  const std::array<View<const float>, 3> planes = {picture.plane(0), picture.plane(1), picture.plane(2)};
  return write_image(file, planes, {"R", "G", "B"}, {.type = SampleType::kUint8});
}

Result<TruthError> error_against(const fs::path& truth, const fs::path& normal) {
  const Result<LoadedImage> real = read_image(truth);
  if (!real) return real.error();
  const Result<LoadedImage> solved = read_image(normal);
  if (!solved) return solved.error();
  const Size size = solved->info.size;
  if (real->info.size != size || real->planes.planes() < 3) {
    return Error{ErrorKind::kBadData, "truth does not fit the photographs", truth.string(),
                 fmt::format("{} x {} pixels instead of {} x {}", real->info.size.width,
                             real->info.size.height, size.width, size.height),
                 "simulate the session again"};
  }
  TruthError error = {{}, report::Downsampler(size, 1)};
  std::vector<float> angles;
  Image<float> row({size.width, 1});
  for (int y = 0; y < size.height; ++y) {
    const Rect line = {0, y, size.width, y + 1};
    const auto rows = [&](const LoadedImage& image) {
      return std::array<View<const float>, 3>{image.planes.plane(0).crop(line),
                                              image.planes.plane(1).crop(line),
                                              image.planes.plane(2).crop(line)};
    };
    report::angular_error_deg(rows(*solved), rows(*real), row.plane());
    error.reduced_deg.add_rows(std::array{View<const float>(row.plane())});
    for (int x = 0; x < size.width; ++x) {
      if (std::isfinite(row(x, 0))) angles.push_back(row(x, 0));
    }
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
                                                 bool absolute_albedo, const TruthError* error) const {
  const Image<float>&normal = normal_.averages(), &albedo = albedo_.averages();
  const double scale = absolute_albedo ? 1 : report::display_scale(albedo);
  std::vector<std::string> names;
  std::vector<report::Panel> panels;
  const auto add = [&](const char* name, const char* label, std::string note, report::Picture picture) {
    names.emplace_back(name);
    panels.push_back({label, std::move(note), std::move(picture)});
  };
  add("albedo.png", "albedo", absolute_albedo ? "sRGB, absolute" : fmt::format("sRGB, x {:.3g}", scale),
      report::albedo_picture(albedo, scale));
  add("normal.png", "normal", "OpenGL, green up", report::normal_picture(normal));
  add("relit.png", "relit", "lamp from the upper left", report::relit_picture(albedo, normal, scale));
  if (error != nullptr) {
    const View<const float> reduced = error->reduced_deg.averages().plane();
    add("error.png", "error", fmt::format("mean {:.3f}°", error->normal.mean_deg),
        report::heat_picture(reduced, report::round_full_scale(reduced)));
  } else {
    add("status_preview.png", "status", "", status_.picture());
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (Result<void> ok = write_png(folder / names[i], panels[i].picture); !ok) return std::move(ok).error();
  }
  if (Result<void> ok = write_png(folder / "sheet.png", report::contact_sheet(title, panels)); !ok) {
    return std::move(ok).error();
  }
  names.emplace_back("sheet.png");
  return names;
}

}  // namespace weft::solve
