/* The mollified impulse method. The slow potentials kick at filtered places. Between the kicks
 * stands the exact motion of quadratic fast potentials.
 *
 *     Ld(q0,q1) = action of the exact fast motion from q0 to q1
 *                 - h/2 (U(t0,A(q0)) + U(t1,A(q1)))
 * The kicks of U(A(q)) are A'(q)^T U'(A(q)), which suppresses the modes that kicks would excite
 * (method/split/oscillation.h). The filter A depends on x = h omega of each mode.
 *     average     mean over a step of the fast motion that starts at rest, phi = sin x/x
 *     projection  modes that a step does not resolve rest at their equilibrium,
 *                 phi = 0 for x > 1, else 1
 * The order is 2 as h goes to 0, and the method is symmetric and symplectic. Source:
 * Garcia-Archilla, Sanz-Serna and Skeel 1999; Izaguirre, Reich and Skeel 1999. */
#include "method/split/oscillation.h"

enum { FILTER };

enum { AVERAGE, PROJECTION };

static const char *mollified_filter_name(int index)
{
  static const char *const name[] = {"average", "projection"};
  return index >= 0 && index < 2 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"filter", mollified_filter_name, 0, 0, AVERAGE,
     "where the slow potentials are asked: average (over the fast motion), or projection (without "
     "the modes of h omega > 1); default: average"},
    {0},
};

static int mollified_pair(int number, double s, dvi__filter *filter)
{
  double c[4];
  if (number == PROJECTION) {
    *filter = s > 1 ? (dvi__filter){0, 1 / s, 0} : (dvi__filter){1, 0, 1};
    return 1;
  }
  dvi__modes_functions(s, c);
  *filter = (dvi__filter){c[1], c[3], c[1]};
  return 1;
}

static const dvi__filters filters[] = {
    {.at = mollified_pair, .number = AVERAGE, .phi = {1, 1, 0}, .psi = {1, 1, 0}},
    {.at = mollified_pair, .number = PROJECTION},
};

static dvi_status mollified_create(dvi__stepper *self)
{
  return dvi__oscillation_create(self, &filters[self->settings.value[FILTER]], DVI__MOTION_AUTO,
                                 "imex and respa:substeps=k take any");
}

const dvi__method dvi__mollified = {
    .name = "mollified",
    .summary = "mollified impulse method, to compare with: filtered kicks, exact motion of "
               "quadratic fast potentials; order 2",
    .cite = "GarciaArchillaSanzSernaSkeel1999",
    .keys = keys,
    DVI__IMPULSE_OPERATIONS,
    .create = mollified_create,
    .destroy = dvi__oscillation_destroy,
    .explain = dvi__oscillation_explain,
};
