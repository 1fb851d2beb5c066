/* States that processes write and read in parts. */
#ifndef TESTS_PETSC_STATES_H
#define TESTS_PETSC_STATES_H

void check_states(void);

#endif
