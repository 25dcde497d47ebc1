// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The pixels that a lane of the camera stage traces together (camera_stage.comp): their data and their start.

uvec3 ray_count = uvec3(0u);

// The arrays below have an entry for each pixel of the packet.
bool is_inside[PACKET_SIZE];
bool is_lit[PACKET_SIZE];  // whether the pixel shows a surface
Path paths[PACKET_SIZE];
ShadingPoint points[PACKET_SIZE];
vec3 seen[PACKET_SIZE];  // radiance from the hit so far
vec3 own_lights[PACKET_SIZE];  // with FEATURE_LIGHT_AOVS: the part of it that no source contributes
vec3 contributions[PACKET_SIZE];
uvec2 sample_ids[PACKET_SIZE];  // with HAS_SAMPLE_POINTS: the arguments of choose_sample()
// The following arrays are for shadow rays that can pass through surfaces:
LightWay ways[PACKET_SIZE];
Hit blockers[PACKET_SIZE];  // the last hit of each ray
uint pass_count = 0u;
uint refraction_count = 0u;
uint hit_count = 0u;

// Returns the id (choose_sample) of a sample of a list.
uvec2 id_of_listed(uint index) {
  uvec4 listed = pixels[index];
  return uvec2(key_of_pixel(uvec2(listed.z & 0xFFFFu, listed.z >> 16)), listed.w);
}

// Prepares the pixels of the packet that lie in the window, and their camera rays. Returns false if no pixel lies in
// the window.
bool begin_packet() {
  uint place = PACKET_SIZE * (group_number() * gl_WorkGroupSize.x + gl_LocalInvocationIndex);
  uint block = first_block() + place / (BLOCK_SIZE * BLOCK_SIZE);
  uvec2 corner = BLOCK_SIZE * uvec2(block % blocks_per_row(), block / blocks_per_row());
  bool is_any_inside = false;
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    uvec2 pixel = corner + pixel_in_block((place + i) % (BLOCK_SIZE * BLOCK_SIZE));
    is_inside[i] = block < end_block() && all(lessThan(pixel, window_size()));
    uint index = pixel.y * window_size().x + pixel.x;
    if (has(FEATURE_LISTED_SAMPLES)) {
      // The index of lanes beyond the last block is limited to pixels of the film.
      index = min(first_block() * (BLOCK_SIZE * BLOCK_SIZE) + place + i, window_pixel_count() - 1u);
      is_inside[i] = block < end_block() && pixels[index].z != NO_LISTED_SAMPLE;
      if (HAS_SAMPLE_POINTS != 0u) sample_ids[i] = id_of_listed(index);
      if (has(FEATURE_LENS)) choose_sample(sample_ids[i], 0u);
      packet[i] = listed_ray(index);
    } else {
      if (HAS_SAMPLE_POINTS != 0u) sample_ids[i] = uvec2(key_of_pixel(window_corner() + pixel), sample_at_hand());
      if (has(FEATURE_LENS)) choose_sample(sample_ids[i], 0u);
      packet[i] = camera_ray(pixel);
    }
    is_any_inside = is_any_inside || is_inside[i];
    forget_passed(i);
    if (!is_inside[i]) packet[i].tmax = -1.0;
    ray_count.x += is_inside[i] ? 1u : 0u;
    paths[i] = Path(packet[i].origin, normalize3(packet[i].direction),
                    vec3(1.0), vec3(0.0),                  // weight and radiance
                    index, NO_ENVIRONMENT,                 // pixel and roughness
                    CAMERA.look.w, CAMERA.right.w,         // width and spread of the cone
                    0u, 0u, -1.0, 0u,                      // no bounces, no layers, nothing passed
                    CAMERA.first_glass.yz, 0u, 0.0, 0u,    // media; no rays, nothing skipped
                    LOG_CAMERA, PART_BACKGROUND);          // kind and part
  }
  passes_backs = true;
  if (has(FEATURE_SHADOW_CATCHERS)) passes_catchers = false;
  sight_width = CAMERA.look.w;
  sight_spread = CAMERA.right.w;
  return is_any_inside;
}
