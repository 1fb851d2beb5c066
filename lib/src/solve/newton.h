/* Newton's method with the factor of its guess, for many problems side by side. Each problem takes
 * the decisions of the solver's own loop (newton.c). */
#ifndef DVI_SOLVE_NEWTON_H
#define DVI_SOLVE_NEWTON_H
#include "solve/nonlinear.h"
#include "solve/progress.h"

/* What the end of an iteration is foreseen from, where that is possible. */
typedef struct dvi__outlook {
  double next;   /* the next correction's own part, as a part of this one */
  double unseen; /* the part of this correction that no longer counts */
  double reach;  /* the first correction by the factor in use, as a part of the unknowns */
} dvi__outlook;

enum { DVI__NEWTON_GROUPS = 16 }; /* most groups of unknowns */

/* The course of one problem's iteration. */
typedef struct dvi__newton_course {
  dvi__history history;
  dvi__outlook now;
  dvi__solve_report report;          /* the iterations, and what the first two corrections tell */
  double before[DVI__NEWTON_GROUPS]; /* the first correction's largest numbers */
} dvi__newton_course;

/* A correction: its largest number in each group of unknowns, the largest unknown after it, and the
 * size of the quantities to which the unknowns are increments. */
typedef struct dvi__newton_correction {
  int groups;
  double change[DVI__NEWTON_GROUPS], whole[DVI__NEWTON_GROUPS], size;
} dvi__newton_correction;

void dvi__newton_begin(dvi__newton_course *course);

/* Judge a correction by the factor of the guess, of a solver whose equations have groups and look
 * ahead, and know no magnitudes of rows. CONVERGED if the solver's loop, when it is wary, would end
 * with success, GO_ON if its next correction would be by the same factor, STALLED in all other
 * cases. */
dvi__progress dvi__newton_go_on(const dvi__solver *solver, dvi__newton_course *course,
                                const dvi__newton_correction *correction);

#endif
