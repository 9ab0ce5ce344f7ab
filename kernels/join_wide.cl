// Puts a wide tree behind others in the same buffers: its links move by what stands before it. Reference:
// host/tree/regions.cpp. The bytes do not depend on how the work was cut.
#include "shared/wide_layout.h"

// One work-item per node.
__kernel void join_nodes(__global const GnWideNode* from, __global GnWideNode* nodes, uint nodes_before,
                         uint places_before, uint count) {
  const uint index = (uint)get_global_id(0);
  GnWideNode node;
  uint slot;
  if (index >= count) return;
  node = from[index];
  for (slot = 0u; slot < GN_WIDTH; ++slot) node.links[slot] = gn_moved_link(node.links[slot], nodes_before, places_before);
  nodes[nodes_before + index] = node;
}

// One work-item per place of leaves.
__kernel void join_leaves(__global const uint* from, __global uint* leaves, uint places_before, uint count) {
  const uint index = (uint)get_global_id(0);
  uint word;
  if (index >= count) return;
  for (word = 0u; word < GN_TRIANGLE_WORDS; ++word)
    leaves[GN_TRIANGLE_WORDS * (places_before + index) + word] = from[GN_TRIANGLE_WORDS * index + word];
}
