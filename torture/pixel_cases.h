// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bench/oracles/oracle_rig.h"
#include "core/rig/light_field.h"
#include "torture/hard_case.h"

namespace weft::torture {

/// What the angles of a case are measured to.
enum class Against {
  kQuad,    ///< exact arithmetic (113 bits) on the readings that can be used
  kTruth,   ///< the cloth, where readings in shadow do not fit the model
  kNothing  ///< the cloth, of which these readings tell nothing: `fast` must not answer
};

/// Pixels of one tile whose readings, or the lights they are taken by, are hard to solve from.
struct PixelCase {
  std::string number, what;  ///< number: that of docs/numerics.md
  LightField field;
  std::function<test::Truth(int x, int y)> truth;
  std::function<void(test::Trial& trial)> spoil;  ///< what becomes of the readings
  double within_deg = 1e-4;                       ///< `fast` promises
  std::string flag = {};                          ///< that it must raise
  bool is_hard = true;                            ///< false: the plain formula gets it right too
  Against against = Against::kQuad;
  std::optional<NoiseModel> noise = {};
  Rect tile = {0, 0, 300, 1};
};
std::vector<PixelCase> pixel_cases();

/// Worst angles of a case's pixels that `fast` solves; of a case that tells nothing, of all by the formula.
/// The textbook's formula is (A^T A)^-1 A^T r of all readings as they are; none: it gives no number.
struct PixelOutcome {
  std::optional<double> plain_float32_deg, plain_double_deg;
  std::optional<double> ours_deg;  ///< none: `fast` answers nowhere, or there is nothing to be right about
  int status = 0;                  ///< bits that were raised
  /// What solved pixels in the end.
  enum Path : std::size_t { kFloat32, kEquations, kQr, kSvd, kUnsolved };
  std::array<double, 5> percent = {};  ///< by path
};
PixelOutcome outcome_of(const PixelCase& pixels);

/// "DARK NO_SOLUTION"
std::string names_of_status(int status);

/// Those cases that the plain formula gets wrong.
std::vector<HardCase> hard_solves();

}  // namespace weft::torture
