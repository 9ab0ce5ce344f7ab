// Reinsertion (shared/reinsert_math.h) on a tree in slots: loads it, measures it, finds moves, settles which are made,
// makes or takes them back, works out boxes and sizes from the leaves up, and writes the tree in its canonical numbering.
// Every kernel's result depends on the tree alone: moves are settled by integer maxima, sums are of integers.
#include "shared/reinsert_math.h"

// What boxes cost, as a kernel's last arguments say: face weights, and areas and segments where there are any.
#if GN_RAY_COSTS
#define GN_COST_PARAMETERS \
  float wx, float wy, float wz, __global const GnAreaCost *areas, uint area_count, __global const gn_u16 *maps, \
      __global const float *segments, uint segment_count, float per_segment
#define GN_COSTS wx, wy, wz, areas, area_count, maps, segments, segment_count, per_segment
#else
#define GN_COST_PARAMETERS float wx, float wy, float wz
#define GN_COSTS wx, wy, wz
#endif

static inline void set_costs(GnBoxCosts* costs, GN_COST_PARAMETERS) {
#if GN_RAY_COSTS
  uint i;
  for (i = 0u; i < area_count; ++i) costs->areas[i] = areas[i];
  costs->count = area_count;
  costs->maps = maps;
  costs->segments = segments;
  costs->segment_count = segment_count;
  costs->per_segment = per_segment;
#endif
  costs->w[0] = wx;
  costs->w[1] = wy;
  costs->w[2] = wz;
}

// One work-item per node. A leaf's count becomes that of its different triangles.
__kernel void load_slots(__global const GnNode* nodes, __global const uint* order, __global GnNode* slots,
                         __global uint* above, uint count) {
  const uint i = (uint)get_global_id(0);
  uint k;
  if (i >= count) return;
  {
    __global GnNode* out = slots + i + 1u;
    const uint first = nodes[i].first, triangles = nodes[i].count;
    for (k = 0u; k < 3u; ++k) {
      out->lo[k] = nodes[i].lo[k];
      out->hi[k] = nodes[i].hi[k];
    }
    if (triangles == 0u) {
      out->first = first + 1u;
      out->count = 0u;
      above[(first + 1u) >> 1] = i + 1u;
    } else {
      uint different = 0u, at, other;
      for (at = 0u; at < triangles; ++at) {
        uint seen = 0u;
        for (other = 0u; other < at; ++other) seen |= order[first + other] == order[first + at];
        different += 1u - seen;
      }
      out->first = first;
      out->count = different;
    }
    if (i == 0u) above[0] = 0u;
  }
}

// One work-item. Cuts a tree as it was loaded, numbered as builders number, into subtrees of at most `limit` inner nodes:
// their roots go to tasks, the inner nodes above them to top, parents first. numbers: how many of each. An inner node's
// subtree has the splits of a range of ranks: from, to.
__kernel void cut_loaded(__global const GnNode* slots, uint inner, uint limit, __global uint* tasks, __global uint* top,
                         __global uint* from, __global uint* to, __global uint* numbers) {
  uint task_count = 0u, top_count = 0u, done, side;
  if (inner > 0u) {
    top[0] = GN_ROOT_SLOT;
    from[0] = 0u;
    to[0] = inner;
    top_count = 1u;
  }
  for (done = 0u; done < top_count; ++done) {
    const uint first = slots[top[done]].first, rank = first / 2u - 1u;
    for (side = 0u; side < 2u; ++side) {
      const uint begin = side ? rank + 1u : from[done], end = side ? to[done] : rank;
      if (end > begin && end - begin <= limit) {
        tasks[task_count] = first + side;
        task_count += 1u;
      } else if (end > begin) {
        top[top_count] = first + side;
        from[top_count] = begin;
        to[top_count] = end;
        top_count += 1u;
      }
    }
  }
  numbers[0] = task_count;
  numbers[1] = top_count;
}

// One work-item. The same of a tree that moves have changed, into subtrees that had about so many when sizes were last
// worked out.
__kernel void cut_slots(__global const GnNode* slots, __global const GnBelow* below, uint limit, __global uint* tasks,
                        __global uint* top, __global uint* numbers) {
  uint task_count = 0u, top_count = 0u, done, side;
  if (slots[GN_ROOT_SLOT].count == 0u) {
    top[0] = GN_ROOT_SLOT;
    top_count = 1u;
  }
  for (done = 0u; done < top_count; ++done) {
    const uint first = slots[top[done]].first;
    for (side = 0u; side < 2u; ++side) {
      const uint child = first + side;
      if (slots[child].count == 0u) {
        if (below[slots[child].first >> 1].inner <= limit) {
          tasks[task_count] = child;
          task_count += 1u;
        } else {
          top[top_count] = child;
          top_count += 1u;
        }
      }
    }
  }
  numbers[0] = task_count;
  numbers[1] = top_count;
}

static inline GnBelow below_of(__global const GnNode* slots, __global const GnBelow* below, uint slot) {
  GnBelow out;
  if (slots[slot].count == 0u) return below[slots[slot].first >> 1];
  out.inner = 0u;
  out.triangles = slots[slot].count;
  out.height = 0u;
  out.changed = 0u;
  return out;
}

// An inner node's box and sizes from its children's.
static inline void join_pair(__global GnNode* slots, __global GnBelow* below, uint slot) {
  const uint first = slots[slot].first;
  const GnBelow left = below_of(slots, below, first), right = below_of(slots, below, first + 1u);
  uint k;
  for (k = 0u; k < 3u; ++k) {
    slots[slot].lo[k] = gn_min(slots[first].lo[k], slots[first + 1u].lo[k]);
    slots[slot].hi[k] = gn_max(slots[first].hi[k], slots[first + 1u].hi[k]);
  }
  below[first >> 1].inner = left.inner + right.inner + 1u;
  below[first >> 1].triangles = left.triangles + right.triangles;
  below[first >> 1].height = max(left.height, right.height) + 1u;
  below[first >> 1].changed =
      (below[first >> 1].changed == GN_RELINKED) | (left.changed != 0u) | (right.changed != 0u);
}

// Inner nodes of one subtree per work-item, children before parents. The way back up is in `above`: no stack, however
// deep moves have made the tree.
__kernel void join_subtrees(__global GnNode* slots, __global const uint* above, __global GnBelow* below,
                            __global const uint* tasks, uint task_count) {
  const uint task = (uint)get_global_id(0);
  uint root, slot, up = 0u;
  if (task >= task_count) return;
  root = tasks[task];
  slot = root;
  for (;;) {
    if (!up && slots[slot].count == 0u) {
      slot = slots[slot].first;
      continue;
    }
    if (up) join_pair(slots, below, slot);
    if (slot == root) break;
    up = slot & 1u;
    slot = up ? above[slot >> 1] : slot + 1u;
  }
}

// One work-item: the nodes above the subtrees, from the last found to the root.
__kernel void join_top(__global GnNode* slots, __global GnBelow* below, __global const uint* top, uint top_count) {
  uint i;
  for (i = top_count; i > 0u; --i) join_pair(slots, below, top[i - 1u]);
}

// One work-item per run of slots: puts the costs of all nodes but the root in bins, counts these, and adds the costs of
// inner nodes up. Nodes near which something moved are settled no more.
__kernel void weigh_slots(__global const GnNode* slots, __global const uint* above, __global const GnBelow* below,
                          __global ushort* cost_bins, volatile __global uint* bins, __global ulong* sums, float units,
                          uint count, uint run, GN_COST_PARAMETERS) {
  const uint chunk = (uint)get_global_id(0);
  const uint begin = GN_ROOT_SLOT + chunk * run;
  GnBoxCosts costs;
  ulong sum = 0u;
  uint i;
  if (begin > count) return;
  set_costs(&costs, GN_COSTS);
  for (i = begin; i <= count && i < begin + run; ++i) {
    const float cost = gn_slot_cost(&costs, slots + i);
    const uint bin = gn_cost_bin(cost);
    const uint settled = cost_bins[i] & GN_SETTLED;
    const uint stays = settled && !below[gn_pair_near(above, i)].changed;
    cost_bins[i] = (ushort)(stays ? bin | GN_SETTLED : bin);
    if (i != GN_ROOT_SLOT) atomic_inc(bins + bin);
    if (slots[i].count == 0u) sum += gn_cost_units(cost, units);
  }
  sums[chunk] = sum;
}

// One work-item per run of slots: those of nodes whose costs are in bins from `floor` on and that are not settled, in any
// order.
__kernel void list_candidates(__global const ushort* cost_bins, __global uint* candidates,
                              volatile __global uint* length, uint floor, uint count, uint run) {
  const uint begin = GN_ROOT_SLOT + (uint)get_global_id(0) * run;
  uint i;
  for (i = begin; i <= count && i < begin + run; ++i) {
    if (i != GN_ROOT_SLOT && cost_bins[i] >= floor && cost_bins[i] < GN_SETTLED) candidates[atomic_inc(length)] = i;
  }
}

// One work-item per run of candidates. leave: those that stay are settled.
__kernel void find_moves(__global const GnNode* slots, __global const uint* above, __global const uint* candidates,
                         __global GnMove* moves, __global ushort* cost_bins, uint leave, uint count, uint run,
                         GN_COST_PARAMETERS) {
  const uint begin = (uint)get_global_id(0) * run;
  GnBoxCosts costs;
  uint i;
  if (begin >= count) return;
  set_costs(&costs, GN_COSTS);
  for (i = begin; i < count && i < begin + run; ++i) {
    const GnMove move = gn_find_move(slots, above, &costs, candidates[i]);
    if (leave && move.target == GN_NONE) cost_bins[move.node] |= (ushort)GN_SETTLED;
    moves[i] = move;
  }
}

// One work-item per move: bids its gain for the slots it needs.
__kernel void bid_gains(__global const GnMove* moves, volatile __global uint* gains, uint count) {
  const uint i = (uint)get_global_id(0);
  uint k;
  if (i >= count || moves[i].target == GN_NONE) return;
  {
    const GnMove move = moves[i];
    for (k = 0u; k < 4u; ++k) atomic_max(gains + gn_claimed_slot(&move, k), gn_bits_of(move.gain));
  }
}

static inline uint holds_all(const GnMove* move, __global const uint* claims, uint value) {
  uint k, all = 1u;
  for (k = 0u; k < 4u; ++k) all &= (uint)(claims[gn_claimed_slot(move, k)] == value);
  return all;
}

// One work-item per move: of those that bid most everywhere the highest slot counts.
__kernel void bid_slots(__global const GnMove* moves, __global const uint* gains, volatile __global uint* owners,
                        uint count) {
  const uint i = (uint)get_global_id(0);
  uint k;
  if (i >= count || moves[i].target == GN_NONE) return;
  {
    const GnMove move = moves[i];
    if (!holds_all(&move, gains, gn_bits_of(move.gain))) return;
    for (k = 0u; k < 4u; ++k) atomic_max(owners + gn_claimed_slot(&move, k), move.node);
  }
}

// One work-item per move: those that own all their slots enter their gain at their node.
__kernel void enter_winners(__global GnMove* moves, __global const uint* gains, __global const uint* owners,
                            __global uint* moving, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count || moves[i].target == GN_NONE) return;
  {
    const GnMove move = moves[i];
    const uint won = holds_all(&move, gains, gn_bits_of(move.gain)) & holds_all(&move, owners, move.node);
    moves[i].made = won;
    if (won) moving[move.node] = gn_bits_of(move.gain);
  }
}

// One work-item per winner: gives way or stays. made counts those that stay.
__kernel void give_way(__global GnMove* moves, __global const uint* above, __global const uint* moving,
                       volatile __global uint* made, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count || moves[i].made == 0u) return;
  {
    const GnMove move = moves[i];
    uint stays = 1u, slot = above[move.target >> 1];
    while (stays && slot != move.pivot) {
      if (moving[slot] != 0u && gn_gives_way(&move, slot, gn_float_of(moving[slot]))) stays = 0u;
      slot = above[slot >> 1];
    }
    moves[i].made = stays;
    if (stays) atomic_inc(made);
  }
}

static inline void put_node(__global GnNode* slots, __global uint* above, uint to, const GnNode* node) {
  slots[to] = *node;
  if (node->count == 0u) above[node->first >> 1] = to;
}

// A new parent of a pair; its box is worked out later.
static inline void put_parent(__global GnNode* slots, __global uint* above, uint to, uint pair) {
  slots[to].first = pair;
  slots[to].count = 0u;
  above[pair >> 1] = to;
}

// One work-item per move. The sibling takes the parent's place, the target the sibling's, and a new parent of node and
// target the target's: the node itself stays in its slot.
__kernel void make_moves(__global GnNode* slots, __global uint* above, __global GnBelow* below,
                         __global const GnMove* moves, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count || moves[i].made == 0u) return;
  {
    const GnMove move = moves[i];
    const GnNode sibling = slots[move.node ^ 1u], target = slots[move.target];
    put_node(slots, above, move.parent, &sibling);
    put_node(slots, above, move.node ^ 1u, &target);
    put_parent(slots, above, move.target, move.node & ~1u);
    below[move.parent >> 1].changed = GN_RELINKED;
    below[move.node >> 1].changed = GN_RELINKED;
    below[move.target >> 1].changed = GN_RELINKED;
  }
}

// One work-item per move: make_moves backwards.
__kernel void take_back(__global GnNode* slots, __global uint* above, __global const GnMove* moves, uint count) {
  const uint i = (uint)get_global_id(0);
  if (i >= count || moves[i].made == 0u) return;
  {
    const GnMove move = moves[i];
    const GnNode sibling = slots[move.parent], target = slots[move.node ^ 1u];
    put_node(slots, above, move.target, &target);
    put_node(slots, above, move.node ^ 1u, &sibling);
    put_parent(slots, above, move.parent, move.node & ~1u);
  }
}
