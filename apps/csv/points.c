#include "csv/points.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/options.h"
#include "csv/rows.h"

void points_clear(points *list)
{
  free(list->t);
  free(list->q);
  *list = (points){0};
}

static bool points_grow(points *to, int n)
{
  if (to->count < to->capacity) return true;
  if (to->capacity > INT_MAX / 2) return complain("%d points are too many", to->count + 1), false;
  const int capacity = to->capacity > 0 ? 2 * to->capacity : 64;
  double *t = realloc(to->t, (size_t)capacity * sizeof *t);
  if (t != NULL) to->t = t;
  double *q = t != NULL ? realloc(to->q, (size_t)capacity * (size_t)n * sizeof *q) : NULL;
  if (q != NULL) to->q = q;
  if (q == NULL) complain("out of memory for %d points", capacity);
  to->capacity = q != NULL ? capacity : to->capacity;
  return q != NULL;
}

bool points_add(points *to, int n, double t, const double *q)
{
  if (!points_grow(to, n)) return false;
  to->t[to->count] = t;
  memcpy(to->q + (size_t)to->count++ * (size_t)n, q, (size_t)n * sizeof *q);
  return true;
}

/* ---- lists ---- */

int list_read(const char *where, const char *text, const problem *scene, double *number)
{
  char field[FIELD_SIZE];
  int count = 0;
  while (text != NULL) {
    double read;
    rows_field(&text, field);
    if (!parse_number(field, &read)) return usage_error("%s: '%s' is no number", where, field);
    if (count < scene->nq) number[count] = read;
    count++;
  }
  if (count == scene->nq) return DONE;
  return usage_error("%s has %d number%s; %s has %d coordinate%s", where, count,
                     count == 1 ? "" : "s", scene->name, scene->nq, scene->nq == 1 ? "" : "s");
}

/* ---- files ---- */

/* A CSV file being read. */
typedef struct reader {
  row_file file;
  const problem *scene;
  int columns;
  /* [columns] coordinate of each column, -1 for t, -2 for a column that is skipped */
  int *coordinate;
  bool *seen; /* [1+n] t, then the coordinates */
  double *q;  /* [n] point of the row */
} reader;

static int coordinate_of_title(const problem *scene, const char *title)
{
  if (strcmp(title, "t") == 0) return -1;
  for (int i = 0; i < scene->nq; i++)
    if (strcmp(title, scene->coordinate[i]) == 0) return i;
  return -2;
}

static int points_read_header(reader *r)
{
  char title[FIELD_SIZE];
  int known = 0;
  if (!rows_next(&r->file))
    return rows_complete(&r->file) ? usage_error("path: '%s' is empty", r->file.path) : FAILED;
  for (const char *text = r->file.line; text != NULL; r->columns++) {
    int *grown = realloc(r->coordinate, ((size_t)r->columns + 1) * sizeof *grown);
    if (grown == NULL) return complain("out of memory"), FAILED;
    r->coordinate = grown;
    rows_field(&text, title);
    const int coordinate = r->coordinate[r->columns] = coordinate_of_title(r->scene, title);
    if (coordinate < -1) continue;
    if (r->seen[1 + coordinate])
      return usage_error("path: '%s' has two columns '%s'; one for each coordinate is needed",
                         r->file.path, title);
    r->seen[1 + coordinate] = true;
    known++;
  }
  if (known == r->scene->nq + 1) return DONE;
  return usage_error(
      "path: '%s' has %d of the %d columns t and coordinates of %s, as dvi run writes them",
      r->file.path, known, r->scene->nq + 1, r->scene->name);
}

static int points_read_row(reader *r, points *read)
{
  char field[FIELD_SIZE];
  double t = 0.0;
  int column = 0;
  const char *text = r->file.line;
  for (; text != NULL && column < r->columns; column++) {
    rows_field(&text, field);
    const int coordinate = r->coordinate[column];
    if (coordinate >= -1 && !parse_number(field, coordinate == -1 ? &t : &r->q[coordinate]))
      return usage_error("path: '%s': line %d: '%s' is no number", r->file.path, r->file.row,
                         field);
  }
  if (text != NULL || column < r->columns)
    return usage_error("path: '%s': line %d does not have the header's %d fields", r->file.path,
                       r->file.row, r->columns);
  if (read->count > 0 && !(t > read->t[read->count - 1]))
    return usage_error("path: '%s': line %d: the time %g does not come after %g", r->file.path,
                       r->file.row, t, read->t[read->count - 1]);
  return points_add(read, r->scene->nq, t, r->q) ? DONE : FAILED;
}

static int points_read_all(reader *r, points *read)
{
  int code = points_read_header(r);
  while (code == DONE && rows_next(&r->file)) code = points_read_row(r, read);
  if (code == DONE && !rows_complete(&r->file)) code = FAILED;
  if (code == DONE && read->count < 2)
    code = usage_error("path: '%s' has %d points; at least 2 are needed", r->file.path,
                       read->count);
  return code;
}

int points_read(const char *path, const problem *scene, points *read)
{
  const size_t n = (size_t)scene->nq;
  reader r = {.scene = scene, .q = calloc(n, sizeof(double)), .seen = calloc(n + 1, sizeof(bool))};
  const bool good = r.q != NULL && r.seen != NULL;
  if (!good) complain("out of memory");
  int code = good && rows_open(&r.file, path) ? rows_of_run("path", &r.file) : FAILED;
  if (code == DONE) code = points_read_all(&r, read);
  rows_close(&r.file);
  free(r.seen);
  free(r.coordinate);
  free(r.q);
  return code;
}
