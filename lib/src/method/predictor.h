/* A better start for the equations of a step. The error of a guess, which is the solution less the
 * guess, changes smoothly from step to step of the same length. It is extrapolated by its backward
 * differences, and added to the next guess. The number of differences is that which would have
 * served the last step best. */
#ifndef DVI_METHOD_PREDICTOR_H
#define DVI_METHOD_PREDICTOR_H
#include <stddef.h>

#include "num/simd/abreast.h"

typedef struct dvi__predictor {
  size_t unknowns;
  double *plain; /* [unknowns] last guess without its expected error */
  double h;      /* the step that it was made for, 0 if there is none */
} dvi__predictor;

/* Give the count of the numbers that are carried from step to step. They begin with zeros. */
size_t dvi__predictor_memory(size_t unknowns);

/* Add the expected error to the guess x [unknowns] for a step of length h. */
void dvi__predictor_correct(dvi__predictor *predictor, const double *memory, double h, double *x);

/* Learn from the solution x [unknowns] of a step of length h. If the last guess was for another
 * length, or dvi__predictor_leave came after it, everything is forgotten. */
void dvi__predictor_learn(dvi__predictor *predictor, double *memory, double h, const double *x);

/* Leave a guess out that is not like the others. */
void dvi__predictor_leave(dvi__predictor *predictor);

/* Predict and learn for several members abreast. Rows of the memory are those of one member, and
 * plain [unknowns] takes the guesses without their expected errors. */
void dvi__predictor_correct_abreast(size_t unknowns, const dvi__abreast *memory, double h,
                                    dvi__abreast *plain, dvi__abreast *x);
void dvi__predictor_learn_abreast(size_t unknowns, dvi__abreast *memory, double h,
                                  const dvi__abreast *plain, const dvi__abreast *x);

#endif
