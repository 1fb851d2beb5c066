/** Signals that end the command: SIGINT (Ctrl-C), SIGTERM, and SIGHUP. */
#ifndef SIGNALS_H
#define SIGNALS_H
#include <signal.h>
#include <stdbool.h>

/** From now on a signal ends the process at once, with exit code 128 and its number; no temporary
 * file stays behind.
 *
 *  @param even_ignored  take back SIGINT and SIGTERM if the process was started to ignore them, as
 *                       a script starts its background jobs. SIGHUP stays ignored if it was: that
 *                       is what nohup is for.
 *  @param sentence      what to say then, ended by a newline, in static storage; NULL: nothing */
void signals_end(bool even_ignored, const char *sentence);

/** From now on a signal is only noted, for the caller to end in good order. A Ctrl-C after that
 *  ends the process at once, as above. Another SIGTERM or SIGHUP does not: one cause often sends
 *  them twice, to the process and to its group.
 *
 *  @return where the number of the first signal stands; 0 until then */
const volatile sig_atomic_t *signals_note(const char *sentence);
#endif
