/** The cores of this machine. */
#ifndef CORES_H
#define CORES_H

/** Return their number, 1 or more. */
int cores_count(void);

/** Keep this process on one of the cores on which it may run, as mpirun does where there is a core
 * for each process: the number counts modulo theirs. Does nothing where the system does not tell.
 */
void cores_keep(int number);
#endif
