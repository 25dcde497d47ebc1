// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The buffers, in addition to the scene, of a kernel that casts rays and writes records (engine/trace/kernels/ray_kernel.h).

layout(std430, set = 0, binding = BINDING_RAYS) readonly buffer Rays { RayRecord rays[]; };
layout(set = 0, binding = BINDING_RAY_TEXELS) uniform usamplerBuffer ray_texels;
layout(std430, set = 0, binding = BINDING_HITS) buffer Hits {
  Dispatch dispatch;
  HitRecord hits[];
};

#include "shared/dispatch.glsl"

RayRecord load_ray(uint index) {
  if (FETCHES_TEXELS == 0u) return rays[index];
  return RayRecord(uintBitsToFloat(texelFetch(ray_texels, int(RAY_TEXELS * index))),
                   uintBitsToFloat(texelFetch(ray_texels, int(RAY_TEXELS * index + 1u))));
}
