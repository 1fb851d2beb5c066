#include "csv/rows.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

enum { LINE_START = 256 };

static bool refuse_unreadable(const char *path)
{
  complain("cannot read '%s': %s", path, strerror(errno));
  return false;
}

bool rows_open(row_file *file, const char *path)
{
  const char *dot = strrchr(path, '.');
  *file = (row_file){.path = path};
  if (dot != NULL && strcmp(dot, ".h5") == 0) {
    complain(
        "'%s' is a file of HDF5, and CSV is read here; dvi.read of the Python package reads it",
        path);
    return false;
  }
  file->stream = strcmp(path, "-") == 0 ? stdin : fopen(path, "r");
  return file->stream != NULL || refuse_unreadable(path);
}

bool rows_next(row_file *file)
{
  size_t length = 0;
  while (true) {
    if (length + 1 >= file->size) {
      const size_t size = file->size > 0 ? 2 * file->size : LINE_START;
      char *line = realloc(file->line, size);
      if (line == NULL) return false;
      file->line = line;
      file->size = size;
    }
    if (fgets(file->line + length, (int)(file->size - length), file->stream) == NULL) break;
    length += strlen(file->line + length);
    if (length > 0 && file->line[length - 1] == '\n') break; /* a NUL makes a line look empty */
  }
  file->row++;
  return length > 0;
}

bool rows_complete(const row_file *file)
{
  if (ferror(file->stream)) return refuse_unreadable(file->path);
  if (feof(file->stream)) return true;
  complain("out of memory");
  return false;
}

void rows_close(row_file *file)
{
  if (file->stream != NULL && file->stream != stdin) (void)fclose(file->stream);
  free(file->line);
  *file = (row_file){0};
}

void rows_field(const char **text, char field[FIELD_SIZE])
{
  const size_t length = strcspn(*text, ",\r\n");
  (void)snprintf(field, FIELD_SIZE, "%.*s", (int)length, *text);
  *text = (*text)[length] == ',' ? *text + length + 1 : NULL;
}
