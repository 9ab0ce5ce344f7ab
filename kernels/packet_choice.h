// Whether packets pay, told from what one did: it tests every child against all its rays, so that it knows what each by itself
// would have met, and both ways have a price. Where rays by themselves are cheaper, those that follow in the work-item go
// so. Counts decide, not clocks: the same rays are traced the same way every time.
// Options: GN_CHOOSE (0: wherever rays make a packet, they are one). Feeds packet_rays.h, packet_walk.h, trace_packet.cl.
#ifndef GNOMON_PACKET_CHOICE_H
#define GNOMON_PACKET_CHOICE_H

#include "shared/scalar.h"

#ifndef GN_CHOOSE
#define GN_CHOOSE 0
#endif

// What a packet did, and, where it is measured, what its rays would have met by themselves.
typedef struct GnPacketWork {
  uint measured;
  uint nodes;      // tested for all rays at once
  uint boxes;      // children, against sixteen rays
  uint triangles;  // against sixteen rays
  uint alone_nodes;
  uint alone_blocks;
} GnPacketWork;

// What is known in a work-item: whether rays go by themselves from here on, whether a packet has been measured, and how many
// attempts in a row found none.
typedef struct GnChoice {
  uint alone;
  uint known;
  uint failures;
} GnChoice;

#if GN_CHOOSE

#define GN_WORK(p, what, more) (p)->work.what += (more)
#define GN_MEASURED(p) ((p)->work.measured)

// Prices in tenths of a nanosecond, fitted to times on PoCL; those of packets a tenth higher, which they have to be cheaper by
// (host/notes/packets.md).
#define GN_PACKET_RAY 190u
#define GN_PACKET_NODE 1620u
#define GN_PACKET_BOX 42u
#define GN_PACKET_TRIANGLE 135u
#define GN_ALONE_RAY 630u
#define GN_ALONE_NODE 51u
#define GN_ALONE_BLOCK 206u

// Before a packet is traced: the first of a work-item is measured.
static inline void begin_choice(GnPacketWork* work, GnChoice* choice) {
  work->measured = !choice->known;
  work->nodes = 0u;
  work->boxes = 0u;
  work->triangles = 0u;
  work->alone_nodes = 0u;
  work->alone_blocks = 0u;
  choice->failures = 0u;
}

// After it, for any hit: closest hits have no prices, since their packets pay wherever there are any.
static inline void choose(const GnPacketWork* work, uint rays, GnChoice* choice) {
  if (choice->known) return;
  const ulong together = (ulong)rays * GN_PACKET_RAY + (ulong)work->nodes * GN_PACKET_NODE +
                         (ulong)work->boxes * GN_PACKET_BOX + (ulong)work->triangles * GN_PACKET_TRIANGLE;
  const ulong alone = (ulong)rays * GN_ALONE_RAY + (ulong)(rays + work->alone_nodes) * GN_ALONE_NODE +
                      (ulong)work->alone_blocks * GN_ALONE_BLOCK;
  choice->known = 1u;
  choice->alone = alone < together;
}

// Where to look for a packet again after an attempt that found none: twice as far each time, up to eight runs of sixteen.
static inline uint rays_to_pass(GnChoice* choice) {
  const uint pass = 16u << choice->failures;
  choice->failures = min(choice->failures + 1u, 3u);
  return pass;
}

#else

#define GN_WORK(p, what, more)
#define GN_MEASURED(p) 0u
static inline void begin_choice(GnPacketWork* work, GnChoice* choice) {}
static inline void choose(const GnPacketWork* work, uint rays, GnChoice* choice) {}
static inline uint rays_to_pass(GnChoice* choice) { return 16u; }

#endif

#endif
