// The wide tree as traversal on CPUs reads it: nodes of eight boxes and blocks of eight triangles, both with the eight
// side by side so that one vector holds a coordinate of all. Made by collapse.cl from the binary tree, read by
// trace_wide.cl and by their references. Same rules as layout.h.
#ifndef GNOMON_SHARED_WIDE_LAYOUT_H
#define GNOMON_SHARED_WIDE_LAYOUT_H

#include "layout.h"

#define GN_WIDTH 8u

// One node. planes: the boxes' lower x of all slots, upper x, lower y, upper y, lower z, upper z. A slot without a
// child has an inverted box, which no ray meets, and a link of GN_NONE. Any hit looks at the last slot first (gn_slot_key).
typedef struct GnWideNode {
  gn_f32 planes[6][8];
  gn_u32 links[8];
} GnWideNode;
GN_SIZE_IS(GnWideNode, 224);

// A link to a node is its index. A link to a leaf has the top bit set, eight bits of triangle count - 1, and the
// index of its first block; the leaf's triangles fill one block after the other.
#define GN_LEAF_LINK 0x80000000u
#define GN_MAX_WIDE_LEAF 256u
#define GN_MAX_BLOCKS 0x00800000u
GN_INLINE gn_u32 gn_leaf_link(gn_u32 block, gn_u32 triangles) {
  return GN_LEAF_LINK | ((triangles - 1u) << 23) | block;
}
GN_INLINE gn_u32 gn_link_block(gn_u32 link) { return link & (GN_MAX_BLOCKS - 1u); }
GN_INLINE gn_u32 gn_link_triangles(gn_u32 link) { return ((link >> 23) & 255u) + 1u; }
GN_INLINE gn_u32 gn_blocks_of(gn_u32 triangles) { return (triangles + GN_WIDTH - 1u) / GN_WIDTH; }

// The end of a run of `length` items from `first` on, of `count` in all, first being no more than that. Never beyond
// 2^32, where first + length may be.
GN_INLINE gn_u32 gn_run_end(gn_u32 first, gn_u32 count, gn_u32 length) {
  return count - first < length ? count : first + length;
}

// Eight triangles: corners[3 * corner + axis] of all, and their numbers in the caller's array. Places behind a leaf's
// last triangle are zero and have the number GN_NONE.
typedef struct GnTriangleBlock {
  gn_f32 corners[9][8];
  gn_u32 primitives[8];
} GnTriangleBlock;
GN_SIZE_IS(GnTriangleBlock, 320);

// What the collapse may do with the subtree of an inner node: cost[i - 1] is the least expected cost of replacing it
// by at most i wide nodes or leaves, relative to a ray that meets everything.
typedef struct GnForest {
  gn_f32 cost[7];
  gn_u32 triangles;
} GnForest;
GN_SIZE_IS(GnForest, 32);

// The children of a wide node as they were found when it was counted (GnSlots), for whoever writes it.
typedef struct GnOpened {
  gn_u32 node[8];       // of the binary tree; GN_NONE behind the last
  gn_u32 triangles[4];  // sixteen bits each, the even ones' below: GN_MAX_WIDE_LEAF at most
} GnOpened;
GN_SIZE_IS(GnOpened, 48);

// A subtree whose wide nodes one work-item writes: its root, where that and what is below it go.
typedef struct GnCollapseTask {
  gn_u32 root;         // in the binary tree
  gn_u32 node;         // of the wide tree
  gn_u32 nodes_below;  // first wide node of those below; while counting: how many
  gn_u32 blocks_below;
  gn_u32 depth;
  gn_u32 largest_leaf;  // triangles
  gn_u32 pad[2];
} GnCollapseTask;
GN_SIZE_IS(GnCollapseTask, 32);

#endif
