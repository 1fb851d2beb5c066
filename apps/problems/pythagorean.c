/* Burrau's problem of masses 3, 4 and 5 at rest in the corners of a right triangle, each opposite
 * to the side of its length. Close encounters follow, the closest of 4.14e-4 at t = 15.8299, until
 * one body leaves for good. */
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

static dvi_status pythagorean_make(const double *setting, problem *made)
{
  (void)setting;
  return nbody_make(&bodies, made);
}

/* Quadruple-precision results, recomputed by tests/reference/test_digits. */
static const double digits_q[] = {
    0.87791185712612620,  2.4685638476332698,  -1.1646387214058229,
    -0.87557691545439917, 0.40496386284898262, -0.78067677621644255,
};
static const double digits_p[] = {
    -0.55871383343489313, -2.2920788979275850, 5.5336382842463239,
    0.80052404568870468,  -4.9749244508114308, 1.4915548522388803,
};

const problem_entry problem_entry_pythagorean = {
    .name = "pythagorean",
    .summary = "masses 3, 4, 5 from rest; close encounters, then one body leaves",
    .make = pythagorean_make,
    .h = 0.001,
    .t_end = 10.0,
    .order_h = 0.01,
    .order_t_end = 1.5,
    .digits_q = digits_q,
    .digits_p = digits_p,
};
