#include "view/places.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"

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

static bool has_point(const problem *scene, const char *name)
{
  const char *known = NULL;
  int i = 0;
  do {
    known = scene->scene != NULL ? point_name_at(i++, scene->scene) : NULL;
  } while (known != NULL && strcmp(known, name) != 0);
  return known != NULL;
}

static int check_names(const problem *scene, const words *names)
{
  char near[2 * FIELD_SIZE] = "";
  for (int k = 0; k < names->count; k++) {
    const char *name = names->word[k];
    if (has_point(scene, name)) continue;
    if (scene->scene != NULL)
      (void)suggestion(name, point_name_at, scene->scene, near, sizeof near);
    return usage_error(
        "view: --point %s: %s has no definition of this name with 2 or 3 numbers, of "
        "coordinates alone%s",
        name, scene->name, near);
  }
  return DONE;
}

int places_add(const problem *scene, const words *names, const int *column, series_table *table,
               int *first)
{
  dvi_scene_point point;
  const int code = check_names(scene, names);
  *first = table->columns;
  if (code != DONE || scene->scene == NULL) return code;
  double *q = calloc((size_t)scene->nq + 1, sizeof *q);
  bool good = q != NULL;
  for (int i = 0; good && dvi_scene_point_of(scene->scene, i, &point) == DVI_OK; i++)
    if (is_wanted(names, point.name)) good = add_point(scene, &point, column, table, q);
  free(q);
  return good ? DONE : no_memory();
}
