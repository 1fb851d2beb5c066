/* Trigonometric integrators: exact for linear oscillators, slow forces through filters.
 *
 *     q1 = cos(h Om) q0 + Om^-1 sin(h Om) p0 + h^2/2 Psi g0,      p1 = -Om sin(h Om) q0 + cos(h Om) p0 + h/2 (Psi_0 g0 + Psi_1 g1),
 *     g = -U'(Phi q),      Psi = sinc(h Om) Psi_1,      Psi_0 = cos(h Om) Psi_1:
 * a kick by Psi_1 g0, exact motion, a kick by Psi_1 g1 (method/oscillation.h), with M = 1 and W = q.Om^2 q/2; other masses and linear parts of W by the modes.
 * Where Psi_1 = Phi it is the variational method of
 *     Ld(q0,q1) = action of the fast motion from q0 to q1 - h/2 (U(Phi q0) + U(Phi q1)).
 * Order 2 as h goes to 0, symmetric; symplectic where it is variational.
 * Source: Hairer, Lubich and Wanner 2006, sec. XIII.2.2 (A to E, G); Stern 2009, sec. 2.3 (exact). */
#include <math.h>

#include "method/oscillation.h"

enum { FILTER };

enum { EXACT, DEUFLHARD, GARCIA_ARCHILLA, GAUTSCHI, HOCHBRUCK_LUBICH, GRIMM_HOCHBRUCK, HAIRER_LUBICH, FILTERS };

static const char *filter_name(int index)
{
  static const char *const name[] = {"exact",           "deuflhard",    "garcia-archilla", "gautschi", "hochbruck-lubich",
                                     "grimm-hochbruck", "hairer-lubich"};
  return index >= 0 && index < FILTERS ? name[index] : NULL;
}

static const dvi__key keys[] = {
    {"filter", filter_name, 0, 0, GARCIA_ARCHILLA,
     "the filters of the slow forces: exact, deuflhard or garcia-archilla (variational); gautschi, hochbruck-lubich, "
     "grimm-hochbruck or hairer-lubich (not symplectic); left out: garcia-archilla"},
    {0},
};

/* A sinc this small is one that rounding made. */
static const double least_sinc = 1e-12;

/* With sinc x = c_1, sinc^2(x/2) = 2 c_2, (1 - sinc x)/x^2 = c_3, and psi_1 = psi/sinc x. */
static int pair(int number, double s, dvi__filter *filter)
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
    filter->shift = s != 0 ? (1 - filter->phi) / s : -1.0 / 24;
    return 1;
  case GARCIA_ARCHILLA: *filter = (dvi__filter){c[1], c[3], c[1]}; return 1;
  case GAUTSCHI: filter->psi = 2 * c[2] / c[1]; return 1;
  case HOCHBRUCK_LUBICH: *filter = (dvi__filter){c[1] * (1 + s * c[2] / 6), c[3] - c[1] * c[2] / 6, 2 * c[2] / c[1]}; return 1;
  case GRIMM_HOCHBRUCK: *filter = (dvi__filter){c[1], c[3], c[1] * c[1]}; return 1;
  case HAIRER_LUBICH: filter->psi = c[1]; return 1;
  default: return 1;
  }
}

static dvi_status create(dvi__stepper *self)
{
  return dvi__oscillation_create(self, pair, self->settings.value[FILTER], "imex and respa:substeps=k take any");
}

const dvi__method dvi__trig = {
    .name = "trig",
    .summary = "trigonometric integrators: exact motion of quadratic fast potentials, filtered slow forces; order 2; constant mass",
    .cite = "HairerLubichWanner2006",
    .keys = keys,
    DVI__IMPULSE_OPERATIONS,
    .create = create,
    .destroy = dvi__oscillation_destroy,
    .explain = dvi__oscillation_explain,
};
