#include "csv/row_source.h"

#include <stdlib.h>

#include "cli/command.h"

/* Numbers of a block: so many that few calls are made, and a megabyte at most for short rows. */
enum { BLOCK_NUMBERS = 1 << 17 };

static int64_t rows_of_block(const row_source *source)
{
  const int64_t rows = BLOCK_NUMBERS / source->content.columns;
  return rows > 0 ? rows : 1;
}

bool row_source_open(row_source *source, const char *path)
{
  *source = (row_source){.module = store_module(path)};
  if (source->module == NULL) return false;
  source->file = source->module->open_source(path, &source->content);
  if (source->file == NULL) {
    complain("cannot read '%s': %s", path, source->module->reason());
    return false;
  }
  const size_t rows = (size_t)rows_of_block(source);
  source->block = calloc(rows * (size_t)source->content.columns, sizeof *source->block);
  if (source->block == NULL) complain("out of memory");
  return source->block != NULL;
}

const double *row_source_next(row_source *source)
{
  const hdf5_content *content = &source->content;
  if (source->next == content->rows || source->failed) return NULL;
  if (source->next == source->first + source->held) {
    const int64_t left = content->rows - source->next, most = rows_of_block(source);
    source->first = source->next;
    source->held = left < most ? left : most;
    source->failed = !source->module->read_rows(source->file, source->first, source->held,
                                                source->block);
    if (source->failed) return NULL;
  }
  return source->block + (source->next++ - source->first) * content->columns;
}

bool row_source_failed(const row_source *source, const char *path)
{
  if (source->failed) complain("cannot read '%s': %s", path, source->module->reason());
  return source->failed;
}

void row_source_close(row_source *source)
{
  if (source->file != NULL) source->module->close_source(&source->file);
  free(source->block);
  *source = (row_source){0};
}
