// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/sanity/drawn_cloth.h"
#include "core/base/result.h"
#include "solve/input/photo_input.h"

namespace weft::bench {

/// Photographs of a drawn cloth and what is said of them, before they are files.
struct DrawnSet {
  enum class Kind { kPng16, kPng8, kTiff16, kExr };

  DrawnCloth cloth;
  std::vector<DrawnLight> lights;  ///< as they were
  std::vector<Vec3> told;          ///< as the light file has them
  bool tells_strengths = false;
  std::vector<Image<float>> photographs;  ///< linear, without noise; 1 is full scale
  std::vector<std::string> names;         ///< of the files, without ending, by light
  Kind kind = Kind::kPng16;
  bool is_srgb = false;              ///< how values are written
  double noise = 0, shot_noise = 0;  ///< at 0, and more by the root of the value
  double black = 0;                  ///< in all of them
  double full = 1;                   ///< where values stop, of the files' full scale
  Image<float> room;                 ///< light of all photographs; empty: none
  bool has_dark = false;             ///< a photograph of that light lies beside them
  Transfer said = Transfer::kAuto;   ///< --transfer
  bool first_is_second = false;      ///< one file is a copy of another
};

/// Everything as it is taken for: 8 to 96 lights of 25 to 75 degrees of height.
DrawnSet draw_set(std::uint32_t seed);

/// What may be wrong with photographs, and which words tell it.
struct SetFault {
  const char* name;
  std::vector<const char*> verdicts;  ///< names, one of which tells it
  std::vector<const char*> words;     ///< in what is assumed, or why it is refused: mended, or told
  void (*make)(DrawnSet&, Draws&);
};
const std::vector<SetFault>& set_faults();  ///< the first is none

/// Files of a set, cloth.lp and a mask where the thing has an edge, and how to solve them.
Result<solve::PhotoOptions> write_set(const DrawnSet& set, const std::filesystem::path& folder, Draws& draws);

}  // namespace weft::bench
