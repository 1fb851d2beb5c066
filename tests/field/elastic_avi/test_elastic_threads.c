/* Asynchronous steps on several threads: the bits are those of one. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "field/elastic_avi/parts.h"
#include "support/field/generated.h"
#include "support/field/solids.h"
#include "support/suite.h"

enum { NUMBERS_MOST = 3 * 1300, THREADS_MOST = 4, WAYS = 3, SOLIDS = 5 };

/* ---- solids ---- */

static int shake(double t, const double *X, double *u, double *rate, void *user)
{
  (void)user;
  memset(u, 0, 3 * sizeof *u);
  memset(rate, 0, 3 * sizeof *rate);
  u[0] = 0.02 * sin(3 * t) * (1 + X[1]);
  rate[0] = 0.06 * cos(3 * t) * (1 + X[1]);
  return 0;
}

static int weight(double t, const double *X, const double *normal, double *force, void *user)
{
  (void)normal, (void)user;
  force[0] = 0.1 * cos(2 * t);
  force[1] = 0.05 * X[0];
  force[2] = -1;
  return 0;
}

static const dvi_elastic_condition condition = {.part = "left", .displacement = shake};
static const dvi_elastic_load load = {.part = "all", .force = weight};
static const dvi_obstacle obstacles[] = {{.name = "floor",
                                          .kind = DVI_OBSTACLE_PLANE,
                                          .point = {0, 0, -0.02},
                                          .normal = {0, 0, 1},
                                          .restitution = 0.7,
                                          .friction = 0.3},
                                         {.name = "shell",
                                          .kind = DVI_OBSTACLE_HOLLOW,
                                          .point = {0.5, 0.5, 0.5},
                                          .radius = 0.92,
                                          .restitution = 1}};

/* A free block in space or in a plane, one among obstacles, one that is driven and loaded, and one
 * with damping, too. */
static dvi_elastic *solid_of(int number)
{
  if (number < 2) return block(3 - number, 5 + 3 * number, 3, DVI_ELASTIC_SVK);
  const dvi_generator_options options = {.cells = {4, 3, 3}, .grading = {3}};
  dvi_elastic_material material = unit_material(DVI_ELASTIC_NEO_HOOKEAN);
  dvi_elastic_terms terms = {.obstacle = obstacles, .obstacles = 2};
  if (number > 2) {
    terms.condition = &condition, terms.conditions = 1;
    terms.load = &load, terms.loads = 1;
  }
  if (number == 4) material.alpha = 0.7, material.beta = 0.02;
  return solid_on(generated("kuhn", options), material, terms);
}

/* Classes, free steps, and equal steps. */
static dvi__solid_request request_of(int way, int threads)
{
  return (dvi__solid_request){
      .fraction = 0.6, .threads = threads, .is_free = way == 1, .is_equal = way == 2};
}

static dvi__solid_avi *started(const dvi_elastic *solid, const dvi__solid_request *request,
                               double t, double scale)
{
  double rate[NUMBERS_MOST];
  dvi__solid_avi *avi;
  spin_block(solid, scale, rate);
  ck_assert_msg(dvi__solid_avi_create(solid, request, &avi) == DVI_OK, "%s", dvi_last_error());
  ck_assert_msg(dvi__solid_avi_start(avi, t, NULL, rate) == DVI_OK, "%s", dvi_last_error());
  return avi;
}

static void advance(dvi__solid_avi *avi, double t)
{
  ck_assert_msg(dvi__solid_avi_advance(avi, t) == DVI_OK, "%s", dvi_last_error());
}

/* Require that all that is stored has the same bits. */
static void check_same(const dvi__solid_avi *a, const dvi__solid_avi *b)
{
  ck_assert_uint_eq(a->size, b->size);
  ck_assert_mem_eq(a->block, b->block, a->size);
  ck_assert(a->clock.events == b->clock.events && a->clock.slot == b->clock.slot);
  ck_assert(a->clock.t == b->clock.t && a->clock.checks == b->clock.checks);
}

/* ---- facts ---- */

START_TEST(threads_change_no_bit)
{
  const int way = _i % WAYS;
  dvi_elastic *solid = solid_of(_i / WAYS);
  dvi__solid_avi *avi[THREADS_MOST];
  for (int i = 0; i < THREADS_MOST; i++) {
    const dvi__solid_request request = request_of(way, i + 1);
    avi[i] = started(solid, &request, 0, 1);
    advance(avi[i], 1.2);
    check_same(avi[0], avi[i]);
  }
  for (int i = 0; i < THREADS_MOST; i++) dvi__solid_avi_destroy(avi + i);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* The calendars of the parts are read as one. */
START_TEST(parts_have_the_bits_of_the_order_by_time)
{
  dvi_elastic *solid = solid_of(_i / THREADS_MOST);
  const dvi__solid_request request = request_of(1, 1 + _i % THREADS_MOST);
  dvi__solid_avi *usual = started(solid, &request, 0, 1), *plain = started(solid, &request, 0, 1);
  advance(usual, 1.2);
  ck_assert_int_eq(dvi__solid_run_in_order(plain, 1.2).returned, 0);
  ck_assert_mem_eq(usual->block, plain->block, usual->size);
  ck_assert(usual->clock.events == plain->clock.events);
  dvi__solid_avi_destroy(&usual);
  dvi__solid_avi_destroy(&plain);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(parts_have_equal_work_and_short_edges)
{
  const dvi_generator_options options = {.cells = {24, 6, 6}, .extent = {4, 1, 1}, .grading = {2}};
  dvi_elastic *solid = solid_on(generated("kuhn", options), unit_material(DVI_ELASTIC_SVK),
                                (dvi_elastic_terms){0});
  const dvi__solid_request request = request_of(_i, 2);
  dvi__solid_avi *avi = started(solid, &request, 0, 0.1);
  const dvi__solid_parts *parts = avi->parts;
  advance(avi, 0.2);
  ck_assert_int_eq(parts->count, 2);
  ck_assert_int_lt(llabs((long long)(parts->part[0].events - parts->part[1].events)),
                   avi->clock.events / 10);
  ck_assert_int_lt(parts->edges, avi->active / 2);
  if (!avi->is_free) ck_assert_int_le(parts->foreign_start[parts->edges], 4 * parts->edges);
  dvi__solid_avi_destroy(&avi);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(the_solids_hit_their_obstacles_where_threads_share_them)
{
  dvi_elastic *solid = solid_of(3);
  const dvi__solid_request request = request_of(0, 1);
  dvi__solid_avi *avi = started(solid, &request, 0, 1);
  int64_t hits = 0;
  advance(avi, 1.2);
  for (int64_t v = 0; v < avi->vertices; v++) hits += avi->state.touch[v].hits;
  ck_assert_int_gt(hits, 10);
  dvi__solid_avi_destroy(&avi);
  dvi_elastic_destroy(&solid);
}
END_TEST

START_TEST(cuts_change_no_bit_on_threads)
{
  dvi_elastic *solid = solid_of(4);
  const dvi__solid_request one = request_of(_i, 1), three = request_of(_i, 3);
  dvi__solid_avi *whole = started(solid, &one, 0, 1), *cut = started(solid, &three, 0, 1);
  advance(whole, 1);
  for (int k = 1; k < 40; k++) {
    advance(cut, k / 40.0);
    ck_assert(dvi__solid_avi_look(cut) == DVI_OK);
  }
  advance(cut, 1);
  check_same(whole, cut);
  dvi__solid_avi_destroy(&whole);
  dvi__solid_avi_destroy(&cut);
  dvi_elastic_destroy(&solid);
}
END_TEST

static dvi_march *march_of(const dvi_elastic *solid, int way, int threads)
{
  static const char *const methods[] = {"avi", "avi:classes=no", "verlet"};
  const dvi_march_options options = {
      .size = sizeof options, .method = methods[way], .fraction = 0.6, .threads = threads};
  dvi_march *march = NULL;
  ck_assert_msg(dvi_elastic_march_create(solid, &options, &march) == DVI_OK, "%s",
                dvi_last_error());
  return march;
}

/* The calendars begin late here, at any phase of their rings. */
START_TEST(a_march_is_saved_on_two_threads_and_goes_on_with_one_or_three)
{
  const int counts[] = {1, 2, 3};
  char path[64];
  double values[3][NUMBERS_MOST], E[NUMBERS_MOST];
  dvi_elastic *solid = solid_of(_i / WAYS ? 4 : 0);
  dvi_march *whole = march_of(solid, _i % WAYS, 2);
  (void)snprintf(path, sizeof path, "elastic_threads_%d_%d.state", _i, (int)getpid());
  spin_block(solid, -1, E);
  const dvi_march_state start = {.size = sizeof start, .E = E};
  ck_assert(dvi_march_start(whole, &start) == DVI_OK);
  ck_assert(dvi_march_advance(whole, 1.234) == DVI_OK);
  ck_assert(dvi_march_save(whole, path) == DVI_OK);
  for (int k = 0; k < 3; k++) {
    dvi_march *march = march_of(solid, _i % WAYS, counts[k]);
    ck_assert(dvi_march_load(march, path) == DVI_OK);
    ck_assert(dvi_march_advance(march, 2) == DVI_OK);
    ck_assert(dvi_march_sample(march, DVI_FORM_E, 0, NULL, values[k]) == DVI_OK);
    dvi_march_destroy(&march);
  }
  (void)remove(path);
  ck_assert(dvi_march_advance(whole, 2) == DVI_OK);
  const size_t size = (size_t)dvi_march_size(whole, DVI_FORM_E) * sizeof(double);
  ck_assert(dvi_march_sample(whole, DVI_FORM_E, 0, NULL, E) == DVI_OK);
  for (int k = 0; k < 3; k++) ck_assert_mem_eq(values[k], E, size);
  dvi_march_destroy(&whole);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* A block that is thrown at itself folds its cells. */
START_TEST(an_inverted_cell_stops_all_threads_where_it_stops_one)
{
  dvi_elastic *solid = block(3, 3, 2, DVI_ELASTIC_NEO_HOOKEAN);
  dvi__solid_avi *avi[THREADS_MOST];
  char message[THREADS_MOST][512];
  for (int i = 0; i < THREADS_MOST; i++) {
    dvi__solid_request request = request_of(_i, i + 1);
    request.band = 1e9;
    avi[i] = started(solid, &request, 0, 40);
    ck_assert_int_eq(dvi__solid_avi_advance(avi[i], 5), DVI_SINGULAR);
    (void)snprintf(message[i], sizeof message[i], "%s", dvi_last_error());
    ck_assert_str_eq(message[i], message[0]);
    check_same(avi[0], avi[i]);
    ck_assert_int_eq(dvi__solid_avi_advance(avi[i], 5), DVI_SINGULAR);
    check_same(avi[0], avi[i]);
  }
  for (int i = 0; i < THREADS_MOST; i++) dvi__solid_avi_destroy(avi + i);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* Far from rest the bound at rest is none. The march stands before that, and can go on a bit. */
START_TEST(what_is_not_finite_is_taken_back_on_all_threads)
{
  dvi_elastic *solid = block(3, 3, 2, DVI_ELASTIC_SVK);
  dvi__solid_avi *avi[2];
  for (int i = 0; i < 2; i++) {
    dvi__solid_request request = request_of(_i, 1 + 2 * i);
    request.fraction = 0.9;
    request.band = 1e300;
    avi[i] = started(solid, &request, 0, 6);
    dvi_status status = DVI_OK;
    for (int k = 1; status == DVI_OK && k < 100; k++)
      status = dvi__solid_avi_advance(avi[i], 0.7 * k);
    ck_assert_msg(status == DVI_NOT_FINITE, "%s", dvi_last_error());
    for (int64_t v = 0; v < avi[i]->vertices; v++)
      for (int k = 0; k < 3; k++) ck_assert(isfinite(avi[i]->state.node[v].v[k]));
    check_same(avi[0], avi[i]);
  }
  for (int i = 0; i < 2; i++) advance(avi[i], avi[i]->clock.t + 0.5 * avi[i]->shortest);
  check_same(avi[0], avi[1]);
  for (int i = 0; i < 2; i++) dvi__solid_avi_destroy(avi + i);
  dvi_elastic_destroy(&solid);
}
END_TEST

/* ---- any order ---- */

static double next_time(const dvi__solid_avi *avi, const int64_t *count, int64_t c)
{
  return dvi__solid_event_time(avi, c, count[c] + 1);
}

/* Whether no cell with a common node has an earlier event. */
static int is_ready(const dvi__solid_avi *avi, const int64_t *count, int64_t c)
{
  const int width = avi->n + 1;
  const double t = next_time(avi, count, c);
  for (int a = 0; a < width; a++) {
    const int v = avi->cell[c].corner[a];
    for (int64_t k = avi->cell_start[v]; k < avi->cell_start[v + 1]; k++) {
      const int other = avi->cell_of[k];
      const double then = next_time(avi, count, other);
      if (then < t || (then == t && other < c)) return 0;
    }
  }
  return 1;
}

/* Let events happen in any order that keeps that of each node. Cells are tried at random. */
static void run_at_random(dvi__solid_avi *avi, double limit, uint64_t seed)
{
  int64_t *count = calloc((size_t)avi->cells, sizeof *count), left = 0;
  for (int64_t c = 0; c < avi->active; c++) left += next_time(avi, count, c) <= limit;
  while (left > 0) {
    seed = seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    const int64_t c = (int64_t)((seed >> 33) % (uint64_t)avi->active);
    const double t = next_time(avi, count, c);
    if (t > limit || !is_ready(avi, count, c)) continue;
    ck_assert_int_eq(dvi__solid_act(avi, c, t), 0);
    count[c]++;
    left -= next_time(avi, count, c) > limit;
  }
  if (avi->state.count != NULL) memcpy(avi->state.count, count, (size_t)avi->cells * sizeof *count);
  free(count);
}

START_TEST(any_order_that_keeps_that_of_each_node_gives_the_same_bits)
{
  dvi_elastic *solid = solid_of(_i / WAYS);
  const dvi__solid_request request = request_of(_i % WAYS, 1);
  dvi__solid_avi *usual = started(solid, &request, 0, 1), *random = started(solid, &request, 0, 1);
  const double limit = 0.3;
  advance(usual, limit);
  run_at_random(random, limit * (1 + 8e-16), 25 + (uint64_t)_i);
  ck_assert_mem_eq(usual->block, random->block, usual->size);
  dvi__solid_avi_destroy(&usual);
  dvi__solid_avi_destroy(&random);
  dvi_elastic_destroy(&solid);
}
END_TEST

SUITE(elastic_threads)
{
  tcase_add_loop_test(tests, threads_change_no_bit, 0, WAYS * SOLIDS);
  tcase_add_loop_test(tests, parts_have_the_bits_of_the_order_by_time, 0, SOLIDS * THREADS_MOST);
  tcase_add_loop_test(tests, parts_have_equal_work_and_short_edges, 0, WAYS);
  tcase_add_test(tests, the_solids_hit_their_obstacles_where_threads_share_them);
  tcase_add_loop_test(tests, cuts_change_no_bit_on_threads, 0, WAYS);
  tcase_add_loop_test(tests, a_march_is_saved_on_two_threads_and_goes_on_with_one_or_three, 0,
                      2 * WAYS);
  tcase_add_loop_test(tests, an_inverted_cell_stops_all_threads_where_it_stops_one, 0, WAYS);
  tcase_add_loop_test(tests, what_is_not_finite_is_taken_back_on_all_threads, 0, WAYS);
  tcase_add_loop_test(tests, any_order_that_keeps_that_of_each_node_gives_the_same_bits, 0,
                      WAYS * SOLIDS);
}
