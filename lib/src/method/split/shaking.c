#include "method/split/shaking.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "method/split/bath.h"
#include "num/normal.h"

/* A noise function, and the rate DeltaW/h of the present step. */
typedef struct shaken {
  const dvi_potential *function;
  const dvi__pattern *qq; /* of its Hessian */
  int n;
  double rate;
} shaken;

struct dvi__shaking {
  const dvi_system *system;
  shaken *each;
  dvi_force *force;
};

/* ---- forces ---- */

static int scaled(int returned, size_t count, double factor, double *x)
{
  for (size_t i = 0; i < count && returned == 0; i++) x[i] *= factor;
  return returned;
}

static int value(double t, const double *q, const double *v, double *F, void *user)
{
  const shaken *own = user;
  const dvi_potential *h = own->function;
  (void)v;
  return scaled(h->gradient(t, q, F, h->user), (size_t)own->n, -own->rate, F);
}

static int value_batch(int count, const double *t, const double *q, const double *v, double *F,
                       void *user)
{
  const shaken *own = user;
  const dvi_potential *h = own->function;
  (void)v;
  return scaled(h->gradient_batch(count, t, q, F, h->user), (size_t)own->n * (size_t)count,
                -own->rate, F);
}

static int jacobian(double t, const double *q, const double *v, double *F_q, double *F_v,
                    void *user)
{
  const shaken *own = user;
  const dvi_potential *h = own->function;
  (void)v, (void)F_v;
  return scaled(h->hessian(t, q, F_q, h->user), (size_t)dvi__pattern_entries(own->qq), -own->rate,
                F_q);
}

static int jacobian_batch(int count, const double *t, const double *q, const double *v, double *F_q,
                          double *F_v, void *user)
{
  const shaken *own = user;
  const dvi_potential *h = own->function;
  (void)v, (void)F_v;
  return scaled(h->hessian_batch(count, t, q, F_q, h->user),
                (size_t)dvi__pattern_entries(own->qq) * (size_t)count, -own->rate, F_q);
}

static dvi_force force_of(shaken *own, const dvi__potential_term *term)
{
  const dvi_potential *h = own->function;
  return (dvi_force){.name = term->name,
                     .value = h->gradient != NULL ? value : NULL,
                     .value_batch = h->gradient_batch != NULL ? value_batch : NULL,
                     .jacobian = h->hessian != NULL ? jacobian : NULL,
                     .jacobian_batch = h->hessian_batch != NULL ? jacobian_batch : NULL,
                     .by_q = {term->qq.start, term->qq.row},
                     .without_velocity = 1,
                     .user = own};
}

/* ---- create, destroy ---- */

dvi_status dvi__shaking_create(const dvi_system *system, dvi__shaking **shaking)
{
  const int count = system->noise.function_count;
  dvi__shaking *made = *shaking = DVI_NEW(dvi__shaking, 1);
  if (made == NULL) return dvi__fail(DVI_NO_MEMORY, "noise: no memory");
  made->system = system;
  made->each = DVI_NEW(shaken, count);
  made->force = DVI_NEW(dvi_force, count);
  dvi_status status = made->each != NULL && made->force != NULL
                          ? dvi__system_prepare_hessian(system)
                          : dvi__fail(DVI_NO_MEMORY, "noise: no memory");
  for (int k = 0; k < count && status == DVI_OK; k++) {
    const dvi__potential_term *term = &system->noise_functions[k];
    made->each[k] = (shaken){.function = &term->callbacks, .qq = &term->qq, .n = system->n};
    made->force[k] = force_of(&made->each[k], term);
  }
  if (status != DVI_OK) dvi__shaking_destroy(shaking);
  return status;
}

void dvi__shaking_destroy(dvi__shaking **shaking)
{
  dvi__shaking *s = *shaking;
  if (s == NULL) return;
  dvi__release(s->each);
  dvi__release(s->force);
  dvi__release(s);
  *shaking = NULL;
}

const dvi_force *dvi__shaking_forces(const dvi__shaking *shaking)
{
  return shaking->force;
}

/* ---- increments ---- */

/* The numbers of a draw stand behind those of the n coordinates. Two functions share a counter. */
void dvi__shaking_draw(dvi__shaking *s, double h, int parts, const double *memory)
{
  const int count = s->system->noise.function_count, behind = (s->system->n + 1) / 2;
  const double per_draw = 1 / sqrt(h * parts);
  for (int k = 0; k < count; k++) s->each[k].rate = 0;
  for (int part = 0; part < parts; part++) {
    const double draw = memory[DVI__BATH_DRAWS] + part;
    for (int k = 0; k < count; k += 2) {
      double first, second;
      dvi__normals(1, s->system->noise.seed, (uint32_t)(behind + k / 2), &draw,
                   memory + DVI__BATH_STREAM, &first, &second);
      s->each[k].rate += per_draw * first;
      if (k + 1 < count) s->each[k + 1].rate += per_draw * second;
    }
  }
}
