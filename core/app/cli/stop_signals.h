#pragma once

namespace drape {

/// Makes SIGINT and SIGTERM request a stop; a second one ends the process at once.
void stop_on_signals();
/// The signal that requested the stop, 0 before.
int stop_signal();

}  // namespace drape
