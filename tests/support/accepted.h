/* Finds the cases of a loop over methods and problems in which the method takes the problem. A
 * suite runs these cases alone, and one more case asserts their number. A refused case has shown
 * nothing, and must not count as passed. */
#ifndef SUPPORT_ACCEPTED_H
#define SUPPORT_ACCEPTED_H
#include "problem.h"

enum { ACCEPTED_MOST = 2000 };

typedef struct accepted_cases {
  int count, which[ACCEPTED_MOST];
} accepted_cases;

/* Finds those of the cases 0 .. total-1 for which is_accepted() returns 1. */
void find_accepted_cases(int total, int (*is_accepted)(int number), accepted_cases *found);

/* Asserts that `count` cases were found, and at least one of each method. Case i has method
 * i % methods. */
void check_accepted_cases(const accepted_cases *found, int count, int methods,
                          const char *const *method);

/* Return 0 if the method refuses the system as unsupported. The test case meets all other
 * failures. */
int method_accepts(const dvi_system *system, const char *method);
int method_accepts_problem(const char *name, const char *setting, const char *method);

#endif
