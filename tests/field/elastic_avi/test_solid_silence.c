/* Solids on shares whose processes cannot speak with each other for a while, or whose callbacks
 * fail from any call on: all of it is told, and nothing is left of it later. */
#include <stdlib.h>
#include <string.h>

#include "support/field/generated.h"
#include "support/field/marches.h"
#include "support/field/ranks.h"
#include "support/field/solids.h"
#include "support/suite.h"

enum { PROCESSES = 3 };

static const char *const method[] = {"verlet", "avi"};

static dvi_mesh *mesh_of_plane(void)
{
  return generated("kuhn", (dvi_generator_options){.cells = {6, 5}, .grading = {2}});
}

/* Calls of one process until one of them fails, and all that follow. */
typedef struct patience {
  long calls, most;
} patience;

static int weigh(double t, const double *X, const double *normal, double *force, void *user)
{
  patience *p = user;
  (void)normal;
  force[0] = 0.1 * t;
  force[1] = 0.05 * X[0];
  return ++p->calls > p->most;
}

static dvi_status make(const dvi_mesh *mesh, const char *name, patience *p, dvi_elastic **solid,
                       dvi_march **march)
{
  const dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  const dvi_elastic_load load = {.part = "all", .force = weigh, .user = p};
  const dvi_elastic_terms terms = {.size = sizeof terms,
                                   .mesh = mesh,
                                   .material = &material,
                                   .materials = 1,
                                   .load = &load,
                                   .loads = 1};
  const dvi_march_options options = {.size = sizeof options, .method = name};
  const dvi_march_state state = {.size = sizeof state};
  dvi_status status = dvi_elastic_create(&terms, solid);
  if (status == DVI_OK) status = dvi_elastic_march_create(*solid, &options, march);
  return status == DVI_OK ? dvi_march_start(*march, &state) : status;
}

/* ---- processes that do not answer ---- */

/* Values of others stay as they are. One of the calls fails. */
typedef struct line {
  long calls, failing;
} line;

static int refresh(int degree, double *values, void *user)
{
  line *l = user;
  (void)degree, (void)values;
  return l->calls++ == l->failing ? 3 : 0;
}

static int sum(int count, int64_t *number, void *user)
{
  (void)count, (void)number, (void)user;
  return 0;
}

static int largest(int count, double *number, void *user)
{
  line *l = user;
  (void)count, (void)number;
  return l->calls++ == l->failing ? 4 : 0;
}

/* Whichever call of a run fails, the run fails. What is lost comes back by a start. */
START_TEST(silence_is_told_until_a_start)
{
  dvi_mesh *whole = mesh_of_plane(), *share = NULL;
  int owner[60];
  line l = {.failing = -1};
  const dvi_ranks ranks = {.size = sizeof ranks,
                           .count = 2,
                           .refresh = refresh,
                           .sum = sum,
                           .largest = largest,
                           .user = &l};
  patience p = {.most = 1000000000};
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  const dvi_march_state state = {.size = sizeof state};
  double value;
  for (int c = 0; c < 60; c++) owner[c] = c >= 30;
  ck_assert_int_eq(dvi_mesh_cut(whole, owner, &ranks, &share), DVI_OK);
  ck_assert_int_eq(make(share, method[_i], &p, &solid, &march), DVI_OK);
  for (long k = 0; k < 40; k++) {
    l = (line){.failing = k};
    ck_assert_int_eq(dvi_march_advance(march, 0.2), DVI_CALLBACK_FAILED);
    const dvi_status observed = dvi_march_observe(march, 0, &value);
    ck_assert(observed == DVI_BAD_STATE || observed == DVI_OK);
    ck_assert_int_eq(dvi_march_start(march, &state), DVI_OK);
  }
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  dvi_mesh_destroy(&share);
  dvi_mesh_destroy(&whole);
}
END_TEST

/* ---- callbacks that fail at any call ---- */

typedef struct trial {
  const char *method;
  long most; /* calls of the load of process 1 */
  size_t size;
  unsigned char *bytes; /* of the whole mesh at the end */
  dvi_status status[PROCESSES];
  double stands[PROCESSES];
  int same[PROCESSES];
} trial;

/* The load of process 1 fails from some call on, also where the run is taken back, until the run is
 * over. Then the march goes on. */
static void run_share(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  patience p = {.most = 1000000000};
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  if (make(share, t->method, &p, &solid, &march) == DVI_OK) {
    if (rank == 1) p = (patience){.most = t->most};
    t->status[rank] = dvi_march_advance(march, 0.3);
    t->stands[rank] = dvi_march_time(march);
    p.most = 1000000000;
    (void)dvi_march_advance(march, 0.5);
    t->same[rank] = march_has_bytes(march, t->bytes, t->size);
  }
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}

START_TEST(a_load_that_fails_from_any_call_on_changes_no_bit_later)
{
  dvi_mesh *whole = mesh_of_plane();
  trial t = {.method = method[_i]};
  int owner[60];
  patience p = {.most = 1000000000};
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  ck_assert_int_eq(make(whole, t.method, &p, &solid, &march), DVI_OK);
  ck_assert_int_eq(dvi_march_advance(march, 0.5), DVI_OK);
  t.bytes = save_march(march, &t.size);
  for (int c = 0; c < 60; c++) owner[c] = c * 7 % PROCESSES;
  for (t.most = 20; t.most < 300; t.most += 60) {
    run_ranks(whole, PROCESSES, owner, run_share, &t);
    for (int r = 0; r < PROCESSES; r++) {
      ck_assert_int_eq(t.status[r], DVI_CALLBACK_FAILED);
      ck_assert_double_eq(t.stands[r], t.stands[0]);
      ck_assert_msg(t.same[r], "process %d after %ld calls", r, t.most);
    }
  }
  free(t.bytes);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  dvi_mesh_destroy(&whole);
}
END_TEST

SUITE(solid_silence)
{
  tcase_add_loop_test(tests, silence_is_told_until_a_start, 0, 2);
  tcase_add_loop_test(tests, a_load_that_fails_from_any_call_on_changes_no_bit_later, 0, 2);
}
