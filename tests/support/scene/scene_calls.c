#include "support/scene/scene_calls.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>

/* The point at which callbacks are called, and the first code that is not 0. */
typedef struct caller {
  const double *q, *v, *p;
  int n, code;
} caller;

static const double t = 0;

static size_t entries(const dvi_pattern *pattern, int rows, int columns)
{
  return pattern->start != NULL ? (size_t)pattern->start[columns] : (size_t)rows * (size_t)columns;
}

static double *numbers(size_t count)
{
  double *made = calloc(count + 1, sizeof *made);
  ck_assert_ptr_nonnull(made);
  return made;
}

/* Checks the code of a callback and its numbers x [count], which are freed. */
static void check_result(caller *c, int code, size_t count, double *x)
{
  for (size_t i = 0; code == 0 && i < count; i++)
    if (!isfinite(x[i])) ck_abort_msg("a callback gives %g for a number", x[i]);
  if (code != 0 && dvi_scene_fault()[0] == '\0')
    ck_abort_msg("nothing is said of the code %d", code);
  if (c->code == 0) c->code = code;
  free(x);
}

static void call_potential(caller *c, const dvi_potential *V)
{
  const size_t n = (size_t)c->n, second = entries(&V->qq, c->n, c->n);
  double *x = numbers(1);
  check_result(c, V->value_batch(1, &t, c->q, x, V->user), 1, x);
  x = numbers(n);
  check_result(c, V->gradient_batch(1, &t, c->q, x, V->user), n, x);
  x = numbers(second);
  check_result(c, V->hessian_batch(1, &t, c->q, x, V->user), second, x);
  x = numbers(1);
  if (V->rate_batch != NULL)
    check_result(c, V->rate_batch(1, &t, c->q, x, V->user), 1, x);
  else
    free(x);
}

static void call_lagrangian(caller *c, const dvi_lagrangian *L)
{
  const size_t n = (size_t)c->n, qq = entries(&L->qq, c->n, c->n), qv = entries(&L->qv, c->n, c->n),
               vv = entries(&L->vv, c->n, c->n);
  double *x = numbers(1);
  check_result(c, L->value_batch(1, &t, c->q, c->v, x, L->user), 1, x);
  x = numbers(2 * n);
  check_result(c, L->gradient_batch(1, &t, c->q, c->v, x, x + n, L->user), 2 * n, x);
  x = numbers(qq + qv + vv);
  check_result(c, L->hessian_batch(1, &t, c->q, c->v, x, x + qq, x + qq + qv, L->user),
               qq + qv + vv, x);
  x = numbers(1);
  if (L->rate_batch != NULL)
    check_result(c, L->rate_batch(1, &t, c->q, c->v, x, L->user), 1, x);
  else
    free(x);
}

static void call_one_form(caller *c, const dvi_one_form *alpha)
{
  const size_t n = (size_t)c->n, first = entries(&alpha->gradients, c->n, c->n),
               second = entries(&alpha->qq, c->n, c->n);
  double *x = numbers(n);
  check_result(c, alpha->value(c->q, x, alpha->user), n, x);
  x = numbers(first);
  check_result(c, alpha->gradient(c->q, x, alpha->user), first, x);
  x = numbers(second);
  check_result(c, alpha->hessian(c->q, c->v, x, alpha->user), second, x);
}

static void call_hamiltonian(caller *c, const dvi_hamiltonian *H)
{
  const size_t n = (size_t)c->n, qq = entries(&H->qq, c->n, c->n), qp = entries(&H->qp, c->n, c->n),
               pp = entries(&H->pp, c->n, c->n);
  double *x = numbers(1);
  check_result(c, H->value(t, c->q, c->p, x, H->user), 1, x);
  x = numbers(2 * n);
  check_result(c, H->gradient(t, c->q, c->p, x, x + n, H->user), 2 * n, x);
  x = numbers(qq + qp + pp);
  check_result(c, H->hessian(t, c->q, c->p, x, x + qq, x + qq + qp, H->user), qq + qp + pp, x);
}

static void call_constraint(caller *c, const dvi_constraint *phi)
{
  const size_t m = (size_t)phi->count, first = entries(&phi->gradients, 2 * c->n, phi->count),
               qq = entries(&phi->qq, c->n, c->n), qp = entries(&phi->qp, c->n, c->n),
               pp = entries(&phi->pp, c->n, c->n);
  double *w = numbers(m), *x = numbers(m);
  for (size_t a = 0; a < m; a++) w[a] = 1.0 + (double)a;
  check_result(c, phi->value(c->q, c->p, x, phi->user), m, x);
  x = numbers(first);
  check_result(c, phi->gradient(c->q, c->p, x, phi->user), first, x);
  x = numbers(qq + qp + pp);
  check_result(c, phi->hessian(c->q, c->p, w, x, x + qq, x + qq + qp, phi->user), qq + qp + pp, x);
  free(w);
}

static void call_watchers(caller *c, const dvi_scene *scene, const dvi_system_terms *terms)
{
  for (int k = 0; k < terms->symmetry_count; k++) {
    double *x = numbers((size_t)c->n);
    check_result(c, terms->symmetries[k].generator(c->q, x, terms->symmetries[k].user),
                 (size_t)c->n, x);
  }
  for (int k = 0; k < terms->invariant_count; k++) {
    double *x = numbers(1);
    check_result(c, terms->invariants[k].value(t, c->q, c->p, x, terms->invariants[k].user), 1, x);
  }
  const dvi_scene_event *event = NULL;
  for (int k = 0; (event = dvi_scene_event_at(scene, k)) != NULL; k++) {
    double *x = numbers(1);
    check_result(c, event->value(t, c->q, c->v, x, event->user), 1, x);
  }
}

int call_all(const dvi_scene *scene)
{
  const dvi_system_terms *terms = dvi_scene_terms(scene);
  caller c = {.n = dvi_system_nq(dvi_scene_system(scene))};
  dvi_scene_start(scene, &c.q, &c.v, &c.p);
  for (int k = 0; k < terms->potential_count; k++) call_potential(&c, &terms->potentials[k]);
  if (terms->lagrangian != NULL) call_lagrangian(&c, terms->lagrangian);
  if (terms->one_form != NULL) call_one_form(&c, terms->one_form);
  if (terms->hamiltonian != NULL) call_hamiltonian(&c, terms->hamiltonian);
  if (terms->constraint != NULL) call_constraint(&c, terms->constraint);
  call_watchers(&c, scene, terms);
  return c.code;
}
