/* Burrau's problem: masses 3, 4 and 5 at rest in the corners of a right triangle, each opposite to the side of its length. Close
 * encounters, the closest of 4.14e-4 at t = 15.8299, until one body leaves for good. */
#include "entry.h"
#include "nbody.h"

static const nbody bodies = {
    .bodies = 3,
    .dimension = 2,
    .G = 1.0,
    .mass = {3.0, 4.0, 5.0},
    .name = {"1", "2", "3"},
    .position = {{1.0, 3.0}, {-2.0, -1.0}, {1.0, -1.0}},
};

static dvi_status make(const double *setting, problem *made)
{
  (void)setting;
  return nbody_make(&bodies, made);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    0.94955013483948425, 2.7732316949455631, -1.6662290659137289, -0.94944240914777313, 0.76325317182729259, -0.90438508964911933,
};
static const double digits_p[] = {
    -0.31878238629427370, -1.4021880181144576, 2.8554639728753562, 0.42799063171242660, -2.5366815865810825, 0.97419738640203097,
};

const problem_entry problem_entry_pythagorean = {
    .name = "pythagorean",
    .summary = "masses 3, 4, 5 from rest; close encounters, then one body leaves",
    .make = make,
    .h = 0.001,
    .t_end = 10.0,
    .order_h = 0.02,
    .order_t_end = 1.0,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
