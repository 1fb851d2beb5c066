/* Translations and rotations that leave a scene as it is, proved on its expressions.
 *
 * L stays as it is if its slope along the motion of coordinates and velocities is zero. Expressions
 * are evaluated with exact numbers for that, modulo a prime, at random coordinates and velocities
 * that have their slopes beside them: a rational function that is not zero is zero there by a
 * chance of less than 1e-8 a trial (Schwartz 1980). Roots and transcendental functions get values
 * and derivatives at random, equal ones for equal arguments, so that a proof holds for any function
 * in their place: sqrt(x^2 + y^2) turns into itself since its argument does. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "expr/graph_make.h"
#include "text/heap.h"
#include "scene/elaborate/model.h"

/* Nodes of a trial over all elements; and in all trials, which take a second. */
enum { TRIALS = 3, WORK_MAX = 2000000, ALL_WORK_MAX = 40000000, GROUP_MAX = 8 };

/* ---- numbers modulo a prime, with slopes ---- */

static const uint64_t prime = 4294967291U; /* 2^32 - 5 */

typedef struct dual {
  uint64_t value, slope;
} dual;

static uint64_t times(uint64_t a, uint64_t b)
{
  return a * b % prime;
}

static uint64_t to_power(uint64_t a, uint64_t exponent)
{
  uint64_t result = 1;
  for (; exponent > 0; exponent >>= 1, a = times(a, a))
    if (exponent & 1U) result = times(result, a);
  return result;
}

/* A whole number of either sign; as an exponent it counts modulo prime - 1. */
static uint64_t whole(int64_t k, uint64_t modulus)
{
  const uint64_t rest = (uint64_t)(k < 0 ? -k : k) % modulus;
  return k < 0 && rest > 0 ? modulus - rest : rest;
}

/* A number of double precision is a whole number times a power of two. */
static uint64_t residue(double x)
{
  int exponent;
  if (!isfinite(x)) return 1;
  const int64_t mantissa = (int64_t)ldexp(frexp(x, &exponent), 53);
  return times(whole(mantissa, prime), to_power(2, whole(exponent - 53, prime - 1)));
}

static dual negative(dual a)
{
  return (dual){(prime - a.value) % prime, (prime - a.slope) % prime};
}

static dual sum(dual a, dual b)
{
  return (dual){(a.value + b.value) % prime, (a.slope + b.slope) % prime};
}

static dual product(dual a, dual b)
{
  return (dual){times(a.value, b.value),
                (times(a.value, b.slope) + times(a.slope, b.value)) % prime};
}

static dual power(dual a, int64_t exponent)
{
  const uint64_t below = to_power(a.value, whole(exponent - 1, prime - 1));
  return (dual){times(below, a.value), times(times(whole(exponent, prime), below), a.slope)};
}

/* Bits that look random and are always the same (Steele, Lea and Flood 2014). */
static uint64_t scramble(uint64_t x)
{
  x += UINT64_C(0x9e3779b97f4a7c15);
  x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
  return x ^ (x >> 31);
}

/* Any function of a and b. */
static dual unknown(const dvi__graph_node *node, dual a, dual b)
{
  const uint64_t key = scramble(scramble(scramble((uint64_t)node->op) + residue(node->value)) +
                                (a.value << 32 | b.value)),
                 by_a = scramble(key + 1) % prime, by_b = scramble(key + 2) % prime;
  return (dual){key % prime, (times(by_a, a.slope) + times(by_b, b.slope)) % prime};
}

/* ---- expressions ---- */

/* A motion: to[i] is 0 if number i stays, n + 1 if it moves on, else the number + 1, with its sign,
 * at which it turns; and the trial. */
typedef struct motion {
  int n;
  const int *to;
  uint64_t trial;
} motion;

static uint64_t at_random(const motion *m, int block, int number)
{
  return scramble(scramble(m->trial * DVI__BLOCKS + (uint64_t)block) + (uint64_t)number) % prime;
}

/* A variable of a block: coordinates move and turn, velocities turn, and what does neither
 * stays. */
static dual variable(const motion *m, unsigned turning, int block, int number)
{
  dual x = {at_random(m, block, number), 0};
  const int to = (turning >> block & 1U) ? m->to[number] : 0;
  if (to > m->n)
    x.slope = block == DVI__COORDINATES;
  else if (to > 0)
    x.slope = at_random(m, block, to - 1);
  else if (to < 0)
    x.slope = prime - at_random(m, block, -to - 1);
  return x;
}

static dual input_of(const motion *m, unsigned turning, const dvi__kernel_input *input, int e)
{
  if (input->is_data) return (dual){residue(input->data[e]), 0};
  return variable(m, turning, input->block, dvi__input_number(input, e));
}

static dual operate(const dvi__graph_node *node, const dual *at)
{
  const int operands = dvi__operands(node->op);
  const dual none = {0, 0}, a = operands > 0 ? at[node->a] : none,
             b = operands > 1 ? at[node->b] : none;
  switch (node->op) {
  case DVI__OP_CONSTANT: return (dual){residue(node->value), 0};
  case DVI__OP_NEGATE: return negative(a);
  case DVI__OP_SQUARE: return product(a, a);
  case DVI__OP_ADD: return sum(a, b);
  case DVI__OP_SUBTRACT: return sum(a, negative(b));
  case DVI__OP_MULTIPLY: return product(a, b);
  case DVI__OP_DIVIDE: return product(a, power(b, -1));
  case DVI__OP_WHERE: return product(unknown(node, a, none), b);
  case DVI__OP_RAISE:
  case DVI__OP_ATAN2:
  case DVI__OP_HYPOT: return unknown(node, a, b);
  case DVI__OP_POWER:
    if (floor(node->value) < node->value) return unknown(node, a, none);
    return power(a, (int64_t)node->value);
  default: return unknown(node, a, none);
  }
}

/* The slope of a kernel, all elements together. */
static uint64_t slope_of(const motion *m, unsigned turning, const dvi__kernel *kernel, dual *at)
{
  uint64_t slope = 0;
  for (int e = 0; e < kernel->elements; e++) {
    for (int k = 0; k <= kernel->root; k++) {
      const dvi__graph_node *node = &kernel->graph->node[k];
      at[k] = node->op == DVI__OP_INPUT ? input_of(m, turning, &kernel->input[node->a], e)
                                        : operate(node, at);
    }
    slope = (slope + at[kernel->root].slope) % prime;
  }
  return slope;
}

/* ---- a scene ---- */

/* Whether a function is a part of L, or a constraint. */
static int counts(const dvi_scene *scene, const dvi__scene_term *term)
{
  return term->role == DVI__MOVES || term == scene->kinetic;
}

/* The most nodes of a kernel; and the work of a trial. */
static int largest(const dvi_scene *scene, double *work)
{
  int most = 0;
  *work = 0;
  for (const dvi__scene_term *term = scene->functions; term != NULL; term = term->next)
    for (int k = 0; counts(scene, term) && k < dvi__function_kernel_count(term->function); k++) {
      const dvi__kernel *kernel = dvi__function_kernel(term->function, k);
      most = kernel->root + 1 > most ? kernel->root + 1 : most;
      *work += (double)kernel->elements * (kernel->root + 1);
    }
  return most;
}

/* The multipliers of a one-form stand for velocities. Sums of several kernels may be kept though
 * none of them is. */
static uint64_t slope_of_scene(const dvi_scene *scene, const motion *m, dual *at)
{
  uint64_t slope = 0;
  for (const dvi__scene_term *term = scene->functions; term != NULL; term = term->next) {
    const unsigned turning = 1U << DVI__COORDINATES |
                             1U << (term == scene->one_form.user ? DVI__MULTIPLIERS
                                                                 : DVI__VELOCITIES);
    const int sign = term == scene->kinetic || term == scene->one_form.user ||
                     term == scene->lagrangian.user;
    for (int k = 0; counts(scene, term) && k < dvi__function_kernel_count(term->function); k++) {
      const uint64_t one = slope_of(m, turning, dvi__function_kernel(term->function, k), at);
      slope = (slope + (sign ? one : prime - one)) % prime;
    }
  }
  return slope;
}

typedef struct search {
  const dvi_scene *scene;
  int *to; /* [n] */
  dual *at;
  char *text;
  size_t size, used;
  int found;
  double work, spent; /* of a trial; so far */
} search;

static bool is_kept(search *s)
{
  for (uint64_t trial = 0; trial < TRIALS; trial++) {
    s->spent += s->work;
    if (s->spent > ALL_WORK_MAX ||
        slope_of_scene(s->scene, &(motion){s->scene->n, s->to, trial}, s->at) != 0)
      return false;
  }
  return true;
}

static void say(search *s, const char *text)
{
  if (s->used < s->size) {
    const int length = snprintf(s->text + s->used, s->size - s->used, "%s", text);
    s->used += length > 0 ? (size_t)length : 0;
  }
}

/* "translation of q and r along x" */
static void say_found(search *s, const char *what, int count, const dvi__coordinate *const *group,
                      const char *way, int axis)
{
  const char end[] = {' ', "xyz"[axis], '\0'};
  say(s, s->found++ > 0 ? ", " : "");
  say(s, what);
  for (int k = 0; k < count; k++) {
    say(s, k == 0 ? " of " : k + 1 < count ? ", " : " and ");
    say(s, group[k]->name);
  }
  say(s, way);
  say(s, way[0] != '\0' ? end : "");
}

/* Component `from` of all members turns towards `to`; from = to: moves on. */
static void move(search *s, const dvi__coordinate *x, int from, int to)
{
  for (int i = 0; i < x->size; i++) {
    const int first = x->q.first + i * x->q.stride;
    s->to[first + from] = from == to ? s->scene->n + 1 : first + to + 1;
    if (from != to) s->to[first + to] = -(first + from + 1);
  }
}

static bool try_group(search *s, const char *what, int count, const dvi__coordinate *const *group,
                      int from, int to)
{
  memset(s->to, 0, (size_t)s->scene->n * sizeof *s->to);
  for (int k = 0; k < count; k++) move(s, group[k], from, to);
  if (!is_kept(s)) return false;
  const int rows = group[0]->shape.rows;
  if (from == to)
    say_found(s, what, count, group, rows > 1 ? " along" : "", from);
  else
    say_found(s, what, count, group, rows > 2 ? " about" : "", 3 - from - to);
  return true;
}

/* All that coordinates of one shape can do together. */
static bool try_shape(search *s, int count, const dvi__coordinate *const *group)
{
  const int rows = group[0]->shape.rows, before = s->found;
  for (int k = 0; k < rows && rows <= 3; k++) (void)try_group(s, "translation", count, group, k, k);
  if (rows == 2) (void)try_group(s, "rotation", count, group, 0, 1);
  for (int k = 0; k < 3 && rows == 3; k++)
    (void)try_group(s, "rotation", count, group, (k + 1) % 3, (k + 2) % 3);
  return s->found > before;
}

/* Two numbers that are coordinates by themselves may be those of a plane. */
static void try_planes(search *s, int count, const dvi__coordinate *const *group)
{
  for (int i = 0; i < count && count <= 3; i++)
    for (int j = i + 1; j < count; j++) {
      const dvi__coordinate *const pair[] = {group[i], group[j]};
      memset(s->to, 0, (size_t)s->scene->n * sizeof *s->to);
      s->to[pair[0]->q.first] = pair[1]->q.first + 1;
      s->to[pair[1]->q.first] = -(pair[0]->q.first + 1);
      if (is_kept(s)) say_found(s, "rotation", 2, pair, "", 0);
    }
}

/* Each coordinate alone, then all of the same shape together. */
static void try_all(search *s)
{
  const dvi_scene *scene = s->scene;
  for (int i = 0; i < scene->coordinate_count; i++) {
    const dvi__coordinate *group[GROUP_MAX], *x = &scene->coordinate[i];
    int count = 0, first = 1, single = x->shape.rank == 0 && !x->family;
    const bool alone = try_shape(s, 1, (const dvi__coordinate *const[]){x});
    for (int k = 0; k < scene->coordinate_count && count < GROUP_MAX; k++) {
      const dvi__coordinate *other = &scene->coordinate[k];
      if (other->shape.rank != x->shape.rank || other->shape.rows != x->shape.rows) continue;
      first = first && k >= i;
      single = single && !other->family;
      group[count++] = other;
    }
    if (first && count > 1 && !alone) (void)try_shape(s, count, group);
    if (first && single) try_planes(s, count, group);
  }
}

int dvi_scene_invariance(const dvi_scene *scene, char *text, size_t size)
{
  if (size > 0 && text != NULL) text[0] = '\0';
  if (scene == NULL || text == NULL || scene->terms.factors != NULL) return -1;
  search s = {.scene = scene, .text = text, .size = size};
  const int nodes = largest(scene, &s.work);
  s.to = dvi__heap_take((size_t)scene->n, sizeof *s.to);
  s.at = dvi__heap_take((size_t)nodes + 1, sizeof *s.at);
  const bool good = s.work <= WORK_MAX && s.to != NULL && s.at != NULL;
  if (good) try_all(&s);
  dvi__heap_free(s.to);
  dvi__heap_free(s.at);
  return good ? s.found : -1;
}
