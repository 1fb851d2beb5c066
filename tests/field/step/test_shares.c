/* Fields on shares of a mesh: every bit of every step is that of the whole mesh, for any number of
 * processes and any division, and so are the bound of the steps, energies, charges and probes. */
#include <stdlib.h>
#include <string.h>

#include "support/field/generated.h"
#include "support/field/ranks.h"
#include "support/shares/shares.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { PROCESSES = 6 };

/* What is measured on the whole mesh, and what differs on shares. */
typedef struct trial {
  whole_run whole;
  int64_t wrong[PROCESSES];
  char sentence[PROCESSES][256];
} trial;

static void try_share(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  t->wrong[rank] = run_share(share, rank, &t->whole);
  if (t->wrong[rank] < 0) (void)strncpy(t->sentence[rank], dvi_last_error(), 255);
}

/* Divide the cells at random, or in the order of their numbers. */
static void divide(int64_t cells, int count, int at_random, int *owner)
{
  unsigned long long state = 77 + (unsigned)count;
  for (int64_t c = 0; c < cells; c++)
    owner[c] = at_random ? (int)(count * random_number(&state)) : (int)(c * count / cells);
  for (int r = 0; r < count; r++) owner[r] = r;
}

static void check_shares(dvi_mesh *mesh, dvi_field *(*make)(const dvi_mesh *mesh))
{
  trial t = {.whole = {.make = make}};
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  int *owner = malloc((size_t)cells * sizeof *owner);
  run_whole(mesh, &t.whole);
  for (int count = 1; count <= PROCESSES - 1; count++)
    for (int at_random = 0; at_random < 2; at_random++) {
      memset(t.wrong, 0, sizeof t.wrong);
      divide(cells, count, at_random, owner);
      run_ranks(mesh, count, owner, try_share, &t);
      for (int r = 0; r < count; r++)
        ck_assert_msg(t.wrong[r] == 0, "process %d of %d, division %d: %lld: %s", r, count,
                      at_random, (long long)t.wrong[r], t.sentence[r]);
    }
  whole_run_clear(&t.whole);
  free(owner);
  dvi_mesh_destroy(&mesh);
}

START_TEST(tetrahedra_have_the_bits_of_the_whole_mesh)
{
  const dvi_generator_options bcc = {.cells = {3, 3, 3}, .extent = {1, 1, 1}};
  const double period[] = {1, 1, 1};
  check_shares(with_core_and_exit(generated("bcc-torus", bcc), period), lossy_field);
}
END_TEST

START_TEST(triangles_have_the_bits_of_the_whole_mesh)
{
  check_shares(with_core_and_exit(staggered_mesh(9, 10), NULL), lossy_field);
  check_shares(equilateral_torus(6, 8), cavity_field);
}
END_TEST

START_TEST(intervals_have_the_bits_of_the_whole_mesh)
{
  const dvi_generator_options options = {.cells = {40}, .grading = {1.3}};
  check_shares(with_core_and_exit(generated("interval", options), NULL), lossy_field);
}
END_TEST

START_TEST(boxes_have_the_bits_of_the_whole_mesh)
{
  const dvi_generator_options options = {.cells = {5, 4, 3}, .grading = {1.2, 1, 1.4}};
  check_shares(generated("box", options), cavity_field);
  check_shares(with_core_and_exit(generated("box", options), NULL), lossy_field);
}
END_TEST

START_TEST(waves_have_the_bits_of_the_whole_mesh)
{
  check_shares(with_core_and_exit(staggered_mesh(8, 9), NULL), driven_wave);
  check_shares(with_core_and_exit(grid_mesh("box", 3, 4, 1.2), NULL), driven_wave);
}
END_TEST

/* ---- steps that are too long ---- */

typedef struct refusals {
  dvi_status status[PROCESSES];
  char sentence[PROCESSES][256];
} refusals;

static void march_too_fast(const dvi_mesh *mesh, int rank, void *user)
{
  refusals *r = user;
  const dvi_march_options options = {.size = sizeof options, .step = 1};
  dvi_field *field = lossy_field(mesh);
  dvi_march *march = NULL;
  r->status[rank] = dvi_march_create(field, &options, &march);
  (void)strncpy(r->sentence[rank], dvi_last_error(), 255);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}

/* The owner of the cell that makes the bound says what one process says, with the cell's number in
 * the whole mesh. */
START_TEST(a_step_that_is_too_long_is_refused_with_the_sentence_of_one_process)
{
  const dvi_generator_options options = {.cells = {4, 4, 4}, .grading = {1.2, 1, 1.4}};
  dvi_mesh *mesh = with_core_and_exit(generated("box", options), NULL);
  refusals whole = {.status = {DVI_OK}}, here = {.status = {DVI_OK}};
  int owner[64], namers = 0;
  march_too_fast(mesh, 0, &whole);
  divide(64, PROCESSES - 1, _i, owner);
  run_ranks(mesh, PROCESSES - 1, owner, march_too_fast, &here);
  for (int r = 0; r < PROCESSES - 1; r++) {
    const int is_namer = strcmp(here.sentence[r], whole.sentence[0]) == 0;
    namers += is_namer;
    ck_assert_int_eq(here.status[r], DVI_BAD_ARGUMENT);
    ck_assert_msg(is_namer || strstr(here.sentence[r], "another one of 5 processes") != NULL, "%s",
                  here.sentence[r]);
  }
  ck_assert_int_eq(namers, 1);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- values that overflow ---- */

/* The field is large at half of the edges of the whole mesh. */
static void march_beyond(const dvi_mesh *mesh, int rank, void *user)
{
  refusals *r = user;
  const int64_t edges = dvi_mesh_count(mesh, 1);
  double *E = calloc((size_t)edges, sizeof *E);
  for (int64_t e = 0; e < edges; e++)
    if (dvi_mesh_share_numbers(mesh, 1)[e] < 150) E[e] = e % 2 ? 1.7e308 : -1.7e308;
  dvi_field *field = cavity_field(mesh);
  dvi_march *march = NULL;
  const dvi_march_state state = {.size = sizeof state, .E = E};
  ck_assert_int_eq(dvi_march_create(field, NULL, &march), DVI_OK);
  ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  r->status[rank] = dvi_march_advance(march, 2);
  (void)strncpy(r->sentence[rank], dvi_last_error(), 255);
  ck_assert_int_eq(dvi_march_advance(march, 3), DVI_BAD_STATE);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
  free(E);
}

START_TEST(values_that_overflow_are_refused_by_all_processes)
{
  dvi_mesh *mesh = generated("box", (dvi_generator_options){.cells = {4, 4, 4}});
  refusals here = {.status = {DVI_OK}};
  int owner[64];
  divide(64, 3, 0, owner);
  run_ranks(mesh, 3, owner, march_beyond, &here);
  for (int r = 0; r < 3; r++) {
    ck_assert_int_eq(here.status[r], DVI_NOT_FINITE);
    ck_assert_msg(strstr(here.sentence[r], "has overflowed") != NULL ||
                      strstr(here.sentence[r], "another one of 3 processes") != NULL,
                  "%s", here.sentence[r]);
  }
  dvi_mesh_destroy(&mesh);
}
END_TEST

static int keep_values(int degree, double *values, void *user)
{
  (void)degree, (void)values, (void)user;
  return 0;
}

static int keep_sums(int count, int64_t *number, void *user)
{
  (void)count, (void)number, (void)user;
  return 0;
}

static int keep_largest(int count, double *number, void *user)
{
  (void)count, (void)number, (void)user;
  return 0;
}

/* Cut the second half out of a mesh. */
static dvi_status cut_half(const dvi_mesh *mesh, dvi_mesh **half)
{
  const dvi_ranks ranks = {.size = sizeof ranks,
                           .rank = 1,
                           .count = 2,
                           .refresh = keep_values,
                           .sum = keep_sums,
                           .largest = keep_largest};
  int owner[64];
  divide(64, 2, 0, owner);
  return dvi_mesh_cut(mesh, owner, &ranks, half);
}

/* The share of one process is cut as the whole mesh is. Others, of which cells are missing, are
 * refused. */
static void cut_again(const dvi_mesh *share, int rank, void *user)
{
  const dvi_mesh *half = user;
  dvi_mesh *again = NULL, *third = NULL;
  (void)rank;
  ck_assert_int_eq(cut_half(share, &again), DVI_OK);
  for (int k = 0; k <= 3; k++) {
    const size_t cells = (size_t)dvi_mesh_count(half, k);
    ck_assert_int_eq(dvi_mesh_count(again, k), (int64_t)cells);
    ck_assert_mem_eq(dvi_mesh_share_numbers(again, k), dvi_mesh_share_numbers(half, k),
                     cells * sizeof(int64_t));
    ck_assert_mem_eq(dvi_mesh_share_owners(again, k), dvi_mesh_share_owners(half, k),
                     cells * sizeof(int));
  }
  ck_assert_int_eq(cut_half(again, &third), DVI_UNSUPPORTED);
  dvi_mesh_destroy(&again);
}

START_TEST(the_share_of_one_process_can_be_cut)
{
  const dvi_generator_options options = {.cells = {4, 4, 4}, .grading = {1.2, 1, 1.4}};
  dvi_mesh *mesh = with_core_and_exit(generated("box", options), NULL), *half = NULL;
  const int owner[64] = {0};
  ck_assert_int_eq(cut_half(mesh, &half), DVI_OK);
  run_ranks(mesh, 1, owner, cut_again, half);
  dvi_mesh_destroy(&half);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(shares)
{
  tcase_add_test(tests, the_share_of_one_process_can_be_cut);
  tcase_add_test(tests, tetrahedra_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, triangles_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, intervals_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, boxes_have_the_bits_of_the_whole_mesh);
  tcase_add_test(tests, waves_have_the_bits_of_the_whole_mesh);
  tcase_add_loop_test(tests, a_step_that_is_too_long_is_refused_with_the_sentence_of_one_process, 0,
                      2);
  tcase_add_test(tests, values_that_overflow_are_refused_by_all_processes);
}
