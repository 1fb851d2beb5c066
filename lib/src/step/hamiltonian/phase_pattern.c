/* The pattern of a step's Jacobian has a block for each pair of components of z or constraints that
 * are coupled. */
#include <stdint.h>
#include <stdlib.h>

#include "step/hamiltonian/phase_struct.h"
#include "core/memory.h"
#include "core/status.h"

/* Pairs (row, column) of a square matrix have the key column * size + row. */
typedef struct pairs {
  int64_t *key, size;
  int count;
} pairs;

static void phase_pattern_add(pairs *p, int row, int column)
{
  p->key[p->count++] = column * p->size + row;
}

static int by_key(const void *a, const void *b)
{
  const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
  return (x > y) - (x < y);
}

static dvi_status phase_pattern_no_memory(void)
{
  return dvi__fail(DVI_NO_MEMORY, "phase space: no memory for the Jacobian");
}

/* Make the pattern of the pairs, which are sorted and made unique. */
static dvi_status phase_pattern_collect(pairs *p, dvi__pattern *pattern)
{
  const int size = (int)p->size;
  int count = 0;
  qsort(p->key, (size_t)p->count, sizeof *p->key, by_key);
  for (int i = 0; i < p->count; i++)
    if (i == 0 || p->key[i] != p->key[i - 1]) p->key[count++] = p->key[i];
  *pattern = (dvi__pattern){.rows = size,
                            .columns = size,
                            .start = DVI_NEW(int, (size_t)size + 1),
                            .row = DVI_NEW(int, count)};
  if (pattern->start == NULL || pattern->row == NULL) return phase_pattern_no_memory();
  for (int i = 0; i < count; i++) {
    pattern->row[i] = (int)(p->key[i] % p->size);
    pattern->start[p->key[i] / p->size + 1] = i + 1;
  }
  for (int j = 0; j < size; j++)
    if (pattern->start[j + 1] < pattern->start[j]) pattern->start[j + 1] = pattern->start[j];
  return DVI_OK;
}

/* ---- derivative of a vector field (F_p, -F_q) ---- */

static void add_field(pairs *p, int n, const dvi__pattern *qq, const dvi__pattern *qp,
                      const dvi__pattern *pp)
{
  for (int j = 0; j < n; j++) {
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++) phase_pattern_add(p, n + qq->row[e], j);
    for (int e = pp->start[j]; e < pp->start[j + 1]; e++) phase_pattern_add(p, pp->row[e], n + j);
    for (int e = qp->start[j]; e < qp->start[j + 1]; e++) {
      phase_pattern_add(p, n + qp->row[e], n + j);
      phase_pattern_add(p, j, qp->row[e]);
    }
  }
}

static dvi_status place_field(const dvi__pattern *joint, int n, const dvi__pattern *qq,
                              const dvi__pattern *qp, const dvi__pattern *pp,
                              dvi__vector_field_places *at)
{
  *at = (dvi__vector_field_places){
      DVI_NEW(int, dvi__pattern_entries(qq)), DVI_NEW(int, dvi__pattern_entries(qp)),
      DVI_NEW(int, dvi__pattern_entries(qp)), DVI_NEW(int, dvi__pattern_entries(pp))};
  if (at->qq == NULL || at->qp_in_p == NULL || at->qp_in_q == NULL || at->pp == NULL)
    return phase_pattern_no_memory();
  for (int j = 0; j < n; j++) {
    for (int e = qq->start[j]; e < qq->start[j + 1]; e++)
      at->qq[e] = dvi__pattern_find(joint, n + qq->row[e], j);
    for (int e = pp->start[j]; e < pp->start[j + 1]; e++)
      at->pp[e] = dvi__pattern_find(joint, pp->row[e], n + j);
    for (int e = qp->start[j]; e < qp->start[j + 1]; e++) {
      at->qp_in_p[e] = dvi__pattern_find(joint, n + qp->row[e], n + j);
      at->qp_in_q[e] = dvi__pattern_find(joint, j, qp->row[e]);
    }
  }
  return DVI_OK;
}

static void clear_field(dvi__vector_field_places *at)
{
  dvi__release(at->qq);
  dvi__release(at->qp_in_p);
  dvi__release(at->qp_in_q);
  dvi__release(at->pp);
}

/* ---- constraints ---- */

/* Return the component of the vector field X_phi that holds the derivative by component `row` of
 * z. */
static int phase_pattern_turned(int n, int row)
{
  return row < n ? n + row : row - n;
}

static void phase_pattern_add_constraints(pairs *p, const dvi__pattern *gradients)
{
  for (int a = 0; a < gradients->columns; a++)
    for (int e = gradients->start[a]; e < gradients->start[a + 1]; e++) {
      phase_pattern_add(p, gradients->rows + a, gradients->row[e]);
      phase_pattern_add(p, phase_pattern_turned(gradients->rows / 2, gradients->row[e]),
                        gradients->rows + a);
    }
}

static dvi_status place_constraints(dvi__phase_element *f)
{
  const dvi__pattern *gradients = &f->system->constraint->gradients;
  const int entries = dvi__pattern_entries(&f->joint);
  f->gradient = DVI_NEW(int, entries);
  if (f->gradient == NULL) return phase_pattern_no_memory();
  for (int e = 0; e < entries; e++) f->gradient[e] = -1;
  for (int a = 0; a < f->m; a++)
    for (int e = gradients->start[a]; e < gradients->start[a + 1]; e++) {
      f->gradient[dvi__pattern_find(&f->joint, 2 * f->n + a, gradients->row[e])] = e;
      f->gradient[dvi__pattern_find(&f->joint, phase_pattern_turned(f->n, gradients->row[e]),
                                    2 * f->n + a)] = e;
    }
  return DVI_OK;
}

/* ---- Jacobian ---- */

static dvi_status phase_pattern_join(const dvi__phase_element *f, dvi__pattern *joint)
{
  const dvi_system *s = f->system;
  const dvi__lagrangian_term *w = &s->constraint->weighted;
  size_t count = 2 * (size_t)f->n + 2 * (size_t)dvi__pattern_entries(&s->constraint->gradients);
  const dvi__pattern *const once[] = {&s->qq, &s->qv, &s->qv, &s->vv,
                                      &w->qq, &w->qv, &w->qv, &w->vv};
  for (int i = 0; i < 8; i++) count += (size_t)dvi__pattern_entries(once[i]);
  if (count > INT32_MAX)
    return dvi__fail(DVI_BAD_SIZE, "phase space: %zu entries are too many; declare sparse patterns",
                     count);
  pairs p = {.key = DVI_NEW(int64_t, count), .size = 2 * f->n + f->m};
  if (p.key == NULL) return phase_pattern_no_memory();
  for (int c = 0; c < 2 * f->n; c++) phase_pattern_add(&p, c, c);
  add_field(&p, f->n, &s->qq, &s->qv, &s->vv);
  add_field(&p, f->n, &w->qq, &w->qv, &w->vv);
  phase_pattern_add_constraints(&p, &s->constraint->gradients);
  const dvi_status status = phase_pattern_collect(&p, joint);
  dvi__release(p.key);
  return status;
}

/* The number of rows or columns of a block, and the first of them. */
static int phase_pattern_length_of(const dvi__phase_element *f, int block)
{
  return block < 2 * f->n ? f->d + 1 : f->k + 1;
}

static int begin_of(const dvi__phase_element *f, int block)
{
  const int z = 2 * f->n;
  return block < z ? block * (f->d + 1) : z * (f->d + 1) + (block - z) * (f->k + 1);
}

static dvi_status phase_pattern_expand(const dvi__phase_element *f, dvi__pattern *pattern)
{
  const dvi__pattern *joint = &f->joint;
  const int size = begin_of(f, joint->columns);
  size_t entries = 0;
  for (int j = 0; j < joint->columns; j++)
    for (int e = joint->start[j]; e < joint->start[j + 1]; e++)
      entries += (size_t)phase_pattern_length_of(f, j) *
                 (size_t)phase_pattern_length_of(f, joint->row[e]);
  if (entries > INT32_MAX)
    return dvi__fail(DVI_BAD_SIZE, "phase space: %zu entries are too many; declare sparse patterns",
                     entries);
  *pattern = (dvi__pattern){.rows = size,
                            .columns = size,
                            .start = DVI_NEW(int, (size_t)size + 1),
                            .row = DVI_NEW(int, entries)};
  if (pattern->start == NULL || pattern->row == NULL) return phase_pattern_no_memory();
  int at = 0, column = 0;
  for (int j = 0; j < joint->columns; j++)
    for (int l = 0; l < phase_pattern_length_of(f, j); l++) {
      for (int e = joint->start[j]; e < joint->start[j + 1]; e++)
        for (int i = 0; i < phase_pattern_length_of(f, joint->row[e]); i++)
          pattern->row[at++] = begin_of(f, joint->row[e]) + i;
      pattern->start[++column] = at;
    }
  return DVI_OK;
}

dvi_status dvi__phase_element_lay_out(dvi__phase_element *f)
{
  const dvi_system *s = f->system;
  const dvi__lagrangian_term *w = &s->constraint->weighted;
  DVI_TRY(phase_pattern_join(f, &f->joint));
  DVI_TRY(phase_pattern_expand(f, &f->pattern));
  DVI_TRY(place_field(&f->joint, f->n, &s->qq, &s->qv, &s->vv, &f->of_H));
  DVI_TRY(place_field(&f->joint, f->n, &w->qq, &w->qv, &w->vv, &f->of_phi));
  return place_constraints(f);
}

void dvi__phase_element_clear_layout(dvi__phase_element *f)
{
  dvi__pattern_clear(&f->joint);
  dvi__pattern_clear(&f->pattern);
  clear_field(&f->of_H);
  clear_field(&f->of_phi);
  dvi__release(f->gradient);
}
