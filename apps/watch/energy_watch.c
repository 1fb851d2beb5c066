#include "watch/energy_watch.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "csv/balance.h"
#include "cli/command.h"
#include "load/density.h"

/* A prime number of steps, so that a motion whose period is a whole number of steps is seen at all
 * its phases. */
enum { STRIDE = 61 };

/* Least scale, as a fraction of the energy. A system at rest has no other scale. */
static const double least_scale = 1e-8;

/* Coordinates that move by less than this fraction of the largest one have roundings only. */
static const double at_rest = 1e-12;

static bool has_kinetic_energy(const problem *scene)
{
  return scene->terms->one_form == NULL && scene->terms->hamiltonian == NULL;
}

const char *energy_scale_name(const problem *scene)
{
  return has_kinetic_energy(scene) ? "kinetic energy" : "energy that the motion exchanges";
}

static bool add_potential(const dvi_potential *of, double t, const double *q, double *sum)
{
  double V = 0.0;
  const int code = of->value != NULL ? of->value(t, q, &V, of->user)
                                     : of->value_batch(1, &t, q, &V, of->user);
  *sum += V;
  return code == 0;
}

static bool potential_energy(const dvi_system_terms *terms, double t, const double *q, double *V)
{
  bool good = true;
  *V = 0.0;
  for (int k = 0; k < terms->potential_count && good; k++)
    good = add_potential(&terms->potentials[k], t, q, V);
  return good;
}

/* Compute the kinetic energy, for a constant mass as T = E - V, and for a general Lagrangian as
 * p.v/2, which is T if it is quadratic in v. */
static bool kinetic_energy(energy_watch *w, double t, double energy, double *T)
{
  const problem *scene = w->scene;
  const double *p = dvi_integrator_p(w->integrator);
  if (scene->terms->lagrangian == NULL) {
    double V;
    const bool good = potential_energy(scene->terms, t, dvi_integrator_q(w->integrator), &V);
    *T = fabs(energy - V);
    return good;
  }
  if (dvi_integrator_interpolate(w->integrator, t, NULL, w->room) != DVI_OK) return false;
  *T = 0.0;
  for (int i = 0; i < scene->nv; i++) *T += 0.5 * p[i] * w->room[i];
  *T = fabs(*T);
  return true;
}

/* Evaluate the energy of a system without velocities. */
static bool plain_energy(const dvi_system_terms *terms, double t, const double *q, const double *p,
                         double *H)
{
  if (terms->hamiltonian != NULL)
    return terms->hamiltonian->value(t, q, p, H, terms->hamiltonian->user) == 0;
  return potential_energy(terms, t, q, H);
}

/* Compute the change of the energy if one number goes back to the start, times the count of
 * numbers. Each look takes the next number. */
static bool exchanged_energy(energy_watch *w, double t, double energy, double *change)
{
  const problem *scene = w->scene;
  const int numbers = scene->nq + (scene->terms->hamiltonian != NULL ? scene->nv : 0);
  double back = 0.0;
  memcpy(w->room, dvi_integrator_q(w->integrator), (size_t)scene->nq * sizeof *w->room);
  memcpy(w->room + scene->nq, dvi_integrator_p(w->integrator), (size_t)scene->nv * sizeof *w->room);
  w->room[w->next] = w->start[w->next];
  const bool good = plain_energy(scene->terms, t, w->room, w->room + scene->nq, &back) &&
                    isfinite(back);
  *change = good ? numbers * fabs(energy - back) : 0.0;
  w->next = (w->next + 1) % numbers;
  return true;
}

static void measure_motion(energy_watch *w)
{
  const double *q = dvi_integrator_q(w->integrator);
  for (int i = 0; i < w->scene->nq; i++) {
    w->moved = fmax(w->moved, fabs(q[i] - w->start[i]));
    w->largest = fmax(w->largest, fabs(q[i]));
  }
}

/* Energies of roundings alone have no scale. */
static bool is_at_rest(const energy_watch *w)
{
  return has_kinetic_energy(w->scene) && w->moved <= at_rest * w->largest;
}

static double mean_scale(const energy_watch *w)
{
  const double span = fabs(w->t - w->t_start);
  return fmax(span > 0.0 ? w->exchanged / span : 0.0, least_scale * fabs(w->first));
}

static double look_ratio(const energy_look *look, double scale)
{
  return look->error > 0.0 ? look->error / fmax(scale, look->local) : 0.0;
}

/* Keep the worse one of two neighbours. */
static void energy_watch_halve(energy_watch *w)
{
  const double scale = mean_scale(w);
  for (int k = 0; k < ENERGY_LOOKS_MAX / 2; k++) {
    const energy_look *one = &w->look[2 * k], *other = one + 1;
    w->look[k] = look_ratio(one, scale) < look_ratio(other, scale) ? *other : *one;
  }
  w->looks = ENERGY_LOOKS_MAX / 2;
}

/* Look at the energy. If it cannot be evaluated, only the watch ends. */
static void energy_watch_look(energy_watch *w)
{
  const double t = dvi_integrator_time(w->integrator);
  double energy, T;
  const bool kinetic = has_kinetic_energy(w->scene);
  w->blind = dvi_integrator_invariant(w->integrator, 0, &energy) != DVI_OK ||
             !(kinetic ? kinetic_energy : exchanged_energy)(w, t, energy, &T) ||
             !isfinite(energy) || !isfinite(T);
  if (w->blind) return;
  w->exchanged += T * fabs(t - w->t);
  w->t = t;
  measure_motion(w);
  if (w->looks == ENERGY_LOOKS_MAX) energy_watch_halve(w);
  w->look[w->looks++] = (energy_look){
      .t = t,
      .error = fabs(balanced_value(w->integrator, 0, energy) - w->first),
      .local = kinetic ? T : 0.0};
  if (isnan(w->passed) && look_ratio(&w->look[w->looks - 1], mean_scale(w)) > w->bound)
    w->passed = t;
}

bool energy_look_due(long steps)
{
  return steps <= ENERGY_EVERY_STEP || steps % STRIDE == 0;
}

/* Affine rows do work, as those of a disk that turns, in systems that do not depend on time. */
static bool has_affine_rows(const dvi_system_terms *terms)
{
  for (int k = 0; k < terms->nonholonomic_count; k++)
    if (terms->nonholonomics[k].affine != NULL) return true;
  return false;
}

static bool is_damped_field(const problem *scene)
{
  return has_field(scene) && has_balances(scene);
}

bool energy_watch_start(energy_watch *w, const problem *scene, dvi_integrator *integrator,
                        double bound)
{
  const size_t nq = (size_t)scene->nq, nv = (size_t)scene->nv;
  *w = (energy_watch){.scene = scene,
                      .integrator = integrator,
                      .bound = bound,
                      .passed = (double)NAN,
                      .blind = true};
  /* what noise exchanges with the bath is no measure of the errors of steps, which add up at
   * random, and a field that leaves or is damped has soon no energy to measure them by */
  if (!dvi_system_autonomous(scene->system) || has_affine_rows(scene->terms) ||
      scene->terms->noise != NULL || is_damped_field(scene))
    return true;
  w->room = calloc(2 * (nq + nv), sizeof *w->room);
  if (w->room == NULL) return library_error(DVI_NO_MEMORY) == DONE;
  double *start = w->room + nq + nv;
  memcpy(start, dvi_integrator_q(integrator), nq * sizeof *start);
  memcpy(start + nq, dvi_integrator_p(integrator), nv * sizeof *start);
  w->start = start;
  w->t = w->t_start = dvi_integrator_time(integrator);
  w->blind = dvi_integrator_invariant(integrator, 0, &w->first) != DVI_OK;
  w->first = balanced_value(integrator, 0, w->first); /* a checkpoint may hold supplies */
  return true;
}

void energy_watch_clear(energy_watch *w)
{
  free(w->room);
  w->room = NULL;
}

void energy_watch_step(energy_watch *w)
{
  w->steps++;
  if (!w->blind && energy_look_due(w->steps)) energy_watch_look(w);
}

energy_verdict energy_watch_end(energy_watch *w)
{
  energy_verdict verdict = {.ratio = (double)NAN, .passed = (double)NAN};
  if (!w->blind && dvi_integrator_time(w->integrator) != w->t) energy_watch_look(w);
  const double scale = mean_scale(w);
  for (int k = 0; k < w->looks; k++) {
    const energy_look *seen = &w->look[k];
    const double ratio = look_ratio(seen, scale);
    if (ratio <= verdict.ratio) continue;
    verdict.ratio = ratio;
    verdict.t = seen->t;
  }
  if (verdict.ratio > w->bound && !is_at_rest(w))
    verdict.passed = isnan(w->passed) ? verdict.t : w->passed;
  return verdict;
}
