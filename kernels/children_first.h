// A subtree of the binary tree from below: inner nodes, children before parents, in one work-item.
// Options: GN_COLLAPSE_DEPTH (inner nodes on the longest way down). Feeds collapse.cl and refit.cl.
#ifndef GNOMON_CHILDREN_FIRST_H
#define GNOMON_CHILDREN_FIRST_H

// Lanes that a work-group smaller than the device's vectors leaves over: Mesa's llvmpipe has them run along in loops. What they
// load is 0, so a loop that looks for something never ends there, and uses up the turns of all (loops-that-end.md).
#define GN_IDLE_LANE (get_local_id(0) >= get_local_size(0))

#define GN_CHILDREN_DONE 0x80000000u

// Runs `visit`, an expression that uses the uint `node`, for every inner node of the subtree whose root, an inner node,
// is `root`.
#define GN_CHILDREN_FIRST(nodes, root, visit)                        \
  {                                                                  \
    uint waiting[2 * GN_COLLAPSE_DEPTH];                             \
    uint height = 1u;                                                \
    waiting[0] = (root);                                             \
    while (height > 0u) {                                            \
      const uint entry = waiting[height - 1u];                       \
      const uint node = entry & ~GN_CHILDREN_DONE;                   \
      const uint first = (nodes)[node].first;                        \
      if (entry & GN_CHILDREN_DONE) {                                \
        visit;                                                       \
        height -= 1u;                                                \
        continue;                                                    \
      }                                                              \
      waiting[height - 1u] = entry | GN_CHILDREN_DONE;               \
      if ((nodes)[first + 1u].count == 0u) waiting[height++] = first + 1u; \
      if ((nodes)[first].count == 0u) waiting[height++] = first;     \
    }                                                                \
  }

#endif
