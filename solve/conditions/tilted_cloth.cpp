// SPDX-License-Identifier: Apache-2.0
#include "solve/conditions/tilted_cloth.h"

#include <utility>

#include "core/rig/cloth_pose.h"

namespace weft::solve {

Result<void> lay_level(const Exposures& exposures) {
  const ClothPose& pose = exposures.plan.session.pose;
  if (pose.is_level()) return {};
  Photographs& photographs = exposures.photographs;
  const double height_mm = exposures.plan.session.cloth_height_mm;
  if (photographs.camera) photographs.camera = seen_from(pose, height_mm, *photographs.camera);
  if (photographs.light_covariance)
    photographs.light_covariance = seen_from(pose, *std::move(photographs.light_covariance));
  Result<LightField> field = LightField::make(seen_from(pose, height_mm, photographs.field->lights()),
                                              photographs.camera, photographs.size, height_mm);
  if (!field) return std::move(field).error();
  photographs.field = std::move(*field);
  return {};
}

}  // namespace weft::solve
