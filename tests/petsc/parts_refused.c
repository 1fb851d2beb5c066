#define _XOPEN_SOURCE 700
/* Files of meshes that are cut short, or have what no mesh has. */
#include <dvi/petsc.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "expect.h"
#include "parts.h"
#include "support/shares/shares.h"
#include "support/meshes.h"

static char path[64];

/* The first process writes a mesh with a boundary and two parts. */
static void write_mesh(void)
{
  dvi_mesh *mesh = with_core_and_exit(staggered_mesh(4, 4), NULL);
  expect(rank > 0 || dvi_mesh_write_divided(mesh, path) == DVI_OK, "not written", "refusals");
  dvi_mesh_destroy(&mesh);
}

/* All processes fail with this status, and a word of the sentence. */
static void refuse(const char *name, dvi_status status, const char *word)
{
  dvi_mesh *share;
  dvi_division *division;
  const dvi_division_options options = {.size = sizeof options, .partitioner = "blocks"};
  const int is_refused = dvi_mesh_read_divided(name, &options, &share, &division) == status &&
                         share == NULL && division == NULL;
  expect(is_refused, word, "refusal");
  expect(strstr(dvi_last_error(), word) != NULL || strstr(dvi_last_error(), "tells why"), word,
         "sentence");
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
}

/* Write the first numbers of a dataset anew. Returns whether it worked. */
static int change(const char *name, hid_t type, hsize_t count, const void *numbers)
{
  const hsize_t start[2] = {0, 0}, extent[2] = {1, count};
  const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT),
              set = H5Dopen2(file, name, H5P_DEFAULT), place = H5Dget_space(set);
  const int axes = H5Sget_simple_extent_ndims(place);
  const hid_t memory = H5Screate_simple(1, &count, NULL);
  int good = H5Sselect_hyperslab(place, H5S_SELECT_SET, start, NULL,
                                 axes == 2 ? extent : extent + 1, NULL) >= 0;
  good = good && H5Dwrite(set, type, memory, place, H5P_DEFAULT, numbers) >= 0;
  (void)H5Sclose(memory);
  (void)H5Sclose(place);
  (void)H5Dclose(set);
  return H5Fclose(file) >= 0 && good;
}

static void refuse_changed(const char *name, hid_t type, hsize_t count, const void *numbers,
                           dvi_status status, const char *word)
{
  write_mesh();
  expect(rank > 0 || change(name, type, count, numbers), name, "changed");
  refuse(path, status, word);
}

/* Give a part the name of another one, as long as its own. */
static int rename_part(const char *name, const char *text)
{
  const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT),
              set = H5Dopen2(file, name, H5P_DEFAULT), type = H5Dget_type(set);
  const int good = H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
  (void)H5Tclose(type);
  (void)H5Dclose(set);
  return H5Fclose(file) >= 0 && good;
}

static void refuse_names(void)
{
  write_mesh();
  expect(rank > 0 || rename_part("parts/3/name", "core"), "parts/3/name", "changed");
  refuse(path, DVI_BAD_FILE, "parts 2 and 3 both are \"core\"");
}

static void refuse_changes(void)
{
  const int beyond[3] = {0, 1, 1000}, before[3] = {0, 1, -1}, twice[3] = {1, 1, 2},
            first[3] = {0, 2, 1};
  const int64_t edges[2] = {27, 3}, cells[3] = {27, 62, 1};
  const int8_t turn = 3;
  const double metric = 2, point[2] = {0, 0. / 0.};
  refuse_changed("cells", H5T_NATIVE_INT, 3, beyond, DVI_BAD_FILE, "has vertex 1000");
  refuse_changed("cells", H5T_NATIVE_INT, 3, before, DVI_BAD_FILE, "has vertex -1");
  refuse_changed("cells", H5T_NATIVE_INT, 3, twice, DVI_BAD_ARGUMENT, "twice");
  refuse_changed("counts", H5T_NATIVE_INT64, 3, cells, DVI_BAD_FILE, "cells, and counts");
  refuse_changed("counts", H5T_NATIVE_INT64, 2, edges, DVI_BAD_FILE, "it counts 3");
  refuse_changed("orientation", H5T_NATIVE_INT8, 1, &turn, DVI_BAD_FILE, "orientation 3");
  refuse_changed("metric", H5T_NATIVE_DOUBLE, 1, &metric, DVI_BAD_ARGUMENT, "metric of axis 0");
  refuse_changed("points", H5T_NATIVE_DOUBLE, 2, point, DVI_BAD_ARGUMENT, "coordinate 1");
  refuse_changed("parts/1/cells_1", H5T_NATIVE_INT, 3, beyond, DVI_BAD_FILE, "number 1000");
  refuse_changed("parts/2/cells_0", H5T_NATIVE_INT, 3, first, DVI_BAD_FILE, "number 1 in row 2");
}

static long size_of_file(void)
{
  long size = 0;
  FILE *stream = rank == 0 ? fopen(path, "rb") : NULL;
  if (stream != NULL && fseek(stream, 0, SEEK_END) == 0) size = ftell(stream);
  if (stream != NULL) (void)fclose(stream);
  (void)MPI_Bcast(&size, 1, MPI_LONG, 0, MPI_COMM_WORLD);
  return size;
}

/* The first process turns the bits of a byte of the file. Returns whether it worked. */
static int turn_byte(long at)
{
  FILE *stream = fopen(path, "r+b");
  if (stream == NULL) return 0;
  int byte = fseek(stream, at, SEEK_SET) == 0 ? fgetc(stream) : EOF;
  if (byte != EOF && fseek(stream, at, SEEK_SET) == 0) byte = fputc(byte ^ 0xff, stream);
  return fclose(stream) == 0 && byte != EOF;
}

static dvi_status read_share(dvi_mesh **share, dvi_division **division)
{
  const dvi_division_options options = {.size = sizeof options, .partitioner = "blocks"};
  return dvi_mesh_read_divided(path, &options, share, division);
}

/* Wherever a byte is damaged, the file is refused, unless nothing is said there. */
static void refuse_damage(void)
{
  dvi_mesh *good, *share;
  dvi_division *of_good, *division;
  int refusals = 0;
  write_mesh();
  const long size = size_of_file();
  expect(read_share(&good, &of_good) == DVI_OK, "good", "damage");
  for (long at = 5; at < size; at += 401) {
    expect(rank > 0 || turn_byte(at), "turned", "damage");
    const dvi_status status = read_share(&share, &division);
    refusals += share == NULL;
    expect(share != NULL || status == DVI_BAD_FILE, "status", "damage");
    expect(share == NULL || share_differs(share, good) == 0, "taken", "damage");
    expect(rank > 0 || turn_byte(at), "turned back", "damage");
    dvi_mesh_destroy(&share);
    dvi_division_destroy(&division);
  }
  expect(refusals > size / 401 / 2, "few", "damage");
  dvi_mesh_destroy(&good);
  dvi_division_destroy(&of_good);
}

static void refuse_cut(void)
{
  const long size = size_of_file();
  for (long cut = size - 1; cut > 0; cut = cut / 3) {
    expect(rank > 0 || truncate(path, cut) == 0, "cut", "file");
    refuse(path, DVI_BAD_FILE, "cut short");
  }
}

/* If memory fails on the last process alone, all of them fail alike. */
static void refuse_memory(void)
{
  dvi_mesh *share;
  dvi_division *division;
  const dvi_division_options options = {.size = sizeof options, .partitioner = "blocks"};
  dvi_status status = DVI_NO_MEMORY;
  for (int successes = 1; status == DVI_NO_MEMORY; successes++) {
    if (rank == ranks - 1) dvi__fail_allocations_after(successes);
    status = dvi_mesh_read_divided(path, &options, &share, &division);
    dvi__fail_allocations_after(-1);
    expect(status == DVI_OK || (status == DVI_NO_MEMORY && share == NULL && division == NULL),
           "memory", "file");
    dvi_mesh_destroy(&share);
    dvi_division_destroy(&division);
  }
}

static void refuse_share(void)
{
  dvi_mesh *share = NULL;
  dvi_division *division = NULL;
  const dvi_division_options many = {.size = sizeof many, .partitioner = "nobody"};
  expect(dvi_mesh_read_divided(path, NULL, &share, &division) == DVI_OK, "share", "file");
  expect(dvi_mesh_write_divided(share, "none.h5") == DVI_UNSUPPORTED, "a share", "file");
  expect(dvi_mesh_write_divided(NULL, path) == DVI_BAD_ARGUMENT, "no mesh", "file");
  expect(dvi_mesh_read_divided(NULL, NULL, &share, &division) == DVI_BAD_ARGUMENT, "path", "file");
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  expect(ranks == 1 || ranks == 4 ||
             dvi_mesh_read_divided(path, &many, &share, &division) == DVI_BAD_OPTION,
         "nobody", "file");
}

void check_refused_parts(void)
{
  parts_path(path, sizeof path, "refused");
  refuse("none.h5", DVI_IO_ERROR, "none.h5");
  write_mesh();
  refuse_share();
  refuse_memory();
  refuse_changes();
  refuse_names();
  refuse_damage();
  refuse_cut();
  if (rank == 0) (void)unlink(path);
}
