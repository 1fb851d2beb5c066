#include "method/split/bath.h"

#include <math.h>

#include "core/memory.h"
#include "core/status.h"
#include "num/envelope.h"
#include "num/normal.h"

struct dvi__bath {
  const dvi_system *system;
  double *root;          /* [n] roots of a diagonal mass, or 1 */
  dvi__envelope *factor; /* factor of a mass that is not diagonal, or NULL */
  double *normal;        /* [2*capacity], or [n + 1] with a factor */
};

/* ---- create, destroy ---- */

static dvi_status find_roots(dvi__bath *b)
{
  const dvi_system *s = b->system;
  for (int i = 0; i < s->n; i++) b->root[i] = 1;
  if (s->mass_diagonal == NULL) {
    const dvi_status status = dvi__envelope_create(&s->vv, s->mass_values, &b->factor);
    return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "noise needs a positive mass");
  }
  for (int i = 0; i < s->n; i++) {
    if (!(s->mass_diagonal[i] > 0))
      return dvi__fail(DVI_SINGULAR, "noise needs a positive mass; that of coordinate %d is %g", i,
                       s->mass_diagonal[i]);
    b->root[i] = sqrt(s->mass_diagonal[i]);
  }
  return DVI_OK;
}

dvi_status dvi__bath_create(const dvi_system *system, int capacity, dvi__bath **bath)
{
  dvi__bath *b = *bath = DVI_NEW(dvi__bath, 1);
  if (b == NULL) return dvi__fail(DVI_NO_MEMORY, "noise: no memory");
  b->system = system;
  b->root = DVI_NEW(double, system->n);
  b->normal = DVI_NEW(double, 2 * (size_t)capacity + (size_t)system->n);
  const dvi_status status = b->root != NULL && b->normal != NULL
                                ? find_roots(b)
                                : dvi__fail(DVI_NO_MEMORY, "noise: no memory");
  if (status != DVI_OK) dvi__bath_destroy(bath);
  return status;
}

void dvi__bath_destroy(dvi__bath **bath)
{
  dvi__bath *b = *bath;
  if (b == NULL) return;
  dvi__envelope_destroy(&b->factor);
  dvi__release(b->root);
  dvi__release(b->normal);
  dvi__release(b);
  *bath = NULL;
}

void dvi__bath_start(const dvi_system *system, uint32_t member, double *memory)
{
  memory[DVI__BATH_DRAWS] = 0;
  memory[DVI__BATH_STREAM] = (double)(uint32_t)(system->noise.stream + member);
}

/* ---- motion ---- */

/* Move one coordinate of all members. Friction shrinks the compensation, too. */
static void move_row(int count, double keep, double strength, const double *normal, double *p,
                     double *p_compensation)
{
  for (int k = 0; k < count; k++) {
    p[k] = keep * p[k] + strength * normal[k];
    p_compensation[k] *= keep;
  }
}

/* Two coordinates share a counter. */
static void move_rows(dvi__bath *b, double keep, double spread, int count, const double *memory,
                      double *p, double *p_compensation)
{
  const size_t n = (size_t)b->system->n, members = (size_t)count;
  const double *draws = memory + DVI__BATH_DRAWS * members,
               *stream = memory + DVI__BATH_STREAM * members;
  for (size_t i = 0; i < n; i += 2) {
    double *second = i + 1 < n ? b->normal + count : NULL;
    dvi__normals(count, b->system->noise.seed, (uint32_t)(i / 2), draws, stream, b->normal, second);
    move_row(count, keep, spread * b->root[i], b->normal, p + i * members,
             p_compensation + i * members);
    if (second != NULL)
      move_row(count, keep, spread * b->root[i + 1], second, p + (i + 1) * members,
               p_compensation + (i + 1) * members);
  }
}

/* A mass that is not diagonal mixes the normal numbers of one member. */
static void move_mixed(dvi__bath *b, double keep, double spread, const double *memory, double *p,
                       double *p_compensation)
{
  const int n = b->system->n;
  double *normal = b->normal;
  for (int i = 0; i < n; i += 2)
    dvi__normals(1, b->system->noise.seed, (uint32_t)(i / 2), memory + DVI__BATH_DRAWS,
                 memory + DVI__BATH_STREAM, normal + i, i + 1 < n ? normal + i + 1 : NULL);
  dvi__envelope_product(b->factor, normal);
  for (int i = 0; i < n; i++) {
    p[i] = keep * p[i] + spread * normal[i];
    p_compensation[i] *= keep;
  }
}

void dvi__bath_move(dvi__bath *b, double tau, int parts, int count, double *memory, double *p,
                    double *p_compensation)
{
  const dvi_noise *noise = &b->system->noise;
  const double x = noise->friction * tau / parts, keep = 1 + dvi__decay(-x),
               spread = sqrt(noise->temperature * -dvi__decay(-2 * x));
  for (int part = 0; part < parts; part++) {
    if (noise->friction > 0 && b->factor != NULL)
      move_mixed(b, keep, spread, memory, p, p_compensation);
    else if (noise->friction > 0)
      move_rows(b, keep, spread, count, memory, p, p_compensation);
    for (int k = 0; k < count; k++) memory[DVI__BATH_DRAWS * count + k]++;
  }
}
