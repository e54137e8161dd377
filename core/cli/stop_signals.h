#pragma once

namespace drape {

/// From now on SIGINT and SIGTERM ask to stop; a second one ends the process at once.
void stop_on_signals();
/// The signal that asked to stop, 0 before there is one.
int stop_signal();

}  // namespace drape
