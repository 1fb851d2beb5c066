/* The cases of a loop over methods and problems in which the method does not refuse the problem. A
 * suite runs these cases alone, and one more case asserts how many they are: what is refused has
 * shown nothing, and must not count as passed. */
#ifndef SUPPORT_ACCEPTED_H
#define SUPPORT_ACCEPTED_H
#include "problem.h"

enum { ACCEPTED_MOST = 2000 };

typedef struct accepted_cases {
  int count, which[ACCEPTED_MOST];
} accepted_cases;

/* Of the cases 0 .. total-1 those for which is_accepted() answers 1. */
void find_accepted_cases(int total, int (*is_accepted)(int which), accepted_cases *found);

/* Asserts that so many cases were found, and at least one of each method; case number `which` has
 * method which % methods. */
void check_accepted_cases(const accepted_cases *found, int count, int methods,
                          const char *const *method);

/* 0 if the method refuses the system as unsupported. Every other failure is left to the case that
 * meets it. */
int method_accepts(const dvi_system *system, const char *method);
int method_accepts_problem(const char *name, const char *setting, const char *method);

#endif
