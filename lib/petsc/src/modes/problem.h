/* The eigenvalue problem of a field that processes share. */
#ifndef DVI_PETSC_PROBLEM_H
#define DVI_PETSC_PROBLEM_H
#include "eigen.h"

typedef struct dvi__modes_problem {
  dvi_division *division;
  const dvi_field *field;
  int64_t most; /* unknowns of a mesh in space for a factor */
  int degree;
  dvi__numbering unknowns;
  Mat K;
  Vec mass, root, start, room[2];
  double mean, below; /* of the eigenvalues; a shift below 0 of the size of the lowest ones */
  int is_large;       /* equations are iterated where they can be */
  dvi__gradients gradients;
  PetscInt constants; /* modes of frequency zero of a wave, the first pairs */
  dvi__pairs pairs;
} dvi__modes_problem;

/* Prepare the problem, of which division, field and `most` are given. All processes call it. For
 * dvi__modes_problem_clear after failures, too. */
dvi_status dvi__modes_problem_create(dvi__modes_problem *problem);
void dvi__modes_problem_clear(dvi__modes_problem *problem);

/* Fill the start of an iteration at random, by numbers in the whole mesh alone. */
dvi_status dvi__modes_draw_start(dvi__modes_problem *problem, int draw);

#endif
