/* Ground states of H(psi) psi = mu M psi with psi.M psi = N (Gross and Pitaevskii).
 *
 * They are stationary points of E on the sphere of the norm. Newton's method for (psi, mu) solves
 *
 *     [ H(psi) + 2 beta psi^2 - mu M   -M psi ] [ dpsi ]   [ mu M psi - H(psi) psi ]
 *     [ -(M psi)^T                        0   ] [ dmu  ] = [ (psi.M psi - N)/2     ]
 *
 * as one sparse system with a border, or for fourier by conjugate gradients on the plane that is
 * tangent to the sphere, where the matrix is positive definite at a minimum of E. The lowest mode
 * is followed from beta = 0 in steps that shrink where Newton's method fails, or where attraction
 * has made the state a saddle (descent.c). Source: Bao and Cai 2013, sec. 3. */
#include "field/schroedinger/ground.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/algebra/vectors.h"

enum { NEWTON = 40, STEPS = 400 };

/* ---- one correction ---- */

void dvi__ground_settle(dvi__ground *g)
{
  const int64_t n = g->s->free;
  dvi__schroedinger_mass(g->s, g->z, g->Mz);
  const double by = sqrt(g->norm / dvi__dot(n, g->z, g->Mz));
  for (int64_t i = 0; i < n; i++) {
    g->z[i] *= by;
    g->Mz[i] *= by;
  }
  dvi__schroedinger_act(g->s, g->s->still, g->strength, 1, g->z, g->Hz, &g->room);
  g->mu = dvi__dot(n, g->z, g->Hz) / g->norm;
  for (int64_t i = 0; i < n; i++) g->residual[i] = g->mu * g->Mz[i] - g->Hz[i];
}

void dvi__ground_vary(dvi__ground *g)
{
  const dvi_schroedinger *s = g->s;
  dvi__schroedinger_to_points(s, g->z, g->room.u, g->room.work);
  for (int64_t k = 0; k < s->points; k++) {
    const double psi = g->room.u[k];
    g->V[k] = s->still[k] - g->mu +
              (s->beta != NULL ? 3 * g->strength * s->beta[k] * psi * psi : 0);
  }
}

/* Take from x its part along psi. The mass is 1. */
static void make_tangent(const dvi__ground *g, double *x)
{
  const int64_t n = g->s->free;
  const double part = dvi__dot(n, g->z, x) / g->norm;
  for (int64_t i = 0; i < n; i++) x[i] -= part * g->z[i];
}

static dvi_status times(void *of, const double *x, double *y)
{
  const dvi__ground *g = of;
  memcpy(g->product, x, (size_t)g->s->free * sizeof *x);
  make_tangent(g, g->product);
  dvi__schroedinger_act(g->s, g->V, 0, 1, g->product, y, &g->room);
  make_tangent(g, y);
  return DVI_OK;
}

void dvi__ground_precondition(void *of, const double *r, double *z)
{
  const dvi__ground *g = of;
  const int64_t n = g->s->free;
  double kinetic = 0;
  for (int64_t i = 0; i < n; i++) kinetic += g->s->diagonal[i] * g->z[i] * g->z[i];
  const double c = kinetic / g->norm + fabs(g->mu) + 1e-300;
  memcpy(z, r, (size_t)n * sizeof *z);
  make_tangent(g, z);
  for (int64_t i = 0; i < n; i++) z[i] /= g->s->diagonal[i] + c;
  make_tangent(g, z);
}

static dvi_status correct_by_gradients(dvi__ground *g)
{
  const dvi__products products = {.size = g->s->free,
                                  .times = times,
                                  .precondition = dvi__ground_precondition,
                                  .of = g,
                                  .work = g->work,
                                  .roundoff = 1e-16 * sqrt(dvi__dot(g->s->free, g->Hz, g->Hz))};
  memcpy(g->kept, g->residual, (size_t)g->s->free * sizeof *g->kept);
  make_tangent(g, g->kept);
  return dvi__conjugate_gradients(&products, 1e-10, g->kept, g->change, NULL);
}

static dvi_status correct(dvi__ground *g)
{
  dvi__ground_vary(g);
  if (g->tangent == NULL) return correct_by_gradients(g);
  return dvi__tangent_solve(g->tangent, g->V, g->Mz, g->residual, g->change);
}

/* ---- Newton's method ---- */

/* A ground state has no nodes. Roundings and truncated series may still cross 0. */
static int is_positive(dvi__ground *g)
{
  const dvi_schroedinger *s = g->s;
  double least = 0, most = 0;
  dvi__schroedinger_to_points(s, g->z, g->room.u, g->room.work);
  for (int64_t k = 0; k < s->points; k++) {
    least = fmin(least, g->room.u[k]);
    most = fmax(most, g->room.u[k]);
  }
  return fmin(-least, most) <= 1e-2 * fmax(-least, most);
}

dvi_status dvi__ground_converge(dvi__ground *g)
{
  const int64_t n = g->s->free;
  double size = 1, before = 2;
  dvi__ground_settle(g);
  for (int i = 0; i < NEWTON && size < before && size > 1e-15; i++) {
    before = size;
    DVI_TRY(correct(g));
    for (int64_t k = 0; k < n; k++) g->z[k] += g->change[k];
    dvi__ground_settle(g);
    size = sqrt(dvi__dot(n, g->change, g->change) / dvi__dot(n, g->z, g->z));
  }
  if (size < 1e-9 && is_positive(g)) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED, "schroedinger: Newton's method ends with changes of %g",
                   size);
}

/* ---- continuation ---- */

static int is_hopeless(dvi_status status)
{
  return status != DVI_OK && status != DVI_NOT_CONVERGED && status != DVI_SINGULAR;
}

/* Newton's method, and with attraction the test of what it has found. A saddle is a failure. */
static dvi_status go_on(dvi__ground *g, int *is_saddle)
{
  int is_minimum = 1;
  *is_saddle = 0;
  DVI_TRY(dvi__ground_converge(g));
  if (g->attracts) DVI_TRY(dvi__ground_is_minimum(g, &is_minimum));
  *is_saddle = !is_minimum;
  return is_minimum ? DVI_OK : DVI_NOT_CONVERGED;
}

/* Follow the state to the whole interaction, or to where it is lost, or no minimum any more. That
 * place is known to a thousandth then, four times the last step, and z is the state there. */
static dvi_status follow(dvi__ground *g)
{
  const size_t size = (size_t)g->s->free * sizeof *g->z;
  const double least_step = 1e-6, near = 2.5e-4;
  double step = 1;
  int is_saddle = 0;
  memcpy(g->good, g->z, size);
  g->followed = 0;
  for (int i = 0; i < STEPS && g->followed < 1 && step > (is_saddle ? near : least_step); i++) {
    g->strength = fmin(1, g->followed + step);
    const dvi_status status = go_on(g, &is_saddle);
    if (is_hopeless(status)) return status;
    if (status == DVI_OK) {
      memcpy(g->good, g->z, size);
      g->followed = g->strength;
      step *= 2;
    } else {
      memcpy(g->z, g->good, size);
      step /= 4;
    }
  }
  return DVI_OK;
}

static dvi_status refuse_loss(const dvi__ground *g)
{
  return dvi__fail(
      DVI_NOT_CONVERGED,
      "schroedinger: the ground state is lost at %g of the interaction; attraction may "
      "let it collapse or leave its place open, and repulsion needs cells that resolve "
      "it",
      g->followed);
}

/* ---- the state ---- */

static dvi_status allocate(dvi__ground *g)
{
  const dvi_schroedinger *s = g->s;
  enum { VECTORS = 15 };
  g->z = DVI_NEW(double, VECTORS * s->free + s->points);
  if (g->z == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld functions",
                     (long long)s->free);
  double **const vectors[] = {&g->kept,   &g->good,    &g->Mz,    &g->Hz,  &g->residual,
                              &g->change, &g->product, &g->modes, &g->work};
  static const int count[] = {1, 1, 1, 1, 1, 1, 1, 2, 5};
  double *at = g->z + s->free;
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
    *vectors[i] = at;
    at += count[i] * s->free;
  }
  g->V = at;
  DVI_TRY(dvi__schroedinger_make_room(s, &g->room));
  return s->is_fourier ? DVI_OK : dvi__tangent_create(s, &g->tangent);
}

double dvi__ground_energy(dvi__ground *g)
{
  const dvi_schroedinger *s = g->s;
  double interaction = 0;
  dvi__schroedinger_to_points(s, g->z, g->room.u, g->room.work);
  for (int64_t k = 0; k < s->points && s->beta != NULL; k++) {
    const double density = g->room.u[k] * g->room.u[k];
    interaction += 0.5 * s->weight[k] * s->beta[k] * density * density;
  }
  return g->norm * g->mu - g->strength * interaction;
}

/* Find whether there is attraction, and refuse what collapses in two dimensions: a small and dense
 * state has the less energy the smaller it is. */
static dvi_status look_for_attraction(dvi__ground *g)
{
  const double critical = 5.850448; /* norm of Townes' soliton, laplace Q/2 - Q + Q^3 = 0 */
  const dvi_schroedinger *s = g->s;
  double least = 0;
  for (int64_t k = 0; k < s->points && s->beta != NULL; k++) least = fmin(least, s->beta[k]);
  g->attracts = least < 0 && s->free >= 4;
  const double strength = -least * g->norm * s->mass / (s->hbar * s->hbar);
  if (dvi__ground_dimension(g) != 2 || !(strength >= critical)) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "schroedinger: attraction lets all states collapse: in two dimensions there is "
                   "no ground state with |beta| norm mass/hbar^2 = %g, which has to be below %g "
                   "(Weinstein 1983); take less of the interaction or of the norm",
                   strength, critical);
}

static dvi_status find(dvi__ground *g)
{
  DVI_TRY(look_for_attraction(g));
  DVI_TRY(allocate(g));
  DVI_TRY(dvi__schroedinger_lowest(g->s, 1, &g->mu, g->z));
  g->followed = 1;
  if (g->s->beta == NULL) {
    dvi__ground_settle(g);
    return DVI_OK;
  }
  DVI_TRY(follow(g));
  if (g->followed >= 1) return DVI_OK;
  return g->attracts && dvi__ground_dimension(g) < 3 ? dvi__ground_descend(g) : refuse_loss(g);
}

dvi_status dvi_schroedinger_ground(const dvi_schroedinger *equation, double norm,
                                   dvi_schroedinger_ground_report *report, double *psi)
{
  dvi__ground g = {.s = equation, .norm = norm};
  if (equation == NULL || !(norm > 0) || isinf(norm))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: an equation and a norm are needed; the norm is %g, and should "
                     "be above 0 and finite",
                     norm);
  const dvi_status status = find(&g);
  if (status == DVI_OK) {
    dvi__choose_sign(equation->free, g.z);
    if (report != NULL)
      *report = (dvi_schroedinger_ground_report){g.mu, dvi__ground_energy(&g), g.followed};
    if (psi != NULL) dvi__schroedinger_extend(equation, g.z, psi);
  }
  dvi__tangent_destroy(&g.tangent);
  dvi__schroedinger_clear_room(&g.room);
  dvi__release(g.z);
  return status;
}
