// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/calibration.h"

namespace weft {

/// The light of a frame, coarsely: the mean of each square cell, planes R, G, B.
class CoarseLight {
 public:
  /// At most 32 x 32 cells.
  explicit CoarseLight(Size frame);
  CoarseLight(Size frame, int side);

  /// Adds the light of one pixel. What is not finite does not count.
  void add(int x, int y, int channel, float light);

  Size frame() const { return frame_; }
  int side() const { return side_; }  ///< of a cell, pixels; the last ones are cut off by the frame
  Size cells() const { return sum_.size(); }
  double sum(int column, int row, int channel) const {
    return static_cast<double>(sum_(column, row, channel));
  }
  double count(int column, int row, int channel) const {
    return static_cast<double>(count_(column, row, channel));
  }

 private:
  Size frame_;
  int side_;
  Image<double> sum_, count_;
};

/// Light that is spread over a frame, by its square cells.
class SpreadLight {
 public:
  /// What a lens makes of the light of a frame when it spreads all of it by a Gaussian; of even light the
  /// same. Cells without light of a channel count as they would be filled by the others. `spread`: standard
  /// deviation, frame diagonals.
  SpreadLight(const CoarseLight& light, double spread);
  /// Cells of `side` pixels whose light is known: planes R, G, B.
  SpreadLight(int side, Image<float> cells);
  /// That of a part of the frame, which begins on an even row and column.
  SpreadLight part(Rect area) const;

  /// Between the middles of cells, linear; beyond the outermost as there.
  double at(int x, int y, int channel) const;
  /// Takes `share` of it from readings of `part`, whose (0, 0) is the part's corner.
  void take_off(double share, Rect part, const CfaPattern& cfa, View<float> readings) const;

 private:
  double cell_at(int column, int y, int channel) const;

  int side_;
  int x0_ = 0, y0_ = 0;  ///< where the frame begins in what `mean_` is of
  std::shared_ptr<const Image<float>> mean_;
};

/// The veil over one photograph (Veil, core/rig/calibration.h), to be taken from its readings: what the lens
/// spreads of what was seen, less what that holds of the veil itself. Exact where the frame is evenly lit;
/// elsewhere off by about the square of the share.
class VeilOverFrame {
 public:
  /// `read` puts the readings of whole rows of the frame into its view; two of every sixteen are asked for.
  /// Readings that are full or missing do not count: beside large full areas too little is taken off.
  using ReadRows = std::function<void(Rect rows, View<float> out)>;
  VeilOverFrame(const Veil& veil, Size frame, const CfaPattern& cfa, const ReadRows& read);

  void take_off(Rect part, View<float> readings) const { light_.take_off(share_, part, cfa_, readings); }

 private:
  CfaPattern cfa_;
  double share_;
  SpreadLight light_;
};

}  // namespace weft
