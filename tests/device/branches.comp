// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#version 450
// This shader has every form of branch that depends on specialisation constants. `compute` in branches.h computes the
// same.
layout(local_size_x = 1) in;

layout(constant_id = 0) const uint FIRST = 0u;
layout(constant_id = 1) const uint SECOND = 0u;
layout(constant_id = 2) const bool THIRD = false;

layout(std430, set = 0, binding = 0) buffer Numbers { uint numbers[]; };

const uint BOTH = (FIRST + SECOND * 4u) >> 1u;
const bool IS_ANY = FIRST != 0u || THIRD;
const uint CHOSEN = THIRD ? FIRST : SECOND;

uint called_twice(uint x) { return x * 5u + 1u; }
uint with_first(uint x) { return called_twice(x) + 7u; }
uint without_first(uint x) { return x ^ 21u; }
bool is_odd(uint x) { return (x & 1u) != 0u; }
bool with_second(uint x) { return is_odd(called_twice(x)); }

uint turn(uint x) {
  while (FIRST > 1u && x < 1000u) {
    x = x * 3u + 1u;
    if (SECOND == 0u && x > 500u) break;
    if (SECOND == 1u) continue;
    x += 5u;
  }
  for (uint i = 0u;; ++i) {
    if (THIRD) break;
    x += i;
    if (i > 3u) break;
  }
  for (uint i = 0u; i < SECOND; ++i) x += called_twice(i);
  do {
    if (IS_ANY) return x + 1u;
    x += 2u;
  } while (x < 50u);
  return x;
}

void main() {
  uint x = numbers[gl_WorkGroupID.x];
  if (FIRST > 0u) {
    x = with_first(x);
  } else {
    x = without_first(x);
  }
  if (SECOND != 0u && with_second(x)) x += 100u;
  if (THIRD || is_odd(x)) x += 1000u;
  x += IS_ANY ? called_twice(x) : BOTH;
  if (CHOSEN >= 2u && SECOND != 1u) {
    if (x > 4000u && !THIRD) x -= 77u;
  } else if (FIRST == 1u) {
    x += 3u;
  }
  switch (x % 3u) {
    case 0u:
      if (FIRST == 0u) {
        x += 11u;
        break;
      }
      x += 13u;
      break;
    case 1u:
      x = turn(x);
    default:
      if (SECOND == 2u) {
        numbers[gl_WorkGroupID.x] = x;
        return;
      }
      x = turn(x) + 17u;
  }
  numbers[gl_WorkGroupID.x] = x;
}
