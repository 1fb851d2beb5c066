#include "watch/field_columns.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "csv/choice.h"
#include "load/density.h"

/* ---- what there is ---- */

/* Tell if the columns have what the scene's system watches, beside what a march observes. */
static bool has_state(const field_columns *c)
{
  return has_field(c->scene) && dvi_march_size(c->march, DVI_FORM_A) > 0;
}

/* Tell if one of the first columns has this name. */
static bool is_among(const field_columns *c, int first, const char *name)
{
  for (int i = 0; i < first; i++)
    if (c->all[i].name != NULL && strcmp(c->all[i].name, name) == 0) return true;
  return false;
}

/* Tell if a probe of a density takes the name of an observable. Marches on meshes know the probes
 * themselves. */
static bool is_probe(const field_columns *c, int invariants, const char *name)
{
  for (int i = 0; i < invariants && density_of(c->scene) != NULL; i++)
    if (strcmp(c->scene->terms->invariants[i].name, name) == 0) return true;
  return false;
}

static bool list_all(field_columns *c)
{
  int observables = 0;
  const char *name;
  const int invariants = has_state(c) ? c->scene->terms->invariant_count : 0;
  while (dvi_march_observable(c->march, observables) != NULL) observables++;
  c->all = calloc((size_t)(observables + invariants) + 1, sizeof *c->all);
  if (c->all == NULL) return false;
  for (int i = 0; (name = dvi_march_observable(c->march, i)) != NULL; i++)
    if (!is_probe(c, invariants, name)) c->all[c->there++] = (field_column){name, i, -1};
  for (int i = 0; i < invariants; i++) {
    name = c->scene->terms->invariants[i].name;
    if (!is_among(c, c->there, name)) c->all[c->there++] = (field_column){name, -1, i};
  }
  return true;
}

static const char *name_at(int k, const void *list)
{
  const field_columns *c = list;
  return k < c->there ? c->all[k].name : NULL;
}

/* ---- what is shown ---- */

/* The laws of charge take a look at the whole field, and are shown when they are asked for, as the
 * parts of the energy. */
static bool is_usual(const char *name)
{
  static const char *const on_demand[] = {"gauss",     "charge",      "divergence", "kinetic",
                                          "potential", "interaction", "stored",     "load",
                                          "growth",    "hits"};
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

/* Momenta of a wave are those of mechanical methods, which the scene wants without being told.
 * Marches of solids observe theirs. */
static bool is_momentum(const field_columns *c, const char *name)
{
  const problem *scene = c->scene;
  if (is_among(c, c->there, name)) return false;
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
    if (!is_momentum(c, c->scene->column[i])) code = choice_add(&choice, c->scene->column[i]);
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
  if (good && has_state(columns))
    columns->state = calloc(2 * (size_t)field_unknowns(scene), sizeof *columns->state);
  if (!good || !columns->column || !columns->place || !columns->number ||
      (has_state(columns) && !columns->state)) {
    complain("out of memory");
    return FAILED;
  }
  const bool is_told = scene->column != NULL && (density_of(scene) == NULL ||
                                                 !dvi_scene_plan_of(scene->scene)->usual_columns);
  if (asked != NULL || is_told) return choose_named(columns, asked);
  choose_usual(columns);
  return DONE;
}

void field_columns_clear(field_columns *columns)
{
  free(columns->all);
  free(columns->column);
  free(columns->place);
  free(columns->number);
  free(columns->state);
}

/* ---- rows ---- */

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
  double *const q = columns->state, *const p = q != NULL ? q + field_unknowns(columns->scene)
                                                         : NULL;
  bool needs_state = false;
  for (int i = 0; i < columns->count; i++)
    needs_state = needs_state || columns->column[i].invariant >= 0;
  const dvi_status status = needs_state
                                ? dvi_scene_march_state(columns->scene->scene, columns->march, q, p)
                                : DVI_OK;
  if (status != DVI_OK) return library_error(status) == DONE;
  for (int i = 0; i < columns->count; i++)
    if (!measure(columns, i, q, p)) return false;
  return true;
}

void field_columns_row(const field_columns *columns, double *row)
{
  row[0] = dvi_march_time(columns->march);
  for (int i = 0; i < columns->count; i++) row[i + 1] = columns->number[i];
}
