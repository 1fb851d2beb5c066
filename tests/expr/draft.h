/* Functions that tests put together, kernel by kernel, and some systems of the catalogue as such
 * functions. */
#ifndef TESTS_EXPR_DRAFT_H
#define TESTS_EXPR_DRAFT_H
#include <check.h>
#include <stdlib.h>

#include "expr/function/function.h"

/* A function under construction, with kernels of at most INPUTS inputs. */
enum { INPUTS = 8, KERNELS = 4 };

/* The blocks and the pairs of a Lagrangian. */
enum { TIME, COORDINATES, VELOCITIES, BLOCKS };
enum { PAIR_QQ, PAIR_QV, PAIR_VV, PAIR_TQ, PAIR_TV, PAIRS };

typedef struct draft {
  dvi__graph graph[KERNELS];
  dvi__kernel kernel[KERNELS];
  dvi__kernel_input input[KERNELS][INPUTS];
  int kernel_count, width[BLOCKS];
  int *list[2];
  double *values;
} draft;

static inline dvi__graph *graph_of(draft *own)
{
  return &own->graph[own->kernel_count];
}

static inline void reset(draft *own, int n)
{
  *own = (draft){.width = {1, n, n}};
}

static inline dvi__node apply(draft *own, dvi__op op, dvi__node a, dvi__node b)
{
  return dvi__apply(graph_of(own), op, a, b);
}

static inline dvi__node variable(draft *own, int input)
{
  return dvi__input(graph_of(own), input);
}

static inline dvi__node number(draft *own, double value)
{
  return dvi__constant(graph_of(own), value);
}

static inline dvi__node times(draft *own, double value, dvi__node a)
{
  return apply(own, DVI__OP_MULTIPLY, number(own, value), a);
}

/* Close the kernel on which the draft is at work. */
static inline void finish(draft *own, dvi__node root, int elements, int input_count)
{
  const int k = own->kernel_count++;
  ck_assert_int_eq(own->graph[k].failed, DVI_OK);
  own->kernel[k] = (dvi__kernel){&own->graph[k], root, elements, input_count, own->input[k]};
}

static inline void affine(draft *own, int input, int block, int base, int stride)
{
  own->input[own->kernel_count][input] = (dvi__kernel_input){
      .block = block, .base = base, .stride = stride};
}

static inline dvi__function *made(draft *own)
{
  static const dvi__block_pair pair[PAIRS] = {
      [PAIR_QQ] = {COORDINATES, COORDINATES}, [PAIR_QV] = {COORDINATES, VELOCITIES},
      [PAIR_VV] = {VELOCITIES, VELOCITIES},   [PAIR_TQ] = {TIME, COORDINATES},
      [PAIR_TV] = {TIME, VELOCITIES},
  };
  const dvi__blocks blocks = {BLOCKS, own->width, PAIRS, pair};
  dvi__function *function;
  ck_assert_int_eq(dvi__function_create(own->kernel_count, own->kernel, &blocks, &function),
                   DVI_OK);
  return function;
}

static inline void drop(draft *own, dvi__function *function)
{
  dvi__function_destroy(&function);
  free(own->list[0]);
  free(own->list[1]);
  free(own->values);
}

/* --- The systems. --- */

/* -G m_a m_b/|x_a - x_b| for all pairs of bodies in `dimension` dimensions. */
static inline dvi__function *gravity(draft *own, int bodies, int dimension, double G,
                                     const double *mass)
{
  const int pairs = bodies * (bodies - 1) / 2;
  reset(own, dimension * bodies);
  for (int i = 0; i < 2; i++) own->list[i] = malloc((size_t)pairs * sizeof **own->list);
  own->values = malloc(2 * (size_t)pairs * sizeof *own->values);
  for (int a = 0, e = 0; a < bodies; a++)
    for (int b = a + 1; b < bodies; b++, e++) {
      own->list[0][e] = dimension * a;
      own->list[1][e] = dimension * b;
      own->values[e] = mass[a];
      own->values[pairs + e] = mass[b];
    }
  dvi__node sum = number(own, 0.0);
  for (int i = 0; i < dimension; i++) {
    for (int side = 0; side < 2; side++)
      own->input[0][2 * i + side] = (dvi__kernel_input){
          .block = COORDINATES, .number = own->list[side], .offset = i};
    const dvi__node d = apply(own, DVI__OP_SUBTRACT, variable(own, 2 * i),
                              variable(own, 2 * i + 1));
    sum = apply(own, DVI__OP_ADD, sum, apply(own, DVI__OP_SQUARE, d, d));
  }
  for (int side = 0; side < 2; side++)
    own->input[0][2 * dimension + side] = (dvi__kernel_input){.is_data = 1,
                                                              .data = own->values + side * pairs};
  const dvi__node product = apply(own, DVI__OP_MULTIPLY, variable(own, 2 * dimension),
                                  variable(own, 2 * dimension + 1));
  finish(own,
         apply(own, DVI__OP_DIVIDE, times(own, -G, product), apply(own, DVI__OP_SQRT, sum, sum)),
         pairs, 2 * dimension + 2);
  return made(own);
}

static const double solar_mass[6] = {0.000954786104043,  0.000285583733151, 0.0000437273164546,
                                     0.0000517759138449, 1.0 / 1.3e8,       1.00000597682};

static inline dvi__function *solar(draft *own)
{
  return gravity(own, 6, 3, 2.95912208286e-4, solar_mass);
}

/* 0.64 exp(q_i - q_(i+1)), and the bond that closes the ring. */
static inline dvi__function *toda(draft *own, int n)
{
  reset(own, n);
  for (int ring = 0; ring < 2; ring++) {
    const dvi__node d = apply(own, DVI__OP_SUBTRACT, variable(own, 0), variable(own, 1));
    affine(own, 0, COORDINATES, ring == 0 ? 0 : n - 1, 1);
    affine(own, 1, COORDINATES, ring == 0 ? 1 : 0, 1);
    finish(own, times(own, 0.64, apply(own, DVI__OP_EXP, d, d)), ring == 0 ? n - 1 : 1, 2);
  }
  return made(own);
}

/* d^4/4 of d = right - left end. The inputs are x0, x1 of the left spring, then x0, x1 of the right
 * one. */
static inline dvi__node quartic(draft *own, dvi__node left, dvi__node right)
{
  const dvi__node d = apply(own, DVI__OP_SUBTRACT, right, left);
  return times(own, 0.25, dvi__power(graph_of(own), d, 4.0));
}

/* The soft springs of Fermi, Pasta and Ulam's chain, inside and at both ends. */
static inline dvi__function *fpu(draft *own, int ell)
{
  reset(own, 2 * ell);
  for (int i = 0; i < 4; i++) affine(own, i, COORDINATES, i / 2 + (i % 2) * ell, 1);
  const dvi__node left = apply(own, DVI__OP_ADD, variable(own, 0), variable(own, 1));
  const dvi__node right = apply(own, DVI__OP_SUBTRACT, variable(own, 2), variable(own, 3));
  finish(own, quartic(own, left, right), ell - 1, 4);
  for (int end = 0; end < 2; end++) {
    affine(own, 0, COORDINATES, end == 0 ? 0 : ell - 1, 0);
    affine(own, 1, COORDINATES, end == 0 ? ell : 2 * ell - 1, 0);
    const dvi__node x0 = variable(own, 0), x1 = variable(own, 1), zero = number(own, 0.0);
    finish(own,
           end == 0 ? quartic(own, zero, apply(own, DVI__OP_SUBTRACT, x0, x1))
                    : quartic(own, apply(own, DVI__OP_ADD, x0, x1), zero),
           1, 2);
  }
  return made(own);
}

/* The double pendulum of the catalogue with its default parameters. */
static inline dvi__function *double_pendulum(draft *own)
{
  const double l1 = 2.0, l2 = 3.0, m1 = 1.0, m2 = 2.0, g = 9.80665;
  reset(own, 2);
  for (int i = 0; i < 4; i++) affine(own, i, i < 2 ? COORDINATES : VELOCITIES, i % 2, 0);
  const dvi__node q1 = variable(own, 0), q2 = variable(own, 1), v1 = variable(own, 2),
                  v2 = variable(own, 3);
  const dvi__node d = apply(own, DVI__OP_SUBTRACT, q1, q2),
                  vv = apply(own, DVI__OP_MULTIPLY, v1, v2);
  dvi__node L = times(own, 0.5 * (m1 + m2) * l1 * l1, apply(own, DVI__OP_SQUARE, v1, v1));
  L = apply(own, DVI__OP_ADD, L,
            times(own, 0.5 * m2 * l2 * l2, apply(own, DVI__OP_SQUARE, v2, v2)));
  L = apply(
      own, DVI__OP_ADD, L,
      times(own, m2 * l1 * l2, apply(own, DVI__OP_MULTIPLY, apply(own, DVI__OP_COS, d, d), vv)));
  L = apply(own, DVI__OP_ADD, L, times(own, (m1 + m2) * g * l1, apply(own, DVI__OP_COS, q1, q1)));
  L = apply(own, DVI__OP_ADD, L, times(own, m2 * g * l2, apply(own, DVI__OP_COS, q2, q2)));
  finish(own, L, 1, 4);
  return made(own);
}

#endif
