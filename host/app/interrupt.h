// Ctrl-C as a wish to stop, looked up between steps of work. Feeds the console's progress function.
#pragma once

namespace gnomon::app {

// From now on the first SIGINT only sets a flag; a second one ends the program at once.
void catch_interrupts();
[[nodiscard]] bool interrupted();
// Throws Error{kCancelled} after a SIGINT: called before results are written.
void stop_if_interrupted();

}  // namespace gnomon::app
