// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/result.h"
#include "core/image/image.h"
#include "core/rig/camera.h"

// Maps as photographed, resampled onto a square grid of the table: lens and perspective removed.

namespace weft::material {

/// Square pixels on the plane z = `height_mm` of the rig frame. Columns run along the rig's x axis turned by
/// `turn_deg` counterclockwise seen from above, rows downwards.
struct TableGrid {
  Size size;
  double mm_per_pixel = 0;
  double height_mm = 0;
  double turn_deg = 0;
  double centre_x_mm = 0, centre_y_mm = 0;  ///< of the picture's centre

  /// Rig frame; (0, 0) is the centre of the top left pixel.
  Vec3 point_mm(double x, double y) const;
};

/// What is asked of a grid on the table.
struct TableGridOptions {
  double mm_per_pixel = 0;  ///< 0: what the camera sees at the grid's centre
  double height_mm = 0;     ///< of the cloth's surface above the table
  double turn_deg = 0;      ///< -360 to 360
};

/// The largest grid with the frame's proportions around what the frame's centre sees that lies in the frame
/// everywhere. kBadData where the camera does not see the plane from above; kUsage for a size that is not
/// above 0 or gives a grid of less than 1 or over 32768 pixels a side.
Result<TableGrid> table_grid(const CameraModel& camera, const TableGridOptions& options);

/// Planes that a map may have.
inline constexpr std::size_t kMostPlanes = 16;

/// How values of a map go together.
enum class MapKind {
  kValue,   ///< weighted means
  kNormal,  ///< three planes X, Y, Z in the rig frame: turned into the grid's axes and brought to unit length
  kSigma,   ///< standard deviations of pixels: root of the weighted mean square, never below 0
  kChoice,  ///< values that have no mean, as azimuths of yarns: those of the nearest pixel
};

/// Rows `y0` <= y < `y0` + out height of a map on the grid. Each output pixel is a weighted mean of the
/// photographed pixels around its place, by cubic convolution with a = -1/2 (Keys 1981, eq. 15) along x and
/// along y, exact for what is quadratic; where the grid is coarser than the frame the kernel is stretched by
/// their ratio, so that nothing finer than the grid aliases. For kSigma the weights' squares take their
/// place.
///
/// Pixels whose status has kNoSolution and values that are not finite are left out; where they hold half of
/// the weight or more the output is that of no solution: 0, the normal (0, 0, 1), sigma `no_sigma`. No output
/// is NaN. `map` is a plane a view, kMostPlanes at most, of the camera's
/// size; `out` has as many.
void rectify_rows(const CameraModel& camera, const TableGrid& grid, MapKind kind,
                  std::span<const View<const float>> map, View<const std::uint16_t> status, int y0,
                  int threads, std::span<const View<float>> out, float no_sigma = 180);

/// The same of a status map: the nearest pixel's, with kNoSolution where rectify_rows() finds none.
void rectify_status_rows(const CameraModel& camera, const TableGrid& grid, View<const std::uint16_t> status,
                         int y0, int threads, View<std::uint16_t> out);

/// The camera of maps that are smaller than the frame by a whole number.
CameraModel reduced_camera(CameraModel camera, int factor);

}  // namespace weft::material
