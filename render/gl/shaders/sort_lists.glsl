// A pixel's list into the order of depths. Each draw takes a limited number of steps (llvmpipe ends all loops of an
// invocation after 65,535 rounds, and a card that is busy for seconds is reset), and leaves a list that another draw
// goes on with.
//
// Before it: list.glsl. Depths are not negative, so that their bits compare as they do.

const uint most_steps = 16000u;
// Longer ones are sorted only where hardly anything has to be moved.
const uint longest_sorted = 12000u;

uint next_of(uint node) {
  return nodes[node - 1u].x;
}

uint depth_of(uint node) {
  return nodes[node - 1u].y;
}

void set_next(uint node, uint next) {
  nodes[node - 1u].x = next;
}

// The last that came is mostly the furthest: each is put in its place among those that came later, mostly the first.
// False when it took too many steps: then what is left stands unsorted behind.
bool insert_each(inout uint list, out uint count) {
  uint sorted = 0u;
  uint last = 0u;
  uint rest = list;
  uint steps = 0u;
  count = 0u;
  while (rest != 0u && steps < most_steps) {
    uint moved = rest;
    uint depth = depth_of(moved);
    rest = next_of(moved);
    uint before = 0u;
    uint after = sorted;
    while (after != 0u && depth_of(after) < depth) {
      before = after;
      after = next_of(after);
      ++steps;
    }
    set_next(moved, after);
    if (before == 0u) {
      sorted = moved;
    } else {
      set_next(before, moved);
    }
    if (after == 0u) last = moved;
    ++count;
    ++steps;
  }
  list = sorted;
  if (rest == 0u) return true;
  set_next(last, rest);
  return false;
}

// Ends the run of ascending depths that begins with `node`; the node after it.
uint end_run(uint node, inout uint count) {
  uint next = next_of(node);
  while (next != 0u && depth_of(next) >= depth_of(node)) {
    node = next;
    next = next_of(node);
    ++count;
  }
  set_next(node, 0u);
  ++count;
  return next;
}

// Merges each two runs; true when that leaves one.
bool merge_runs(inout uint list, out uint count) {
  uint rest = list;
  uint last = 0u;
  uint merged = 0u;
  list = 0u;
  count = 0u;
  while (rest != 0u) {
    uint a = rest;
    uint b = end_run(a, count);
    rest = b == 0u ? 0u : end_run(b, count);
    while (a != 0u || b != 0u) {
      bool take_a = b == 0u || (a != 0u && depth_of(a) <= depth_of(b));
      uint moved = take_a ? a : b;
      if (take_a) {
        a = next_of(a);
      } else {
        b = next_of(b);
      }
      if (last == 0u) {
        list = moved;
      } else {
        set_next(last, moved);
      }
      last = moved;
    }
    ++merged;
  }
  return merged <= 1u;
}

uint length_of(uint list) {
  uint length = 0u;
  while (list != 0u && length <= longest_sorted) {
    list = next_of(list);
    ++length;
  }
  return length;
}

// True when it is sorted, or cannot be.
bool sort_list(inout uint list, bool first_draw) {
  uint count;
  if (first_draw) return insert_each(list, count);
  count = length_of(list);
  if (count > longest_sorted) return true;
  uint steps = count;
  do {
    if (merge_runs(list, count)) return true;
    steps += 2u * count;
  } while (steps + 2u * count < 2u * most_steps);
  return false;
}
