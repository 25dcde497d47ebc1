// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#version 450
// Branches of every form that depend on specialisation constants. `compute` in branches.h computes the same.
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

struct Walk {
  uint at;
  uint steps;
};

uint next_step(uint i) {
  if (THIRD) {
    i += 2u;
  } else {
    i += 1u;
  }
  return i;
}

// One return, so spirv-opt inlines it with its loops.
void walk(inout Walk w) {
  // The continue target has several blocks.
  for (uint i = 0u; i < 9u; i = next_step(i)) {
    if (FIRST == 1u && w.at % 7u == 3u) break;
    if (FIRST == 2u) {
      w.at += i + 4u;
      break;
    }
    w.at = w.at * 3u + called_twice(i);
    w.steps += 1u;
  }
  // Without THIRD no branch leads back to the beginning.
  do {
    const uint before = w.at;
    w.at += w.steps + 1u;
    w.steps ^= before & 1u;
  } while (THIRD && w.at < 200u);
}

void main() {
  uint x = numbers[gl_WorkGroupID.x];
  Walk w = Walk(x % 50u, SECOND);
  walk(w);
  walk(w);
  x += w.at * (w.steps + 1u);
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
