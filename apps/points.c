#include "points.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "options.h"

enum { WORD_SIZE = 64, LINE_START = 256 };

void points_clear(points *list)
{
  free(list->t);
  free(list->q);
  *list = (points){0};
}

static bool make_room(points *to, int n)
{
  if (to->count < to->capacity) return true;
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
  if (!make_room(to, n)) return false;
  to->t[to->count] = t;
  memcpy(to->q + (size_t)to->count++ * (size_t)n, q, (size_t)n * sizeof *q);
  return true;
}

/* ---- lists ---- */

/* The next field of a line; *text moves behind its comma, or becomes NULL at the end. */
static void take_field(const char **text, char *field)
{
  const size_t length = strcspn(*text, ",\r\n");
  (void)snprintf(field, WORD_SIZE, "%.*s", (int)length, *text);
  *text = (*text)[length] == ',' ? *text + length + 1 : NULL;
}

int list_read(const char *where, const char *text, const problem *scene, double *number)
{
  char field[WORD_SIZE];
  int count = 0;
  while (text != NULL) {
    double read;
    take_field(&text, field);
    if (!parse_number(field, &read)) return usage_error("%s: '%s' is no number", where, field);
    if (count < scene->nq) number[count] = read;
    count++;
  }
  if (count == scene->nq) return DONE;
  return usage_error("%s has %d number%s; %s has %d coordinate%s", where, count, count == 1 ? "" : "s", scene->name, scene->nq,
                     scene->nq == 1 ? "" : "s");
}

/* ---- files ---- */

/* A CSV file being read. */
typedef struct reader {
  const char *path;
  const problem *scene;
  FILE *stream;
  char *line;
  size_t size;
  int row;
  int columns;
  int *coordinate; /* [columns] of each column: -1 for t, -2 for one that is passed over */
  double *q;       /* [n] the row's point */
} reader;

/* The next line, however long. False at the end. */
static bool next_line(reader *r)
{
  size_t length = 0;
  while (true) {
    if (length + 1 >= r->size) {
      const size_t size = r->size > 0 ? 2 * r->size : LINE_START;
      char *line = realloc(r->line, size);
      if (line == NULL) return false;
      r->line = line;
      r->size = size;
    }
    if (fgets(r->line + length, (int)(r->size - length), r->stream) == NULL) break;
    length += strlen(r->line + length);
    if (r->line[length - 1] == '\n') break;
  }
  r->row++;
  return length > 0;
}

static int unreadable(const char *path)
{
  complain("cannot read '%s': %s", path, strerror(errno));
  return FAILED;
}

static int column_of(const problem *scene, const char *title)
{
  if (strcmp(title, "t") == 0) return -1;
  for (int i = 0; i < scene->nq; i++)
    if (strcmp(title, scene->coordinate[i]) == 0) return i;
  return -2;
}

static int read_header(reader *r)
{
  char title[WORD_SIZE];
  int known = 0;
  if (!next_line(r)) return ferror(r->stream) ? unreadable(r->path) : usage_error("path: '%s' is empty", r->path);
  for (const char *text = r->line; text != NULL; r->columns++) {
    int *grown = realloc(r->coordinate, ((size_t)r->columns + 1) * sizeof *grown);
    if (grown == NULL) return complain("out of memory"), FAILED;
    r->coordinate = grown;
    take_field(&text, title);
    r->coordinate[r->columns] = column_of(r->scene, title);
    known += r->coordinate[r->columns] >= -1;
  }
  if (known == r->scene->nq + 1) return DONE;
  return usage_error("path: '%s' has %d of the %d columns t and coordinates of %s, as dvi run writes them", r->path, known,
                     r->scene->nq + 1, r->scene->name);
}

static int read_row(reader *r, points *read)
{
  char field[WORD_SIZE];
  double t = 0.0;
  int column = 0;
  const char *text = r->line;
  for (; text != NULL && column < r->columns; column++) {
    take_field(&text, field);
    const int coordinate = r->coordinate[column];
    if (coordinate >= -1 && !parse_number(field, coordinate == -1 ? &t : &r->q[coordinate]))
      return usage_error("path: '%s': line %d: '%s' is no number", r->path, r->row, field);
  }
  if (text != NULL || column < r->columns)
    return usage_error("path: '%s': line %d does not have the header's %d fields", r->path, r->row, r->columns);
  if (read->count > 0 && !(t > read->t[read->count - 1]))
    return usage_error("path: '%s': line %d: the time %g does not come after %g", r->path, r->row, t, read->t[read->count - 1]);
  return points_add(read, r->scene->nq, t, r->q) ? DONE : FAILED;
}

static int read_all(reader *r, points *read)
{
  int code = read_header(r);
  while (code == DONE && next_line(r)) code = read_row(r, read);
  if (code == DONE && ferror(r->stream)) code = unreadable(r->path);
  if (code == DONE && read->count < 2) code = usage_error("path: '%s' has %d points; at least 2 are needed", r->path, read->count);
  return code;
}

int points_read(const char *path, const problem *scene, points *read)
{
  int code;
  reader r = {.path = path, .scene = scene, .q = calloc((size_t)scene->nq, sizeof(double))};
  if (r.q == NULL) return complain("out of memory"), FAILED;
  r.stream = fopen(path, "r");
  if (r.stream == NULL)
    code = unreadable(path);
  else
    code = read_all(&r, read);
  if (r.stream != NULL) (void)fclose(r.stream);
  free(r.line);
  free(r.coordinate);
  free(r.q);
  return code;
}
