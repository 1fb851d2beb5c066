/** Processes that are killed while others wait for them.
 *
 *  MPI lets the others wait without end, or they get a SIGTERM and, a second later, SIGKILL. The
 *  processes of one machine therefore look for each other, when a signal comes and four times a
 *  second. The first one that misses another says so, and all end. */
#ifndef LOSS_H
#define LOSS_H
#include <stdbool.h>

#include "petsc/petsc_module.h"

/** Begin to look for the other processes, all of which call this. Returns whether there was memory.
 *
 *  @param rank  that of this process
 *  @param speech  the descriptor of its standard error */
bool loss_watch(const petsc_module *module, int rank, int speech);

/** Set what is said after the sentence that a process is missing. Copied, and cut if it is long. */
void loss_remedy(const char *remedy);

/** Tell if this process may say why all of them end, at its standard error. One of a machine
 *  may. */
bool loss_may_speak(void);

/** Look for others no more: they end in good order. */
void loss_end(void);
#endif
