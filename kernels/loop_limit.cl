// Asks the device whether it lets loops run: some end every loop of a work-item, without a word, once all of its loops
// together have made a certain number of turns (Mesa's llvmpipe after 65535). Feeds Context::device().loop_limit.

// turns receives how many of the asked turns were made. The chain of values has no closed form that a compiler could
// replace the loop by, and value keeps it from being dropped.
__kernel void count_turns(__global uint* turns, __global uint* value, uint asked) {
  uint i, chain = 1u;
  for (i = 0u; i < asked; ++i) chain = (chain >> 3) ^ (chain * 1664525u + i);
  turns[0] = i;
  value[0] = chain;
}
