// Structs and sizes of reinsertion (host/notes/best-builder.md). All sizes here are part of the algorithm: they decide
// the tree, so no device may choose others. Same rules as layout.h. Feeds reinsert_math.h, reinsert.cl and the reference.
#ifndef GNOMON_SHARED_REINSERT_LAYOUT_H
#define GNOMON_SHARED_REINSERT_LAYOUT_H

#include "layout.h"

// While it is optimised a tree's nodes stand in slots: the root in slot 1, siblings in 2k and 2k + 1, so that they share
// a cache line, a sibling is one bit away, and k names the pair. An inner node's `first` is the slot of its left child.
#define GN_ROOT_SLOT 1u

// Pairs of nodes one search looks at, at most.
#define GN_SEARCH_PAIRS 512u
// Pairs waiting in one search: one for each level of the deepest tree that is optimised, and a few.
#define GN_SEARCH_STACK 132u
#define GN_MOST_DEPTH 128u

// Of a node's own cost: gains up to that are left alone.
#define GN_LEAST_GAIN 0.0009765625f

// Measures are counted in bins of an eighth of a power of two.
#define GN_MEASURE_BINS 2048u
#define GN_MEASURE_BIN_SHIFT 20

// Measures are added up as integers, the root's being this many: sums do not depend on their order.
#define GN_ROOT_UNITS 1073741824.0f

// Of GnBelow::changed, from when a pair is written until sizes are worked out again.
#define GN_RELINKED 2u

// Beside the bin a node's cost is in: no better place was found for it and nothing near has moved since.
#define GN_SETTLED 0x8000u

// A node that would be better placed beside `target`. gain: how much less all inner nodes would then measure. pivot: the
// lowest node above both.
typedef struct GnMove {
  gn_u32 node;
  gn_u32 target;  // GN_NONE: it stays
  gn_u32 pivot;
  gn_f32 gain;
  gn_u32 made;    // 1: no other move is in its way
  gn_u32 parent;  // of the node, before the move
  gn_u32 pad[2];
} GnMove;
GN_SIZE_IS(GnMove, 32);

// What is below an inner node, kept with its children's pair.
typedef struct GnBelow {
  gn_u32 inner;      // inner nodes, itself counted
  gn_u32 triangles;
  gn_u32 height;     // levels below it
  gn_u32 changed;    // 0: links below it are what they were when sizes were worked out before; GN_RELINKED: its children's
} GnBelow;
GN_SIZE_IS(GnBelow, 16);

#endif
