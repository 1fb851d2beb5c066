#include "watch/field_columns.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/choice.h"
#include "csv/table.h"
#include "load/field.h"

/* ---- what there is ---- */

/* Tell if the columns have what a wave's system watches, beside what a march observes. */
static bool is_wave(const field_columns *c)
{
  return dvi_scene_field(c->scene->scene) != NULL && dvi_march_size(c->march, DVI_FORM_A) > 0;
}

static int64_t count_unknowns(const field_columns *c)
{
  int64_t unknowns;
  (void)dvi_field_unknowns(dvi_scene_field(c->scene->scene), &unknowns);
  return unknowns;
}

/* Tell if one of the first columns has this name. */
static bool is_among(const field_columns *c, int first, const char *name)
{
  for (int i = 0; i < first; i++)
    if (strcmp(c->all[i].name, name) == 0) return true;
  return false;
}

static bool list_all(field_columns *c)
{
  int observables = 0;
  const int invariants = is_wave(c) ? c->scene->terms->invariant_count : 0;
  while (dvi_march_observable(c->march, observables) != NULL) observables++;
  c->all = calloc((size_t)(observables + invariants) + 1, sizeof *c->all);
  if (c->all == NULL) return false;
  for (int i = 0; i < observables; i++)
    c->all[c->there++] = (field_column){dvi_march_observable(c->march, i), i, -1};
  for (int i = 0; i < invariants; i++) {
    const char *name = c->scene->terms->invariants[i].name;
    if (!is_among(c, observables, name)) c->all[c->there++] = (field_column){name, -1, i};
  }
  return true;
}

static const char *name_at(int k, const void *list)
{
  const field_columns *c = list;
  return k < c->there ? c->all[k].name : NULL;
}

/* ---- what is shown ---- */

/* The laws of charge take a look at the whole field, and are shown when they are asked for. */
static bool is_usual(const char *name)
{
  static const char *const on_demand[] = {"gauss", "charge", "divergence"};
  for (size_t k = 0; k < sizeof on_demand / sizeof *on_demand; k++)
    if (strcmp(name, on_demand[k]) == 0) return false;
  return true;
}

static void choose_usual(field_columns *c)
{
  const char *name;
  for (int i = 0; (name = name_at(i, c)) != NULL; i++)
    if (is_usual(name)) c->column[c->count++] = c->all[i];
}

/* Momenta of a wave are those of mechanical methods, which the scene wants without being told. */
static bool is_momentum(const problem *scene, const char *name)
{
  for (int i = 0; i < scene->terms->symmetry_count; i++)
    if (strcmp(scene->terms->symmetries[i].name, name) == 0) return true;
  return false;
}

/* Choose the columns "A,B,..", or those of the scene. */
static int choose_named(field_columns *c, const char *asked)
{
  dvi_march_facts facts;
  dvi_march_facts_of(c->march, &facts);
  column_choice choice = {.scene = c->scene->name,
                          .method = facts.method,
                          .name_at = name_at,
                          .list = c,
                          .place = c->place};
  int code = asked != NULL ? choice_add_all(&choice, asked) : DONE;
  for (int i = 0; i < c->scene->column_count && asked == NULL && code == DONE; i++)
    if (!is_momentum(c->scene, c->scene->column[i]))
      code = choice_add(&choice, c->scene->column[i]);
  for (int i = 0; i < choice.count; i++) c->column[c->count++] = c->all[c->place[i]];
  return code;
}

int field_columns_choose(field_columns *columns, const problem *scene, const dvi_march *march,
                         const char *asked)
{
  *columns = (field_columns){.scene = scene, .march = march};
  bool good = list_all(columns);
  if (good) columns->column = calloc((size_t)columns->there + 1, sizeof *columns->column);
  if (good) columns->place = calloc((size_t)columns->there + 1, sizeof *columns->place);
  if (good) columns->number = calloc((size_t)columns->there + 1, sizeof *columns->number);
  if (good && is_wave(columns))
    columns->form = calloc(
        (size_t)(2 * dvi_march_size(march, DVI_FORM_A) + 2 * count_unknowns(columns)),
        sizeof *columns->form);
  if (!good || !columns->column || !columns->place || !columns->number ||
      (is_wave(columns) && !columns->form)) {
    complain("out of memory");
    return FAILED;
  }
  if (asked != NULL || scene->column != NULL) return choose_named(columns, asked);
  choose_usual(columns);
  return DONE;
}

void field_columns_clear(field_columns *columns)
{
  free(columns->all);
  free(columns->column);
  free(columns->place);
  free(columns->number);
  free(columns->form);
}

/* ---- rows ---- */

void field_columns_header(const field_columns *columns, FILE *stream)
{
  (void)fputc('t', stream);
  for (int i = 0; i < columns->count; i++) {
    (void)fputc(',', stream);
    csv_text(stream, columns->column[i].name);
  }
  (void)fputc('\n', stream);
}

/* Set q = u and p = -M E of a wave. */
static dvi_status find_state(field_columns *c, double **q, double **p)
{
  const int64_t cells = dvi_march_size(c->march, DVI_FORM_A);
  const dvi_field *field = dvi_scene_field(c->scene->scene);
  double *u = c->form, *E = u + cells;
  *q = E + cells;
  *p = *q + count_unknowns(c);
  dvi_status status = dvi_march_sample(c->march, DVI_FORM_A, 0, NULL, u);
  if (status == DVI_OK) status = dvi_march_sample(c->march, DVI_FORM_E, 0, NULL, E);
  for (int64_t i = 0; i < cells; i++) E[i] = -E[i];
  return status == DVI_OK ? dvi_field_project(field, u, E, *q, *p) : status;
}

static bool measure(field_columns *c, int i, const double *q, const double *p)
{
  const field_column *column = c->column + i;
  const double t = dvi_march_time(c->march);
  int failed = 0;
  if (column->observable >= 0) {
    const dvi_status status = dvi_march_observe(c->march, column->observable, c->number + i);
    if (status != DVI_OK) return library_error(status) == DONE;
  } else {
    const dvi_invariant *invariant = c->scene->terms->invariants + column->invariant;
    failed = invariant->value(t, q, p, c->number + i, invariant->user);
  }
  if (failed == 0 && isfinite(c->number[i])) return true;
  complain("run: column '%s' is not a finite number at t = %.17g", column->name, t);
  return false;
}

bool field_columns_measure(field_columns *columns)
{
  double *q = NULL, *p = NULL;
  bool needs_state = false;
  for (int i = 0; i < columns->count; i++)
    needs_state = needs_state || columns->column[i].invariant >= 0;
  const dvi_status status = needs_state ? find_state(columns, &q, &p) : DVI_OK;
  if (status != DVI_OK) return library_error(status) == DONE;
  for (int i = 0; i < columns->count; i++)
    if (!measure(columns, i, q, p)) return false;
  return true;
}

void field_columns_row(const field_columns *columns, FILE *stream)
{
  (void)fprintf(stream, "%.17g", dvi_march_time(columns->march));
  for (int i = 0; i < columns->count; i++) (void)fprintf(stream, ",%.17g", columns->number[i]);
  (void)fputc('\n', stream);
}
