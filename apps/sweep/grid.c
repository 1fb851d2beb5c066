#include "sweep/grid.h"

#include <dvi/number.h>
#include <dvi/scene.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/spelling.h"

/* Limit beyond which the rows of a sweep would not fit into memory. */
enum { POINTS_MAX = 10000000, HINT_SIZE = 128 };

/* ---- options ---- */

static bool axis_allocate(grid_axis *axis, long count)
{
  axis->count = count;
  axis->value = calloc((size_t)count, sizeof *axis->value);
  if (axis->value == NULL) complain("out of memory");
  return axis->value != NULL;
}

/* Read the number that ends with the character `stop`. Returns the text after it, or NULL if there
 * is no number. */
static const char *take_number(const char *text, char stop, double *number)
{
  if (text == NULL) return NULL;
  const char *end = dvi_number_read(text, number);
  return end != text && *end == stop && isfinite(*number) ? end + 1 : NULL;
}

/* Read FROM:TO:COUNT, both ends included. */
static int axis_read_range(const char *setting, const char *text, grid_axis *axis)
{
  double from = 0.0, to = 0.0, count = 0.0;
  text = take_number(take_number(take_number(text, ':', &from), ':', &to), '\0', &count);
  if (text == NULL || !(count >= 2.0 && count <= POINTS_MAX) || floor(count) < count)
    return usage_error(
        "sweep: --set %s: two numbers and a count from 2 to %d are wanted, FROM:TO:COUNT", setting,
        (int)POINTS_MAX);
  if (!isfinite((to - from) * count))
    return usage_error("sweep: --set %s: the range is too wide", setting);
  if (!axis_allocate(axis, (long)count)) return FAILED;
  (void)dvi_study_range(from, to, axis->count, axis->value);
  return DONE;
}

static int axis_read_list(const char *setting, const char *text, grid_axis *axis)
{
  const size_t room = GRID_SETTING_SIZE - 1 - strlen(axis->name) - 1;
  axis->list = text;
  if (strpbrk(text, "\r\n\"") != NULL)
    return usage_error("sweep: --set %s: values stand on one line, without quotes", setting);
  for (const char *at = text; at != NULL; axis->count++) {
    const size_t length = strcspn(at, ",");
    if (length == 0) return usage_error("sweep: --set %s: a value is missing", setting);
    if (length > room) return usage_error("sweep: --set %s: a value is too long", setting);
    at = at[length] == ',' ? at + length + 1 : NULL;
  }
  return DONE;
}

static int find_axis(const grid *in, const char *name)
{
  for (int i = 0; i < in->axes; i++)
    if (strcmp(in->axis[i].name, name) == 0) return i;
  return -1;
}

static int read_axis(const char *setting, grid *read)
{
  const size_t length = strcspn(setting, "=");
  grid_axis axis = {.count = 0};
  if (setting[length] != '=' || length == 0)
    return usage_error("sweep: --set wants NAME=VALUES, not '%s'", setting);
  if (length >= GRID_SETTING_SIZE / 2)
    return usage_error("sweep: --set %s: the name is too long", setting);
  (void)snprintf(axis.name, sizeof axis.name, "%.*s", (int)length, setting);
  if (find_axis(read, axis.name) >= 0) return usage_error("sweep: --set names %s twice", axis.name);
  const char *values = setting + length + 1;
  const int code = strchr(values, ':') != NULL ? axis_read_range(setting, values, &axis)
                                               : axis_read_list(setting, values, &axis);
  if (code == DONE) read->axis[read->axes++] = axis;
  return code;
}

int grid_read(const words *settings, grid *read)
{
  int code = DONE;
  for (int i = 0; i < settings->count && code == DONE; i++)
    code = read_axis(settings->word[i], read);
  return code;
}

/* ---- points ---- */

static void axis_spell(const grid_axis *axis, long k, char *text, size_t size)
{
  if (axis->list == NULL) {
    char number[DVI_NUMBER_SIZE];
    dvi_number_write(axis->value[k], number);
    (void)snprintf(text, size, "%s", number);
    return;
  }
  const char *at = axis->list;
  for (; k > 0; k--) at += strcspn(at, ",") + 1;
  (void)snprintf(text, size, "%.*s", (int)strcspn(at, ","), at);
}

static void point_set_axis(const grid_axis *axis, long k, grid_point *point)
{
  char *text = point->text[point->settings.count];
  const int length = snprintf(text, GRID_SETTING_SIZE, "%s=", axis->name);
  axis_spell(axis, k, text + length, (size_t)(GRID_SETTING_SIZE - length));
  point->settings.word[point->settings.count++] = text;
}

void grid_fixed(const grid *of, grid_point *point)
{
  point->settings.count = 0;
  for (int i = 0; i < of->axes; i++)
    if (of->axis[i].count == 1) point_set_axis(&of->axis[i], 0, point);
}

void grid_at(const grid *of, const int64_t *index, grid_point *point)
{
  point->settings.count = 0;
  for (int i = 0; i < of->axes; i++) point_set_axis(&of->axis[i], (long)index[i], point);
}

/* ---- with the problem ---- */

static const char *grid_parameter_at(int k, const void *list)
{
  return ((const problem_parameter *)list)[k].name;
}

static int refuse_unknown_parameter(const problem *scene, const char *name)
{
  char hint[HINT_SIZE];
  for (const problem_parameter *p = scene->parameter; p->name != NULL; p++)
    if (strcmp(p->name, name) == 0) return DONE;
  return usage_error("sweep: %s has no parameter '%s' that could be set%s", scene->name, name,
                     suggestion(name, grid_parameter_at, scene->parameter, hint, sizeof hint));
}

static int axis_take_range(const dvi_scene_range *range, grid_axis *axis)
{
  if (strlen(range->name) >= GRID_SETTING_SIZE / 2)
    return usage_error("sweep: the name '%s' is too long", range->name);
  (void)snprintf(axis->name, sizeof axis->name, "%s", range->name);
  if (!axis_allocate(axis, range->count)) return FAILED;
  memcpy(axis->value, range->value, (size_t)range->count * sizeof *range->value);
  return DONE;
}

/* Make the scene's range axis i, or the range of the options with its name. */
static int place_range(const dvi_scene_range *range, int i, grid *all)
{
  int at = find_axis(all, range->name);
  if (at < 0) {
    if (all->axes == WORDS_MAX)
      return usage_error("sweep: more than %d parameters", (int)WORDS_MAX);
    const int code = axis_take_range(range, &all->axis[all->axes]);
    if (code != DONE) return code;
    at = all->axes++;
  }
  const grid_axis placed = all->axis[at];
  memmove(&all->axis[i + 1], &all->axis[i], (size_t)(at - i) * sizeof placed);
  all->axis[i] = placed;
  return DONE;
}

int grid_complete(const problem *scene, grid *all)
{
  const dvi_scene_range *range;
  int code = DONE;
  for (int i = 0; scene->scene != NULL && code == DONE &&
                  (range = dvi_scene_range_at(scene->scene, i)) != NULL;
       i++)
    code = place_range(range, i, all);
  for (int i = 0; i < all->axes && code == DONE; i++)
    code = refuse_unknown_parameter(scene, all->axis[i].name);
  if (code != DONE) return code;
  if (all->axes == 0)
    return usage_error(
        "sweep: nothing to sweep over; give --set NAME=V1,V2,.. or NAME=FROM:TO:COUNT");
  for (int i = 0; i < all->axes; i++)
    all->study[i] = (dvi_study_axis){.count = all->axis[i].count, .value = all->axis[i].value};
  const int64_t points = dvi_study_points(all->axes, all->study);
  if (points < 0 || points > POINTS_MAX)
    return usage_error("sweep: more than %d points", (int)POINTS_MAX);
  all->points = (long)points;
  return DONE;
}

void grid_clear(grid *old)
{
  for (int i = 0; i < old->axes; i++) free(old->axis[i].value);
  *old = (grid){.axes = 0};
}
