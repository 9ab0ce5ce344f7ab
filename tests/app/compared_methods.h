// What comparisons in tests set beside each other: Embree too, where the program was built with it.
#pragma once

namespace program {

#ifdef GNOMON_HAS_EMBREE
inline constexpr bool kHasPeers = true;
inline constexpr const char* kComparedMethods = "sah-fast,sah-best,sah-balanced/fast,pah-window,auto,embree";
#else
inline constexpr bool kHasPeers = false;
inline constexpr const char* kComparedMethods = "sah-fast,sah-best,sah-balanced/fast,pah-window,auto";
#endif

}  // namespace program
