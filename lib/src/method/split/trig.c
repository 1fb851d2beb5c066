/* Trigonometric integrators are exact for linear oscillators and filter the slow forces.
 *
 *     q1 = cos(h Om) q0 + Om^-1 sin(h Om) p0 + h^2/2 Psi g0,
 *     p1 = -Om sin(h Om) q0 + cos(h Om) p0 + h/2 (Psi_0 g0 + Psi_1 g1),
 *     g = -U'(Phi q),      Psi = sinc(h Om) Psi_1,      Psi_0 = cos(h Om) Psi_1
 *
 * This is a kick by Psi_1 g0, the exact motion, and a kick by Psi_1 g1
 * (method/split/oscillation.h), with M = 1 and W = q.Om^2 q/2. Other masses and linear parts of W
 * are treated by the modes. Where Psi_1 = Phi, this is the variational method of
 *     Ld(q0,q1) = action of the fast motion from q0 to q1 - h/2 (U(Phi q0) + U(Phi q1)).
 * The order is 2 as h goes to 0. The method is symmetric, and symplectic where it is variational.
 * Source: Hairer, Lubich and Wanner 2006, sec. XIII.2.2 (A to E, G); Stern 2009, sec. 2.3
 * (exact). */
#include <math.h>

#include "method/split/oscillation.h"

enum { FILTER, MOTION };

enum {
  EXACT,
  DEUFLHARD,
  GARCIA_ARCHILLA,
  GAUTSCHI,
  HOCHBRUCK_LUBICH,
  GRIMM_HOCHBRUCK,
  HAIRER_LUBICH,
  FILTERS
};

static const char *trig_filter_name(int index)
{
  static const char *const name[] = {"exact",        "deuflhard",        "garcia-archilla",
                                     "gautschi",     "hochbruck-lubich", "grimm-hochbruck",
                                     "hairer-lubich"};
  return index >= 0 && index < FILTERS ? name[index] : NULL;
}

static const char *motion_name(int index)
{
  static const char *const name[] = {"auto", "modes", "polynomials"};
  return index >= 0 && index < 3 ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"filter", trig_filter_name, 0, 0, GARCIA_ARCHILLA,
     "the filters of the slow forces: exact, deuflhard or garcia-archilla (variational); gautschi, "
     "hochbruck-lubich, grimm-hochbruck or hairer-lubich (not symplectic); default: "
     "garcia-archilla"},
    {"motion", motion_name, 0, 0, DVI__MOTION_AUTO,
     "how the fast motion is found: by normal modes, in blocks of up to 2000 coupled coordinates, "
     "or by polynomials, for sparse springs of any size; default: auto"},
    {0},
};

/* A sinc this small is a rounding error of 0. */
static const double least_sinc = 1e-12;

/* Compute (1 - phi)/s of `exact`, phi = a/sqrt(b) with a = sinc(x/2) and b = sinc x. Where this
 * cancels, use (b - a^2)/s over b + a sqrt(b), with (b - a^2)/s = -sum_j (-s)^j
 * (2j + 2)/(2j + 4)!. */
static double exact_shift(double s, double a, double b)
{
  double sum = 0;
  if (fabs(s) > 1) return (1 - a / sqrt(b)) / s;
  for (int j = 8; j >= 0; j--) sum = (2 * j + 2) - s / ((2 * j + 5) * (2 * j + 6)) * sum;
  return -sum / 24 / (b + a * sqrt(b));
}

/* Compute a pair of filters from sinc x = c_1, sinc^2(x/2) = 2 c_2, (1 - sinc x)/x^2 = c_3, and
 * psi_1 = psi/sinc x. */
static int trig_pair(int number, double s, dvi__filter *filter)
{
  double c[4], half[4];
  dvi__modes_functions(s, c);
  const int divides = number == EXACT || number == GAUTSCHI || number == HOCHBRUCK_LUBICH;
  if (divides && (number == EXACT ? c[1] : fabs(c[1])) < least_sinc) return 0;
  *filter = (dvi__filter){1, 0, 1};
  switch (number) {
  case EXACT:
    dvi__modes_functions(s / 4, half);
    filter->phi = filter->psi = half[1] / sqrt(c[1]);
    filter->shift = exact_shift(s, half[1], c[1]);
    return 1;
  case GARCIA_ARCHILLA: *filter = (dvi__filter){c[1], c[3], c[1]}; return 1;
  case GAUTSCHI: filter->psi = 2 * c[2] / c[1]; return 1;
  case HOCHBRUCK_LUBICH:
    *filter = (dvi__filter){c[1] * (1 + s * c[2] / 6), c[3] - c[1] * c[2] / 6, 2 * c[2] / c[1]};
    return 1;
  case GRIMM_HOCHBRUCK: *filter = (dvi__filter){c[1], c[3], c[1] * c[1]}; return 1;
  case HAIRER_LUBICH: filter->psi = c[1]; return 1;
  default: return 1;
  }
}

/* The growth bounds follow from means of cos(tau x). c_1 and 2 c_2 are means over |tau| <= 1, and
 * 1 + s c_2/6 = (7 - cos x)/6. */
static const dvi__filters filters[] = {
    [EXACT] = {trig_pair, EXACT, {0.5, 1, 0.5}, {0.5, 1, 0.5}},
    [DEUFLHARD] = {trig_pair, DEUFLHARD, {0, 1, 0}, {0, 1, 0}},
    [GARCIA_ARCHILLA] = {trig_pair, GARCIA_ARCHILLA, {1, 1, 0}, {1, 1, 0}},
    [GAUTSCHI] = {trig_pair, GAUTSCHI, {0, 1, 0}, {1, 1, 1}},
    [HOCHBRUCK_LUBICH] = {trig_pair, HOCHBRUCK_LUBICH, {2, 4.0 / 3, 0}, {1, 1, 1}},
    [GRIMM_HOCHBRUCK] = {trig_pair, GRIMM_HOCHBRUCK, {1, 1, 0}, {2, 1, 0}},
    [HAIRER_LUBICH] = {trig_pair, HAIRER_LUBICH, {0, 1, 0}, {1, 1, 0}},
};

static dvi_status trig_create(dvi__stepper *self)
{
  const int *value = self->settings.value;
  return dvi__oscillation_create(self, &filters[value[FILTER]], (dvi__motion)value[MOTION],
                                 "imex and respa:substeps=k take any");
}

const dvi__method dvi__trig = {
    .name = "trig",
    .summary = "trigonometric integrators: exact motion of quadratic fast potentials, filtered "
               "slow forces; order 2; constant mass",
    .cite = "HairerLubichWanner2006",
    .keys = keys,
    DVI__IMPULSE_OPERATIONS,
    .create = trig_create,
    .destroy = dvi__oscillation_destroy,
    .explain = dvi__oscillation_explain,
};
