/** Signals that end the command, namely SIGINT (Ctrl-C), SIGTERM, and SIGHUP. */
#ifndef SIGNALS_H
#define SIGNALS_H
#include <signal.h>
#include <stdbool.h>

/** From now on a signal ends the process at once, with exit code 128 and its number. No temporary
 * file stays behind.
 *
 *  @param even_ignored  catch SIGINT and SIGTERM even if the process was started to ignore them, as
 *                       a script starts its background jobs. SIGHUP stays ignored if it was,
 *                       because nohup asks for that.
 *  @param sentence      the message to write then, ended by a newline, in static storage, or
 *                       NULL */
void signals_end(bool even_ignored, const char *sentence);

/** From now on a signal is only noted, so that the caller can end in good order. A Ctrl-C after
 * that ends the process at once, as above. Another SIGTERM or SIGHUP does not, because one cause
 * often sends them twice, to the process and to its group.
 *
 *  @return the address of the number of the first signal, 0 until then */
const volatile sig_atomic_t *signals_note(const char *sentence);

/** From now on the process is one of several. In the handler of each signal `look` is called first,
 *  and may end the process. `may_speak` is called before a sentence, and tells if this process is
 *  the one that writes it. */
void signals_among(void (*look)(void), bool (*may_speak)(void));
#endif
