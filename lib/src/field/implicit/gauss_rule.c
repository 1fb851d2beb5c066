/* Gauss collocation with two stages, the step of galerkin:degree=2 (docs/methods/galerkin.md). With
 * Q_j = q0 + Z_j and the coefficients A of the method, M Z = h A 1 p0 - h^2 A^2 F(Q). Times A^-2,
 *
 *     M (6 Z_1 + (12 r - 18) Z_2) + h (h F(Q_1) - 2 r p0) = 0,      r = sqrt(3),
 *     M (6 Z_2 - (12 r + 18) Z_1) + h (h F(Q_2) + 2 r p0) = 0,
 *     q1 = q0 + r (Z_2 - Z_1),      p1 = p0 - h/2 (F(Q_1) + F(Q_2)).
 *
 * A^2 has the eigenvalues exp(+- i pi/3)/12, and their eigenvectors are Z_1 + i sigma Z_2 with
 * sigma = 2 - r, up to factors. In x = Z_1 and y = sigma Z_2 the first equation times 1/12, and the
 * second one times -sigma/12, have the symmetric Jacobian of pairs (field/model/elliptic.h) with an
 * angle of 60 degrees, A = M + h^2/12 K and D_j = h^2/12 w V_uu(Q_j).
 *
 * Coefficients have rests, without which the energy of a linear field would change by the same
 * rounding in each step. Order 4. Sources: Hairer, Lubich and Wanner 2006, secs. II.1.3 and VIII.6,
 * and Hairer and Wanner 1996, sec. IV.8, on eigenvectors. */
#include "core/status.h"
#include "field/implicit/step.h"

/* sqrt(3), 12 sqrt(3) - 18 and 12 sqrt(3) + 18 */
static const double root = 1.7320508075688772, root_rest = 1.0035084221806903e-16,
                    minus = 2.7846096908265277, minus_rest = -1.2805752293335954e-16,
                    plus = 38.78460969082653, plus_rest = -5.721467327834222e-16;

/* Z_2 = stretch y */
static const double stretch = 3.7320508075688772;

/* Find both forces at x. */
static dvi_status find_forces(dvi__implicit_step *s, const double *x)
{
  DVI_TRY(dvi__implicit_force(s, 1, x, s->force[0]));
  return dvi__implicit_force(s, stretch, x + s->field->unknowns, s->force[1]);
}

/* Rests come last, when the large terms have cancelled. The forces of the last residual are those
 * of the solution. */
static dvi_status residual(void *of, const double *x, double *r)
{
  dvi__implicit_step *s = of;
  const dvi_field *f = s->field;
  const int64_t n = f->unknowns;
  const double h = s->h, *F1 = s->force[0], *F2 = s->force[1];
  DVI_TRY(find_forces(s, x));
  for (int64_t i = 0; i < n; i++) {
    const double m = f->mass.value[i], p = s->from->p[f->unknown[i]], Z1 = x[i],
                 Z2 = stretch * x[n + i], rest = h * 2 * root_rest * p,
                 first = m * (6 * Z1 + minus * Z2) + h * (h * F1[i] - 2 * root * p),
                 second = m * (6 * Z2 - plus * Z1) + h * (h * F2[i] + 2 * root * p);
    r[i] = (first + (m * minus_rest * Z2 - rest)) / 12;
    r[n + i] = -(second - (m * plus_rest * Z1 - rest)) / (12 * stretch);
  }
  return DVI_OK;
}

static dvi_status diagonal(void *of, const double *x, double *d)
{
  dvi__implicit_step *s = of;
  const int64_t n = s->field->unknowns;
  const double factor = s->h * s->h / 12;
  DVI_TRY(dvi__implicit_diagonal(s, factor, 1, x, d));
  DVI_TRY(dvi__implicit_diagonal(s, factor, stretch, x + n, d + n));
  DVI_TRY(dvi__implicit_check_curvature(s, 3, d));
  return dvi__implicit_check_curvature(s, 3, d + n);
}

static void equations(const dvi__implicit_step *s, dvi__field_equations *equations)
{
  equations->stiffness = s->h * s->h / 12;
  equations->cosine = 0.5;
  equations->sine = root / 2;
  equations->residual = residual;
  equations->diagonal = s->field->potential.density != NULL ? diagonal : NULL;
}

/* Where the velocity of the start leads to at the nodes. */
static dvi_status begin(dvi__implicit_step *s)
{
  const dvi_field *f = s->field;
  const double first = (3 - root) / 6, second = (3 + root) / 6 / stretch;
  for (int64_t i = 0; i < f->unknowns; i++) {
    const double way = s->h * (s->from->p[f->unknown[i]] / f->mass.value[i]);
    s->x[i] = first * way;
    s->x[f->unknowns + i] = second * way;
  }
  return DVI_OK;
}

static void move(const dvi__implicit_step *s, int64_t i, double *q, double *p)
{
  const double way = stretch * s->x[s->field->unknowns + i] - s->x[i];
  *q += __builtin_fma(root, way, root_rest * way);
  *p -= s->h / 2 * (s->force[0][i] + s->force[1][i]);
}

const dvi__rule dvi__gauss_rule = {.name = "galerkin-2",
                                   .numbers = 2,
                                   .forces = 2,
                                   .equations = equations,
                                   .begin = begin,
                                   .move = move};
