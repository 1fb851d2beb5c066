#include "step/lie/lie_drift_members.h"

#include "group/moser_veselov_core.h"
#include "num/simd/lanes.h"
#include "step/lie/lie_drift_struct.h"
#include "step/lie/slot.h"

/* Mark a loop of which no step writes what another one reads. clang warns of one that it does not
 * make vectors of, as it does where it optimises little. */
#if defined(__clang__)
#pragma clang diagnostic ignored "-Wpass-failed"
#define INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define INDEPENDENT _Pragma("GCC ivdep")
#else
#define INDEPENDENT
#endif

typedef dvi__slot_lanes lanes;

/* Copy the numbers of one member from its rows, and back. */
FUSED_INLINE void get(size_t count, const double *rows, int numbers, double *x)
{
  for (int i = 0; i < numbers; i++) x[i] = rows[(size_t)i * count];
}

FUSED_INLINE void put(size_t count, double *rows, int numbers, const double *x)
{
  for (int i = 0; i < numbers; i++) rows[(size_t)i * count] = x[i];
}

/* ---- kicks ---- */

FUSED_INLINE void kick_lines(const lanes *s)
{
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
      dvi__add_compensated(s->p + k, s->p_low + k, -s->h * s->V[k]);
}

FUSED_INLINE void kick_circles(const lanes *s)
{
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double y[2], V[2];
    get(s->count, s->y + k, 2, y);
    get(s->count, s->V + k, 2, V);
    dvi__slot_kick_circle(s->h, V, y, s->p + k, s->p_low + k);
  }
}

/* Kick directions of 3 numbers, or bodies of 9. */
FUSED_INLINE void kick_vectors(const lanes *s, const int numbers)
{
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double y[9], V[9], p[3], p_low[3];
    get(s->count, s->y + k, numbers, y);
    get(s->count, s->V + k, numbers, V);
    get(s->count, s->p + k, 3, p);
    get(s->count, s->p_low + k, 3, p_low);
    if (numbers == 9)
      dvi__slot_kick_body(s->h, V, y, p, p_low);
    else
      dvi__slot_kick_direction(s->h, V, y, p, p_low);
    put(s->count, s->p + k, 3, p);
    put(s->count, s->p_low + k, 3, p_low);
  }
}

FUSED_INLINE void kick(const lanes *s, dvi__chart_kind kind)
{
  switch (kind) {
  case DVI__CIRCLE: kick_circles(s); break;
  case DVI__SPHERE: kick_vectors(s, 3); break;
  case DVI__ROTATION: kick_vectors(s, 9); break;
  default: kick_lines(s);
  }
}

/* ---- drifts ---- */

FUSED_INLINE void drift_lines(const lanes *s)
{
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    s->moved[k] = s->h * (s->p[k] / s->block->mass);
    dvi__add_compensated(s->y + k, s->y_low + k, s->moved[k]);
  }
}

/* The C library finds angles of their sines one by one. */
FUSED_INLINE void drift_circles(const lanes *s)
{
  const double h = s->h, mass = s->block->mass;
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double y[3] = {0}, y_low[3] = {0};
    const double sine = h * (s->p[k] / mass);
    get(s->count, s->y + k, 2, y);
    get(s->count, s->y_low + k, 2, y_low);
    dvi__slot_turn_circle(sine, y, y_low);
    put(s->count, s->y + k, 2, y);
    put(s->count, s->y_low + k, 2, y_low);
    s->work[k] = sine;
  }
  for (size_t k = 0; k < s->count; k++) {
    if (!(fabs(s->work[k]) < 1)) s->left[k] = 1;
    s->moved[k] = asin(s->work[k]);
  }
}

FUSED_INLINE void drift_directions(const lanes *s)
{
  const double h = s->h, mass = s->block->mass;
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double y[3], y_low[3], p[3], p_low[3], moved[3];
    get(s->count, s->y + k, 3, y);
    get(s->count, s->y_low + k, 3, y_low);
    get(s->count, s->p + k, 3, p);
    get(s->count, s->p_low + k, 3, p_low);
    s->work[k] = dvi__slot_turn_direction(h, mass, y, y_low, p, p_low, moved);
    put(s->count, s->y + k, 3, y);
    put(s->count, s->y_low + k, 3, y_low);
    put(s->count, s->p + k, 3, p);
    put(s->count, s->p_low + k, 3, p_low);
    put(s->count, s->moved + k, 3, moved);
  }
  for (size_t k = 0; k < s->count; k++) {
    const double stretch = dvi__slot_stretch(s->work[k]);
    if (!(s->work[k] < 1)) s->left[k] = 1;
    for (size_t i = 0; i < 3; i++) s->moved[i * s->count + k] *= stretch;
  }
}

/* ---- bodies ---- */

/* The work of bodies: impulses in the principal axes, iterates, the iterates before, and 1 for
 * members that iterate. */
enum { IMPULSE = 0, ITERATE = 3, BEFORE = 6, GOES = 9 };

FUSED_INLINE double *work_rows(const lanes *s, int row)
{
  return s->work + (size_t)row * s->count;
}

FUSED_INLINE void begin_bodies(const lanes *s, const int rigid)
{
  const dvi__mass_block block = *s->block;
  const dvi__body body = *block.body;
  double *impulses = work_rows(s, IMPULSE), *f = work_rows(s, ITERATE),
         *before = work_rows(s, BEFORE), *goes = work_rows(s, GOES);
  const double none[3] = {0};
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double R[9], p[6], p_low[3], impulse[3], inside[3], first[3];
    get(s->count, s->y + k, 9, R);
    get(s->count, s->p + k, rigid ? 6 : 3, p);
    get(s->count, s->p_low + k, 3, p_low);
    if (rigid) dvi__slot_shift(-1, block.centre, R, p, p_low);
    for (int i = 0; i < 3; i++) impulse[i] = s->h * p[i];
    goes[k] = dvi__body_begin(&body, DVI__BY_CAYLEY, impulse, inside, first) ? 1 : 0;
    put(s->count, s->p + k, 3, p);
    put(s->count, s->p_low + k, 3, p_low);
    put(s->count, impulses + k, 3, inside);
    put(s->count, f + k, 3, first);
    put(s->count, before + k, 3, none);
  }
}

FUSED_INLINE void iterate_bodies(const lanes *s)
{
  const dvi__body body = *s->block->body;
  double *impulses = work_rows(s, IMPULSE), *f = work_rows(s, ITERATE),
         *before = work_rows(s, BEFORE), *goes = work_rows(s, GOES);
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double impulse[3], here[3], next[3], last[3];
    get(s->count, impulses + k, 3, impulse);
    get(s->count, f + k, 3, here);
    get(s->count, f + k, 3, next);
    get(s->count, before + k, 3, last);
    const int solved = dvi__body_iterate(&body, DVI__BY_CAYLEY, impulse, next, last);
    const double go = goes[k];
    for (int i = 0; i < 3; i++) here[i] = go > 0 ? next[i] : here[i];
    put(s->count, f + k, 3, here);
    put(s->count, before + k, 3, last);
    goes[k] = solved ? 0 : go;
  }
}

FUSED_INLINE void solve_bodies(const lanes *s)
{
  const double *goes = work_rows(s, GOES);
  for (size_t k = 0; k < s->count; k++)
    if (!(goes[k] > 0)) s->left[k] = 1;
  for (int iteration = 0, going = 1; iteration < DVI__BODY_ITERATIONS && going; iteration++) {
    iterate_bodies(s);
    going = 0;
    for (size_t k = 0; k < s->count; k++) going |= goes[k] > 0;
  }
  for (size_t k = 0; k < s->count; k++)
    if (goes[k] > 0) s->left[k] = 1;
}

FUSED_INLINE void place_bodies(const lanes *s)
{
  const dvi__mass_block block = *s->block;
  double *const x = s->y + 9 * s->count, *const x_low = s->y_low + 9 * s->count;
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double R[9], p_x[3], w[3], dx[3], place[3], low[3];
    get(s->count, s->y + k, 9, R);
    get(s->count, s->p + 3 * s->count + k, 3, p_x);
    get(s->count, s->moved + k, 3, w);
    get(s->count, x + k, 3, place);
    get(s->count, x_low + k, 3, low);
    dvi__slot_place(block.mass, block.centre, s->h, R, p_x, w, dx);
    dvi__add_compensated_all(3, place, low, dx);
    put(s->count, x + k, 3, place);
    put(s->count, x_low + k, 3, low);
    put(s->count, s->moved + 3 * s->count + k, 3, dx);
  }
}

/* Turn by rows, which leaves room for a row in registers. */
FUSED_INLINE void turn_bodies(const lanes *s)
{
  const size_t count = s->count;
  const dvi__body body = *s->block->body;
  const double *f = work_rows(s, ITERATE);
  INDEPENDENT for (size_t k = 0; k < count; k++)
  {
    double here[3], w[3];
    get(count, f + k, 3, here);
    dvi__body_turn(&body, &body.out, here, w);
    put(count, s->moved + k, 3, w);
  }
}

FUSED_INLINE void turn_rows(const lanes *s, double *x, double *x_low)
{
  const size_t count = s->count;
  INDEPENDENT for (size_t k = 0; k < count; k++)
  {
    double w[3], row[3], low[3];
    get(count, s->moved + k, 3, w);
    const dvi__turn turn = dvi__turn_made(w);
    get(count, x + k, 3, row);
    get(count, x_low + k, 3, low);
    dvi__turn_row(&turn, row, low);
    put(count, x + k, 3, row);
    put(count, x_low + k, 3, low);
  }
}

FUSED_INLINE void shift_back(const lanes *s)
{
  const dvi__mass_block block = *s->block;
  INDEPENDENT for (size_t k = 0; k < s->count; k++)
  {
    double R[9], p[6], p_low[3];
    get(s->count, s->y + k, 9, R);
    get(s->count, s->p + k, 6, p);
    get(s->count, s->p_low + k, 3, p_low);
    dvi__slot_shift(1, block.centre, R, p, p_low);
    put(s->count, s->p + k, 3, p);
    put(s->count, s->p_low + k, 3, p_low);
  }
}

FUSED_INLINE void drift_bodies(const lanes *s)
{
  const int rigid = s->block->rigid;
  if (rigid)
    begin_bodies(s, 1);
  else
    begin_bodies(s, 0);
  solve_bodies(s);
  turn_bodies(s);
  if (rigid) place_bodies(s);
  for (size_t i = 0; i < 9; i += 3) turn_rows(s, s->y + i * s->count, s->y_low + i * s->count);
  turn_rows(s, s->p, s->p_low);
  if (rigid) shift_back(s);
}

FUSED_INLINE void drift(const lanes *s, dvi__chart_kind kind)
{
  switch (kind) {
  case DVI__CIRCLE: drift_circles(s); break;
  case DVI__SPHERE: drift_directions(s); break;
  case DVI__ROTATION: drift_bodies(s); break;
  default: drift_lines(s);
  }
}

/* ---- instruction sets ---- */

#define LEVEL(suffix, target)                                             \
  target static void kick_##suffix(const lanes *s, dvi__chart_kind kind)  \
  {                                                                       \
    kick(s, kind);                                                        \
  }                                                                       \
  target static void drift_##suffix(const lanes *s, dvi__chart_kind kind) \
  {                                                                       \
    drift(s, kind);                                                       \
  }

LEVEL(baseline, )
#ifdef __x86_64__
LEVEL(avx2, __attribute__((target("avx2,fma"))))
LEVEL(avx512, __attribute__((target("fma,avx512f,avx512dq,avx512vl"))))
#endif

/* Levels in the order of num/simd/lanes.c. */
static void (*const kicks[])(const lanes *s, dvi__chart_kind kind) = {
    kick_baseline,
#ifdef __x86_64__
    kick_avx2,
    kick_avx512,
#endif
};

static void (*const drifts[])(const lanes *s, dvi__chart_kind kind) = {
    drift_baseline,
#ifdef __x86_64__
    drift_avx2,
    drift_avx512,
#endif
};

void dvi__slot_lanes_drift(const dvi__slot_lanes *s)
{
  drifts[dvi__lanes_level()](s, s->block->slot->kind);
}

/* ---- all slots ---- */

int dvi__lie_drift_has_members(const dvi__lie_drift *l)
{
  return l->blocks.coupled == 0 && (l->blocks.bodies == 0 || l->by == DVI__BY_CAYLEY);
}

/* Give the rows of a slot. */
static lanes lanes_of(const dvi__factor_slot *slot, int count, double h, const dvi__phase *members)
{
  const size_t q = (size_t)slot->q * (size_t)count, v = (size_t)slot->v * (size_t)count;
  return (lanes){.count = (size_t)count,
                 .h = h,
                 .y = members->q + q,
                 .y_low = members->q_compensation + q,
                 .p = members->p + v,
                 .p_low = members->p_compensation + v};
}

void dvi__lie_drift_kick_members(const dvi__lie_drift *l, int count, double h, const double *V_q,
                                 const dvi__phase *members)
{
  for (int c = 0; c < l->blocks.system->slot_count; c++) {
    const dvi__factor_slot *slot = &l->blocks.system->slots[c];
    lanes rows = lanes_of(slot, count, h, members);
    rows.V = V_q + (size_t)slot->q * rows.count;
    kicks[dvi__lanes_level()](&rows, slot->kind);
  }
}

void dvi__lie_drift_push_members(const dvi__lie_drift *l, int count, double h, const double *F,
                                 const dvi__phase *members)
{
  for (int c = 0; c < l->blocks.system->slot_count; c++) {
    const dvi__factor_slot *slot = &l->blocks.system->slots[c];
    lanes rows = lanes_of(slot, count, -h, members);
    rows.V = F + (size_t)slot->v * rows.count;
    if (slot->kind == DVI__SPHERE)
      kicks[dvi__lanes_level()](&rows, slot->kind);
    else
      dvi__lanes_add_scaled((size_t)dvi__chart_velocities(slot->kind) * rows.count, h, rows.V,
                            rows.p, rows.p_low);
  }
}

void dvi__lie_drift_drift_members(const dvi__lie_drift *l, int count, double h,
                                  const dvi__phase *members, double *displacement, double *work,
                                  char *left)
{
  for (int i = 0; i < l->blocks.alone; i++) {
    const dvi__mass_block *block = &l->blocks.block[i];
    lanes rows = lanes_of(block->slot, count, h, members);
    rows.block = block;
    rows.moved = displacement + (size_t)block->slot->v * rows.count;
    rows.work = work;
    rows.left = left;
    dvi__slot_lanes_drift(&rows);
  }
}
