// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

// What a scene may say about its camera beyond an ideal pinhole with an ideal sensor. The default of every
// number is that ideal.

namespace weft::simulator {

/// Brown-Conrady distortion in the coefficients of OpenCV, and where the optical axis meets the sensor.
struct LensSettings {
  double k1 = 0, k2 = 0, k3 = 0;  ///< radial, -10 to 10; what folds the picture is refused (lens.h)
  double p1 = 0, p2 = 0;          ///< tangential, -1 to 1
  double offset_x_px = 0;         ///< of the principal point from the frame's centre, right, -5000 to 5000
  double offset_y_px = 0;         ///< down, -5000 to 5000

  bool operator==(const LensSettings&) const = default;
};

/// The camera looks at a point of the table from the scene's camera distance.
struct PoseSettings {
  double tilt_deg = 0;     ///< between the line of sight and z, 0 to 80
  double azimuth_deg = 0;  ///< where the tilted camera stands, from x towards y, -360 to 360
  double roll_deg = 0;     ///< of the camera about its line of sight, clockwise as seen from it, -360 to 360
  double x_mm = 0;         ///< the point of the table it looks at, -10000 to 10000
  double y_mm = 0;         ///< -10000 to 10000

  bool operator==(const PoseSettings&) const = default;
};

/// How far the cloth is moved between one shot and the next: standard deviations.
struct MovementSettings {
  double sigma_mm = 0;   ///< of the shift along x and along y, 0 to 100
  double sigma_deg = 0;  ///< of the turn about the table's centre, 0 to 45

  bool operator==(const MovementSettings&) const = default;
};

/// Shots that a session has beyond one a LED and the dark one.
struct RetakeSettings {
  bool repeat = false;            ///< LED 1 once more, after the last LED
  std::optional<double> bracket;  ///< every LED once more, for so many times the exposure, 0.001 to 100
  double shutter_error = 0;       ///< share of light a bracket gathers beyond what its time says, -0.5 to 1

  bool operator==(const RetakeSettings&) const = default;
};

/// Light lost towards the edge of the frame.
struct VignetteSettings {
  double cosine_power = 4;  ///< natural: the law of cos^4 by default, 0 (a telecentric lens) to 8
  double corner_loss = 0;   ///< mechanical: share lost in the farthest corner, 0 to 0.5

  bool operator==(const VignetteSettings&) const = default;
};

/// Where the light of a point goes.
struct BlurSettings {
  double defocus_px = 0;      ///< diameter of the circle of confusion, 0 to 32
  double spread_px = 0;       ///< standard deviation of the point spread, 0 to 5
  double halo_share = 0;      ///< share of the light that goes into a disc around the point, 0 to 0.5
  double halo_radius_px = 8;  ///< radius of the disc, 1 to 40

  bool operator==(const BlurSettings&) const = default;
};

/// Focus on a bowl instead of a plane: what is sharp at the frame's centre is not in its corners.
struct FieldSettings {
  double corner_px = 0;  ///< diameter of the circle of confusion in the farthest corner, 0 to 16

  bool operator==(const FieldSettings&) const = default;
};

/// Lateral colour: in the frame's farthest corner, a photosite of that colour sees what a green one sees so
/// much nearer to the optical axis.
struct ChromaticSettings {
  double red_px = 0;   ///< -10 to 10
  double blue_px = 0;  ///< -10 to 10

  bool operator==(const ChromaticSettings&) const = default;
};

/// Light that reflections within the lens spread over the whole frame.
struct VeilSettings {
  double share = 0;     ///< of the frame's mean light, 0 to 0.2
  double spread = 0.3;  ///< standard deviation of how far a point's light goes, frame diagonals, 0.05 to 10

  bool operator==(const VeilSettings&) const = default;
};

/// How photosites differ. Counts are those of the scene's converter, whatever its bits.
struct DefectSettings {
  double dark_electrons_per_s = 0;  ///< of a photosite at 25 degrees Celsius, 0 to 1e6
  double temperature_c = 25;        ///< of the sensor, degrees Celsius, -50 to 100
  double dark_doubling_c = 6;       ///< warming that doubles dark current and hot pixels, 2 to 20
  double response_percent = 0;      ///< PRNU: standard deviation of a photosite's response, 0 to 20
  double column_counts = 0;         ///< standard deviation of a column's black level, 0 to 1000
  double photosite_counts = 0;      ///< standard deviation of a photosite's black level, 0 to 1000
  std::array<std::array<double, 2>, 2> cell_counts = {};  ///< of [y & 1][x & 1], -1000 to 1000
  double hot_per_million = 0;                             ///< photosites with more dark current, 0 to 1e5
  double hot_electrons_per_s = 10000;                     ///< mean of that, at 25 degrees Celsius, 0 to 1e9
  double dead_per_million = 0;                            ///< photosites that see too little, 0 to 1e5
  double dead_response = 0;                               ///< of the light that they see, 0 to 0.9

  bool operator==(const DefectSettings&) const = default;
};

/// What runs out of a photosite that is full.
struct BloomSettings {
  double share = 0;    ///< of the charge above a full well that spills along the column, 0 to 1
  double decay = 0.5;  ///< of the spill from one photosite to the next, 0 to 0.9

  bool operator==(const BloomSettings&) const = default;
};

/// The made-up camera bodies, by how they store no light.
enum class Body {
  kOffset,  ///< black at 600 counts, so that noise below it survives; white at 15520
  kD5100,   ///< black subtracted and clipped at 0, as a Nikon D5100 does; white at 15846
  kD80,     ///< the same sensor by another name: the virtual rig's second body
};

/// The camera of a scene. A comment that begins with the name of an effect says where the value counts.
struct CameraSettings {
  int width = 2464;  ///< photosites, even: whole filter cells
  int height = 1632;
  double mm_per_pixel = 0.08;  ///< on the table, z = 0
  double distance_mm = 600;    ///< from the table to the projection centre
  Body body = Body::kOffset;
  int bits = 14;                       ///< 12, 14 or 16; black and white scale with it
  double full_well_electrons = 40000;  ///< electrons of a photosite at white, at ISO 100
  double read_noise_electrons = 3;     ///< standard deviation
  double iso = 100;
  double f_number = 8;  ///< recorded; the flux of the LEDs is what arrives through it
  std::optional<double> exposure_us;
  /// Without exposure_us: the albedo that, at the table's centre and facing a LED, gives 0.90 of full scale
  /// in the brightest channel of the brightest LED.
  double albedo_at_full = 0.99;

  PoseSettings pose;                                          ///< no effect but geometry: always there
  LensSettings lens = {.k1 = -0.06, .k2 = 0.02};              ///< distortion
  RetakeSettings retakes;                                     ///< no effect but more shots
  MovementSettings movement = {0.02, 0.005};                  ///< movement
  VignetteSettings vignette = {4, 0.05};                      ///< vignetting
  BlurSettings blur = {.defocus_px = 0.5, .spread_px = 0.4};  ///< defocus
  FieldSettings field = {.corner_px = 1};                     ///< field_curvature
  ChromaticSettings chromatic = {0.4, -0.4};                  ///< chromatic_aberration
  VeilSettings veil = {.share = 0.005};                       ///< veil
  BloomSettings bloom = {.share = 0.5};                       ///< bloom
  std::array<double, 2> linearity = {0.01, -0.005};           ///< nonlinearity: Response::linearity
  DefectSettings defects = {.dark_electrons_per_s = 5,        ///< dark_current, uneven_response
                            .response_percent = 0.4,
                            .column_counts = 0.3,
                            .photosite_counts = 0.3,
                            .hot_per_million = 20,
                            .dead_per_million = 2};

  bool operator==(const CameraSettings&) const = default;
};

}  // namespace weft::simulator
