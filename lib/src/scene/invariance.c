/* Translations and rotations that leave a scene as it is, proved on its expressions.
 *
 * L stays as it is if its slope along the motion of coordinates and velocities is zero. Expressions
 * are evaluated for that with exact numbers, modulo a prime, at random coordinates and velocities
 * that have their slopes beside them. A rational function that is not zero is zero there by a
 * chance of less than 1e-8 a trial (Schwartz 1980). Roots and transcendental functions get values
 * and derivatives at random, equal ones for equal arguments. A proof then holds for any function in
 * their place. So sqrt(x^2 + y^2) stays as it is since its argument does. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "expr/graph_make.h"
#include "text/heap.h"
#include "scene/elaborate/model.h"

/* Limits on the nodes of a trial over all elements, and of all trials, which take a second. */
enum { TRIALS = 3, WORK_MAX = 2000000, ALL_WORK_MAX = 40000000, GROUP_MAX = 8 };

/* ---- numbers modulo a prime, with slopes ---- */

static const uint64_t prime = 4294967291U; /* 2^32 - 5 */

typedef struct dual {
  uint64_t value, slope;
} dual;

static uint64_t residue_product(uint64_t a, uint64_t b)
{
  return a * b % prime;
}

static uint64_t residue_power(uint64_t a, uint64_t exponent)
{
  uint64_t result = 1;
  for (; exponent > 0; exponent >>= 1, a = residue_product(a, a))
    if (exponent & 1U) result = residue_product(result, a);
  return result;
}

/* Return the residue of a whole number of either sign. That of an exponent is modulo prime - 1. */
static uint64_t residue_of_whole(int64_t k, uint64_t modulus)
{
  const uint64_t rest = (uint64_t)(k < 0 ? -k : k) % modulus;
  return k < 0 && rest > 0 ? modulus - rest : rest;
}

/* Return the residue of a double, which is a whole number times a power of two. */
static uint64_t residue_of_double(double x)
{
  int exponent;
  if (!isfinite(x)) return 1;
  const int64_t mantissa = (int64_t)ldexp(frexp(x, &exponent), 53);
  return residue_product(residue_of_whole(mantissa, prime),
                         residue_power(2, residue_of_whole(exponent - 53, prime - 1)));
}

static dual dual_negative(dual a)
{
  return (dual){(prime - a.value) % prime, (prime - a.slope) % prime};
}

static dual dual_sum(dual a, dual b)
{
  return (dual){(a.value + b.value) % prime, (a.slope + b.slope) % prime};
}

static dual dual_product(dual a, dual b)
{
  return (dual){residue_product(a.value, b.value),
                (residue_product(a.value, b.slope) + residue_product(a.slope, b.value)) % prime};
}

static dual dual_power(dual a, int64_t exponent)
{
  const uint64_t below = residue_power(a.value, residue_of_whole(exponent - 1, prime - 1));
  return (dual){
      residue_product(below, a.value),
      residue_product(residue_product(residue_of_whole(exponent, prime), below), a.slope)};
}

/* Scramble bits so that they look random and are always the same (Steele, Lea and Flood 2014). */
static uint64_t scramble_bits(uint64_t x)
{
  x += UINT64_C(0x9e3779b97f4a7c15);
  x = (x ^ (x >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
  x = (x ^ (x >> 27)) * UINT64_C(0x94d049bb133111eb);
  return x ^ (x >> 31);
}

/* Apply an unknown function to a and b. Its value and derivatives look random. */
static dual dual_unknown(const dvi__graph_node *node, dual a, dual b)
{
  const uint64_t key = scramble_bits(scramble_bits(scramble_bits((uint64_t)node->op) +
                                                   residue_of_double(node->value)) +
                                     (a.value << 32 | b.value)),
                 by_a = scramble_bits(key + 1) % prime, by_b = scramble_bits(key + 2) % prime;
  return (dual){key % prime,
                (residue_product(by_a, a.slope) + residue_product(by_b, b.slope)) % prime};
}

/* ---- expressions ---- */

/* A motion and its trial. to[i] is 0 if number i stays and n + 1 if it moves on. Else it is the
 * number + 1, with its sign, towards which number i turns. */
typedef struct motion {
  int n;
  const int *to;
  uint64_t trial;
} motion;

static uint64_t at_random(const motion *m, int block, int number)
{
  return scramble_bits(scramble_bits(m->trial * DVI__BLOCKS + (uint64_t)block) + (uint64_t)number) %
         prime;
}

/* Return a variable of a block. Coordinates move and turn, velocities turn, and others stay. */
static dual dual_variable(const motion *m, unsigned turning, int block, int number)
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
  if (input->is_data) return (dual){residue_of_double(input->data[e]), 0};
  return dual_variable(m, turning, input->block, dvi__input_number(input, e));
}

static dual dual_operate(const dvi__graph_node *node, const dual *at)
{
  const int operands = dvi__operands(node->op);
  const dual none = {0, 0}, a = operands > 0 ? at[node->a] : none,
             b = operands > 1 ? at[node->b] : none;
  switch (node->op) {
  case DVI__OP_CONSTANT: return (dual){residue_of_double(node->value), 0};
  case DVI__OP_NEGATE: return dual_negative(a);
  case DVI__OP_SQUARE: return dual_product(a, a);
  case DVI__OP_ADD: return dual_sum(a, b);
  case DVI__OP_SUBTRACT: return dual_sum(a, dual_negative(b));
  case DVI__OP_MULTIPLY: return dual_product(a, b);
  case DVI__OP_DIVIDE: return dual_product(a, dual_power(b, -1));
  case DVI__OP_WHERE: return dual_product(dual_unknown(node, a, none), b);
  case DVI__OP_RAISE:
  case DVI__OP_ATAN2:
  case DVI__OP_HYPOT: return dual_unknown(node, a, b);
  case DVI__OP_POWER:
    if (floor(node->value) < node->value) return dual_unknown(node, a, none);
    return dual_power(a, (int64_t)node->value);
  default: return dual_unknown(node, a, none);
  }
}

/* Return the slope of a kernel, all elements together. */
static uint64_t slope_of(const motion *m, unsigned turning, const dvi__kernel *kernel, dual *at)
{
  uint64_t slope = 0;
  for (int e = 0; e < kernel->elements; e++) {
    for (int k = 0; k <= kernel->root; k++) {
      const dvi__graph_node *node = &kernel->graph->node[k];
      at[k] = node->op == DVI__OP_INPUT ? input_of(m, turning, &kernel->input[node->a], e)
                                        : dual_operate(node, at);
    }
    slope = (slope + at[kernel->root].slope) % prime;
  }
  return slope;
}

/* ---- a scene ---- */

/* Return 1 if a function is a part of L, or a constraint. The kinetic term has the velocities of a
 * vector potential, too. */
static int term_counts(const dvi_scene *scene, const dvi__scene_term *term)
{
  if (term == scene->vector_potential.user) return 0;
  return term->role == DVI__ROLE_MOTION || term == scene->kinetic;
}

/* Return the most nodes of a kernel, and the work of a trial. */
static int largest_kernel(const dvi_scene *scene, double *work)
{
  int most = 0;
  *work = 0;
  for (const dvi__scene_term *term = scene->functions; term != NULL; term = term->next)
    for (int k = 0; term_counts(scene, term) && k < dvi__function_kernel_count(term->function);
         k++) {
      const dvi__kernel *kernel = dvi__function_kernel(term->function, k);
      most = kernel->root + 1 > most ? kernel->root + 1 : most;
      *work += (double)kernel->elements * (kernel->root + 1);
    }
  return most;
}

/* Return the slope of all functions. The multipliers of a one-form stand for velocities. Sums of
 * several kernels may be conserved though none of them is. */
static uint64_t slope_of_scene(const dvi_scene *scene, const motion *m, dual *at)
{
  uint64_t slope = 0;
  for (const dvi__scene_term *term = scene->functions; term != NULL; term = term->next) {
    const unsigned turning = 1U << DVI__COORDINATES |
                             1U << (term == scene->one_form.user ? DVI__MULTIPLIERS
                                                                 : DVI__VELOCITIES);
    const int sign = term == scene->kinetic || term == scene->one_form.user ||
                     term == scene->lagrangian.user;
    for (int k = 0; term_counts(scene, term) && k < dvi__function_kernel_count(term->function);
         k++) {
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
  double work, spent; /* work of a trial, and of all trials so far */
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

static void report_text(search *s, const char *text)
{
  if (s->used < s->size) {
    const int length = snprintf(s->text + s->used, s->size - s->used, "%s", text);
    s->used += length > 0 ? (size_t)length : 0;
  }
}

/* Report a symmetry as "translation of q and r along x". */
static void report_symmetry(search *s, const char *what, int count,
                            const dvi__coordinate *const *group, const char *way, int axis)
{
  const char end[] = {' ', "xyz"[axis], '\0'};
  report_text(s, s->found++ > 0 ? ", " : "");
  report_text(s, what);
  for (int k = 0; k < count; k++) {
    report_text(s, k == 0 ? " of " : k + 1 < count ? ", " : " and ");
    report_text(s, group[k]->name);
  }
  report_text(s, way);
  report_text(s, way[0] != '\0' ? end : "");
}

/* Turn component `from` of all members towards `to`. With from = to it moves on. */
static void turn_component(search *s, const dvi__coordinate *x, int from, int to)
{
  for (int i = 0; i < x->size; i++) {
    const int first = dvi__slots_at(&x->q, i);
    s->to[first + from] = from == to ? s->scene->n + 1 : first + to + 1;
    if (from != to) s->to[first + to] = -(first + from + 1);
  }
}

static bool try_group(search *s, const char *what, int count, const dvi__coordinate *const *group,
                      int from, int to)
{
  memset(s->to, 0, (size_t)s->scene->n * sizeof *s->to);
  for (int k = 0; k < count; k++) turn_component(s, group[k], from, to);
  if (!is_kept(s)) return false;
  const int rows = group[0]->shape.rows;
  if (from == to)
    report_symmetry(s, what, count, group, rows > 1 ? " along" : "", from);
  else
    report_symmetry(s, what, count, group, rows > 2 ? " about" : "", 3 - from - to);
  return true;
}

/* Try all motions that coordinates of one shape can do together. */
static bool try_shape(search *s, int count, const dvi__coordinate *const *group)
{
  const int rows = group[0]->shape.rows, before = s->found;
  for (int k = 0; k < rows && rows <= 3; k++) (void)try_group(s, "translation", count, group, k, k);
  if (rows == 2) (void)try_group(s, "rotation", count, group, 0, 1);
  for (int k = 0; k < 3 && rows == 3; k++)
    (void)try_group(s, "rotation", count, group, (k + 1) % 3, (k + 2) % 3);
  return s->found > before;
}

/* Try rotations of two numbers. They are coordinates by themselves, but may be those of a plane. */
static void try_planes(search *s, int count, const dvi__coordinate *const *group)
{
  for (int i = 0; i < count && count <= 3; i++)
    for (int j = i + 1; j < count; j++) {
      const dvi__coordinate *const pair[] = {group[i], group[j]};
      memset(s->to, 0, (size_t)s->scene->n * sizeof *s->to);
      s->to[pair[0]->q.first] = pair[1]->q.first + 1;
      s->to[pair[1]->q.first] = -(pair[0]->q.first + 1);
      if (is_kept(s)) report_symmetry(s, "rotation", 2, pair, "", 0);
    }
}

/* Try each coordinate alone, then all of the same shape together. */
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
  if (scene == NULL || text == NULL || scene->terms.factors != NULL || scene->field != NULL ||
      scene->density != NULL)
    return -1;
  search s = {.scene = scene, .text = text, .size = size};
  const int nodes = largest_kernel(scene, &s.work);
  s.to = dvi__heap_take((size_t)scene->n, sizeof *s.to);
  s.at = dvi__heap_take((size_t)nodes + 1, sizeof *s.at);
  const bool good = s.work <= WORK_MAX && s.to != NULL && s.at != NULL;
  if (good) try_all(&s);
  dvi__heap_free(s.to);
  dvi__heap_free(s.at);
  return good ? s.found : -1;
}
