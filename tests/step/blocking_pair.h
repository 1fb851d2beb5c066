/* A lattice with two integrators of it, one with temporal blocking and one without, whose bits must
 * be the same. */
#ifndef TESTS_STEP_BLOCKING_PAIR_H
#define TESTS_STEP_BLOCKING_PAIR_H
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "integrator/integrator_struct.h"
#include "num/simd/lanes.h"
#include "step/split/temporal_blocking.h"
#include "support/runs.h"
#include "support/suite.h"

enum { THREADS_MOST = 4 };

/* Springs between each site and its next `reach` ones, and a well for each site that a drive moves.
 * What the springs' callback shall do wrong at one site, from some time on, is a number to return
 * or a number to give. */
typedef struct lattice {
  int n, reach;
  int bad_site; /* -1: none */
  double bad_time, bad_number;
  int bad_return;
  atomic_long entries, ranges; /* that the springs were asked for */
  atomic_long blind;           /* coordinates among them that were not finite */
} lattice;

static inline double spring(int distance, double d)
{
  return (d + 0.3 * d * d * d) / distance;
}

static inline double springs_entry(const lattice *own, const double *q, int i)
{
  double sum = 0;
  for (int k = 1; k <= own->reach; k++) {
    if (i - k >= 0) sum += spring(k, q[i] - q[i - k]);
    if (i + k < own->n) sum -= spring(k, q[i + k] - q[i]);
  }
  return sum;
}

static inline int springs_range(double t, const double *q, int first, int last, double *V_q,
                                void *user)
{
  lattice *own = user;
  const int bad = own->bad_site >= first && own->bad_site < last && t >= own->bad_time;
  if (first < 0 || first >= last || last > own->n) return -7;
  atomic_fetch_add(&own->entries, last - first);
  atomic_fetch_add(&own->ranges, 1);
  for (int i = first; i < last; i++) V_q[i - first] = springs_entry(own, q, i);
  for (int i = first; i < last; i++)
    if (!isfinite(q[i])) atomic_fetch_add(&own->blind, 1);
  if (bad && own->bad_return == 0) V_q[own->bad_site - first] = own->bad_number;
  return bad ? own->bad_return : 0;
}

static inline int springs_value(double t, const double *q, double *V, void *user)
{
  const lattice *own = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < own->n; i++)
    for (int k = 1; k <= own->reach && i + k < own->n; k++) {
      const double d = q[i + k] - q[i];
      *V += (d * d / 2 + 0.3 * d * d * d * d / 4) / k;
    }
  return 0;
}

static inline int wells_range(double t, const double *q, int first, int last, double *V_q,
                              void *user)
{
  (void)user;
  for (int i = first; i < last; i++) V_q[i - first] = (1 + i % 3) * q[i] * q[i] * q[i] + t;
  return 0;
}

static inline int wells_value(double t, const double *q, double *V, void *user)
{
  const lattice *own = user;
  *V = 0;
  for (int i = 0; i < own->n; i++) *V += (1 + i % 3) * pow(q[i], 4) / 4 + t * q[i];
  return 0;
}

/* A lattice with its system and two integrators of it that start alike. */
typedef struct pair {
  lattice lattice;
  dvi_system *system;
  dvi_integrator *wave, *plain;
} pair;

static inline double place_of_site(int i)
{
  return 0.4 * sin(1.0 + 7 * i);
}

static inline dvi_mass mass_of(int kind, int n, double *diagonal)
{
  const double scalar[] = {1, 0.25, 3, -7};
  for (int i = 0; i < n; i++) diagonal[i] = 1 + i % 5;
  return kind < 4 ? (dvi_mass){.scalar = scalar[kind]} : (dvi_mass){.diagonal = diagonal};
}

static inline void start_alike(pair *p)
{
  const int n = p->lattice.n;
  double *q = calloc(2 * (size_t)n, sizeof *q), *momenta = q + n;
  ck_assert_ptr_nonnull(q);
  for (int i = 0; i < n; i++) q[i] = place_of_site(i), momenta[i] = place_of_site(i + 1000);
  ck_assert_int_eq(dvi_integrator_start(p->wave, 0.25, q, momenta), DVI_OK);
  ck_assert_int_eq(dvi_integrator_start(p->plain, 0.25, q, momenta), DVI_OK);
  free(q);
}

/* `method` has a place for the keys of verlet. */
static inline void make_pair(pair *p, int n, int reach, int potentials, int mass,
                             const char *method, int threads, int block)
{
  const dvi_potential both[] = {
      {.name = "springs",
       .value = springs_value,
       .gradient_range = springs_range,
       .reach = reach,
       .user = &p->lattice},
      {.name = "wells", .value = wells_value, .gradient_range = wells_range, .user = &p->lattice}};
  double *diagonal = calloc((size_t)n, sizeof *diagonal);
  ck_assert_ptr_nonnull(diagonal);
  p->lattice = (lattice){.n = n, .reach = reach, .bad_site = -1};
  const dvi_system_terms terms = {.dimension = n,
                                  .mass = mass_of(mass, n, diagonal),
                                  .potentials = both,
                                  .potential_count = potentials};
  ck_assert_msg(dvi_system_create(&terms, &p->system) == DVI_OK, "%s", dvi_last_error());
  free(diagonal);
  dvi__blocking_choose_block(block);
  p->wave = create_integrator(p->system,
                              method_spec("%sblocking=temporal,threads=%d", method, threads));
  p->plain = create_integrator(p->system, method_spec("%sblocking=none", method));
  dvi__blocking_choose_block(0);
  start_alike(p);
}

static inline void destroy_pair(pair *p)
{
  dvi_integrator_destroy(&p->wave);
  dvi_integrator_destroy(&p->plain);
  dvi_system_destroy(&p->system);
}

/* All that the next step depends on. */
static inline void check_same(const dvi_integrator *a, const dvi_integrator *b, const char *when)
{
  const size_t n = (size_t)a->system->n, half = 2 * n * sizeof(double),
               memory = a->stepper.memory_count * sizeof(double);
  ck_assert_msg(memcmp(a->now.q, b->now.q, half) == 0, "%s: the state, n = %zu, %s", when, n,
                a->stepper.specification);
  ck_assert_msg(memcmp(a->now.q_compensation, b->now.q_compensation, half) == 0,
                "%s: the compensations, n = %zu, %s", when, n, a->stepper.specification);
  ck_assert_msg(memcmp(a->stepper.memory, b->stepper.memory, memory) == 0,
                "%s: the memory, n = %zu, %s", when, n, a->stepper.specification);
  ck_assert_mem_eq(&a->now.t, &b->now.t, 2 * sizeof(double));
}

static inline void step_both(pair *p, double h)
{
  advance(p->wave, h, 1);
  advance(p->plain, h, 1);
}

static const char *const methods[] = {"verlet:", "composition:order=4,", "composition:order=6,",
                                      "composition:order=8,"};
static const int substeps[] = {1, 5, 9, 17};
enum { STEPPERS = 4, METHODS = 2 * STEPPERS };

/* Each method comes twice, the second time with chains that count as long, whose operations work in
 * windows. */
static inline const char *method_of(int which)
{
  dvi__blocking_choose_long_chain(which < STEPPERS ? 0 : 1);
  return methods[which % STEPPERS];
}

static inline void use_best_level(void)
{
  dvi__lanes_choose(-1);
  dvi__blocking_choose_block(0);
  dvi__blocking_choose_long_chain(0);
}

#endif
