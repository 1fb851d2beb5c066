/* States of marches on shares: the file of the whole mesh, which any number of processes loads. */
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "support/field/marches.h"
#include "support/field/ranks.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { BEFORE = 4, AFTER = 9 };

static int ring(double t, double *value, void *user)
{
  (void)user;
  *value = sin(9 * t + 1);
  return 0;
}

static int along_x(const double *x, double *value, void *user)
{
  (void)user;
  value[0] = x[1];
  value[1] = 0.3;
  return 0;
}

typedef struct run {
  dvi_field *field;
  dvi_march *march;
} run;

/* A field with absorbing walls, so that the march keeps A, and charge that two currents move. */
static run run_on(const dvi_mesh *mesh, double permittivity)
{
  run made = {.field = NULL};
  const int64_t cells = dvi_mesh_count(mesh, 2);
  double *eps = malloc((size_t)cells * sizeof *eps);
  for (int64_t c = 0; c < cells; c++) eps[c] = permittivity;
  const double *factor[DVI_MESH_DIMENSION_MAX + 1] = {NULL, eps};
  const dvi_star_options options = {.size = sizeof options, .factor = factor};
  const dvi_wall wall = {.part = "boundary", .kind = DVI_ABSORBING};
  const dvi_current current[] = {{.at = {0.53, 0.41}, .along = {1, 0.5}, .signal = ring},
                                 {.density = along_x, .signal = ring}};
  dvi_star *star = NULL;
  (void)dvi_star_create(mesh, &options, &star);
  const dvi_maxwell_terms terms = {.size = sizeof terms,
                                   .star = star,
                                   .wall = &wall,
                                   .walls = 1,
                                   .current = current,
                                   .currents = 2};
  (void)dvi_maxwell_create(&terms, &made.field);
  (void)dvi_march_create(made.field, NULL, &made.march);
  dvi_star_destroy(&star);
  free(eps);
  return made;
}

static void end(run *of)
{
  dvi_march_destroy(&of->march);
  dvi_field_destroy(&of->field);
}

/* Begin with E = -0 but for a few cells, and A at random. */
static void begin(const dvi_mesh *mesh, dvi_march *march)
{
  const int64_t edges = dvi_mesh_count(mesh, 1), *number = dvi_mesh_share_numbers(mesh, 1);
  double *E = malloc((size_t)edges * sizeof *E);
  for (int64_t e = 0; e < edges; e++) {
    const int64_t i = number != NULL ? number[e] : e;
    E[e] = i % 5 == 0 ? 0.01 * (double)i - 1 : -0.0;
  }
  const dvi_march_state state = {.size = sizeof state, .E = E, .A = E};
  (void)dvi_march_start(march, &state);
  free(E);
}

static dvi_status advance(dvi_march *march, int steps)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  return dvi_march_advance(march, (steps + 0.3) * facts.step);
}

/* Run on the whole mesh. */
static state_trial try_whole(const dvi_mesh *mesh)
{
  state_trial t = {.path = ""};
  run whole = run_on(mesh, 1);
  ck_assert_msg(whole.march != NULL, "%s", dvi_last_error());
  begin(mesh, whole.march);
  ck_assert_int_eq(advance(whole.march, BEFORE), DVI_OK);
  t.saved = save_march(whole.march, &t.size);
  ck_assert_int_eq(advance(whole.march, AFTER), DVI_OK);
  t.later = save_march(whole.march, &t.size);
  end(&whole);
  (void)snprintf(t.path, sizeof t.path, "shares-%ld.state", (long)getpid());
  return t;
}

static void run_divided(const dvi_mesh *mesh, int count, state_trial *t,
                        void (*work)(const dvi_mesh *share, int rank, void *user))
{
  const int64_t cells = dvi_mesh_count(mesh, 2);
  int *owner = malloc((size_t)cells * sizeof *owner);
  for (int64_t c = 0; c < cells; c++) owner[c] = (int)(c * 7 % count);
  run_ranks(mesh, count, owner, work, t);
  free(owner);
}

/* ---- states go from one division to another ---- */

static void save_share(const dvi_mesh *share, int rank, void *user)
{
  state_trial *t = user;
  run here = run_on(share, 1);
  begin(share, here.march);
  (void)advance(here.march, BEFORE);
  t->status[rank] = dvi_march_save(here.march, t->path);
  t->same[rank] = march_has_bytes(here.march, t->saved, t->size);
  end(&here);
}

static void load_share(const dvi_mesh *share, int rank, void *user)
{
  state_trial *t = user;
  run here = run_on(share, 1);
  t->status[rank] = dvi_march_load(here.march, t->path);
  (void)advance(here.march, AFTER);
  t->same[rank] = march_has_bytes(here.march, t->later, t->size);
  end(&here);
}

static void check_all(const state_trial *t, int count, dvi_status status, int same)
{
  for (int r = 0; r < count; r++) {
    ck_assert_int_eq(t->status[r], status);
    ck_assert_int_eq(t->same[r], same);
  }
}

START_TEST(a_file_of_shares_is_that_of_the_whole_mesh)
{
  dvi_mesh *mesh = staggered_mesh(6, 7);
  state_trial t = try_whole(mesh);
  for (int count = 1; count <= STATE_TRIAL_MOST; count += 2) {
    run_divided(mesh, count, &t, save_share);
    check_all(&t, count, DVI_OK, 1);
    ck_assert(file_has_bytes(t.path, t.saved, t.size));
    (void)unlink(t.path);
  }
  end_state_trial(&t);
  dvi_mesh_destroy(&mesh);
}
END_TEST

START_TEST(a_run_goes_on_with_the_same_bits_on_any_number_of_processes)
{
  const int counts[] = {1, 2, 5};
  dvi_mesh *mesh = staggered_mesh(6, 7);
  state_trial t = try_whole(mesh);
  run_divided(mesh, 3, &t, save_share);
  for (int i = 0; i < 3; i++) {
    run_divided(mesh, counts[i], &t, load_share);
    check_all(&t, counts[i], DVI_OK, 1);
  }
  load_share(mesh, 0, &t);
  check_all(&t, 1, DVI_OK, 1);
  end_state_trial(&t);
  dvi_mesh_destroy(&mesh);
}
END_TEST

/* ---- states that are refused ---- */

/* Try to load bytes, or on one process the right ones, and see that nothing changes. */
static void refuse_share(const dvi_mesh *share, int rank, void *user)
{
  state_trial *t = user;
  run here = run_on(share, 1);
  begin(share, here.march);
  (void)advance(here.march, BEFORE);
  t->status[rank] = dvi_march_load_memory(here.march, rank == 1 ? t->saved : t->tried,
                                          rank == 1 ? t->size : t->tried_size);
  t->same[rank] = march_has_bytes(here.march, t->saved, t->size);
  end(&here);
}

static void check_refused(const dvi_mesh *mesh, state_trial *t, const unsigned char *bytes,
                          size_t size)
{
  t->tried = bytes;
  t->tried_size = size;
  run_divided(mesh, 3, t, refuse_share);
  check_all(t, 3, DVI_BAD_FILE, 1);
}

START_TEST(all_processes_refuse_what_one_of_them_cannot_load)
{
  dvi_mesh *mesh = staggered_mesh(6, 7);
  state_trial t = try_whole(mesh);
  size_t size;
  run foreign = run_on(mesh, 2);
  begin(mesh, foreign.march);
  unsigned char *bytes = save_march(foreign.march, &size);
  check_refused(mesh, &t, bytes, size);         /* of another field */
  check_refused(mesh, &t, t.saved, t.size - 9); /* cut short */
  check_refused(mesh, &t, t.later, t.size);     /* of another time than that of process 1 */
  free(bytes);
  end(&foreign);
  end_state_trial(&t);
  dvi_mesh_destroy(&mesh);
}
END_TEST

static void load_missing(const dvi_mesh *share, int rank, void *user)
{
  state_trial *t = user;
  run here = run_on(share, 1);
  begin(share, here.march);
  (void)advance(here.march, BEFORE);
  t->status[rank] = dvi_march_load(here.march, "no/such.state");
  if (t->status[rank] == DVI_IO_ERROR)
    t->status[rank] = dvi_march_save(here.march, "no/such.state");
  t->same[rank] = march_has_bytes(here.march, t->saved, t->size);
  end(&here);
}

START_TEST(all_processes_know_that_a_file_is_missing_or_cannot_be_written)
{
  dvi_mesh *mesh = staggered_mesh(6, 7);
  state_trial t = try_whole(mesh);
  run_divided(mesh, 3, &t, load_missing);
  check_all(&t, 3, DVI_IO_ERROR, 1);
  end_state_trial(&t);
  dvi_mesh_destroy(&mesh);
}
END_TEST

SUITE(shares_saved)
{
  tcase_add_test(tests, a_file_of_shares_is_that_of_the_whole_mesh);
  tcase_add_test(tests, a_run_goes_on_with_the_same_bits_on_any_number_of_processes);
  tcase_add_test(tests, all_processes_refuse_what_one_of_them_cannot_load);
  tcase_add_test(tests, all_processes_know_that_a_file_is_missing_or_cannot_be_written);
}
