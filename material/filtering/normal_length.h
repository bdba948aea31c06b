// SPDX-License-Identifier: Apache-2.0
#pragma once

// How short the mean normal of a rough surface is. Means of unit normals are shorter than 1 the more the
// normals differ, so that a length stands for a roughness (Chan 2018, "Material Advances in Call of Duty:
// WWII", section 2: seed 001).

namespace weft::material {

/// Mean normal's length for GGX facets of roughness `alpha`, 0 to 1, weighed by the area that they cover seen
/// from above: 1 at 0, 2/3 at 1 (seed 001 eq. 26). In its logarithm's form it loses no digits at small alpha;
/// above alpha 0.954, where both terms cancel, it is the sum of its series.
double normal_length(double alpha);

/// The same weighed by the facets' own area: 1 at 0, 1/2 at 1 (seed 001 eq. 24).
double normal_length_by_area(double alpha);

/// The alpha whose normal_length() this is; 0 from length 1 less rounding on, 1 up to 2/3. Newton's method,
/// kept in its bracket, from `start`; a start that is right to rounding comes back as it is.
double alpha_of_normal_length(double length, double start = 0.3);

}  // namespace weft::material
