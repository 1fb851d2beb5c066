#include "view/places.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"
#include "load/catalogue.h"

/* Difference of two starts by rounding. */
static const double SAME_START = 1e-12;

static int no_memory(void)
{
  complain("out of memory");
  return FAILED;
}

/* Add a column for a number of a point. Returns it, or NULL without memory. */
static double *add_column(const dvi_scene_point *point, int k, series_table *table)
{
  char name[FIELD_SIZE];
  if (snprintf(name, sizeof name, "%s_%c", point->name, "xyz"[k]) >= (int)sizeof name) return NULL;
  const int columns = table->columns, at = series_want(table, name);
  if (at < 0) return NULL;
  double *value = calloc((size_t)table->capacity + 1, sizeof *value);
  if (at < columns) free(table->column[at].value); /* the file has it, perhaps of fewer digits */
  table->column[at].value = value;
  return value;
}

/* Evaluate a point at all rows. q [nq] is work. Numbers that cannot be had are NaN. */
static bool add_point(const problem *scene, const dvi_scene_point *point, const int *column,
                      series_table *table, double *q)
{
  double *x[3] = {NULL};
  for (int k = 0; k < point->size; k++)
    if ((x[k] = add_column(point, k, table)) == NULL) return false;
  int time = 0;
  while (strcmp(table->column[time].name, "t") != 0) time++;
  for (int row = 0; row < table->rows; row++) {
    for (int i = 0; i < scene->nq; i++) q[i] = table->column[column[i]].value[row];
    const double t = table->column[time].value[row];
    for (int k = 0; k < point->size; k++)
      if (point->value(t, q, NULL, &x[k][row], point->user[k]) != 0) x[k][row] = (double)NAN;
  }
  return true;
}

static bool is_wanted(const words *names, const char *name)
{
  bool wanted = names->count == 0;
  for (int k = 0; k < names->count; k++) wanted = wanted || strcmp(names->word[k], name) == 0;
  return wanted;
}

/* The names of a scene's points. */
static const char *point_name_at(int k, const void *list)
{
  dvi_scene_point point;
  return dvi_scene_point_of((dvi_scene *)list, k, &point) == DVI_OK ? point.name : NULL;
}

static bool has_point(const dvi_scene *expressions, const char *name)
{
  const char *known = NULL;
  int i = 0;
  do {
    known = expressions != NULL ? point_name_at(i++, expressions) : NULL;
  } while (known != NULL && strcmp(known, name) != 0);
  return known != NULL;
}

static int check_names(const problem *scene, const dvi_scene *expressions, const words *names)
{
  char near[2 * FIELD_SIZE] = "";
  for (int k = 0; k < names->count; k++) {
    const char *name = names->word[k];
    if (has_point(expressions, name)) continue;
    if (expressions != NULL) (void)suggestion(name, point_name_at, expressions, near, sizeof near);
    return usage_error(
        "view: --point %s: %s has no definition of this name with 2 or 3 numbers, of "
        "coordinates alone%s",
        name, scene->name, near);
  }
  return DONE;
}

/* ---- scenes of the catalogue ---- */

static bool starts_alike(const problem *scene, const dvi_scene *other)
{
  const double *q, *v, *p;
  dvi_scene_start(other, &q, &v, &p);
  bool alike = q != NULL && dvi_system_nq(dvi_scene_system(other)) == scene->nq;
  for (int i = 0; i < scene->nq && alike; i++)
    alike = fabs(q[i] - scene->q[i]) <= SAME_START * fmax(1, fabs(q[i]));
  return alike;
}

dvi_scene *places_scene(const problem *scene, const words *settings, dvi_scene **made)
{
  *made = NULL;
  if (scene->scene != NULL) return scene->scene;
  for (const catalogue_text *at = catalogue_texts; at->name != NULL && *made == NULL; at++)
    if (strcmp(at->name, scene->name) == 0)
      (void)dvi_scene_parse(at->name, at->text, at->length, settings->count, settings->word, made,
                            NULL, 0);
  if (*made != NULL && !starts_alike(scene, *made)) dvi_scene_destroy(made);
  return *made;
}

/* ---- all points ---- */

int places_add(const problem *scene, dvi_scene *expressions, const words *names, const int *column,
               series_table *table, int *first)
{
  dvi_scene_point point;
  const int code = check_names(scene, expressions, names);
  *first = table->columns;
  if (code != DONE || expressions == NULL) return code;
  double *q = calloc((size_t)scene->nq + 1, sizeof *q);
  bool good = q != NULL;
  for (int i = 0; good && dvi_scene_point_of(expressions, i, &point) == DVI_OK; i++)
    if (is_wanted(names, point.name)) good = add_point(scene, &point, column, table, q);
  free(q);
  return good ? DONE : no_memory();
}
