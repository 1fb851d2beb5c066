/* The ground state beyond a bifurcation.
 *
 * Attraction may turn the state that is followed from no interaction, a minimum of E on the sphere
 * of the norm, into a saddle: that in both sides of a double well, when a state in one side has
 * less energy (a pitchfork). The second variation H + 2 beta psi^2 - mu has two negative
 * eigenvalues then, and a combination of their modes is tangent to the sphere. E falls along it.
 * From its minimum there, steps P^-1 (mu M psi - H psi) with P = H_0 + c, a positive definite
 * matrix, and with a search along each of them, lead down until Newton's method converges to a
 * minimum. Source: Jackson and Weinstein 2004 (the bifurcation); Bao and Cai 2013, sec. 3. */
#include <math.h>
#include <string.h>

#include "core/status.h"
#include "field/algebra/vectors.h"
#include "field/schroedinger/ground.h"

enum { LOWEST = 2, SADDLES = 4, DESCENTS = 7, STEPS = 4000, HALVINGS = 40, LENGTHS = 38 };

dvi_status dvi__ground_is_minimum(dvi__ground *g, int *is_minimum)
{
  dvi_schroedinger varied = *g->s;
  double energy[LOWEST];
  dvi__ground_vary(g);
  varied.still = g->V;
  DVI_TRY(dvi__schroedinger_lowest(&varied, LOWEST, energy, g->modes));
  *is_minimum = energy[1] >= -1e-8 * fabs(energy[0]);
  return DVI_OK;
}

/* ---- along one direction ---- */

/* Set z to kept + by change, on the sphere. Returns its energy. */
static double move(dvi__ground *g, double by)
{
  for (int64_t i = 0; i < g->s->free; i++) g->z[i] = g->kept[i] + by * g->change[i];
  dvi__ground_settle(g);
  return dvi__ground_energy(g);
}

static void keep(dvi__ground *g)
{
  memcpy(g->kept, g->z, (size_t)g->s->free * sizeof *g->z);
}

/* Set the change to the combination of both modes that is orthogonal to psi, with psi's norm. */
static void combine_modes(dvi__ground *g)
{
  const int64_t n = g->s->free;
  const double a = dvi__dot(n, g->modes, g->Mz), b = dvi__dot(n, g->modes + n, g->Mz),
               by = sqrt(g->norm) / hypot(a, b);
  for (int64_t i = 0; i < n; i++) g->change[i] = by * (a * g->modes[n + i] - b * g->modes[i]);
}

/* Go to the least energy along the falling direction, to the side where it is less. */
static void leave_saddle(dvi__ground *g)
{
  double least = dvi__ground_energy(g), best = 0;
  combine_modes(g);
  keep(g);
  for (int i = 0; i < LENGTHS; i++)
    for (int side = 1; side >= -1; side -= 2) {
      const double by = side * 0.02 * pow(1.2, i), energy = move(g, by);
      if (energy >= least - 1e-12 * fabs(least)) continue;
      least = energy;
      best = by;
    }
  (void)move(g, best);
}

/* ---- descent ---- */

/* Set the change to P^-1 times the residual, beside psi. */
static dvi_status find_descent(dvi__ground *g)
{
  const dvi_schroedinger *s = g->s;
  double least = INFINITY;
  if (s->is_fourier) {
    dvi__ground_precondition(g, g->residual, g->change);
    return DVI_OK;
  }
  for (int64_t k = 0; k < s->points; k++) least = fmin(least, s->still[k]);
  for (int64_t k = 0; k < s->points; k++) g->V[k] = s->still[k] - least + fabs(g->mu - least);
  return dvi__tangent_solve(g->tangent, g->V, g->Mz, g->residual, g->change);
}

/* Move along the change until the energy falls. Tells if it does, and leaves z if not. */
static int search(dvi__ground *g, double *by)
{
  const double before = dvi__ground_energy(g),
               slope = 2 * dvi__dot(g->s->free, g->change, g->residual);
  keep(g);
  *by = fmin(2 * *by, 4);
  for (int i = 0; i < HALVINGS; i++, *by /= 2)
    if (move(g, *by) < before - 1e-4 * *by * slope) return 1;
  (void)move(g, 0);
  return 0;
}

static double size_of_change(const dvi__ground *g)
{
  const int64_t n = g->s->free;
  return sqrt(dvi__dot(n, g->change, g->change) / dvi__dot(n, g->z, g->z));
}

/* Descend until changes are small, or the energy does not fall any more. */
static dvi_status descend(dvi__ground *g, double small)
{
  double by = 0.5;
  for (int i = 0; i < STEPS; i++) {
    DVI_TRY(find_descent(g));
    if (size_of_change(g) < small || !search(g, &by)) return DVI_OK;
  }
  return DVI_OK;
}

/* Newton's method from lower and lower states, until it does not lead up again. */
static dvi_status settle_down(dvi__ground *g)
{
  const size_t size = (size_t)g->s->free * sizeof *g->z;
  dvi_status status = DVI_NOT_CONVERGED;
  double small = 0.1;
  for (int i = 0; i < DESCENTS && status != DVI_OK; i++, small *= 0.1) {
    DVI_TRY(descend(g, small));
    const double before = dvi__ground_energy(g);
    memcpy(g->good, g->z, size);
    status = dvi__ground_converge(g);
    if (status != DVI_OK && status != DVI_NOT_CONVERGED && status != DVI_SINGULAR) return status;
    if (status == DVI_OK && dvi__ground_energy(g) > before + 1e-12 * fabs(before))
      status = DVI_NOT_CONVERGED;
    if (status == DVI_OK) return DVI_OK;
    memcpy(g->z, g->good, size);
    dvi__ground_settle(g);
  }
  return status;
}

dvi_status dvi__ground_descend(dvi__ground *g)
{
  int is_minimum = 0;
  dvi_status status = DVI_OK;
  g->strength = 1;
  dvi__ground_settle(g);
  DVI_TRY(dvi__ground_is_minimum(g, &is_minimum));
  for (int i = 0; i < SADDLES && status == DVI_OK && (i == 0 || !is_minimum); i++) {
    if (!is_minimum) leave_saddle(g);
    status = settle_down(g);
    if (status == DVI_OK) status = dvi__ground_is_minimum(g, &is_minimum);
  }
  if (status == DVI_OK && is_minimum) return DVI_OK;
  return dvi__fail(DVI_NOT_CONVERGED,
                   "schroedinger: the ground state is that followed from no interaction up to %g "
                   "of it, and none is found beyond; attraction may leave its place open, as in a "
                   "potential without a minimum: take one that prefers a place",
                   g->followed);
}
