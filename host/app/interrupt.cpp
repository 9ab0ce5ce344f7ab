#include "interrupt.h"

#include <csignal>

#include "gnomon/base/error.h"

namespace gnomon::app {
namespace {

volatile std::sig_atomic_t asked_to_stop = 0;

extern "C" void remember_interrupt(int) {
  asked_to_stop = 1;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = remember_interrupt;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
}

bool interrupted() {
  return asked_to_stop != 0;
}

void stop_if_interrupted() {
  if (interrupted()) throw Error(ErrorCode::kCancelled, "cancelled");
}

}  // namespace gnomon::app
