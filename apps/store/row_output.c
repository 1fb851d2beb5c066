#define _POSIX_C_SOURCE 200809L
#include "store/row_output.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "csv/table.h"

/* ---- CSV ---- */

static bool csv_is_good(const row_output *out)
{
  if (!ferror(out->file.stream)) return true;
  if (out->file.path != NULL) complain("cannot write '%s': %s", out->file.path, strerror(errno));
  return false;
}

static bool open_csv(row_output *out, const hdf5_head *head)
{
  if (!file_open(&out->file, out->path)) return false;
  for (int k = 0; k < head->columns; k++) {
    if (k > 0) (void)fputc(',', out->file.stream);
    csv_text(out->file.stream, head->column[k]);
  }
  (void)fputc('\n', out->file.stream);
  return true;
}

static bool add_csv(const row_output *out)
{
  FILE *stream = out->file.stream;
  (void)fprintf(stream, "%.17g", out->row[0]);
  for (int k = 1; k < out->columns; k++) (void)fprintf(stream, ",%.17g", out->row[k]);
  (void)fputc('\n', stream);
  return csv_is_good(out);
}

/* ---- HDF5 ---- */

static bool refuse(row_output *out)
{
  out->lost = true;
  return store_refuse(out->path);
}

static bool open_hdf5(row_output *out, const hdf5_head *head, const hdf5_state *state)
{
  const hdf5_module *module = store_module(out->path);
  if (module == NULL) return false;
  if (state != NULL && access(out->path, F_OK) == 0) {
    out->rows = module->append_rows(out->path, head, state, &out->has_row);
    out->is_appended = true;
    if (out->rows == NULL)
      complain("run: --resume cannot append to '%s': %s; give another --out", out->path,
               module->reason());
    return out->rows != NULL;
  }
  if (!store_begin(&out->file, out->path)) return false;
  out->rows = module->create_rows(out->file.temporary, head);
  return out->rows != NULL || refuse(out);
}

/* Add a row. With the first one the file comes to its place, where it grows. The second flush locks
 * it again, for closing the temporary file's stream takes the lock away. */
static bool add_hdf5(row_output *out)
{
  const hdf5_module *module = store_module(out->path);
  if (!module->add_row(out->rows, out->row)) return refuse(out);
  if (out->file.stream == NULL) return true;
  if (!row_output_flush(out)) return false;
  out->lost = !file_keep(&out->file);
  return !out->lost && row_output_flush(out);
}

/* Bring what was written to the disk. Some file systems cannot. */
static void synchronise(const char *path)
{
  const int descriptor = open(path, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return;
  (void)fsync(descriptor);
  (void)close(descriptor);
}

static bool close_hdf5(row_output *out)
{
  const bool is_kept = out->file.stream == NULL;
  const bool good = store_module(out->path)->close_rows(&out->rows);
  if (is_kept) synchronise(out->path);
  return good || !is_kept || out->lost || refuse(out);
}

/* ---- both ---- */

bool row_output_open(row_output *out, const char *path, const hdf5_head *head,
                     const hdf5_state *state)
{
  *out = (row_output){.path = path, .columns = head->columns};
  out->row = calloc((size_t)head->columns, sizeof *out->row);
  if (out->row == NULL) {
    complain("out of memory");
    return false;
  }
  return store_is_wanted(path) ? open_hdf5(out, head, state) : open_csv(out, head);
}

bool row_output_add(row_output *out)
{
  return out->rows != NULL ? add_hdf5(out) : add_csv(out);
}

bool row_output_flush(row_output *out)
{
  return out->rows == NULL || store_module(out->path)->flush_rows(out->rows) || refuse(out);
}

bool row_output_close(row_output *out, bool keep)
{
  bool good = true;
  if (out->rows != NULL)
    good = close_hdf5(out);
  else if (keep && out->file.stream != NULL)
    good = file_keep(&out->file);
  file_discard(&out->file);
  free(out->row);
  *out = (row_output){.path = NULL};
  return good;
}
