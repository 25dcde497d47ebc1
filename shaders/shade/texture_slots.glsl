// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The textures of a material at a point.

// True if materials may have layers above them, or other rare properties (ExtensionRecord).
const bool HAS_LAYERS = (FEATURE_BIT(FEATURE_COATS) | FEATURE_BIT(FEATURE_SHEENS)) != 0u;
const uint RARE_FEATURES = FEATURE_BIT(FEATURE_SPECULAR_TEXTURES) | FEATURE_BIT(FEATURE_DIFFUSE_TRANSMISSION) |
                           FEATURE_BIT(FEATURE_IRIDESCENCE) | FEATURE_BIT(FEATURE_ANISOTROPY);
const bool HAS_EXTENSIONS = HAS_LAYERS || RARE_FEATURES != 0u;

// The textures that a point may need, each with its own place in the arrays below. Rare textures come last.
const uint BASE_SLOT = 0u;  // colour and alpha
const uint EMISSIVE_SLOT = 1u;
const uint SURFACE_SLOT = 2u;  // metal and roughness, or the specular colour of Phong
const uint OCCLUSION_SLOT = 3u;
const uint NORMAL_SLOT = 4u;
const uint COAT_SLOT = 5u;
const uint COAT_ROUGHNESS_SLOT = 6u;
const uint COAT_NORMAL_SLOT = 7u;
const uint SHEEN_COLOR_SLOT = 8u;
const uint SHEEN_ROUGHNESS_SLOT = 9u;
const uint SPECULAR_SLOT = 10u;
const uint SPECULAR_COLOR_SLOT = 11u;
const uint MOST_SLOTS = 18u;
const uint TRANSMISSION_SLOT =
    5u + 7u * (FEATURE_BIT(FEATURE_COATS) | FEATURE_BIT(FEATURE_SHEENS) | FEATURE_BIT(FEATURE_SPECULAR_TEXTURES));
const uint SCATTERING_SLOT = TRANSMISSION_SLOT + FEATURE_BIT(FEATURE_GLASS);
const uint SCATTERING_COLOR_SLOT = SCATTERING_SLOT + 1u;
const uint IRIDESCENCE_SLOT = SCATTERING_SLOT + 2u * FEATURE_BIT(FEATURE_DIFFUSE_TRANSMISSION);
const uint IRIDESCENCE_THICKNESS_SLOT = IRIDESCENCE_SLOT + 1u;
const uint ANISOTROPY_SLOT = IRIDESCENCE_SLOT + 2u * FEATURE_BIT(FEATURE_IRIDESCENCE);
const uint SLOT_COUNT = ANISOTROPY_SLOT + FEATURE_BIT(FEATURE_ANISOTROPY);

uint slot_numbers[MOST_SLOTS];  // number of each slot, 0 without a texture; the caller of look_up_slots sets it
vec4 shown[MOST_SLOTS];         // value of each slot; look_up_slots sets it

uint next_slot_number() {
  uint number = 0u;
  [[unroll]] for (uint i = 0u; i < SLOT_COUNT; ++i) number = number == 0u ? slot_numbers[i] : number;
  return number;
}

// Fills `shown` with the values of the slots, or 1 for missing textures, and clears `slot_numbers`. It looks up one
// slot after the other at a single place of the code. CPU drivers execute for all lanes what any of them may need, and
// most materials lack most textures. Slots with the same number, or the same bundle, are looked up once.
void look_up_slots(TexturePlace place) {
  [[unroll]] for (uint i = 0u; i < SLOT_COUNT; ++i) shown[i] = vec4(1.0);
  uint number = next_slot_number();
  do {
    if (number != 0u) {
      BundleValues values = look_up_bundle(number, place);
      [[unroll]] for (uint i = 0u; i < SLOT_COUNT; ++i) {
        bool is_shown = slot_numbers[i] != 0u && are_bundled(slot_numbers[i], number);
        shown[i] = is_shown ? value_of(slot_numbers[i], values) : shown[i];
        slot_numbers[i] = is_shown ? 0u : slot_numbers[i];
      }
      number = next_slot_number();
    }
  } while (number != 0u);
}
