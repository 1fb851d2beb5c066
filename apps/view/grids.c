#include "view/grids.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"

/* Fields of a page unless they are named, and numbers of all frames together, at 5.4 bytes. */
enum { FIELDS_USUAL = 4, NUMBERS_MOST = 1 << 24 };

static int no_memory(void)
{
  complain("out of memory");
  return FAILED;
}

/* ---- the list ---- */

static bool add_file(grid_series *series, double time, const char *folder, size_t folder_length,
                     const char *name, size_t length)
{
  if (series->count == series->room) {
    const int room = 2 * series->room + 16;
    double *times = realloc(series->time, (size_t)room * sizeof *times);
    if (times != NULL) series->time = times;
    char **paths = times != NULL ? realloc(series->path, (size_t)room * sizeof *paths) : NULL;
    if (paths == NULL) return false;
    series->path = paths;
    series->room = room;
  }
  char *path = malloc(folder_length + length + 1);
  if (path == NULL) return false;
  memcpy(path, folder, folder_length);
  memcpy(path + folder_length, name, length);
  path[folder_length + length] = '\0';
  series->time[series->count] = time;
  series->path[series->count++] = path;
  return true;
}

/* Return the value of an attribute of a line, and its length, or NULL. */
static const char *attribute(const char *line, const char *start, size_t *length)
{
  const char *at = strstr(line, start);
  if (at == NULL) return NULL;
  at += strlen(start);
  *length = strcspn(at, "\"");
  return at[*length] == '"' ? at : NULL;
}

static bool add_line(grid_series *series, const char *path, const char *line)
{
  size_t digits = 0, length = 0;
  char word[64];
  double time;
  const char *when = attribute(line, " timestep=\"", &digits),
             *name = attribute(line, " file=\"", &length), *slash = strrchr(path, '/');
  if (when == NULL || name == NULL || digits >= sizeof word) return false;
  memcpy(word, when, digits);
  word[digits] = '\0';
  const size_t folder = slash != NULL && name[0] != '/' ? (size_t)(slash - path) + 1 : 0;
  return parse_number(word, &time) && add_file(series, time, path, folder, name, length);
}

/* List the times of a file that has all grids. */
static int open_stored(grid_series *series, const char *path)
{
  const hdf5_views_content *content = &series->stored.content;
  int code = stored_grids_open(&series->stored, path);
  for (int64_t k = 0; k < content->steps && code == DONE; k++)
    if (!add_file(series, content->time[k], "", 0, path, strlen(path))) code = no_memory();
  return code;
}

int grid_series_read(const char *path, grid_series *series)
{
  const char *ending = strrchr(path, '.');
  char line[4096];
  bool good = true, ended = false;
  *series = (grid_series){0};
  if (stored_grids_are_wanted(path)) return open_stored(series, path);
  if (ending == NULL || strcmp(ending, ".pvd") != 0)
    return add_file(series, 0, "", 0, path, strlen(path)) ? DONE : no_memory();
  FILE *stream = fopen(path, "r");
  while (stream != NULL && good && fgets(line, sizeof line, stream) != NULL) {
    if (strstr(line, "<DataSet") != NULL) good = add_line(series, path, line);
    ended = ended || strstr(line, "</VTKFile>") != NULL;
  }
  const int reason = errno;
  const bool read = stream != NULL && !ferror(stream);
  if (stream != NULL) (void)fclose(stream);
  if (!read) {
    complain("cannot read '%s': %s", path, strerror(reason));
    return FAILED;
  }
  if (good && ended && series->count > 0) return DONE;
  complain("%s: %s; dvi view reads the .pvd files that dvi has written", path,
           good && ended ? "it lists no grid" : "it is no list of grids, or it is cut short");
  return FAILED;
}

void grid_series_clear(grid_series *series)
{
  for (int k = 0; k < series->count; k++) free(series->path[k]);
  free(series->path);
  free(series->time);
  stored_grids_close(&series->stored);
  *series = (grid_series){0};
}

/* ---- the frames ---- */

static int choose_fields(grid_frames *g, const char *path, int names, const char *const *name)
{
  const vtu_grid *first = &g->first;
  for (int k = 0; k < names; k++) {
    const vtu_field *field = vtu_find(first, name[k]);
    if (field == NULL && first->fields > 0)
      return usage_error("view: %s has no field '%s' among %d, of which '%s' is the first", path,
                         name[k], first->fields, first->field[0].name);
    if (field != NULL) g->field[g->fields++] = (int)(field - first->field);
  }
  for (int k = 0; names == 0 && k < first->fields && k < FIELDS_USUAL; k++)
    g->field[g->fields++] = k;
  return g->fields > 0 ? DONE : usage_error("view: the grid in %s has no fields", path);
}

static int64_t width_of(const grid_frames *g, int k)
{
  return g->first.field[g->field[k]].is_by_cell ? g->first.cells : g->first.points;
}

/* Return how many frames a page has room for. */
static int frames_with_room(const grid_frames *g, int frames)
{
  int64_t width = g->moves ? 3 * g->first.points : 0;
  for (int k = 0; k < g->fields; k++) width += width_of(g, k);
  const int64_t most = NUMBERS_MOST / (width > 0 ? width : 1);
  return most >= frames ? frames : most > 1 ? (int)most : 1;
}

static bool take_room(grid_frames *g)
{
  const size_t frames = (size_t)g->frames, places = g->moves ? frames : 1;
  g->point = calloc(places * (size_t)g->first.points * 3 + 1, sizeof *g->point);
  bool good = g->point != NULL;
  for (int k = 0; k < g->fields && good; k++) {
    g->value[k] = calloc(frames * (size_t)width_of(g, k) + 1, sizeof *g->value[k]);
    good = g->value[k] != NULL;
  }
  return good;
}

static bool copy(float *to, const double *from, int64_t count)
{
  bool finite = true;
  for (int64_t i = 0; i < count; i++) {
    to[i] = (float)from[i];
    finite = finite && isfinite(to[i]);
  }
  return finite;
}

static int refuse(const char *path, const char *reason)
{
  complain("%s: %s", path, reason);
  return FAILED;
}

/* Copy the values and the places of one grid, which must be as the first one. */
static int take_grid(grid_frames *g, int at, const vtu_grid *grid, const char *path)
{
  const vtu_grid *first = &g->first;
  if (grid->kind != first->kind || grid->points != first->points || grid->cells != first->cells ||
      memcmp(grid->vertex, first->vertex,
             (size_t)(grid->cells * grid->corners) * sizeof *grid->vertex) != 0)
    return refuse(path, "its cells are not those of the first grid");
  bool finite = true;
  if (g->moves || at == 0)
    finite = copy(g->point + (int64_t)at * grid->points * 3, grid->point, 3 * grid->points);
  for (int k = 0; k < g->fields; k++) {
    const vtu_field *wanted = &first->field[g->field[k]], *field = vtu_find(grid, wanted->name);
    if (field == NULL || field->is_by_cell != wanted->is_by_cell)
      return refuse(path, "its fields are not those of the first grid");
    finite = copy(g->value[k] + at * width_of(g, k), field->value, width_of(g, k)) && finite;
  }
  return finite ? DONE : refuse(path, "it has numbers that are not finite, or too large to draw");
}

static int read_grid(const grid_series *series, int k, vtu_grid *grid)
{
  return series->stored.file != NULL ? stored_grids_read(&series->stored, k, series->path[k], grid)
                                     : vtu_read(series->path[k], grid);
}

/* Tell whether the points of a later grid are not those of the first one. */
static int find_motion(grid_frames *g, const grid_series *series, int k)
{
  vtu_grid last;
  const int code = read_grid(series, k, &last);
  if (code == DONE)
    g->moves = last.points == g->first.points &&
               memcmp(last.point, g->first.point, (size_t)last.points * 3 * sizeof *last.point) !=
                   0;
  vtu_clear(&last);
  return code;
}

static int read_frames(grid_frames *g, const grid_series *series, const int *frame)
{
  int code = DONE;
  for (int k = 0; k < g->frames && code == DONE; k++) {
    vtu_grid grid;
    const char *path = series->path[frame[k]];
    code = read_grid(series, frame[k], &grid);
    if (code == DONE) code = take_grid(g, k, &grid, path);
    vtu_clear(&grid);
  }
  return code;
}

int grid_frames_read(const grid_series *series, int *frames, int *frame, int names,
                     const char *const *name, grid_frames *g)
{
  const viewpoint above = {.is_flat = true};
  const int given = *frames;
  memset(g, 0, sizeof *g);
  int code = read_grid(series, frame[0], &g->first);
  if (code == DONE) code = choose_fields(g, series->path[frame[0]], names, name);
  if (code == DONE && !skin_make(&g->first, &above, &g->surface)) code = FAILED;
  if (code == DONE) code = find_motion(g, series, frame[given - 1]);
  if (code != DONE) return code;
  g->frames = *frames = frames_with_room(g, given);
  for (int k = 1; k < *frames; k++)
    frame[k] = frame[(int)((int64_t)k * (given - 1) / (*frames - 1))];
  return take_room(g) ? read_frames(g, series, frame) : no_memory();
}

void grid_frames_clear(grid_frames *g)
{
  for (int k = 0; k < g->fields; k++) free(g->value[k]);
  free(g->point);
  skin_clear(&g->surface);
  vtu_clear(&g->first);
}

/* ---- the page ---- */

static void write_integers(page *p, const char *name, int64_t count, const int64_t *number)
{
  (void)fprintf(p->stream, ",\n\"%s\":", name);
  page_integers_begin(p);
  for (int64_t i = 0; i < count; i++) page_integer(p, number[i]);
  page_list_end(p);
}

/* Write lists of the corners of lines or triangles, and of the cells that these belong to. */
static void write_cells(const grid_frames *g, page *p)
{
  static const int half[2][3] = {{0, 1, 2}, {0, 2, 3}};
  if (g->first.kind == VTU_LINE) {
    write_integers(p, "corners", 2 * g->first.cells, g->first.vertex);
  } else {
    (void)fputs(",\n\"corners\":", p->stream);
    page_integers_begin(p);
    for (int64_t f = 0; f < g->surface.faces; f++)
      for (int h = 0; h < g->surface.face[f].corners - 2; h++)
        for (int k = 0; k < 3; k++) page_integer(p, g->surface.face[f].vertex[half[h][k]]);
    page_list_end(p);
  }
  (void)fputs(",\n\"cells\":", p->stream);
  page_integers_begin(p);
  for (int64_t c = 0; c < g->first.cells && g->first.kind == VTU_LINE; c++) page_integer(p, c);
  for (int64_t f = 0; f < g->surface.faces; f++)
    for (int h = 0; h < g->surface.face[f].corners - 2; h++)
      page_integer(p, g->surface.face[f].cell);
  page_list_end(p);
}

static void write_floats(page *p, int64_t count, const float *number)
{
  page_floats_begin(p);
  for (int64_t i = 0; i < count; i++) page_float(p, (double)number[i]);
  page_list_end(p);
}

void grid_frames_write(const grid_frames *g, page *p)
{
  (void)fprintf(p->stream, "{\"isLine\":%s,\"isFlat\":%s,\"moves\":%s,\"pointCount\":%lld",
                g->first.kind == VTU_LINE ? "true" : "false",
                skin_is_flat(&g->first) ? "true" : "false", g->moves ? "true" : "false",
                (long long)g->first.points);
  write_cells(g, p);
  (void)fputs(",\n\"points\":", p->stream);
  write_floats(p, (g->moves ? g->frames : 1) * g->first.points * 3, g->point);
  (void)fputs(",\n\"fields\":[", p->stream);
  for (int k = 0; k < g->fields; k++) {
    const vtu_field *field = &g->first.field[g->field[k]];
    (void)fputs(k > 0 ? ",\n{\"name\":" : "\n{\"name\":", p->stream);
    page_text(p, field->name);
    (void)fprintf(p->stream, ",\"isByCell\":%s,\"values\":", field->is_by_cell ? "true" : "false");
    write_floats(p, g->frames * width_of(g, k), g->value[k]);
    (void)fputs("}", p->stream);
  }
  (void)fputs("]}", p->stream);
}

bool grid_frames_are_flat(const grid_frames *g)
{
  return skin_is_flat(&g->first);
}
