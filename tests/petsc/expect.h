/* What all processes of a test expect together. */
#ifndef TESTS_PETSC_EXPECT_H
#define TESTS_PETSC_EXPECT_H

extern int rank, ranks, failures; /* this process, how many there are, and what went wrong */

/* Count a failure unless a condition holds on all processes. Called on all of them. */
void expect(int holds, const char *what, const char *where);

#endif
