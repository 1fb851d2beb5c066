#include "view/source.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "module/store.h"
#include "view/factors.h"
#include "view/links.h"
#include "view/moments.h"
#include "view/places.h"

/* Distances that change by less are those of rods. More points than these have no such links. */
static const double RIGID = 1e-6;
enum { RIGID_MOST = 32 };

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

/* Return whether a file of lines ends within one, as one that was cut short does. */
static bool is_cut_short(const char *path)
{
  const bool has_lines = strcmp(path, "-") != 0 && !store_is_wanted(path);
  FILE *stream = has_lines ? fopen(path, "rb") : NULL;
  const bool cut = stream != NULL && fseek(stream, -1, SEEK_END) == 0 && fgetc(stream) != '\n';
  if (stream != NULL) (void)fclose(stream);
  return cut;
}

static int read_table(view_source *s, const char *path)
{
  s->table.of_run = true;
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

/* ---- points of definitions ---- */

/* Return whether coordinates show where the system is in space: as points that are more than unit
 * vectors, or as a chain. */
static bool shows_places(const view_source *s)
{
  bool shows = s->layout.is_chain;
  for (int k = 0; k < s->layout.points && !s->layout.is_state; k++)
    shows = shows || !is_of_direction(s->scene, s->layout.point[k].from[0]);
  return shows;
}

/* Take the definitions' points in place of unit vectors. Bodies and points of coordinates stay. */
static int take_places(view_source *s, const words *settings, const words *points)
{
  int first;
  dvi_scene *made;
  dvi_scene *const expressions = places_scene(s->scene, settings, &made);
  const int code = places_add(s->scene, expressions, points, s->column, &s->table, &first);
  dvi_scene_destroy(&made);
  if (code != DONE || first == s->table.columns) return code;
  const size_t room = (size_t)s->names + (size_t)(s->table.columns - first) + 1;
  const char **name = realloc(s->name, room * sizeof *name);
  if (name != NULL) s->name = name;
  int *column = realloc(s->column, room * sizeof *column);
  if (column != NULL) s->column = column;
  if (name == NULL || column == NULL) return no_memory();
  for (int i = 0; i < s->scene->nq; i++)
    if (is_of_direction(s->scene, i)) s->name[i] = "";
  s->places = s->names;
  for (int k = first; k < s->table.columns; k++) (void)take_name(s, s->table.column[k].name, k);
  layout_clear(&s->layout);
  return layout_find(s->names, name_at, s, &s->layout) ? DONE : FAILED;
}

/* Return a place of a point at a row. */
static double place_at(const view_source *s, int point, int axis, int row)
{
  const int from = point != VIEW_NONE ? s->layout.point[point].from[axis] : VIEW_NONE;
  if (from != VIEW_NONE) return s->table.column[s->column[from]].value[row];
  return point != VIEW_NONE ? s->layout.point[point].fixed[axis] : 0;
}

/* Return whether two points stay at one distance, and turn about each other. */
static bool is_rigid(const view_source *s, int a, int b)
{
  double least = HUGE_VAL, most = 0, turned = 0;
  for (int row = 0; row < s->table.rows; row++) {
    double square = 0, change = 0;
    for (int k = 0; k < 3; k++) {
      const double d = place_at(s, b, k, row) - place_at(s, a, k, row);
      square += d * d;
      change = fmax(change, fabs(d - place_at(s, b, k, 0) + place_at(s, a, k, 0)));
    }
    least = fmin(least, sqrt(square));
    most = fmax(most, sqrt(square));
    turned = fmax(turned, change);
  }
  return most - least <= RIGID * most && turned > RIGID * most;
}

/* Link points of definitions, and the origin, that stay at one distance, as if by a rod. */
static bool link_rigid(view_source *s)
{
  const int points = s->layout.points;
  int first = 0;
  while (first < points && s->layout.point[first].from[0] < s->places) first++;
  for (int b = first; b < points && points <= first + RIGID_MOST; b++) {
    if (is_rigid(s, VIEW_NONE, b) && !layout_link(&s->layout, VIEW_NONE, b)) return false;
    for (int a = first; a < b; a++)
      if (is_rigid(s, a, b) && !layout_link(&s->layout, a, b)) return false;
  }
  return true;
}

/* ---- runs ---- */

/* Find what the coordinates of a scene mean, in space. */
static int lay_out_scene(view_source *s, const words *settings, const words *points)
{
  int code = DONE;
  moments_find(s->scene, &s->layout);
  if (points->count > 0 || !shows_places(s)) code = take_places(s, settings, points);
  if (code != DONE) return code;
  if (s->places == 0) return links_find(s->scene, &s->layout) ? DONE : FAILED;
  moments_find(s->scene, &s->layout);
  return link_rigid(s) ? DONE : no_memory();
}

int view_source_rows(view_source *s, const char *path, long frames, const words *settings,
                     const words *points)
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
  if (s->scene != NULL) code = lay_out_scene(s, settings, points);
  if (code != DONE) return code;
  choose_curves(s);
  s->run.layout = &s->layout;
  s->run.column = s->column;
  s->run.time = s->table.column[find_column(&s->table, "t", 0)].value;
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
