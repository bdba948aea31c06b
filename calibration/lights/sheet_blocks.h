// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/image/image.h"
#include "core/image/raw_frame.h"

namespace weft::calibration {

/// What one channel of a square of pixels reads.
struct BlockMean {
  double reading = 0;         ///< at the block's centre: NaN where a photosite is full or most are missing
  float standard_error = 0;   ///< of `reading`, from the scatter of its photosites: noise and fine texture
  std::uint16_t count = 0;    ///< photosites that were averaged
  std::uint16_t clipped = 0;  ///< photosites left out as outliers
  std::uint16_t full = 0;     ///< saturated photosites
};

/// A frame of readings as averages of squares. Rows and columns that do not fill a square are left out.
struct SheetBlockGrid {
  int block_px = 16;
  int columns = 0;
  int rows = 0;
  std::vector<BlockMean> blocks;  ///< row by row, three channels each

  SheetBlockGrid() = default;
  SheetBlockGrid(Size frame, int side_px);
  const BlockMean& at(int column, int row, int channel) const { return blocks[index(column, row, channel)]; }
  BlockMean& at(int column, int row, int channel) { return blocks[index(column, row, channel)]; }
  /// Pixel coordinate of the centre of the i-th column or row.
  double centre_px(int i) const { return (i + 0.5) * block_px - 0.5; }

 private:
  std::size_t index(int column, int row, int channel) const {
    const auto place =
        static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
    return 3 * place + static_cast<std::size_t>(channel);
  }
};

/// A photosite this many standard deviations off the plane through its block is left out.
inline constexpr double kClipFrom_sigmas = 4;

/// Averages row `row` of blocks from the `grid.block_px` rows of readings that it covers, which begin at
/// row 0 of `band`. Of a mosaic, each channel from its own photosites (`cfa` is that of the frame, whose
/// block rows begin on even rows). A plane is fitted through each channel of a block (Gauss 1809), photosites
/// far off it are left out and the plane is fitted again: the reading is its value at the block's centre, so
/// neither the place of a channel's photosites in the cell nor the slope of the light across the block shifts
/// it or counts as noise. Sums are in double. Holds nothing but the blocks: readings come band by band.
void average_row(SheetBlockGrid& grid, int row, View<const float> band, const CfaPattern& cfa);
/// The same of developed pictures, planes R, G, B.
void average_row(SheetBlockGrid& grid, int row, const std::array<View<const float>, 3>& band);

/// Several blocks as one.
struct MergedBlock {
  double x_px = 0, y_px = 0;                  ///< mean of the centres
  std::array<double, 3> reading_rgb = {};     ///< mean of the readings
  std::array<double, 3> relative_sigma = {};  ///< standard error over the reading
  int blocks = 0;
};

/// Columns x0 <= i < x1 and rows of `places` that hold of one grid; those with a NaN are left out. The
/// standard error is what the blocks' own errors give, or what their scatter about a plane gives where that
/// is more: texture coarser than a photosite.
MergedBlock merge(const SheetBlockGrid& grid, std::span<const std::array<int, 2>> places);

}  // namespace weft::calibration
