// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>

#include "core/base/vec.h"
#include "core/image/color_spaces.h"
#include "simulator/reflectance/anisotropic_ggx.h"
#include "simulator/reflectance/beckmann.h"
#include "simulator/reflectance/blinn_phong.h"
#include "simulator/reflectance/cloth.h"
#include "simulator/reflectance/directions.h"
#include "simulator/reflectance/disney_diffuse.h"
#include "simulator/reflectance/fibre_cones.h"
#include "simulator/reflectance/ggx.h"
#include "simulator/reflectance/lambert.h"
#include "simulator/reflectance/mixed_ggx.h"
#include "simulator/reflectance/multiple_scattering.h"
#include "simulator/reflectance/oren_nayar.h"

// How a surface reflects: f(l, v) in 1/sr by channel, 1 / pi included, the cosine n.l not. What a light of a
// given strength gives is pi f (n.l) strength, which for Lambert is albedo strength (n.l). Directions as in
// simulator/reflectance/directions.h. The models are values; parameters outside their range give numbers
// without meaning. Light at or below the horizon gives 0; a view there goes on without a step as if it were
// on it. Every model is reciprocal where both are above it. docs/reflectance.md compares the models.

namespace weft::simulator {

using Reflectance = std::variant<Lambert, Ggx, AnisotropicGgx, Beckmann, BlinnPhong, Cloth,
                                 MultipleScattering, OrenNayar, DisneyDiffuse, FibreCones, MixedGgx>;

/// f in 1/sr; `albedo` is the diffuse reflectance of the pixel, 0 to 1.
Rgb evaluate(const Reflectance& model, const Rgb& albedo, Vec3 to_light, Vec3 to_view);

/// A direction drawn about where the model reflects, from u1 and u2 uniform in [0, 1): half cosine, half
/// lobe; all cosine for models without a lobe. The estimate of what is reflected to the view is f (n.l) /
/// density.
DirectionSample sample(const Reflectance& model, Vec3 to_view, double u1, double u2);

/// The density of sample(), 1/sr over the whole sphere; integrates to 1.
double density(const Reflectance& model, Vec3 to_light, Vec3 to_view);

}  // namespace weft::simulator
