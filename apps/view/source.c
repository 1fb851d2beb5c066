#include "view/source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "view/links.h"
#include "view/moments.h"

static int no_memory(void)
{
  complain("out of memory");
  return FAILED;
}

/* ---- tables ---- */

static int find_column(const series_table *table, const char *name, int from)
{
  for (int k = 0; k < table->columns; k++) {
    const int at = (from + k) % table->columns;
    if (strncmp(table->column[at].name, name, FIELD_SIZE - 1) == 0) return at;
  }
  return -1;
}

/* Return whether a file ends within a line, as one that was cut short does. */
static bool is_cut_short(const char *path)
{
  FILE *stream = strcmp(path, "-") != 0 ? fopen(path, "rb") : NULL;
  const bool cut = stream != NULL && fseek(stream, -1, SEEK_END) == 0 && fgetc(stream) != '\n';
  if (stream != NULL) (void)fclose(stream);
  return cut;
}

static int read_table(view_source *s, const char *path)
{
  const int code = series_read("view", path, &s->table);
  if (code != DONE) return code;
  const int time = find_column(&s->table, "t", 0);
  if (time < 0 || strcmp(s->table.column[time].name, "t") != 0)
    return usage_error("view: '%s' has no column 't', the time; dvi run writes it", path);
  if (s->table.rows == 0) return usage_error("view: '%s' has a header and no rows", path);
  s->run.table = &s->table;
  s->run.time = s->table.column[time].value;
  for (int k = 0; k < s->table.columns; k++)
    if (isnan(s->table.column[k].value[s->table.rows - 1]) && is_cut_short(path)) {
      complain("view: '%s' was cut short: its last row has no number in column '%s'", path,
               s->table.column[k].name);
      return FAILED;
    }
  for (int row = 0; row < s->table.rows; row++)
    if (!isfinite(s->run.time[row])) {
      complain("view: row %d of '%s' has no time", row + 1, path);
      return FAILED;
    }
  return DONE;
}

/* ---- the coordinates ---- */

/* Names of momenta, velocities and angular velocities begin with these. */
static bool is_of_velocity(const char *name)
{
  static const char *const start[] = {"p_", "v_", "omega_", "rate_", "Omega", "Pi"};
  for (size_t k = 0; k < sizeof start / sizeof *start; k++)
    if (strncmp(name, start[k], strlen(start[k])) == 0) return true;
  return false;
}

static bool take_name(view_source *s, const char *name, int column)
{
  s->name[s->names] = name;
  s->column[s->names++] = column;
  return true;
}

/* Take the coordinates of the scene, all of which the file must have. */
static int take_coordinates(view_source *s, const char *path)
{
  int column = 0;
  for (int i = 0; i < s->scene->nq; i++) {
    const char *name = s->scene->coordinate[i];
    column = find_column(&s->table, name, column + (i > 0));
    if (column < 0)
      return usage_error("view: '%s' has no column '%s', a coordinate of %s", path, name,
                         s->scene->name);
    (void)take_name(s, name, column);
  }
  /* a single number is drawn beside its momentum */
  const int momentum = s->scene->nq == 1 ? find_column(&s->table, s->scene->momentum[0], 0) : -1;
  if (momentum >= 0) (void)take_name(s, s->scene->momentum[0], momentum);
  return DONE;
}

/* Take the columns before the first momentum or velocity. A single number takes that one along. */
static void guess_coordinates(view_source *s)
{
  for (int k = 0; k < s->table.columns; k++) {
    const char *name = s->table.column[k].name;
    if (strcmp(name, "t") == 0) continue;
    if (strcmp(name, "energy") == 0 || (is_of_velocity(name) && s->names != 1)) break;
    (void)take_name(s, name, k);
    if (is_of_velocity(name)) break;
  }
}

static const char *name_at(int k, const void *list)
{
  const view_source *s = list;
  return k < s->names ? s->name[k] : NULL;
}

/* ---- curves ---- */

static bool is_named(int count, char *const *list, const char *name)
{
  for (int i = 0; i < count; i++)
    if (strncmp(list[i], name, FIELD_SIZE - 1) == 0) return true;
  return false;
}

/* Return whether a column belongs to the state. */
static bool is_of_state(const view_source *s, int column)
{
  const char *name = s->table.column[column].name;
  const problem *scene = s->scene;
  if (strcmp(name, "t") == 0) return true;
  for (int i = 0; i < s->names && s->layout.owner != NULL; i++)
    if (s->column[i] == column && s->layout.owner[i] != VIEW_NONE) return true;
  for (int k = 0; k < s->layout.bodies; k++)
    for (int e = 0; e < 9; e++)
      if (s->column[s->layout.body[k].rotation + e] == column) return true;
  if (scene == NULL || scene->coordinate == NULL) return is_of_velocity(name);
  return is_named(scene->nq, scene->coordinate, name) ||
         is_named(scene->nv, scene->momentum, name) ||
         (scene->velocity != NULL && is_named(scene->nv, scene->velocity, name));
}

static void choose_curves(view_source *s)
{
  for (int k = 0; k < s->table.columns && s->run.curves < VIEW_CURVES; k++)
    if (!is_of_state(s, k)) s->run.curve[s->run.curves++] = k;
}

/* ---- runs ---- */

int view_source_rows(view_source *s, const char *path, long frames)
{
  int code = read_table(s, path);
  if (code != DONE) return code;
  const size_t room = (size_t)s->table.columns + (s->scene != NULL ? (size_t)s->scene->nq : 0) + 2;
  s->name = calloc(room, sizeof *s->name);
  s->column = calloc(room, sizeof *s->column);
  if (s->name == NULL || s->column == NULL) return no_memory();
  if (s->scene != NULL)
    code = take_coordinates(s, path);
  else
    guess_coordinates(s);
  if (code != DONE) return code;
  if (s->names == 0) return usage_error("view: '%s' has no coordinates behind t", path);
  if (!layout_find(s->names, name_at, s, &s->layout)) return FAILED;
  if (s->scene != NULL) {
    moments_find(s->scene, &s->layout);
    if (!links_find(s->scene, &s->layout)) return FAILED;
  }
  choose_curves(s);
  s->run.layout = &s->layout;
  s->run.column = s->column;
  s->run.frames = view_thin(s->table.rows, frames, &s->run.row);
  return s->run.frames > 0 ? DONE : no_memory();
}

int view_source_grids(view_source *s, const char *path, const char *rows, long frames, int fields,
                      const char *const *field)
{
  int code = grid_series_read(path, &s->series);
  if (code == DONE && rows != NULL) code = read_table(s, rows);
  if (code != DONE) return code;
  if (rows != NULL && s->table.rows != s->series.count)
    return usage_error("view: '%s' has %d rows, and '%s' %d grids; dvi run writes a grid for each "
                       "row",
                       rows, s->table.rows, path, s->series.count);
  s->run.frames = view_thin(s->series.count, frames, &s->run.row);
  if (s->run.frames == 0) return no_memory();
  code = grid_frames_read(&s->series, &s->run.frames, s->run.row, fields, field, &s->grids);
  if (code != DONE) return code;
  if (rows != NULL) choose_curves(s);
  s->run.time = s->series.time;
  s->run.grids = &s->grids;
  return DONE;
}

void view_source_clear(view_source *s)
{
  problem_destroy(&s->scene);
  series_clear(&s->table);
  grid_series_clear(&s->series);
  grid_frames_clear(&s->grids);
  layout_clear(&s->layout);
  free(s->name);
  free(s->column);
  free(s->run.row);
}
