#pragma once

namespace drape {

/// Makes SIGINT, SIGTERM and SIGHUP (a lost terminal) request a stop; a second one ends the process at once.
/// SIGHUP stays ignored under nohup. SIGPIPE is ignored: a run goes on where nobody reads its progress.
void stop_on_signals();
/// The signal that requested the stop, 0 before.
int stop_signal();

}  // namespace drape
