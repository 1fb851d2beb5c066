/* Which blocks the Jacobian of a stacked shot has, and where their entries go. */
#include <limits.h>
#include <string.h>

#include "step/onestep/stacked_struct.h"
#include "core/memory.h"
#include "core/status.h"

/* ---- blocks ---- */

/* Write a block, or count it. */
static void add(dvi__stacked_shot *s, int row, int column, dvi__stuff stuff, dvi__columns columns,
                int point, double factor)
{
  if (factor == 0) return;
  if (s->block != NULL)
    s->block[s->block_count] = (dvi__stack_block){row, column, stuff, columns, point, factor};
  s->block_count++;
}

/* The same in the columns on which z_m depends: those of its way, and of the start's momentum. */
static void add_node(dvi__stacked_shot *s, int row, int m, dvi__stuff stuff, int point,
                     double factor)
{
  add(s, row, dvi__stack_start(s), stuff, DVI__SECOND, point, factor);
  if (m > 0) add(s, row, dvi__stack_node(s, m), stuff, DVI__BOTH, point, factor);
}

/* Columns of lambda_{m}; at the end it is h b L_z(z), which row is the next but one. */
static void add_lambda(dvi__stacked_shot *s, int row, int m, double factor)
{
  const int pieces = s->course.pieces;
  if (m < pieces)
    add(s, row, dvi__stack_lambda(s, m), DVI__ONE, DVI__BOTH, 0, factor);
  else
    add_node(s, row, m, DVI__LAGRANGIAN_ZZ, dvi__stack_node_point(s, m), factor * s->course.b[m]);
}

static void add_piece(dvi__stacked_shot *s, int m)
{
  const dvi__runge_kutta *rk = &s->method;
  const double part = s->course.c[m + 1] - s->course.c[m];
  const int node = dvi__stack_node(s, m + 1), lambda = dvi__stack_lambda(s, m);
  add(s, node, node, DVI__ONE, DVI__BOTH, 0, 1);
  if (m > 0) add(s, node, dvi__stack_node(s, m), DVI__ONE, DVI__BOTH, 0, -1);
  add(s, lambda, lambda, DVI__ONE, DVI__BOTH, 0, 1);
  add_lambda(s, lambda, m + 1, -1);
  add_node(s, lambda, m, DVI__LAGRANGIAN_ZZ, dvi__stack_node_point(s, m), -s->course.b[m]);
  for (int j = 0; j < rk->stages; j++) {
    const int W = dvi__stack_W(s, m, j), Gamma = dvi__stack_Gamma(s, m, j),
              point = dvi__stack_stage_point(s, m, j);
    add(s, W, W, DVI__ONE, DVI__BOTH, 0, 1);
    add_node(s, W, m, DVI__FLOW, point, -part);
    add(s, node, W, DVI__ONE, DVI__BOTH, 0, -rk->b[j]);
    add(s, Gamma, Gamma, DVI__ONE, DVI__BOTH, 0, 1);
    add_lambda(s, Gamma, m + 1, -rk->b[j]);
    add(s, Gamma, dvi__stack_start(s), DVI__ONE, DVI__FIRST, 0, rk->b[j]);
    add(s, lambda, Gamma, DVI__FLOW_TRANSPOSED, DVI__BOTH, point, -part);
    for (int k = 0; k < rk->stages; k++) {
      add(s, W, dvi__stack_W(s, m, k), DVI__FLOW, DVI__BOTH, point, -part * rk->a[j][k]);
      add(s, Gamma, dvi__stack_Gamma(s, m, k), DVI__FLOW_TRANSPOSED, DVI__BOTH,
          dvi__stack_stage_point(s, m, k), -part * rk->a[k][j]);
    }
  }
}

static void add_all(dvi__stacked_shot *s)
{
  const int start = dvi__stack_start(s);
  s->block_count = 0;
  for (int m = 0; m < s->course.pieces; m++) add_piece(s, m);
  add(s, start, dvi__stack_lambda(s, 0), DVI__ONE, DVI__BOTH, 0, 1);
  add(s, start, start, DVI__ONE, DVI__FIRST, 0, -1);
}

/* ---- entries ---- */

/* The same pattern in each quarter. */
static dvi_status repeat(const dvi__pattern *quarter, dvi__pattern *whole)
{
  const int n = quarter->columns, entries = dvi__pattern_entries(quarter);
  int *start = DVI_NEW(int, 2 * (size_t)n + 1), *row = DVI_NEW(int, 4 * (size_t)entries + 1), e = 0;
  *whole = (dvi__pattern){2 * n, 2 * n, start, row};
  if (start == NULL || row == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  for (int c = 0; c < 2 * n; c++) {
    for (int half = 0; half < 2; half++)
      for (int k = quarter->start[c % n]; k < quarter->start[c % n + 1]; k++)
        row[e++] = quarter->row[k] + half * n;
    start[c + 1] = e;
  }
  return DVI_OK;
}

/* Of a diagonal mass that of L_qq with the diagonal; of others all. */
static dvi_status join(dvi__stacked_shot *s, const dvi_system *system)
{
  dvi__pattern diagonal = {0}, quarter = {0};
  if (system->mass_diagonal == NULL)
    return dvi__pattern_copy(&(dvi_pattern){0}, 2 * s->n, "stages", &s->joint);
  dvi_status status = dvi__pattern_diagonal(s->n, &diagonal);
  if (status == DVI_OK) status = dvi__pattern_union(&system->qq, &diagonal, &quarter);
  if (status == DVI_OK) status = repeat(&quarter, &s->joint);
  dvi__pattern_clear(&diagonal);
  dvi__pattern_clear(&quarter);
  return status;
}

/* f_z = (H_pz, -H_qz): the sign is the row's. */
static dvi_status turn(dvi__stacked_shot *s)
{
  const dvi__pattern *joint = &s->joint;
  const int n = s->n;
  s->flow = DVI_NEW(int, dvi__pattern_entries(joint));
  s->transposed = DVI_NEW(int, dvi__pattern_entries(joint));
  s->H_zz = DVI_NEW(double, dvi__pattern_entries(joint));
  if (!s->flow || !s->transposed || !s->H_zz) return dvi__fail(DVI_NO_MEMORY, "no memory");
  for (int c = 0; c < 2 * n; c++)
    for (int e = joint->start[c]; e < joint->start[c + 1]; e++) {
      const int i = joint->row[e];
      s->flow[e] = dvi__pattern_find(joint, (i + n) % (2 * n), c);
      s->transposed[e] = dvi__pattern_find(joint, (c + n) % (2 * n), i);
    }
  return DVI_OK;
}

/* The rows (lambda_0)_p = 0 and that of lambda_0 itself change places: then no entry of the
 * diagonal is 0. */
static int row_of(const dvi__stacked_shot *s, int block, int i)
{
  const int z = 2 * s->n, lambda = dvi__stack_lambda(s, 0), start = dvi__stack_start(s);
  if (i >= s->n && (block == lambda || block == start)) block = lambda + start - block;
  return block * z + i;
}

/* Entries of a block, column by column: how many, or the first row and column of each. */
static int entries_of(const dvi__stacked_shot *s, const dvi__stack_block *b, int *row, int *column)
{
  const int z = 2 * s->n, from = b->columns == DVI__SECOND ? s->n : 0,
            to = b->columns == DVI__FIRST ? s->n : z;
  int count = 0;
  for (int c = from; c < to; c++)
    for (int e = b->stuff == DVI__ONE ? -1 : s->joint.start[c];
         e < (b->stuff == DVI__ONE ? 0 : s->joint.start[c + 1]); e++) {
      if (row != NULL) {
        row[count] = row_of(s, b->row, b->stuff == DVI__ONE ? c : s->joint.row[e]);
        column[count] = b->column * z + c;
      }
      count++;
    }
  return count;
}

/* Stable: order [count] by key, 0 <= key < keys. */
static void sort(int count, const int *key, int keys, int *begin, const int *order, int *sorted)
{
  memset(begin, 0, ((size_t)keys + 1) * sizeof *begin);
  for (int t = 0; t < count; t++) begin[key[t] + 1]++;
  for (int k = 0; k < keys; k++) begin[k + 1] += begin[k];
  for (int t = 0; t < count; t++) sorted[begin[key[order[t]]]++] = order[t];
}

/* Entries at one place become one. order is by columns, and by rows in each. */
static void merge(dvi__stacked_shot *s, int count, const int *row, const int *column,
                  const int *order)
{
  int last = -1;
  for (int t = 0; t < count; t++) {
    const int e = order[t],
              fresh = t == 0 || row[e] != row[order[t - 1]] || column[e] != column[order[t - 1]];
    last += fresh;
    s->where[e] = last;
    s->pattern.row[last] = row[e];
    s->pattern.start[column[e] + 1] = last + 1;
  }
}

static dvi_status fill(dvi__stacked_shot *s, int count)
{
  const int unknowns = 2 * s->n * s->blocks;
  int *room = DVI_NEW(int, 4 * (size_t)count + (size_t)unknowns + 1);
  s->where = DVI_NEW(int, count);
  s->pattern = (dvi__pattern){unknowns, unknowns, DVI_NEW(int, (size_t)unknowns + 1),
                              DVI_NEW(int, count)};
  if (room == NULL || s->where == NULL || s->pattern.start == NULL || s->pattern.row == NULL) {
    dvi__release(room);
    return dvi__fail(DVI_NO_MEMORY, "no memory for %d unknowns", unknowns);
  }
  int *row = room, *column = row + count, *first = column + count, *second = first + count,
      *begin = second + count, at = 0;
  for (int b = 0; b < s->block_count; b++) at += entries_of(s, &s->block[b], row + at, column + at);
  for (int t = 0; t < count; t++) second[t] = t;
  sort(count, row, unknowns, begin, second, first);
  sort(count, column, unknowns, begin, first, second);
  merge(s, count, row, column, second);
  dvi__release(room);
  return DVI_OK;
}

dvi_status dvi__stacked_shot_lay_out(dvi__stacked_shot *s, const dvi_system *system)
{
  size_t count = 0;
  DVI_TRY(join(s, system));
  DVI_TRY(turn(s));
  add_all(s);
  s->block = DVI_NEW(dvi__stack_block, s->block_count);
  if (s->block == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  add_all(s);
  for (int b = 0; b < s->block_count; b++) count += (size_t)entries_of(s, &s->block[b], NULL, NULL);
  if (count < INT_MAX) return fill(s, (int)count);
  return dvi__fail(DVI_BAD_SIZE,
                   "the stages' Jacobian would have %zu entries, more than an int can count; take "
                   "fewer stages or nodes",
                   count);
}

void dvi__stacked_shot_clear_layout(dvi__stacked_shot *s)
{
  dvi__pattern_clear(&s->joint);
  dvi__pattern_clear(&s->pattern);
  dvi__release(s->flow);
  dvi__release(s->transposed);
  dvi__release(s->H_zz);
  dvi__release(s->block);
  dvi__release(s->where);
}
