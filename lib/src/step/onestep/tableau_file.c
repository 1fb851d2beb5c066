/* A tableau in a file consists of lines of a word and numbers.
 *
 *     # a comment
 *     order 4
 *     c 0 1/2 1/2 1
 *     a
 *     a 1/2
 *     a 0 1/2
 *     a 0 0 1
 *     b 1/6 1/3 1/3 1/6
 *
 * `order` and `b` stand once. `a` stands once for each stage, in their order, and missing numbers
 * at the end of a row are 0. Without `c` the sums of a's rows are taken. */
#define _POSIX_C_SOURCE 200809L /* for S_ISREG */
#include <dvi/number.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "step/onestep/runge_kutta.h"
#include "core/memory.h"
#include "core/status.h"

enum { FILE_MOST = 65536, ORDER_MOST = 32 };

typedef struct reader {
  const char *path;
  dvi__runge_kutta *method;
  int line, rows, c_count, b_count;
  char *text; /* the current line */
} reader;

static dvi_status tableau_complain(const reader *r, const char *at, const char *sentence)
{
  return dvi__fail(DVI_BAD_OPTION, "%s:%d:%d: %s", r->path, r->line, (int)(at - r->text) + 1,
                   sentence);
}

static const char *tableau_skip_blanks(const char *at)
{
  return at + strspn(at, " \t\r\n");
}

/* Read a decimal number, or the quotient of two. */
static dvi_status tableau_read_number(const reader *r, const char **at, double *number)
{
  double denominator = 1;
  const char *start = *at, *end = dvi_number_read(start, number);
  if (end == start) return tableau_complain(r, start, "a number is expected, such as 0.25 or 1/4");
  if (*end == '/') {
    const char *below = end + 1;
    end = dvi_number_read(below, &denominator);
    if (end == below || denominator == 0)
      return tableau_complain(r, below, "a number other than 0 is expected behind the stroke");
  }
  *number /= denominator;
  if (*end != 0 && strchr(" \t\r\n#", *end) == NULL)
    return tableau_complain(r, end, "a blank is expected behind the number");
  if (!isfinite(*number)) return tableau_complain(r, start, "the number is not finite");
  *at = end;
  return DVI_OK;
}

static dvi_status tableau_read_row(const reader *r, const char *at, double *row, int *count)
{
  for (*count = 0; *(at = tableau_skip_blanks(at)) != 0 && *at != '#'; ++*count) {
    if (*count == DVI__RK_STAGES_MOST)
      return tableau_complain(r, at,
                              "more than 16 numbers; methods of up to 16 stages are possible");
    DVI_TRY(tableau_read_number(r, &at, &row[*count]));
  }
  return DVI_OK;
}

static dvi_status read_order(const reader *r, const char *at)
{
  double number[DVI__RK_STAGES_MOST];
  int count;
  if (r->method->order != 0) return tableau_complain(r, r->text, "the order is given twice");
  DVI_TRY(tableau_read_row(r, at, number, &count));
  if (count != 1 || number[0] != floor(number[0]) || number[0] < 1 || number[0] > ORDER_MOST)
    return tableau_complain(r, tableau_skip_blanks(at), "the order is one whole number, 1 to 32");
  r->method->order = (int)number[0];
  return DVI_OK;
}

static dvi_status read_stage(reader *r, const char *at)
{
  int count;
  if (r->rows == DVI__RK_STAGES_MOST)
    return tableau_complain(r, r->text,
                            "more than 16 rows of a; methods of up to 16 stages are possible");
  return tableau_read_row(r, at, r->method->a[r->rows++], &count);
}

static dvi_status tableau_read_line(reader *r)
{
  const char *word = tableau_skip_blanks(r->text), *at = word + strcspn(word, " \t\r\n#");
  const int length = (int)(at - word);
  if (length == 0) return DVI_OK;
  if (length == 5 && strncmp(word, "order", 5) == 0) return read_order(r, at);
  if (length == 1 && *word == 'a') return read_stage(r, at);
  if (length == 1 && *word == 'b' && r->b_count == 0)
    return tableau_read_row(r, at, r->method->b, &r->b_count);
  if (length == 1 && *word == 'c' && r->c_count == 0)
    return tableau_read_row(r, at, r->method->c, &r->c_count);
  return tableau_complain(r, word,
                          length == 1 && (*word == 'b' || *word == 'c')
                              ? "this row is given twice"
                              : "order, a, b or c is expected");
}

/* Check the lines together. */
static dvi_status tableau_finish(const reader *r)
{
  dvi__runge_kutta *m = r->method;
  m->stages = r->rows;
  if (m->order == 0) return dvi__fail(DVI_BAD_OPTION, "%s: the order is missing", r->path);
  if (r->rows == 0 || r->b_count != r->rows || (r->c_count != 0 && r->c_count != r->rows))
    return dvi__fail(
        DVI_BAD_OPTION,
        "%s: rows of a: %d, numbers of b: %d, of c: %d; as many of each are needed, or none of c",
        r->path, r->rows, r->b_count, r->c_count);
  for (int i = 0; i < m->stages; i++) {
    for (int j = m->stages; j < DVI__RK_STAGES_MOST; j++)
      if (m->a[i][j] != 0)
        return dvi__fail(DVI_BAD_OPTION, "%s: row %d of a has more numbers than there are stages",
                         r->path, i + 1);
    for (int j = 0; j < m->stages && r->c_count == 0; j++) m->c[i] += m->a[i][j];
  }
  dvi__runge_kutta_classify(m);
  const dvi_status status = dvi__runge_kutta_check(m, m->order);
  return status == DVI_OK ? DVI_OK : dvi__fail_in(status, "%s", r->path);
}

/* Read line after line. The text is cut into lines. */
static dvi_status read_lines(reader *r, size_t length)
{
  for (char *end = r->text + length; r->text < end; r->line++) {
    char *stop = memchr(r->text, '\n', (size_t)(end - r->text));
    if (stop == NULL) stop = end;
    *stop = 0;
    if (strlen(r->text) < (size_t)(stop - r->text))
      return tableau_complain(r, r->text + strlen(r->text), "a byte of 0; no text has it");
    DVI_TRY(tableau_read_line(r));
    r->text = stop + 1;
  }
  return tableau_finish(r);
}

/* Load the whole file, at most one character more than the limit. Only a regular file is opened,
 * because a pipe may block or never end. */
static dvi_status tableau_load(const char *path, char *text, size_t *length)
{
  struct stat about;
  if (stat(path, &about) == 0 && !S_ISREG(about.st_mode))
    return dvi__fail(DVI_BAD_OPTION, "%s cannot be read: it is no regular file", path);
  errno = 0;
  FILE *file = fopen(path, "r");
  if (file != NULL) *length = fread(text, 1, FILE_MOST + 1, file);
  const int broken = file == NULL || ferror(file), reason = errno;
  if (file != NULL) (void)fclose(file);
  if (broken) return dvi__fail(DVI_BAD_OPTION, "%s cannot be read: %s", path, strerror(reason));
  if (*length > FILE_MOST)
    return dvi__fail(DVI_BAD_OPTION, "%s has more than %d characters; a tableau needs no more",
                     path, FILE_MOST);
  return DVI_OK;
}

dvi_status dvi__runge_kutta_read(const char *path, dvi__runge_kutta *method)
{
  size_t length = 0;
  char *text = DVI_NEW(char, FILE_MOST + 2);
  reader r = {.path = path, .method = method, .line = 1, .text = text};
  *method = (dvi__runge_kutta){0};
  dvi_status status = text != NULL ? tableau_load(path, text, &length)
                                   : dvi__fail(DVI_NO_MEMORY, "no memory");
  if (status == DVI_OK) status = read_lines(&r, length);
  dvi__release(text);
  return status;
}
