#define _POSIX_C_SOURCE 200809L
#include "sweep/sweep_lines.h"

#include <dvi/scene.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* ---- sums ---- */

static const uint64_t no_bytes = UINT64_C(0xcbf29ce484222325);

/* Add bytes to a sum by FNV-1a (Fowler, Noll and Vo), 64 bits. */
static uint64_t add_bytes(uint64_t sum, const void *bytes, size_t size)
{
  const unsigned char *byte = bytes;
  for (size_t i = 0; i < size; i++) sum = (sum ^ byte[i]) * UINT64_C(0x100000001b3);
  return sum;
}

/* Add a text with the zero at its end, which separates it from the next text. */
static uint64_t add_text(uint64_t sum, const char *text)
{
  return add_bytes(sum, text, strlen(text) + 1);
}

static uint64_t add_values(uint64_t sum, const grid_axis *axis)
{
  sum = add_text(sum, axis->name);
  return axis->list != NULL
             ? add_text(sum, axis->list)
             : add_bytes(sum, axis->value, (size_t)axis->count * sizeof *axis->value);
}

/* Add the files of the components that a scene includes. */
static uint64_t add_components(uint64_t sum, const dvi_scene *scene)
{
  dvi_scene_file file;
  for (int i = 1; dvi_scene_file_of(scene, i, &file); i++)
    sum = add_bytes(add_text(sum, file.name), file.text, file.size);
  return sum;
}

sweep_key sweep_key_of(const sweep_task *task, const study_part *part)
{
  sweep_key key = {.part = *part, .grid = no_bytes};
  key.scene = task->text.text != NULL ? add_bytes(no_bytes, task->text.text, task->text.length)
                                      : add_text(no_bytes, task->operand);
  key.scene = add_components(key.scene, task->model->scene);
  key.run = add_text(no_bytes, task->method != NULL ? task->method : "");
  key.run = add_bytes(key.run, &task->h, sizeof task->h);
  key.run = add_bytes(key.run, &task->t_end, sizeof task->t_end);
  for (int i = 0; i < task->grid.axes; i++) key.grid = add_values(key.grid, &task->grid.axis[i]);
  return key;
}

/* ---- heads ---- */

void sweep_head(const sweep_key *key, char *head)
{
  (void)snprintf(
      head, SWEEP_HEAD_SIZE,
      "dvi sweep %s part %ld/%ld scene %016" PRIx64 " run %016" PRIx64 " grid %016" PRIx64 "\n",
      dvi_version(), key->part.part + 1, key->part.parts, key->scene, key->run, key->grid);
}

/* Return what follows a word of a head, or NULL if another word stands there. */
static const char *after(const char *text, const char *word)
{
  const size_t length = strlen(word);
  return text != NULL && strncmp(text, word, length) == 0 ? text + length : NULL;
}

/* Read a sum behind its name. */
static const char *take_sum(const char *text, const char *name, uint64_t *sum)
{
  char *end;
  text = after(text, name);
  if (text == NULL) return NULL;
  *sum = strtoull(text, &end, 16);
  return end != text ? end : NULL;
}

/* Read "K/N" and the sums. Returns false if they are not all there. */
static bool read_key(const char *text, sweep_key *read)
{
  char *end;
  read->part.part = strtol(text, &end, 10) - 1;
  if (*end != '/') return false;
  read->part.parts = strtol(end + 1, &end, 10);
  if (read->part.part < 0 || read->part.part >= read->part.parts) return false;
  text = take_sum(end, " scene ", &read->scene);
  text = take_sum(text, " run ", &read->run);
  text = take_sum(text, " grid ", &read->grid);
  return text != NULL && strcmp(text, "\n") == 0;
}

sweep_difference sweep_compare(const char *head, const sweep_key *key, study_part *part)
{
  sweep_key read;
  const char *version = after(head, "dvi sweep "), *ours = dvi_version();
  const char *rest = version != NULL ? strstr(version, " part ") : NULL;
  if (rest == NULL || !read_key(after(rest, " part "), &read)) return SWEEP_NO_HEAD;
  *part = read.part;
  if (strlen(ours) != (size_t)(rest - version) || after(version, ours) == NULL)
    return SWEEP_OTHER_VERSION;
  if (read.scene != key->scene) return SWEEP_OTHER_SCENE;
  if (read.run != key->run) return SWEEP_OTHER_RUN;
  return read.grid != key->grid ? SWEEP_OTHER_GRID : SWEEP_SAME;
}

/* ---- lines ---- */

/* Return the sum of a line's number, failure and row, and of the head. */
static uint64_t row_sum(const char *head, long k, const sweep_row *row)
{
  uint64_t sum = add_text(no_bytes, head);
  sum = add_bytes(sum, &k, sizeof k);
  sum = add_bytes(sum, &row->failed, sizeof row->failed);
  return add_text(sum, row->text);
}

/* Read "K FAILED SUM ROW\n". Returns the number of the point, or -1 if the line is not complete or
 * the point is none of the part. */
static long read_line(const char *head, const study_part *part, long points, char *line,
                      sweep_row *read)
{
  char *end;
  const size_t length = strlen(line);
  if (length < 1 || line[length - 1] != '\n') return -1;
  line[length - 1] = '\0';
  const long k = strtol(line, &end, 10);
  const long failed = strtol(end, &end, 10);
  const uint64_t sum = strtoull(end, &end, 16);
  if (k < 0 || k >= points || k % part->parts != part->part || *end != ' ') return -1;
  *read = (sweep_row){.text = end + 1, .failed = failed != 0};
  return row_sum(head, k, read) == sum ? k : -1;
}

bool sweep_read_lines(FILE *stream, const char *head, const study_part *part, long points,
                      sweep_row *row, long *size)
{
  sweep_row read;
  char *line = NULL;
  size_t room = 0;
  bool good = true;
  *size = 0;
  for (;;) {
    const ssize_t length = getline(&line, &room, stream);
    /* a line with a zero in it was damaged */
    if (length < 1 || strlen(line) != (size_t)length) break;
    const long k = read_line(head, part, points, line, &read);
    if (k < 0) break;
    free(row[k].text);
    row[k] = (sweep_row){.text = strdup(read.text), .failed = read.failed};
    good = row[k].text != NULL;
    if (!good) break;
    *size += (long)length;
  }
  free(line);
  return good;
}

void sweep_write_line(FILE *stream, const char *head, long k, const sweep_row *row)
{
  (void)fprintf(stream, "%ld %d %016" PRIx64 " %s\n", k, row->failed, row_sum(head, k, row),
                row->text);
}
