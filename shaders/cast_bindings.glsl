// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What a kernel that takes rays and gives records is bound to beyond the scene (engine/render/ray_kernel.h).

layout(constant_id = CONSTANT_ANY_HIT) const uint ANY_HIT = 0u;

layout(std430, set = 0, binding = BINDING_RAYS) readonly buffer Rays { RayRecord rays[]; };
layout(std430, set = 0, binding = BINDING_HITS) buffer Hits {
  Dispatch dispatch;
  HitRecord hits[];
};
