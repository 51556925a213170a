// Ctrl-C and SIGTERM: the frame being worked on is finished, then the program ends with 130 or 143.
// A second signal of the same kind ends it at once.
#pragma once

namespace understory {

/// Notes SIGINT and SIGTERM from now on instead of dying of them.
void catch_interrupts();

/// The signal that asked the program to stop; 0: none.
int interrupt_received();

}  // namespace understory
