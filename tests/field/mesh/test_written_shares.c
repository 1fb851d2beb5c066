/* Shares of a mesh are written as the file of the whole mesh, byte for byte. */
#include <dvi/mesh.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/generated.h"
#include "support/field/ranks.h"
#include "support/files.h"
#include "support/suite.h"

enum { MOST = 4 };

/* What processes write, and what came of it. */
typedef struct trial {
  const char *path;
  int is_moved;
  int poor;       /* the process that gets no memory, or -1 */
  long successes; /* of its allocations */
  dvi_status status[MOST];
} trial;

static dvi_mesh *torus(void)
{
  return generated("bcc-torus", (dvi_generator_options){.cells = {3, 3, 3}, .extent = {1, 1, 1}});
}

/* A value of a cell of the whole mesh, of which some are -0. */
static double value_of(int64_t number, int component)
{
  return number % 7 == 3 ? -0.0 : sin((double)(5 * number + component));
}

/* Give values of the process `rank`. Those of other owners' cells must not be looked at. */
static double *values_of(const dvi_mesh *mesh, int rank, int k, int components)
{
  const int64_t count = dvi_mesh_count(mesh, k), *number = dvi_mesh_share_numbers(mesh, k);
  double *value = malloc((size_t)(count * components) * sizeof *value);
  for (int64_t i = 0; i < count * components; i++) {
    const int64_t cell = i / components;
    value[i] = value_of(number != NULL ? number[cell] : cell, (int)(i % components));
  }
  for (int64_t c = 0; c < count && number != NULL; c++)
    if (dvi_mesh_share_owners(mesh, k)[c] != rank) value[c * components] = (double)NAN;
  return value;
}

static double *moved_points(const dvi_mesh *mesh)
{
  const int64_t numbers = dvi_mesh_count(mesh, 0) * dvi_mesh_space(mesh);
  double *point = malloc((size_t)numbers * sizeof *point);
  for (int64_t i = 0; i < numbers; i++)
    point[i] = dvi_mesh_points(mesh)[i] + 0.01 * sin(9 * dvi_mesh_points(mesh)[i]);
  return point;
}

static dvi_status write_views(const dvi_mesh *mesh, int rank, const char *path, int is_moved)
{
  double *u = values_of(mesh, rank, 0, 1), *E = values_of(mesh, rank, 3, 3),
         *point = is_moved ? moved_points(mesh) : NULL;
  const dvi_view view[] = {{"E", E, 3, 3}, {"u", u, 1, 0}};
  const dvi_status status = is_moved ? dvi_mesh_write_moved(mesh, point, path, 2, view)
                                     : dvi_mesh_write(mesh, path, 2, view);
  free(point);
  free(E);
  free(u);
  return status;
}

static void write_share(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  if (rank == t->poor) dvi__fail_allocations_after(t->successes);
  t->status[rank] = write_views(share, rank, t->path, t->is_moved);
  dvi__fail_allocations_after(-1);
}

/* Let processes write. All must end with the same status, which is returned. */
static dvi_status write_divided(const dvi_mesh *mesh, int count, trial *t)
{
  const int64_t cells = dvi_mesh_count(mesh, 3);
  int *owner = malloc((size_t)cells * sizeof *owner);
  for (int64_t c = 0; c < cells; c++) owner[c] = (int)(c * 7 % count);
  run_ranks(mesh, count, owner, write_share, t);
  free(owner);
  for (int r = 1; r < count; r++) ck_assert_int_eq(t->status[r], t->status[0]);
  return t->status[0];
}

START_TEST(a_file_of_shares_is_that_of_the_whole_mesh)
{
  dvi_mesh *mesh = torus();
  trial t = {.path = path_in_folder("all.vtu"), .poor = -1, .is_moved = _i};
  ck_assert_int_eq(write_views(mesh, 0, path_in_folder("one.vtu"), _i), DVI_OK);
  const bytes one = read_bytes(path_in_folder("one.vtu"));
  for (int count = 1; count <= MOST; count++) {
    ck_assert_msg(write_divided(mesh, count, &t) == DVI_OK, "%s", dvi_last_error());
    const bytes all = read_bytes(t.path);
    ck_assert_uint_eq(all.count, one.count);
    ck_assert_mem_eq(all.at, one.at, one.count);
    free(all.at);
  }
  free(one.at);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(all_processes_fail_where_one_has_no_memory)
{
  dvi_mesh *mesh = torus();
  trial t = {.path = path_in_folder("all.vtu"), .poor = _i};
  dvi_status status = DVI_NO_MEMORY;
  write_bytes(t.path, (const unsigned char *)"old", 3);
  for (t.successes = 0; status != DVI_OK; t.successes++) {
    status = write_divided(mesh, 2, &t);
    if (status == DVI_OK) break;
    ck_assert_int_eq(status, DVI_NO_MEMORY);
    const bytes file = read_bytes(t.path);
    ck_assert_uint_eq(file.count, 3);
    free(file.at);
  }
  ck_assert_int_ge(t.successes, 3);
  ck_assert_int_eq(count_files_in_folder(), 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(what_cannot_be_written_is_told_on_all_processes)
{
  static const struct {
    const char *file;
    dvi_status status;
  } list[] = {{"none/all.vtu", DVI_IO_ERROR}, {"all.msh", DVI_UNSUPPORTED}};
  dvi_mesh *mesh = generated("kuhn", (dvi_generator_options){.cells = {2, 2, 2}});
  trial t = {.path = path_in_folder(list[_i].file), .poor = -1};
  ck_assert_int_eq(write_divided(mesh, 3, &t), list[_i].status);
  ck_assert_int_eq(count_files_in_folder(), 0);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(points_that_are_not_finite_are_refused)
{
  dvi_mesh *mesh = generated("kuhn", (dvi_generator_options){.cells = {2, 2}});
  double *point = moved_points(mesh);
  point[5] = (double)NAN;
  ck_assert_int_eq(dvi_mesh_write_moved(mesh, point, path_in_folder("m.vtu"), 0, NULL),
                   DVI_BAD_ARGUMENT);
  check_words("a coordinate of vertex 2 is nan");
  ck_assert_int_eq(dvi_mesh_write_moved(mesh, NULL, path_in_folder("m.vtu"), 0, NULL),
                   DVI_BAD_ARGUMENT);
  ck_assert_int_eq(count_files_in_folder(), 0);
  free(point);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(written_shares)
{
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_loop_test(tests, a_file_of_shares_is_that_of_the_whole_mesh, 0, 2);
  tcase_add_loop_test(tests, all_processes_fail_where_one_has_no_memory, 0, 2);
  tcase_add_loop_test(tests, what_cannot_be_written_is_told_on_all_processes, 0, 2);
  tcase_add_test(tests, points_that_are_not_finite_are_refused);
}
