#include "support/systems/necklace.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>

#include "support/runs.h"
#include "support/systems/systems.h"

/* Gives the stretch of spring i, before bead i. */
static double stretch_of_spring(const necklace *own, const double *q, int i)
{
  return (i < own->n ? q[i] : 0) - (i > 0 ? q[i - 1] : 0);
}

static double push_of_bead(const necklace *own, int i)
{
  return own->kind == PUSHED && i % 3 == 0 ? 5 : 0;
}

static int fast_value(double t, const double *q, double *V, void *user)
{
  const necklace *own = user;
  (void)t;
  *V = 0;
  for (int i = 0; i <= own->n; i++)
    *V += own->spring[i] * stretch_of_spring(own, q, i) * stretch_of_spring(own, q, i) / 2;
  for (int i = 0; i < own->n; i++) *V -= push_of_bead(own, i) * q[i] * q[i] / 2;
  return 0;
}

static int fast_gradient(double t, const double *q, double *V_q, void *user)
{
  const necklace *own = user;
  (void)t;
  for (int i = 0; i < own->n; i++)
    V_q[i] = own->spring[i] * stretch_of_spring(own, q, i) -
             own->spring[i + 1] * stretch_of_spring(own, q, i + 1) - push_of_bead(own, i) * q[i];
  return 0;
}

static int fast_hessian(double t, const double *q, double *V_qq, void *user)
{
  const necklace *own = user;
  (void)t, (void)q;
  for (int i = 0; i < own->n; i++) {
    if (i > 0) *V_qq++ = -own->spring[i];
    *V_qq++ = own->spring[i] + own->spring[i + 1] - push_of_bead(own, i);
    if (i + 1 < own->n) *V_qq++ = -own->spring[i + 1];
  }
  return 0;
}

static int slow_value(double t, const double *q, double *V, void *user)
{
  const necklace *own = user;
  (void)t;
  *V = 0;
  for (int i = 0; i < own->n && !own->slow_off; i++)
    *V += own->kind == FREE ? (i > 0 ? pow(q[i] - q[i - 1], 4) / 4 : 0) : 1 - cos(q[i]);
  return 0;
}

static int slow_gradient(double t, const double *q, double *V_q, void *user)
{
  const necklace *own = user;
  (void)t;
  double before = 0;
  for (int i = 0; i < own->n; i++) {
    const double d = i + 1 < own->n ? q[i + 1] - q[i] : 0, after = d * d * d;
    V_q[i] = own->slow_off ? 0 : own->kind == FREE ? before - after : sin(q[i]);
    before = after;
  }
  return 0;
}

static int generate_shift(const double *q, double *xi, void *user)
{
  const necklace *own = user;
  (void)q;
  for (int i = 0; i < own->n; i++) xi[i] = 1;
  return 0;
}

static void fill_necklace(necklace *made, int uneven)
{
  int at = 0;
  for (int i = 0; i < made->n; i++) {
    made->mass[i] = uneven ? 1 + 0.5 * sin(3.0 * i) * sin(3.0 * i) : 1;
    made->spring[i] = (made->kind == FREE && i == 0) ? 0
                      : uneven                       ? 1 - 0.6 * pow(cos(2.0 * i), 2)
                                                     : 1;
    made->q[i] = sin(0.3 * i) + 0.2 * sin(1.7 * i * i);
    made->p[i] = cos(0.2 * i) + 0.5 * cos(2.3 * i * i);
    made->first[i] = at;
    for (int j = i - 1; j <= i + 1; j++)
      if (j >= 0 && j < made->n) made->row[at++] = j;
  }
  made->first[made->n] = at;
  made->spring[made->n] = made->kind == FREE ? 0 : 1;
}

void make_necklace(int n, necklace_kind kind, int uneven, necklace *made)
{
  const size_t size = (size_t)n;
  *made = (necklace){.n = n, .kind = kind};
  made->mass = calloc(4 * size + 1, sizeof(double));
  made->first = calloc(4 * size + 1, sizeof(int));
  ck_assert(made->mass != NULL && made->first != NULL);
  made->q = made->mass + size;
  made->p = made->q + size;
  made->spring = made->p + size;
  made->row = made->first + size + 1;
  fill_necklace(made, uneven);
  const dvi_potential potentials[] = {{.name = "springs",
                                       .value = fast_value,
                                       .gradient = fast_gradient,
                                       .hessian = fast_hessian,
                                       .qq = {made->first, made->row},
                                       .user = made,
                                       .fast = 1,
                                       .quadratic = 1},
                                      {.name = "slow",
                                       .value = slow_value,
                                       .gradient = slow_gradient,
                                       .qq = {made->first, made->row},
                                       .user = made}};
  const dvi_symmetry shift = {.name = "momentum", .generator = generate_shift, .user = made};
  made->system = make_system(&(dvi_system_terms){.dimension = n,
                                                 .mass.diagonal = made->mass,
                                                 .potentials = potentials,
                                                 .potential_count = 2,
                                                 .symmetries = kind == FREE ? &shift : NULL,
                                                 .symmetry_count = kind == FREE,
                                                 .autonomous = 1});
}

void destroy_necklace(necklace *made)
{
  dvi_system_destroy(&made->system);
  free(made->mass);
  free(made->first);
}

dvi_integrator *necklace_integrator(const necklace *string, const char *method)
{
  dvi_integrator *integrator = create_integrator(string->system, method);
  ck_assert_int_eq(dvi_integrator_start(integrator, 0, string->q, string->p), DVI_OK);
  return integrator;
}
