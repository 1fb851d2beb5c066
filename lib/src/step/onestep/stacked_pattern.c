/* The blocks of the Jacobian of a stacked shot, and the places of their entries. */
#include <limits.h>
#include <string.h>

#include "step/onestep/stacked_struct.h"
#include "core/memory.h"
#include "core/status.h"

/* ---- blocks ---- */

/* Count a block, and write the block if there is a list. */
static void stack_add(dvi__stacked_shot *s, int row, int column, dvi__stack_content content,
                      dvi__stack_columns columns, int point, double factor)
{
  if (factor == 0) return;
  if (s->block != NULL)
    s->block[s->block_count] = (dvi__stack_block){.row = row,
                                                  .column = column,
                                                  .content = content,
                                                  .columns = columns,
                                                  .point = point,
                                                  .factor = factor};
  s->block_count++;
}

/* Add a block in the columns on which z_m depends. These are the columns of its motion, and of the
 * start's momentum. */
static void stack_add_node(dvi__stacked_shot *s, int row, int m, dvi__stack_content content,
                           int point, double factor)
{
  stack_add(s, row, dvi__stack_start(s), content, DVI__SECOND, point, factor);
  if (m > 0) stack_add(s, row, dvi__stack_node(s, m), content, DVI__BOTH, point, factor);
}

/* Add a block in the columns of lambda_{m}. At the end this is h b L_z(z), whose row is the next
 * but one. */
static void add_lambda(dvi__stacked_shot *s, int row, int m, double factor)
{
  const int pieces = s->course.pieces;
  if (m < pieces)
    stack_add(s, row, dvi__stack_lambda(s, m), DVI__ONE, DVI__BOTH, 0, factor);
  else
    stack_add_node(s, row, m, DVI__LAGRANGIAN_ZZ, dvi__stack_node_point(s, m),
                   factor * s->course.b[m]);
}

static void stack_add_piece(dvi__stacked_shot *s, int m)
{
  const dvi__runge_kutta *rk = &s->method;
  const double part = s->course.c[m + 1] - s->course.c[m];
  const int node = dvi__stack_node(s, m + 1), lambda = dvi__stack_lambda(s, m);
  stack_add(s, node, node, DVI__ONE, DVI__BOTH, 0, 1);
  if (m > 0) stack_add(s, node, dvi__stack_node(s, m), DVI__ONE, DVI__BOTH, 0, -1);
  stack_add(s, lambda, lambda, DVI__ONE, DVI__BOTH, 0, 1);
  add_lambda(s, lambda, m + 1, -1);
  stack_add_node(s, lambda, m, DVI__LAGRANGIAN_ZZ, dvi__stack_node_point(s, m), -s->course.b[m]);
  for (int j = 0; j < rk->stages; j++) {
    const int W = dvi__stack_W(s, m, j), Gamma = dvi__stack_Gamma(s, m, j),
              point = dvi__stack_stage_point(s, m, j);
    stack_add(s, W, W, DVI__ONE, DVI__BOTH, 0, 1);
    stack_add_node(s, W, m, DVI__FLOW, point, -part);
    stack_add(s, node, W, DVI__ONE, DVI__BOTH, 0, -rk->b[j]);
    stack_add(s, Gamma, Gamma, DVI__ONE, DVI__BOTH, 0, 1);
    add_lambda(s, Gamma, m + 1, -rk->b[j]);
    stack_add(s, Gamma, dvi__stack_start(s), DVI__ONE, DVI__FIRST, 0, rk->b[j]);
    stack_add(s, lambda, Gamma, DVI__FLOW_TRANSPOSED, DVI__BOTH, point, -part);
    for (int k = 0; k < rk->stages; k++) {
      stack_add(s, W, dvi__stack_W(s, m, k), DVI__FLOW, DVI__BOTH, point, -part * rk->a[j][k]);
      stack_add(s, Gamma, dvi__stack_Gamma(s, m, k), DVI__FLOW_TRANSPOSED, DVI__BOTH,
                dvi__stack_stage_point(s, m, k), -part * rk->a[k][j]);
    }
  }
}

static void stack_add_all(dvi__stacked_shot *s)
{
  const int start = dvi__stack_start(s);
  s->block_count = 0;
  for (int m = 0; m < s->course.pieces; m++) stack_add_piece(s, m);
  stack_add(s, start, dvi__stack_lambda(s, 0), DVI__ONE, DVI__BOTH, 0, 1);
  stack_add(s, start, start, DVI__ONE, DVI__FIRST, 0, -1);
}

/* ---- entries ---- */

/* Repeat the pattern in each quarter. */
static dvi_status stack_repeat(const dvi__pattern *quarter, dvi__pattern *whole)
{
  const int n = quarter->columns, entries = dvi__pattern_entries(quarter);
  int *start = DVI_NEW(int, 2 * (size_t)n + 1), *row = DVI_NEW(int, 4 * (size_t)entries + 1), e = 0;
  *whole = (dvi__pattern){.rows = 2 * n, .columns = 2 * n, .start = start, .row = row};
  if (start == NULL || row == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  for (int c = 0; c < 2 * n; c++) {
    for (int half = 0; half < 2; half++)
      for (int k = quarter->start[c % n]; k < quarter->start[c % n + 1]; k++)
        row[e++] = quarter->row[k] + half * n;
    start[c + 1] = e;
  }
  return DVI_OK;
}

/* Make the joint pattern. For a diagonal mass this is the pattern of L_qq with the diagonal,
 * otherwise of all Hessians. */
static dvi_status stack_join(dvi__stacked_shot *s, const dvi_system *system)
{
  dvi__pattern diagonal = {0}, quarter = {0};
  if (system->mass_diagonal == NULL)
    return dvi__pattern_copy(&(dvi_pattern){0}, 2 * s->n, "stages", &s->joint);
  dvi_status status = dvi__pattern_diagonal(s->n, &diagonal);
  if (status == DVI_OK) status = dvi__pattern_union(&system->qq, &diagonal, &quarter);
  if (status == DVI_OK) status = stack_repeat(&quarter, &s->joint);
  dvi__pattern_clear(&diagonal);
  dvi__pattern_clear(&quarter);
  return status;
}

/* Find the entries of f_z = (H_pz, -H_qz). The sign is that of the row. */
static dvi_status stack_turn(dvi__stacked_shot *s)
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

/* Return a row of the Jacobian. The rows (lambda_0)_p = 0 and that of lambda_0 itself change
 * places, so that no entry of the diagonal is 0. */
static int stack_row_of(const dvi__stacked_shot *s, int block, int i)
{
  const int z = 2 * s->n, lambda = dvi__stack_lambda(s, 0), start = dvi__stack_start(s);
  if (i >= s->n && (block == lambda || block == start)) block = lambda + start - block;
  return block * z + i;
}

/* Write the row and the column of each entry of a block, column by column, unless both are NULL.
 * Returns the number of entries. */
static int stack_entries_of(const dvi__stacked_shot *s, const dvi__stack_block *b, int *row,
                            int *column)
{
  const int z = 2 * s->n, from = b->columns == DVI__SECOND ? s->n : 0,
            to = b->columns == DVI__FIRST ? s->n : z;
  int count = 0;
  for (int c = from; c < to; c++)
    for (int e = b->content == DVI__ONE ? -1 : s->joint.start[c];
         e < (b->content == DVI__ONE ? 0 : s->joint.start[c + 1]); e++) {
      if (row != NULL) {
        row[count] = stack_row_of(s, b->row, b->content == DVI__ONE ? c : s->joint.row[e]);
        column[count] = b->column * z + c;
      }
      count++;
    }
  return count;
}

/* Sort order [count] by key, 0 <= key < keys, stably. */
static void stack_sort(int count, const int *key, int keys, int *begin, const int *order,
                       int *sorted)
{
  memset(begin, 0, ((size_t)keys + 1) * sizeof *begin);
  for (int t = 0; t < count; t++) begin[key[t] + 1]++;
  for (int k = 0; k < keys; k++) begin[k + 1] += begin[k];
  for (int t = 0; t < count; t++) sorted[begin[key[order[t]]]++] = order[t];
}

/* Merge entries at the same place. `order` is sorted by columns, and by rows within each column. */
static void stack_merge(dvi__stacked_shot *s, int count, const int *row, const int *column,
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

static dvi_status stack_initialise(dvi__stacked_shot *s, int count)
{
  const int unknowns = 2 * s->n * s->blocks;
  int *room = DVI_NEW(int, 4 * (size_t)count + (size_t)unknowns + 1);
  s->where = DVI_NEW(int, count);
  s->pattern = (dvi__pattern){.rows = unknowns,
                              .columns = unknowns,
                              .start = DVI_NEW(int, (size_t)unknowns + 1),
                              .row = DVI_NEW(int, count)};
  if (room == NULL || s->where == NULL || s->pattern.start == NULL || s->pattern.row == NULL) {
    dvi__release(room);
    return dvi__fail(DVI_NO_MEMORY, "no memory for %d unknowns", unknowns);
  }
  int *row = room, *column = row + count, *first = column + count, *second = first + count,
      *begin = second + count, at = 0;
  for (int b = 0; b < s->block_count; b++)
    at += stack_entries_of(s, &s->block[b], row + at, column + at);
  for (int t = 0; t < count; t++) second[t] = t;
  stack_sort(count, row, unknowns, begin, second, first);
  stack_sort(count, column, unknowns, begin, first, second);
  stack_merge(s, count, row, column, second);
  dvi__release(room);
  return DVI_OK;
}

dvi_status dvi__stacked_shot_lay_out(dvi__stacked_shot *s, const dvi_system *system)
{
  size_t count = 0;
  DVI_TRY(stack_join(s, system));
  DVI_TRY(stack_turn(s));
  stack_add_all(s);
  s->block = DVI_NEW(dvi__stack_block, s->block_count);
  if (s->block == NULL) return dvi__fail(DVI_NO_MEMORY, "no memory");
  stack_add_all(s);
  for (int b = 0; b < s->block_count; b++)
    count += (size_t)stack_entries_of(s, &s->block[b], NULL, NULL);
  if (count < INT_MAX) return stack_initialise(s, (int)count);
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
