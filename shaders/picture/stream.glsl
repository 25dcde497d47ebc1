// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The stream: the paths of a piece of a picture that continue at a mirror, and the rays that they request. It is stored
// in the film, after the pixels. A turn first makes lists of the requested rays, sorted so that neighbours meet the
// same nodes (place_rays.comp, list_rays.comp). It then traces the shadow rays (trace_shadow_rays.comp). At last it
// follows the paths (follow_paths.comp): adds the light of the shadow rays, traces the mirror ray, shades its hit and
// requests the rays of the next turn. Paths share no numbers, and the lane of a path adds its light in the order of
// bounces and sources, so no bit depends on the order of the lists.
//
// Each path has 7 records, and one more for each source of a turn:
const uint RECORD_ORIGIN = 0u;     // xyz = origin of the path's ray, w = pixel
const uint RECORD_DIRECTION = 1u;  // xyz = direction of the ray, unit; w = roughness of the path
const uint RECORD_WEIGHTS = 2u;    // xyz = weight of the ray's radiance; two records, selected by the parity of the
                                   // ray's turn; if the ray continues behind a surface: w = t of the surface, in the
                                   // other record its order
const uint RECORD_RADIANCE = 4u;   // xyz = sum so far, without the current point; w = width of the path's cone
const uint RECORD_SEEN = 5u;       // xyz = radiance of the current point so far; w = spread of the path's cone
const uint RECORD_SHADOW_ORIGIN = 6u;  // w = bounces so far; from LAYERS_SHIFT on, surfaces passed
const uint LAYERS_SHIFT = 16u;
const uint RECORD_CONTRIBUTION = 0u;  // for each source: xyz = its unblocked contribution; if rays pass through
                                      // surfaces, after the shadow ray the contribution that arrives
// With FEATURE_DIFFUSE_TRANSMISSION a path has one more record. w of RECORD_CONTRIBUTION is 1 if the shadow ray starts
// there:
const uint RECORD_SHADOW_BEHIND = 7u;  // xyz = origin of shadow rays that start behind the surface
// With FEATURE_SAMPLED_LIGHT each source has one more record, RECORD_WAY, and each path has RECORD_SAMPLE (below).
const uint RECORD_WAY = 1u;  // xyz = direction of the source's shadow ray; w = its tmax
// With FEATURE_GLASS there are further records behind these, and 4 for each ray that waits (tree.glsl):
const uint RECORD_MEDIA = 0u;         // x, y = media that contain the ray; z = rays so far; bit HAS_SEEN_SHIFT:
                                      // RECORD_SEEN is in use; w = waiting rays, and the kind of the ray
const uint RECORD_SHADOW_MEDIA = 1u;  // x, y = media in which shadow rays start; z, w = skip and skipped of a Path
const uint WAITING_OBJECT_SHIFT = 15u;
const uint WAITING_IS_TRANSMITTED = 0x4000u;  // the ray belongs to PART_TRANSMISSION, otherwise to PART_REFLECTION
const uint WAITING_BOUNCES_MASK = 0x3FFFu;
const uint HAS_SEEN_SHIFT = 16u;
const uint KIND_SHIFT = 16u;

// With TRACES_SHADOWS a path has other records (scatter.glsl), and follow_paths.comp also traces its shadow rays. Few
// lanes wait, because nearly all of these paths continue at each hit. A bounce always takes one turn, and a turn has no
// sources. traces_shadows_with_paths() in path_stream.cpp has the same condition.
const uint TRACES_SHADOWS =
    FEATURE_BIT(FEATURE_SCATTERING) &
    uint((FEATURE_BIT(FEATURE_BLENDING) | FEATURE_BIT(FEATURE_GLASS) | FEATURE_BIT(FEATURE_SHADOW_CATCHERS) |
          FEATURE_BIT(FEATURE_RAY_LOG)) == 0u);

// The records are followed by words in this order: the requests of each path, one word for its own ray and one for each
// source; the list of the paths of even turns; the list of the paths of odd turns; the list of shadow rays; and the
// bins of paths and of shadow rays. For each bin there is first the number of its rays, then the position in the list
// where it begins. A request is a bin and, in the bits above, the number of the ray in the bin, or one of these values:
const uint ASK_NOTHING = 0xFFFFFFFFu;  // a path that has ended, a source without a shadow ray, or an unblocked one
const uint ASK_BLOCKED = 0xFFFFFFFEu;  // the answer to a shadow ray that is blocked
// The last bin contains paths that have no ray but wait for shadow rays.
const uint BIN_WITHOUT_RAY = STREAM_BINS - 1u;

layout(std430, set = 0, binding = BINDING_FILM) buffer StreamWords {
  FILM_HEAD(stream_dispatch, stream, stream_ray_counts, stream_pass_counts)
  uint words[];
};

// The head of the stream at the beginning of the invocation. Each invocation calls begin_stream() first. The values are
// copied, because lavapipe loads values of a buffer lane by lane and at each use.
uint first_record;
uint most_paths;
uint sources_of_turn;
uint turn;
uint records_of_path;
const uint PATH_RECORDS = STREAM_PATH_RECORDS + STREAM_BEHIND_RECORDS * FEATURE_BIT(FEATURE_DIFFUSE_TRANSMISSION) +
                          STREAM_SAMPLE_RECORDS * FEATURE_BIT(FEATURE_SAMPLED_LIGHT);
const uint RECORD_SAMPLE = PATH_RECORDS - 1u;  // x, y = the sample's key and number (samples.glsl); with
                                               // FEATURE_SCATTERING: z, w = the state of scatter.glsl
const uint SOURCE_RECORDS = STREAM_SOURCE_RECORDS + STREAM_SAMPLE_RECORDS * FEATURE_BIT(FEATURE_SAMPLED_LIGHT);
void begin_stream() {
  first_record = stream.place.x;
  most_paths = stream.place.y;
  sources_of_turn = stream.place.z;
  turn = stream.turn.x;
  records_of_path = has(FEATURE_GLASS) ? stream.shadow_rays.y
                                       : PATH_RECORDS + SOURCE_RECORDS * sources_of_turn;
  if (TRACES_SHADOWS != 0u) records_of_path = STREAM_SCATTERED_RECORDS + FEATURE_BIT(FEATURE_TEXTURES);
}

uint paths_of_turn(uint which) { return (which & 1u) == 0u ? stream.turn.y : stream.turn.z; }
uint paths_with_ray() { return stream.turn.w; }

uint record_of_path(uint path) { return first_record + records_of_path * path; }
uint record_of_source(uint path, uint source) {
  return record_of_path(path) + PATH_RECORDS + SOURCE_RECORDS * source;
}
uint record_of_glass(uint path) { return record_of_source(path, sources_of_turn); }
uint record_of_waiting(uint path, uint place) {
  return record_of_glass(path) + STREAM_GLASS_RECORDS + STREAM_WAITING_RECORDS * place;
}
uint record_of_weight(uint path, uint which) { return record_of_path(path) + RECORD_WEIGHTS + (which & 1u); }

uint first_ask() { return 4u * record_of_path(most_paths); }
uint ask_of_path(uint path) { return first_ask() + (1u + sources_of_turn) * path; }
uint ask_of_source(uint path, uint source) { return ask_of_path(path) + 1u + source; }
uint path_list(uint which) { return ask_of_path(most_paths) + (which & 1u) * most_paths; }
uint shadow_list() { return path_list(0u) + 2u * most_paths; }
// The argument `kind` of ask() is one of these values.
const uint LIST_OF_PATHS = 0u;
const uint LIST_OF_SHADOW_RAYS = 1u;
uint counts_of_bins(uint kind) { return shadow_list() + sources_of_turn * most_paths + kind * STREAM_BINS; }
uint places_of_bins(uint kind) { return counts_of_bins(STREAM_LISTS + kind); }

// Requests a ray in a bin. Returns the request.
uint ask(uint kind, uint bin) {
  return bin | (atomicAdd(words[counts_of_bins(kind) + bin], 1u) << STREAM_BIN_BITS);
}
