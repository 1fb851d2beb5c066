/* States of marches that processes write and read in parts: the file is that of one process, byte
 * for byte, and any number of processes goes on from it with the same bits. */
#include "states.h"

#include <dvi/elastic.h>
#include <dvi/petsc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "core/memory.h"
#include "expect.h"
#include "parts.h"
#include "support/field/generated.h"
#include "support/field/marches.h"
#include "support/meshes.h"
#include "support/shares/shares.h"

/* PETSc includes complex.h, whose I is no name for a parameter: libdvi's headers come first. */
#include <petscsys.h>

enum { STEPS = 5 };

/* A march on a mesh, with what it is made of. */
typedef struct subject {
  dvi_field *field;
  dvi_elastic *solid;
  dvi_march *march;
  double step;
} subject;

static char whole_path[64], shared_path[64];

/* ---- marches ---- */

static dvi_status start(const dvi_mesh *mesh, int k, int components, subject *s)
{
  const int64_t count = dvi_mesh_count(mesh, k), *number = dvi_mesh_share_numbers(mesh, k);
  double *E = DVI_NEW(double, count *components);
  for (int64_t i = 0; i < count * components; i++) {
    const int64_t cell = number != NULL ? number[i / components] : i / components;
    E[i] = cell % 5 == 0 ? 0.01 * (double)(cell % 17 + i % components) : -0.0;
  }
  const dvi_march_state state = {.size = sizeof state, .E = E};
  const dvi_status status = dvi_march_start(s->march, &state);
  dvi_march_facts facts;
  dvi_march_facts_of(s->march, &facts);
  s->step = facts.longest;
  dvi__release(E);
  return status;
}

static subject field_on(const dvi_mesh *mesh)
{
  subject s = {.field = lossy_field(mesh)};
  if (dvi_march_create(s.field, NULL, &s.march) == DVI_OK) (void)start(mesh, 1, 1, &s);
  return s;
}

static subject solid_on(const dvi_mesh *mesh)
{
  const dvi_elastic_material rubber = {
      .part = "all", .law = DVI_ELASTIC_NEO_HOOKEAN, .lambda = 1, .mu = 1, .rho = 1};
  const dvi_elastic_terms terms = {
      .size = sizeof terms, .mesh = mesh, .material = &rubber, .materials = 1};
  const dvi_march_options options = {.size = sizeof options, .method = "avi", .fraction = 0.5};
  subject s = {.field = NULL};
  if (dvi_elastic_create(&terms, &s.solid) == DVI_OK &&
      dvi_elastic_march_create(s.solid, &options, &s.march) == DVI_OK)
    (void)start(mesh, 0, 3, &s);
  return s;
}

static void end(subject *s)
{
  dvi_march_destroy(&s->march);
  dvi_field_destroy(&s->field);
  dvi_elastic_destroy(&s->solid);
}

static dvi_status advance(const subject *s, int steps)
{
  return dvi_march_advance(s->march, dvi_march_time(s->march) + (steps + 0.3) * s->step);
}

/* ---- files ---- */

static int same_files(const char *a, const char *b)
{
  FILE *first = fopen(a, "rb"), *second = fopen(b, "rb");
  int one = 0, other = 1;
  if (first != NULL && second != NULL) do {
      one = getc(first);
      other = getc(second);
    } while (one == other && one != EOF);
  if (first != NULL) (void)fclose(first);
  if (second != NULL) (void)fclose(second);
  return one == other;
}

/* Copy a file but for its last bytes. */
static void cut(const char *from, const char *to, long left_out)
{
  FILE *first = fopen(from, "rb"), *second = fopen(to, "wb");
  (void)fseek(first, 0, SEEK_END);
  const long size = ftell(first) - left_out;
  (void)fseek(first, 0, SEEK_SET);
  for (long i = 0; i < size; i++) (void)putc(getc(first), second);
  (void)fclose(first);
  (void)fclose(second);
}

/* ---- tests ---- */

/* Processes go on from the file of one, and one from theirs, to the state of the whole march. */
static void check_going_on(subject *whole, subject *shared, const dvi_division *division)
{
  size_t size;
  expect(advance(whole, STEPS) == DVI_OK, "no steps", "whole");
  unsigned char *later = save_march(whole->march, &size);
  expect(advance(shared, 2) == DVI_OK, "no steps", "share");
  expect(dvi_march_read_divided(shared->march, division, whole_path) == DVI_OK, "not read",
         "share");
  expect(advance(shared, STEPS) == DVI_OK, "no steps", "share");
  expect(march_has_bytes(shared->march, later, size), "other bits", "share");
  expect(dvi_march_read_divided(whole->march, NULL, shared_path) == DVI_OK, "not read", "whole");
  expect(advance(whole, STEPS) == DVI_OK, "no steps", "whole");
  expect(march_has_bytes(whole->march, later, size), "other bits", "whole");
  free(later);
}

static void refuse(const subject *s, const dvi_division *division, const char *path,
                   dvi_status status, const char *word)
{
  size_t size;
  unsigned char *before = save_march(s->march, &size);
  expect(dvi_march_read_divided(s->march, division, path) == status, "another status", word);
  expect(strstr(dvi_last_error(), word) != NULL, dvi_last_error(), word);
  expect(march_has_bytes(s->march, before, size), "a refused state changes the march", word);
  free(before);
}

/* If memory fails on the last process alone, all fail, and the march and the old file stay. */
static void check_memory(const subject *s, const dvi_division *division)
{
  dvi_status status = DVI_NO_MEMORY;
  for (int k = 0; k < 2; k++, status = DVI_NO_MEMORY)
    for (int successes = 0; status == DVI_NO_MEMORY; successes++) {
      if (rank == ranks - 1) dvi__fail_allocations_after(successes);
      status = k == 0 ? dvi_march_write_divided(s->march, division, shared_path)
                      : dvi_march_read_divided(s->march, division, shared_path);
      dvi__fail_allocations_after(-1);
      expect(status == DVI_OK || status == DVI_NO_MEMORY, "memory", dvi_last_error());
    }
  expect(same_files(whole_path, shared_path), "another file", "memory");
}

static void check_refused(const dvi_mesh *mesh, const subject *whole, const subject *shared,
                          const dvi_division *division)
{
  char bad[64];
  parts_path(bad, sizeof bad, "bad");
  if (rank == 0) cut(whole_path, bad, 100);
  (void)MPI_Barrier(MPI_COMM_WORLD);
  refuse(shared, division, bad, DVI_BAD_FILE, rank == 0 ? "cut short" : "");
  refuse(shared, division, "no/such.h5", DVI_IO_ERROR, "");
  refuse(shared, NULL, whole_path, DVI_BAD_ARGUMENT, "give its division");
  refuse(whole, division, whole_path, DVI_BAD_ARGUMENT, "is not one of");
  expect(dvi_march_write_divided(shared->march, division, "no/such.h5") == DVI_IO_ERROR, "written",
         "no/such.h5");
  expect(dvi_march_write_divided(NULL, division, bad) == DVI_BAD_ARGUMENT, "written", "no march");
  (void)MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0 && dvi_mesh_write_divided(mesh, bad) != DVI_OK) bad[0] = 0;
  (void)MPI_Barrier(MPI_COMM_WORLD);
  refuse(shared, division, bad, DVI_BAD_FILE, "layout");
  (void)MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0) (void)unlink(bad);
}

/* The mesh is destroyed. */
static void check_subject(dvi_mesh *mesh, subject (*make)(const dvi_mesh *mesh), int tries_all)
{
  dvi_mesh *share = NULL;
  dvi_division *division = NULL;
  expect(dvi_mesh_divide(mesh, NULL, &share, &division) == DVI_OK, "no division", "states");
  subject whole = make(mesh), shared = make(share);
  expect(advance(&whole, STEPS) == DVI_OK && advance(&shared, STEPS) == DVI_OK, "no steps", "");
  const dvi_status alone = rank == 0 ? dvi_march_write_divided(whole.march, NULL, whole_path)
                                     : DVI_OK;
  expect(alone == DVI_OK, "not written", "whole");
  expect(dvi_march_write_divided(shared.march, division, shared_path) == DVI_OK, "not written",
         "shares");
  expect(same_files(whole_path, shared_path), "another file", "states");
  if (tries_all) check_refused(mesh, &whole, &shared, division);
  if (tries_all) check_memory(&shared, division);
  check_going_on(&whole, &shared, division);
  end(&whole);
  end(&shared);
  dvi_mesh_destroy(&share);
  dvi_division_destroy(&division);
  dvi_mesh_destroy(&mesh);
}

void check_states(void)
{
  const dvi_generator_options block = {.cells = {4, 3, 3}, .grading = {2, 1, 1}};
  parts_path(whole_path, sizeof whole_path, "whole-state");
  parts_path(shared_path, sizeof shared_path, "shared-state");
  /* two and four fail as three do */
  check_subject(with_core_and_exit(staggered_mesh(9, 10), NULL), field_on, ranks % 2);
  check_subject(generated("kuhn", block), solid_on, 0);
  (void)MPI_Barrier(MPI_COMM_WORLD);
  if (rank == 0) (void)unlink(whole_path);
  if (rank == 0) (void)unlink(shared_path);
}
