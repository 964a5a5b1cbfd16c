#pragma once
/// A request to stop, from Ctrl-C (SIGINT), SIGTERM, SIGHUP, SIGUSR1 or SIGXCPU: the run ends after the current
/// increment, with a checkpoint.

namespace voussoir::host {

/// From now on these signals set a flag instead of ending the process. A second signal ends the process at once, except
/// a second SIGHUP. Where SIGHUP is ignored, as under nohup, it stays ignored.
void catch_interrupts();

/// From now on these signals end the process at once, with one line on standard error and this exit code.
void end_on_interrupts(int code);

/// True once a signal has arrived.
[[nodiscard]] bool interrupted();

}  // namespace voussoir::host
