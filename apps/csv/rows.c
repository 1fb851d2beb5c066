#include "csv/rows.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

/* Bytes of a line at first, and of a number in 17 digits with its comma, at most. */
enum { LINE_START = 256, NUMBER_SIZE = 32 };

static bool refuse_unreadable(const char *path)
{
  complain("cannot read '%s': %s", path, strerror(errno));
  return false;
}

/* The first byte of a file of HDF5, with which no CSV begins. */
enum { HDF5_BYTE = 0x89 };

static bool ends_with(const char *path, const char *ending)
{
  const size_t length = strlen(path), end = strlen(ending);
  return length > end && strcmp(path + length - end, ending) == 0;
}

/* Refuse a file of HDF5 that is read as CSV. */
static bool refuse_hdf5(const row_file *file)
{
  const int first = getc(file->stream);
  if (first != EOF) (void)ungetc(first, file->stream);
  if (first != HDF5_BYTE) return true;
  if (strcmp(file->path, "-") == 0)
    complain("standard input has a file of HDF5, which is read by its name only; give FILE.h5");
  else if (ends_with(file->path, ".vtkhdf"))
    complain("'%s' has fields at the times of a run, and no rows; dvi view shows them, and "
             "dvi run --out writes rows",
             file->path);
  else
    complain("'%s' is a file of HDF5; give it a name that ends in .h5", file->path);
  return false;
}

bool rows_open(row_file *file, const char *path)
{
  *file = (row_file){.path = path, .is_hdf5 = store_is_wanted(path)};
  if (file->is_hdf5) return row_source_open(&file->source, path);
  file->stream = strcmp(path, "-") == 0 ? stdin : fopen(path, "r");
  return file->stream != NULL ? refuse_hdf5(file) : refuse_unreadable(path);
}

int rows_of_run(const char *command, const row_file *file)
{
  if (!file->source.content.is_table) return DONE;
  return usage_error("%s: '%s' is the table of a sweep, and the rows of a run are wanted, which "
                     "dvi run --out writes",
                     command, file->path);
}

/* ---- lines ---- */

/* Make room for a line of so many bytes, and perhaps more. */
static bool make_room(row_file *file, size_t wanted)
{
  if (wanted <= file->size) return true;
  size_t size = file->size > 0 ? 2 * file->size : LINE_START;
  while (size < wanted) size *= 2;
  char *line = realloc(file->line, size);
  if (line == NULL) return false;
  file->line = line;
  file->size = size;
  return true;
}

static bool read_line(row_file *file)
{
  size_t length = 0;
  while (true) {
    if (!make_room(file, length + 2)) return false;
    if (fgets(file->line + length, (int)(file->size - length), file->stream) == NULL) break;
    length += strlen(file->line + length);
    if (length > 0 && file->line[length - 1] == '\n') break; /* a NUL makes a line look empty */
  }
  file->row++;
  return length > 0;
}

/* Spell a row, or without numbers the names of the columns, as dvi run does in CSV. */
static bool spell_line(row_file *file, const double *number)
{
  const hdf5_content *content = &file->source.content;
  size_t length = 0;
  for (int k = 0; k < content->columns; k++) {
    const char *name = number == NULL ? content->column[k] : "";
    if (!make_room(file, length + strlen(name) + NUMBER_SIZE)) return false;
    char *at = file->line + length;
    const size_t room = file->size - length;
    const char *comma = k > 0 ? "," : "";
    length += (size_t)(number == NULL ? snprintf(at, room, "%s%s", comma, name)
                                      : snprintf(at, room, "%s%.17g", comma, number[k]));
  }
  return true;
}

const double *rows_numbers(row_file *file)
{
  file->row++;
  return row_source_next(&file->source);
}

bool rows_next(row_file *file)
{
  if (!file->is_hdf5) return read_line(file);
  if (file->row == 0) return ++file->row, spell_line(file, NULL);
  const double *number = rows_numbers(file);
  return number != NULL && spell_line(file, number);
}

bool rows_complete(const row_file *file)
{
  const row_source *source = &file->source;
  if (file->is_hdf5 && row_source_failed(source, file->path)) return false;
  if (!file->is_hdf5 && ferror(file->stream)) return refuse_unreadable(file->path);
  if (file->is_hdf5 ? source->next == source->content.rows : feof(file->stream)) return true;
  complain("out of memory");
  return false;
}

void rows_close(row_file *file)
{
  if (file->stream != NULL && file->stream != stdin) (void)fclose(file->stream);
  row_source_close(&file->source);
  free(file->line);
  *file = (row_file){0};
}

void rows_field(const char **text, char field[FIELD_SIZE])
{
  const size_t length = strcspn(*text, ",\r\n");
  (void)snprintf(field, FIELD_SIZE, "%.*s", (int)length, *text);
  *text = (*text)[length] == ',' ? *text + length + 1 : NULL;
}
