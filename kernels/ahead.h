// Sending for memory before it is needed, where the compiler has a way to (PoCL on x86); nothing elsewhere, and no result
// depends on it. For reads whose addresses jump: those that go straight on the hardware foresees. Device only.
#ifndef GNOMON_AHEAD_H
#define GNOMON_AHEAD_H

#if defined(POCL_DEVICE_ADDRESS_BITS) && defined(__x86_64__)
#define GN_EXPECT(address) __builtin_prefetch((const void*)(uintptr_t)(address))
#else
#define GN_EXPECT(address)
#endif
#define GN_CACHE_LINE 64u

static inline void expect_range(__global const void* from, size_t bytes) {
#if defined(POCL_DEVICE_ADDRESS_BITS) && defined(__x86_64__)
  size_t i;
  for (i = 0u; i < bytes; i += GN_CACHE_LINE) GN_EXPECT((__global const char*)from + i);
#endif
}

#endif
