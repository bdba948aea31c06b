// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "core/image/image.h"
#include "core/image/raw_frame.h"
#include "core/rig/camera.h"
#include "core/rig/lateral_color.h"

namespace weft::solver {

/// Rows of the maps of a mosaic, (0, 0) of each view being column 0 of the image's row `first_row`. Albedo is
/// demosaiced; a photosite's own colour is as it was measured.
struct MosaicRows {
  Size image;
  int first_row = 0;
  CfaPattern cfa;
  std::array<View<const float>, 3> normal, albedo, sigma_albedo;
  View<const float> sigma_normal_deg, residual;
  View<const std::uint16_t> status;
};

/// Rows of what becomes of them, (0, 0) being column 0 of row `first_row`.
struct AlignedRows {
  int first_row = 0;
  std::array<View<float>, 3> normal;
  View<float> rho, sigma_rho;  ///< albedo of each photosite in its own colour, to be demosaiced again
  View<float> sigma_normal_deg, residual;
  View<std::uint16_t> status;
};

/// Puts what red and blue photosites measured where green ones look. Behind a lens with lateral colour they
/// were solved for another place of the cloth than the pixel they stand in.
///
/// Each takes what the photosite of its colour measured that looks nearest to it, less what changes from
/// there to here: the monotonized central difference (van Leer 1977) of the albedo demosaiced around, and of
/// the normals of green. At the edge of a yarn, which one side alone shows, nothing is taken off. Sigma,
/// residual and status are that photosite's; the noise of the change is not in sigma.
///
/// Beyond the frame its last pixels go on. A photosite stays as it is where one without a solution is among
/// all that it would be made from, and where its shift is 0.
class LateralAlignment {
 public:
  LateralAlignment(const LateralColor& lateral, const CameraModel& camera);

  /// Rows above and below an area that aligning it looks at.
  int reach() const { return most_px_ + 6; }

  /// Fills `area`, whole rows; `from` has it grown by reach(), as far as the image goes.
  void align(const MosaicRows& from, Rect area, const AlignedRows& out) const;

 private:
  LateralColor lateral_;
  CameraModel camera_;
  int most_px_;  // that a photosite looks aside, rounded up
};

}  // namespace weft::solver
