#define _POSIX_C_SOURCE 200809L
#include "sweep/sweep_part.h"

#include <dvi/scene.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"

enum { HEAD_SIZE = 64 };

static const char tail[] = ".part";

/* ---- sums ---- */

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

uint64_t sweep_key(const sweep_task *task)
{
  uint64_t sum = add_text(UINT64_C(0xcbf29ce484222325), dvi_version());
  sum = task->text.text != NULL ? add_bytes(sum, task->text.text, task->text.length)
                                : add_text(sum, task->operand);
  sum = add_components(sum, task->model->scene);
  sum = add_text(sum, task->method != NULL ? task->method : "");
  sum = add_bytes(sum, &task->h, sizeof task->h);
  sum = add_bytes(sum, &task->t_end, sizeof task->t_end);
  for (int i = 0; i < task->grid.axes; i++) sum = add_values(sum, &task->grid.axis[i]);
  return sum;
}

/* ---- lines ---- */

static bool refuse_part(const sweep_part *part)
{
  complain("cannot write '%s': %s", part->path, strerror(errno));
  return false;
}

static void write_head(uint64_t key, char *head)
{
  (void)snprintf(head, HEAD_SIZE, "dvi sweep %016" PRIx64 "\n", key);
}

/* Return the sum of a line's number, failure and row. */
static uint64_t row_sum(uint64_t key, long k, const sweep_row *row)
{
  uint64_t sum = add_bytes(key, &k, sizeof k);
  sum = add_bytes(sum, &row->failed, sizeof row->failed);
  return add_text(sum, row->text);
}

/* Read "K FAILED SUM ROW\n". Returns false if the line is not complete. */
static bool part_read_line(uint64_t key, char *line, ssize_t length, long points, sweep_row *row)
{
  char *end;
  if (length < 1 || line[length - 1] != '\n' || strlen(line) != (size_t)length) return false;
  line[length - 1] = '\0';
  const long k = strtol(line, &end, 10);
  const long failed = strtol(end, &end, 10);
  const uint64_t sum = strtoull(end, &end, 16);
  if (k < 0 || k >= points || *end != ' ') return false;
  sweep_row read = {.text = end + 1, .failed = failed != 0};
  if (row_sum(key, k, &read) != sum) return false;
  free(row[k].text);
  row[k].failed = read.failed;
  row[k].text = strdup(read.text);
  return row[k].text != NULL;
}

/* ---- the file ---- */

/* Lock the file, because two processes would write the same rows. */
static bool part_lock(const sweep_part *part)
{
  struct flock all = {.l_type = (short)F_WRLCK, .l_whence = (short)SEEK_SET};
  if (fcntl(fileno(part->stream), F_SETLK, &all) == 0 || (errno != EACCES && errno != EAGAIN))
    return true;
  complain("sweep: another process writes '%s'; wait for it, or give another --out", part->path);
  return false;
}

/* Read the rows up to the first line that is not complete, and cut off the rest. */
static bool part_read_rows(sweep_part *part, long points, sweep_row *row)
{
  char *line = NULL;
  size_t size = 0;
  long good = ftell(part->stream);
  ssize_t length = getline(&line, &size, part->stream);
  while (length > 0 && part_read_line(part->key, line, length, points, row)) {
    good += (long)length;
    length = getline(&line, &size, part->stream);
  }
  free(line);
  if (fseek(part->stream, good, SEEK_SET) == 0 && ftruncate(fileno(part->stream), (off_t)good) == 0)
    return true;
  return refuse_part(part);
}

static bool part_read(sweep_part *part, long points, sweep_row *row)
{
  char head[HEAD_SIZE];
  char found[HEAD_SIZE] = "";
  write_head(part->key, head);
  const size_t length = fread(found, 1, strlen(head), part->stream);
  if (length == 0) {
    if (fseek(part->stream, 0, SEEK_SET) == 0 && fputs(head, part->stream) >= 0 &&
        fflush(part->stream) == 0)
      return true;
    return refuse_part(part);
  }
  if (strcmp(found, head) == 0) return part_read_rows(part, points, row);
  complain("sweep: '%s' was begun with another scene or other settings; remove it, or give another "
           "--out",
           part->path);
  return false;
}

bool sweep_part_open(sweep_part *part, const char *out, uint64_t key, long points, sweep_row *row)
{
  const size_t length = strlen(out);
  *part = (sweep_part){.path = malloc(length + sizeof tail), .key = key};
  if (part->path == NULL) {
    complain("out of memory");
    return false;
  }
  memcpy(part->path, out, length);
  memcpy(part->path + length, tail, sizeof tail);
  const int descriptor = open(part->path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor < 0) return refuse_part(part);
  part->stream = fdopen(descriptor, "r+");
  if (part->stream != NULL) return part_lock(part) && part_read(part, points, row);
  (void)close(descriptor);
  return refuse_part(part);
}

bool sweep_part_add(sweep_part *part, long k, const sweep_row *row)
{
  errno = 0;
  (void)fprintf(part->stream, "%ld %d %016" PRIx64 " %s\n", k, row->failed,
                row_sum(part->key, k, row), row->text);
  return (fflush(part->stream) == 0 && !ferror(part->stream)) || refuse_part(part);
}

void sweep_part_close(sweep_part *part, bool complete)
{
  if (complete) (void)unlink(part->path);
  if (part->stream != NULL) (void)fclose(part->stream);
  free(part->path);
  *part = (sweep_part){.path = NULL};
}
