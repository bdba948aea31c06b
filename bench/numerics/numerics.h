// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "bench/base/study.h"
#include "core/base/result.h"

namespace weft::bench {

/// One row for each numerically hard case of docs/numerics.md, by its number.
/// plain_float32_deg, plain_double_deg: the textbook formula, (A^T A)^-1 A^T r of all readings as they are;
/// worst angle to what exact arithmetic makes of the same readings. ours_deg: that of `fast` over all pixels
/// with a solution. Where readings tell nothing the formula's angle is to the cloth. Null is no number at
/// all. flags: the status bits that were raised. float32, double_normal_equations, double_qr, double_svd,
/// unsolved: percent of the pixels by what solved them in the end.
Rows numerics_cases();

/// One row for each condition number from 1 to 1e8: worst angles of 300 pixels under six lights that close
/// up, by the textbook formula, by QR and by SVD in float32, by the formula and by SVD in double, and of
/// `fast`. flagged: whether it raised ILL_CONDITIONED.
Rows numerics_curve();

/// The curve as a picture for print.
std::string numerics_plot(const Rows& curve);

/// Writes into a folder of documentation: the tables between their marks in measured/numerics.md, which must
/// be there, numerics_curve.svg and .json, and pictures/numerics_*.png of testdata/scenes/torture.toml, read
/// from `scenes`.
Result<void> write_numerics_docs(const std::filesystem::path& docs, const std::filesystem::path& scenes);

}  // namespace weft::bench
