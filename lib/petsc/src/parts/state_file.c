/* States of marches in files of HDF5, of which each process writes and reads a block of each array
 * (docs/fields/processes.md, "Checkpoints in parts"). */
#include <dvi/petsc.h>
#include <petscsys.h>
#include <stdio.h>
#include <string.h>

#include "blocks.h"
#include "core/memory.h"
#include "core/status.h"
#include "division.h"
#include "march/parts.h"
#include "slabs.h"

enum { PATH_NAME = 512, ARRAY_NAME = 32 };

static const char layout[] = "dvi state 1";

/* A file, and the processes that share it, or NULL for one alone. */
typedef struct state_file {
  dvi__slabs *file;
  const dvi__world *world;
} state_file;

static dvi_status agree(const state_file *f, dvi_status status)
{
  return f->world != NULL ? dvi__world_agree(f->world, status) : status;
}

/* A process alone has the whole mesh, and several ones their shares. */
static dvi_status check_rows(const state_file *f, const dvi__part_rows *rows)
{
  if ((rows->number == NULL) == (f->world == NULL)) return DVI_OK;
  return dvi__fail(DVI_BAD_ARGUMENT, f->world == NULL
                                         ? "petsc: the march is one of a share: give its division"
                                         : "petsc: the march is not one of the division's share");
}

static const char *array_name(char name[ARRAY_NAME], int array)
{
  (void)snprintf(name, ARRAY_NAME, "arrays/%d", array);
  return name;
}

/* ---- write ---- */

/* Own rows, and the block that this process writes. */
typedef struct parcel {
  int count;
  int *number;   /* [count] */
  double *value; /* [count] */
  double *block;
} parcel;

static dvi_status pack(const dvi__part_rows *rows, const dvi__block *block, const double *value,
                       parcel *p)
{
  p->number = DVI_NEW(int, rows->listed);
  p->value = DVI_NEW(double, rows->listed);
  p->block = DVI_NEW(double, block->last - block->first);
  if (p->number == NULL || p->value == NULL || p->block == NULL)
    return dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a block of a state");
  for (int64_t i = 0; i < rows->listed; i++) {
    if (rows->owner[i] != block->world->rank) continue;
    p->number[p->count] = (int)rows->number[i];
    p->value[p->count++] = value[i];
  }
  return DVI_OK;
}

/* Send own rows to those that write them, and write the block. */
static dvi_status write_block(const state_file *f, const dvi__slab *slab, const dvi__block *block,
                              const parcel *p)
{
  const dvi__row row = {.type = MPI_DOUBLE, .width = 1};
  PetscSF forest = NULL;
  dvi_status status = dvi__forest_of(block, p->count, p->number, 1, &forest);
  if (status == DVI_OK) status = dvi__place(f->world, forest, row, p->value, p->block);
  if (status == DVI_OK) status = dvi__slabs_write_rows(f->file, slab, block->total, p->block);
  (void)PetscSFDestroy(&forest);
  return agree(f, status);
}

static dvi_status put(void *of, const dvi__part_rows *rows, const double *value)
{
  const state_file *f = of;
  char name[ARRAY_NAME];
  parcel p = {0};
  dvi__slab slab = {
      .name = array_name(name, rows->array), .type = DVI__DOUBLE, .rows = rows->total};
  DVI_TRY(check_rows(f, rows));
  if (f->world == NULL) return dvi__slabs_write_rows(f->file, &slab, rows->total, value);
  const dvi__block block = dvi__block_of(f->world, rows->total);
  slab.first = block.first;
  slab.rows = block.last - block.first;
  dvi_status status = agree(f, pack(rows, &block, value, &p));
  if (status == DVI_OK) status = write_block(f, &slab, &block, &p);
  dvi__release(p.number);
  dvi__release(p.value);
  dvi__release(p.block);
  return status;
}

/* Write what is not in arrays, which the first process gives. */
static dvi_status write_rest(const state_file *f, const unsigned char *bytes, size_t size)
{
  const int is_first = f->world == NULL || f->world->rank == 0;
  const dvi__slab slab = {.name = "rest", .type = DVI__INT8, .rows = is_first ? (int64_t)size : 0};
  return agree(f, dvi__slabs_write_rows(f->file, &slab, (int64_t)size, bytes));
}

static dvi_status write_state(const dvi_march *march, state_file *f)
{
  const dvi__parts parts = {.put = put, .of = f};
  unsigned char *bytes = NULL;
  size_t size = 0;
  dvi_status status = dvi__slabs_write_text(f->file, "layout", layout);
  if (status == DVI_OK) status = dvi__slabs_write_group(f->file, "arrays");
  status = agree(f, status);
  if (status == DVI_OK) status = dvi__march_put_parts(march, &parts, &bytes, &size);
  if (status == DVI_OK) status = write_rest(f, bytes, size);
  dvi__release(bytes);
  return status;
}

static const dvi__world *world_of(const dvi_division *division)
{
  return division != NULL ? &division->world : NULL;
}

dvi_status dvi_march_write_divided(const dvi_march *march, const dvi_division *division,
                                   const char *path)
{
  state_file f = {.world = world_of(division)};
  if (march == NULL || path == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a march and a path are needed");
  if (division != NULL) (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  dvi_status status = dvi__slabs_create(f.world, path, &f.file);
  if (status == DVI_OK) {
    status = write_state(march, &f);
    const dvi_status ended = dvi__slabs_end(&f.file, status == DVI_OK);
    if (status == DVI_OK) status = ended;
  }
  if (division != NULL) (void)PetscPopErrorHandler();
  return status;
}

/* ---- read ---- */

static dvi_status check_array(const state_file *f, const char *name, int64_t total)
{
  int64_t rows;
  int width;
  DVI_TRY(dvi__slabs_shape(f->file, name, &rows, &width));
  if (rows == total && width == 0) return DVI_OK;
  return dvi__slabs_refuse(f->file, "\"%s\" has %lld rows, and %lld are needed", name,
                           (long long)rows, (long long)total);
}

/* Read a block, and give the others their rows of it. `number` [listed] has room. */
static dvi_status read_block(const state_file *f, const dvi__part_rows *rows, const dvi__slab *slab,
                             const dvi__block *block, int *number, double *own, double *value)
{
  const dvi__row row = {.type = MPI_DOUBLE, .width = 1};
  PetscSF forest = NULL;
  DVI_TRY(agree(f, dvi__slabs_read(f->file, slab, own)));
  for (int64_t i = 0; i < rows->listed; i++) number[i] = (int)rows->number[i];
  dvi_status status = dvi__forest_of(block, rows->listed, number, 1, &forest);
  if (status == DVI_OK) status = dvi__spread(f->world, forest, row, own, value);
  (void)PetscSFDestroy(&forest);
  return status;
}

static dvi_status take(void *of, const dvi__part_rows *rows, double *value)
{
  const state_file *f = of;
  char name[ARRAY_NAME];
  dvi__slab slab = {
      .name = array_name(name, rows->array), .type = DVI__DOUBLE, .rows = rows->total};
  DVI_TRY(check_rows(f, rows));
  DVI_TRY(agree(f, check_array(f, name, rows->total)));
  if (f->world == NULL) return dvi__slabs_read(f->file, &slab, value);
  const dvi__block block = dvi__block_of(f->world, rows->total);
  slab.first = block.first;
  slab.rows = block.last - block.first;
  int *number = DVI_NEW(int, rows->listed);
  double *own = DVI_NEW(double, slab.rows);
  dvi_status status = agree(
      f, number != NULL && own != NULL
             ? DVI_OK
             : dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a block of a state"));
  if (status == DVI_OK) status = read_block(f, rows, &slab, &block, number, own, value);
  dvi__release(number);
  dvi__release(own);
  return status;
}

/* Read what is not in arrays. */
static dvi_status read_rest(const state_file *f, unsigned char **bytes, size_t *size)
{
  char text[32];
  int width;
  dvi__slab slab = {.name = "rest", .type = DVI__INT8};
  DVI_TRY(dvi__slabs_read_text(f->file, "layout", sizeof text, text));
  if (strcmp(text, layout) != 0)
    return dvi__slabs_refuse(f->file, "its layout is \"%s\" and not \"%s\"", text, layout);
  DVI_TRY(dvi__slabs_shape(f->file, slab.name, &slab.rows, &width));
  *size = (size_t)slab.rows;
  *bytes = dvi__allocate(*size, 1);
  if (*bytes == NULL) return dvi__fail(DVI_NO_MEMORY, "petsc: no memory for a state");
  return dvi__slabs_read(f->file, &slab, *bytes);
}

dvi_status dvi_march_read_divided(dvi_march *march, const dvi_division *division, const char *path)
{
  state_file f = {.world = world_of(division)};
  const dvi__parts parts = {.take = take, .of = &f};
  char name[PATH_NAME];
  unsigned char *bytes = NULL;
  size_t size = 0;
  if (march == NULL || path == NULL)
    return dvi__fail(DVI_BAD_ARGUMENT, "petsc: a march and a path are needed");
  (void)snprintf(name, sizeof name, "checkpoint %s", path);
  if (division != NULL) (void)PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  dvi_status status = dvi__slabs_open(f.world, path, &f.file);
  if (status == DVI_OK) {
    const dvi_status rest = read_rest(&f, &bytes, &size);
    status = dvi__march_take_parts(march, name, &parts, bytes, size, rest);
    (void)dvi__slabs_end(&f.file, 0);
  }
  if (division != NULL) (void)PetscPopErrorHandler();
  return status;
}
