// The handler only notes the signal; SA_RESETHAND gives the second one its usual effect.
#include "host/app/interrupt.hpp"

#include <csignal>

namespace understory {
namespace {
volatile std::sig_atomic_t received_signal = 0;
void note_signal(int signal) { received_signal = signal; }
}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

int interrupt_received() { return received_signal; }

}  // namespace understory
