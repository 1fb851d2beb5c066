/* Ground states of H(psi) psi = mu M psi with psi.M psi = N (Gross and Pitaevskii).
 *
 * They are stationary points of E on the sphere of the norm. Newton's method for (psi, mu) solves
 *
 *     [ H(psi) + 2 beta psi^2 - mu M   -M psi ] [ dpsi ]   [ mu M psi - H(psi) psi ]
 *     [ -(M psi)^T                        0   ] [ dmu  ] = [ (psi.M psi - N)/2     ]
 *
 * as one sparse system with a border, or for fourier by conjugate gradients on the plane that is
 * tangent to the sphere, where the matrix is positive definite at a minimum of E. The lowest mode
 * is followed from beta = 0 in steps that shrink where Newton's method fails. Source: Bao and Cai
 * 2013, sec. 3. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "core/status.h"
#include "field/algebra/conjugate.h"
#include "field/schroedinger/tangent.h"

enum { NEWTON = 40, STEPS = 400 };

typedef struct ground {
  const dvi_schroedinger *s;
  double norm, strength; /* of the interaction now, 0 to 1 */
  double mu;
  double *z, *kept, *Mz, *Hz, *residual, *change, *product; /* [free] */
  double *V;                                                /* [points] */
  double *work;                                             /* [5*free] of conjugate gradients */
  dvi__schroedinger_room room;
  dvi__tangent *tangent; /* NULL for fourier */
} ground;

static double dot(int64_t n, const double *x, const double *y)
{
  double sum = 0;
  for (int64_t i = 0; i < n; i++) sum += x[i] * y[i];
  return sum;
}

/* ---- one correction ---- */

/* Scale psi to the norm, and give mu and the residual M mu psi - H psi. */
static void settle(ground *g)
{
  const int64_t n = g->s->free;
  dvi__schroedinger_mass(g->s, g->z, g->Mz);
  const double by = sqrt(g->norm / dot(n, g->z, g->Mz));
  for (int64_t i = 0; i < n; i++) {
    g->z[i] *= by;
    g->Mz[i] *= by;
  }
  dvi__schroedinger_act(g->s, g->s->still, g->strength, 1, g->z, g->Hz, &g->room);
  g->mu = dot(n, g->z, g->Hz) / g->norm;
  for (int64_t i = 0; i < n; i++) g->residual[i] = g->mu * g->Mz[i] - g->Hz[i];
}

/* V + 3 beta psi^2 - mu, the potential of the second variation. */
static void find_potential(ground *g)
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
static void make_tangent(const ground *g, double *x)
{
  const int64_t n = g->s->free;
  const double part = dot(n, g->z, x) / g->norm;
  for (int64_t i = 0; i < n; i++) x[i] -= part * g->z[i];
}

static dvi_status times(void *of, const double *x, double *y)
{
  const ground *g = of;
  memcpy(g->product, x, (size_t)g->s->free * sizeof *x);
  make_tangent(g, g->product);
  dvi__schroedinger_act(g->s, g->V, 0, 1, g->product, y, &g->room);
  make_tangent(g, y);
  return DVI_OK;
}

/* The kinetic energy with a constant, which is that of the state's own energies. */
static void precondition(void *of, const double *r, double *z)
{
  const ground *g = of;
  const int64_t n = g->s->free;
  double kinetic = 0;
  for (int64_t i = 0; i < n; i++) kinetic += g->s->diagonal[i] * g->z[i] * g->z[i];
  const double c = kinetic / g->norm + fabs(g->mu) + 1e-300;
  memcpy(z, r, (size_t)n * sizeof *z);
  make_tangent(g, z);
  for (int64_t i = 0; i < n; i++) z[i] /= g->s->diagonal[i] + c;
  make_tangent(g, z);
}

static dvi_status correct_by_gradients(ground *g)
{
  const dvi__products products = {.size = g->s->free,
                                  .times = times,
                                  .precondition = precondition,
                                  .of = g,
                                  .work = g->work,
                                  .roundoff = 1e-16 * sqrt(dot(g->s->free, g->Hz, g->Hz))};
  memcpy(g->kept, g->residual, (size_t)g->s->free * sizeof *g->kept);
  make_tangent(g, g->kept);
  return dvi__conjugate_gradients(&products, 1e-10, g->kept, g->change, NULL);
}

static dvi_status correct(ground *g)
{
  find_potential(g);
  if (g->tangent == NULL) return correct_by_gradients(g);
  return dvi__tangent_solve(g->tangent, g->V, g->Mz, g->residual, g->change);
}

/* ---- Newton's method ---- */

/* A ground state has no nodes. Roundings and truncated series may still cross 0. */
static int is_positive(ground *g)
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

/* Correct until corrections are roundings. DVI_NOT_CONVERGED or DVI_SINGULAR if the state is too
 * far from the guess. */
static dvi_status converge(ground *g)
{
  const int64_t n = g->s->free;
  double size = 1, before = 2;
  settle(g);
  for (int i = 0; i < NEWTON && size < before && size > 1e-15; i++) {
    before = size;
    DVI_TRY(correct(g));
    for (int64_t k = 0; k < n; k++) g->z[k] += g->change[k];
    settle(g);
    size = sqrt(dot(n, g->change, g->change) / dot(n, g->z, g->z));
  }
  if (size < 1e-9 && is_positive(g)) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED, "schroedinger: Newton's method ends with changes of %g",
                   size);
}

static int is_hopeless(dvi_status status)
{
  return status != DVI_OK && status != DVI_NOT_CONVERGED && status != DVI_SINGULAR;
}

/* Follow the state to the whole interaction. */
static dvi_status follow(ground *g)
{
  const size_t size = (size_t)g->s->free * sizeof *g->z;
  double done = 0, step = 1;
  double *good = g->work + 5 * g->s->free;
  memcpy(good, g->z, size);
  for (int i = 0; i < STEPS && done < 1 && step > 1e-6; i++) {
    g->strength = fmin(1, done + step);
    const dvi_status status = converge(g);
    if (is_hopeless(status)) return status;
    if (status == DVI_OK) {
      memcpy(good, g->z, size);
      done = g->strength;
      step *= 2;
    } else {
      memcpy(g->z, good, size);
      step /= 4;
    }
  }
  if (done >= 1) return DVI_OK;
  return dvi__fail(
      DVI_NOT_CONVERGED,
      "schroedinger: the ground state is lost at %g of the interaction; attraction may "
      "let it collapse or leave its place open, and repulsion needs cells that resolve "
      "it",
      done);
}

/* ---- the kind of stationary point ---- */

static int attracts(const dvi_schroedinger *s)
{
  int64_t k = 0;
  while (s->beta != NULL && k < s->points && !(s->beta[k] < 0)) k++;
  return s->beta != NULL && k < s->points;
}

/* Refuse a state whose second variation H + 2 beta psi^2 - mu has two negative eigenvalues. One of
 * their directions at least is tangent to the sphere: attraction has let the state of least energy
 * leave this one, to one side of a double well, say. Without attraction E has one minimum. */
static dvi_status check_minimum(const ground *g)
{
  enum { LOWEST = 2 };
  const dvi_schroedinger *s = g->s;
  dvi_schroedinger varied = *s;
  double energy[LOWEST], *z = DVI_NEW(double, LOWEST * s->free);
  if (z == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld functions",
                     (long long)s->free);
  varied.still = g->V;
  const dvi_status status = dvi__schroedinger_lowest(&varied, LOWEST, energy, z);
  dvi__release(z);
  DVI_TRY(status);
  if (energy[1] >= -1e-8 * fabs(energy[0])) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "schroedinger: attraction has let another state of less energy leave the one "
                   "with mu = %g, which is that without interaction, followed; take a potential "
                   "that prefers a place",
                   g->mu);
}

/* ---- the state ---- */

static dvi_status allocate(ground *g)
{
  const dvi_schroedinger *s = g->s;
  g->z = DVI_NEW(double, 13 * s->free + s->points);
  if (g->z == NULL)
    return dvi__fail(DVI_NO_MEMORY, "schroedinger: no memory for %lld functions",
                     (long long)s->free);
  double **const vectors[] = {&g->kept,   &g->Mz,      &g->Hz,  &g->residual,
                              &g->change, &g->product, &g->work};
  for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
    *vectors[i] = g->z + (int64_t)(i + 1) * s->free;
  g->V = g->z + 13 * s->free;
  DVI_TRY(dvi__schroedinger_make_room(s, &g->room));
  return s->is_fourier ? DVI_OK : dvi__tangent_create(s, &g->tangent);
}

/* Energy, E = norm mu - (integral of beta psi^4)/2. */
static double energy_of(ground *g)
{
  const dvi_schroedinger *s = g->s;
  double interaction = 0;
  dvi__schroedinger_to_points(s, g->z, g->room.u, g->room.work);
  for (int64_t k = 0; k < s->points && s->beta != NULL; k++) {
    const double density = g->room.u[k] * g->room.u[k];
    interaction += 0.5 * s->weight[k] * s->beta[k] * density * density;
  }
  return g->norm * g->mu - interaction;
}

static dvi_status find(ground *g)
{
  DVI_TRY(allocate(g));
  DVI_TRY(dvi__schroedinger_lowest(g->s, 1, &g->mu, g->z));
  if (g->s->beta == NULL) {
    settle(g);
    return DVI_OK;
  }
  DVI_TRY(follow(g));
  if (!attracts(g->s) || g->s->free < 4) return DVI_OK;
  find_potential(g);
  return check_minimum(g);
}

dvi_status dvi_schroedinger_ground(const dvi_schroedinger *equation, double norm, double *mu,
                                   double *energy, double *psi)
{
  ground g = {.s = equation, .norm = norm};
  if (equation == NULL || !(norm > 0) || isinf(norm))
    return dvi__fail(DVI_BAD_ARGUMENT,
                     "schroedinger: an equation and a norm are needed; the norm is %g, and should "
                     "be above 0 and finite",
                     norm);
  const dvi_status status = find(&g);
  if (status == DVI_OK) {
    dvi__schroedinger_choose_sign(equation->free, g.z);
    if (mu != NULL) *mu = g.mu;
    if (energy != NULL) *energy = energy_of(&g);
    if (psi != NULL) dvi__schroedinger_extend(equation, g.z, psi);
  }
  dvi__tangent_destroy(&g.tangent);
  dvi__schroedinger_clear_room(&g.room);
  dvi__release(g.z);
  return status;
}
