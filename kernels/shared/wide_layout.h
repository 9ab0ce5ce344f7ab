// The wide tree as traversal on CPUs reads it: nodes of eight boxes and leaves in blocks of eight triangles, both with the
// eight side by side so that one vector holds a coordinate of all. Made by collapse.cl from the binary tree, read by
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

// Leaves lie in places of ten words, one a triangle, in blocks of up to eight triangles: first all their first corners' x,
// then all their y, ..., and at last their numbers. A block of fewer than eight is as much shorter, so that no memory is
// spent on what is not there: vectors of eight read on into what follows, and their lanes behind the last triangle say
// nothing. So GN_LEAF_SLACK words follow the last place, and numbers are written as GN_NUMBER more than they are: read as
// floats they would be denormal, which is slow.
#define GN_TRIANGLE_WORDS 10u
#define GN_LEAF_SLACK 8u
#define GN_NUMBER 0x40000000u
#define GN_MAX_PLACES 0x04000000u

// A link to a node is its index. A link to a leaf has the top bit set, five bits of triangle count - 1, and its first place.
// A long leaf has GN_LONG_LEAF triangles or more: its first place begins with how many, and they follow.
#define GN_LEAF_LINK 0x80000000u
#define GN_LONG_LEAF 32u
#define GN_MAX_WIDE_LEAF 256u
GN_INLINE gn_u32 gn_leaf_link(gn_u32 place, gn_u32 triangles) {
  return GN_LEAF_LINK | (((triangles < GN_LONG_LEAF ? triangles : GN_LONG_LEAF) - 1u) << 26) | place;
}
GN_INLINE gn_u32 gn_link_place(gn_u32 link) { return link & (GN_MAX_PLACES - 1u); }
GN_INLINE gn_u32 gn_leaf_places(gn_u32 triangles) { return triangles < GN_LONG_LEAF ? triangles : triangles + 1u; }
// A link of a tree whose first node and place are no longer the first.
GN_INLINE gn_u32 gn_moved_link(gn_u32 link, gn_u32 nodes_before, gn_u32 places_before) {
  if (link == GN_NONE) return link;
  return link + ((link & GN_LEAF_LINK) != 0u ? places_before : nodes_before);
}
GN_INLINE gn_u32 gn_blocks_of(gn_u32 triangles) { return (triangles + GN_WIDTH - 1u) / GN_WIDTH; }

// The places of a leaf's triangles.
typedef struct GnLeaf {
  gn_u32 first;
  gn_u32 count;
} GnLeaf;
GN_INLINE GnLeaf gn_leaf_at(GN_GLOBAL const gn_u32* leaves, gn_u32 link) {
  GnLeaf leaf;
  leaf.first = gn_link_place(link);
  leaf.count = ((link >> 26) & 31u) + 1u;
  if (leaf.count == GN_LONG_LEAF) {
    leaf.count = leaves[GN_TRIANGLE_WORDS * leaf.first];
    leaf.first += 1u;
  }
  return leaf;
}

// A triangle's seat, by which its words are found: the first place of its block, how many sit there, and which it is.
GN_INLINE gn_u32 gn_seat(gn_u32 first, gn_u32 count, gn_u32 lane) { return 64u * first + 8u * (count - 1u) + lane; }
GN_INLINE gn_u32 gn_seat_in(GnLeaf leaf, gn_u32 i) {
  const gn_u32 before = i / GN_WIDTH * GN_WIDTH, rest = leaf.count - before;
  return gn_seat(leaf.first + before, rest < GN_WIDTH ? rest : GN_WIDTH, i - before);
}
// The word of its first coordinate, how far on the next one is, and the word of its number.
GN_INLINE gn_u32 gn_seat_word(gn_u32 seat) { return GN_TRIANGLE_WORDS * (seat >> 6) + (seat & 7u); }
GN_INLINE gn_u32 gn_seat_stride(gn_u32 seat) { return ((seat >> 3) & 7u) + 1u; }
GN_INLINE gn_u32 gn_number_at(GN_GLOBAL const gn_u32* leaves, gn_u32 seat) {
  return leaves[gn_seat_word(seat) + 9u * gn_seat_stride(seat)] - GN_NUMBER;
}

// The end of a run of `length` items from `first` on, of `count` in all, first being no more than that. Never beyond
// 2^32, where first + length may be.
GN_INLINE gn_u32 gn_run_end(gn_u32 first, gn_u32 count, gn_u32 length) {
  return count - first < length ? count : first + length;
}

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
  gn_u32 nodes_below;  // first wide node of those below, first place of their leaves; while counting: how many
  gn_u32 places_below;
  gn_u32 depth;
  gn_u32 largest_leaf;  // triangles
  gn_u32 pad[2];
} GnCollapseTask;
GN_SIZE_IS(GnCollapseTask, 32);

#endif
