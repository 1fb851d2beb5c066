/* Marches on boxes for tests, and a judge of them: the same equations from matrices of incidence
 * and lists of stars, which are made from the cells alone. */
#ifndef TESTS_SUPPORT_BOXES_H
#define TESTS_SUPPORT_BOXES_H
#include <dvi/yee.h>

#include "support/field/marches.h"

/* Create a march, or report why there is none. */
dvi_march *box_march(const dvi_yee_terms *terms);

/* Start with E and B, each NULL for 0. */
void start_boxes(dvi_march *march, const double *E, const double *B);

/* Give `count` random numbers from -1 to 1, for free(). */
double *random_values(int64_t count, unsigned long long seed);

/* The judge. One node of an axis that repeats itself is one, and edges on conductors stay 0. */
typedef struct box_judge {
  int64_t edges, faces;
  int *boundary;   /* [faces*4] edges of a face, -1 for none */
  double *sign;    /* [faces*4] */
  double *M1, *M2; /* [edges], [faces] */
  int *is_free;    /* [edges] */
  double *E, *B;   /* E half a step after B */
} box_judge;

box_judge make_judge(const dvi_yee_terms *terms);
void free_judge(box_judge *judge);

/* Set E^0, B^0, and take the half step. */
void start_judge(box_judge *judge, const double *E, const double *B, double dt);
void step_judge(box_judge *judge, double dt);

/* Give the largest eigenvalue of M_1^-1 d^T M_2 d, by the power method. */
double largest_of_judge(const box_judge *judge);

#endif
