#include "gnomon/cl/loop_limit.h"

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"

namespace gnomon::cl {

namespace {

// Beyond the known limit (65535) even where a compiler makes one turn out of seven.
constexpr std::uint32_t kTurnsAsked = 500'000;

}  // namespace

std::uint32_t measure_loop_limit(const Context& context) {
  const Buffer turns = context.create_buffer("loop_turns", sizeof(std::uint32_t));
  const Buffer value = context.create_buffer("loop_value", sizeof(std::uint32_t));
  const Handle<cl_kernel> kernel = context.programs().kernel({"loop_limit.cl"}, "", "count_turns");
  set_arguments(kernel.get(), turns, value, kTurnsAsked);
  wait(enqueue(context.queue(), kernel.get(), 1, 1));
  const std::uint32_t made = context.download_values<std::uint32_t>(turns, 1).front();
  return made == kTurnsAsked ? 0 : made;
}

}  // namespace gnomon::cl
