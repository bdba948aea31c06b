// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "solver/reflectance/measured_lobe.h"

namespace weft::solver {

/// The lobes of a cloth, one a material: one for plain cloth; two where its pixels share none and split into
/// two groups of which each shares one, or follows Lambert's law; three where a group after Lambert's law
/// beside two that shine costs clearly less. Pixels are told apart by which lobe costs
/// them less, from a first split by how ill Lambert's law fits them, by their brightness or by a sharper and
/// a broader lobe (k-means of models, Diday and Simon 1976). Where they fade into each other the pixels that
/// neither explains belong to no group, if most of them are blends of both (trimmed k-means, Cuesta-Albertos,
/// Gordaliza and Matran 1997). Measured
/// ones come first, and of these the one with most pixels.
std::vector<MeasuredLobe> measure_materials(const LobeSamples& samples, const std::vector<Vec3>& start,
                                            int threads);

/// Whether a lobe that was looked for leaves room for a second material: its readings are not explained.
bool may_be_two(const MeasuredLobe& one);

}  // namespace weft::solver
