/* Solids that several processes share: marches have every byte of those of the whole mesh, and what
 * one process cannot do ends all of them. Processes are threads. */
#include <dvi/march.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "field/elastic_avi/borders.h"
#include "support/field/generated.h"
#include "support/field/ranks.h"
#include "support/field/solids.h"
#include "support/meshes.h"
#include "support/suite.h"

enum { SOLIDS = 4, METHODS = 3, MOST = 4, LOOKS = 2, OBSERVED = 12 };

static const char *const method[METHODS] = {"verlet", "avi", "avi:classes=no"};

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

/* `user` is not NULL on a process that fails from t = 0.1 on. */
static int weigh(double t, const double *X, const double *normal, double *force, void *user)
{
  force[0] = 0.1 * cos(2 * t) + (normal != NULL ? 0.1 * normal[0] : 0);
  force[1] = 0.05 * X[0];
  force[2] = -1;
  return user != NULL && t > 0.1;
}

static dvi_mesh *mesh_of(int number)
{
  const dvi_generator_options space = {.cells = {5, 3, 2}, .extent = {2, 1, 1}, .grading = {2}},
                              plane = {.cells = {7, 5}, .extent = {1, 1}, .grading = {2}};
  return generated("kuhn", number == 1 ? plane : space);
}

/* A free block in space and one in a plane, one that is driven, loaded and held in part, and one of
 * two materials with a damping. */
static dvi_status create(int number, const dvi_mesh *mesh, void *fails, dvi_elastic **solid)
{
  dvi_elastic_material material[2] = {unit_material(DVI_ELASTIC_NEO_HOOKEAN),
                                      unit_material(DVI_ELASTIC_SVK)};
  const dvi_elastic_condition condition[] = {{.part = "left", .displacement = shake},
                                             {.part = "bottom", .component = {0, 1}}};
  const dvi_elastic_load load[] = {{.part = "all", .force = weigh, .user = fails},
                                   {.part = "right", .force = weigh}};
  dvi_elastic_terms terms = {
      .size = sizeof terms, .mesh = mesh, .material = material, .materials = 1};
  if (number >= 2) {
    terms.condition = condition, terms.conditions = 2;
    terms.load = load, terms.loads = 2;
  }
  if (number == 3) material[0].alpha = 0.7;
  return dvi_elastic_create(&terms, solid);
}

/* ---- marches ---- */

/* What a march shows. */
typedef struct shown {
  double step, value[LOOKS][OBSERVED];
  int64_t updates;
  size_t size;
  unsigned char *bytes[LOOKS];
} shown;

typedef struct trial {
  int solid, method, failing, threads; /* of each process */
  const dvi_mesh *whole;
  shown of_whole;
  double *u; /* of the whole mesh at the end */
  dvi_status end[MOST];
  double stands[MOST];
  char wrong[MOST][300];
} trial;

#define WRONG(...) ((void)snprintf(wrong, 300, __VA_ARGS__))

static int64_t whole_number(const dvi_mesh *mesh, int64_t vertex)
{
  const int64_t *number = dvi_mesh_share_numbers(mesh, 0);
  return number != NULL ? number[vertex] : vertex;
}

/* The rates of other processes' nodes do not matter. */
static dvi_status start(dvi_march *march, const dvi_mesh *mesh, int rank)
{
  const int n = dvi_mesh_dimension(mesh), *owner = dvi_mesh_share_owners(mesh, 0);
  const int64_t vertices = dvi_mesh_count(mesh, 0);
  const double *X = dvi_mesh_points(mesh);
  double *E = calloc((size_t)(vertices * n), sizeof *E);
  for (int64_t v = 0; v < vertices; v++)
    for (int i = 0; i < n; i++)
      E[v * n + i] = owner != NULL && owner[v] != rank
                         ? 1e3
                         : 0.1 * sin(X[v * n] + 2 * X[v * n + 1] + (double)i);
  const dvi_march_state state = {.size = sizeof state, .E = E};
  const dvi_status status = dvi_march_start(march, &state);
  free(E);
  return status;
}

static dvi_status make(const dvi_mesh *mesh, const trial *t, int rank, void *fails,
                       dvi_elastic **solid, dvi_march **march)
{
  const dvi_march_options options = {.size = sizeof options,
                                     .method = method[t->method],
                                     .fraction = 0.6,
                                     .threads = mesh != t->whole ? t->threads : 1};
  dvi_status status = create(t->solid, mesh, fails, solid);
  if (status == DVI_OK) status = dvi_elastic_march_create(*solid, &options, march);
  if (status == DVI_OK) status = start(*march, mesh, rank);
  return status;
}

static unsigned char *state_of(const dvi_march *march, size_t *size)
{
  *size = 0;
  if (dvi_march_save_memory(march, NULL, 0, size) != DVI_OK) return NULL;
  unsigned char *bytes = malloc(*size);
  const size_t capacity = *size;
  if (dvi_march_save_memory(march, bytes, capacity, size) == DVI_OK) return bytes;
  free(bytes);
  return NULL;
}

static double time_of_look(int look)
{
  return 0.05 * (look + 1);
}

static void run(const dvi_mesh *mesh, const trial *t, int rank, shown *to, double *u, char *wrong)
{
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  *to = (shown){.step = 0};
  if (make(mesh, t, rank, NULL, &solid, &march) != DVI_OK) WRONG("%.250s", dvi_last_error());
  for (int s = 0; s < LOOKS && *wrong == '\0'; s++) {
    if (dvi_march_advance(march, time_of_look(s)) != DVI_OK) WRONG("%.250s", dvi_last_error());
    for (int i = 0; i < OBSERVED && dvi_march_observable(march, i) != NULL; i++)
      if (dvi_march_observe(march, i, &to->value[s][i]) != DVI_OK)
        WRONG("%.250s", dvi_last_error());
    to->bytes[s] = state_of(march, &to->size);
  }
  if (*wrong == '\0') {
    dvi_march_facts facts;
    dvi_march_facts_of(march, &facts);
    to->step = facts.step;
    to->updates = facts.updates;
    if (dvi_march_sample(march, DVI_FORM_A, 0, NULL, u) != DVI_OK)
      WRONG("%.250s", dvi_last_error());
  }
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}

static void forget(shown *of)
{
  for (int s = 0; s < LOOKS; s++) free(of->bytes[s]);
}

/* ---- comparisons ---- */

static void compare(const shown *here, const shown *whole, char *wrong)
{
  if (here->step != whole->step || here->updates != whole->updates)
    WRONG("the step %.17g, not %.17g, or %lld events, not %lld", here->step, whole->step,
          (long long)here->updates, (long long)whole->updates);
  for (int s = 0; s < LOOKS && *wrong == '\0'; s++) {
    for (int i = 0; i < OBSERVED; i++)
      if (here->value[s][i] != whole->value[s][i])
        WRONG("observable %d at look %d: %.17g, not %.17g", i, s, here->value[s][i],
              whole->value[s][i]);
    if (here->bytes[s] == NULL || here->size != whole->size)
      WRONG("state %d of %zu bytes, not %zu", s, here->size, whole->size);
    else if (memcmp(here->bytes[s], whole->bytes[s], here->size) != 0)
      WRONG("the bytes of state %d", s);
  }
}

/* Load a state of the whole mesh, and go on. */
static void go_on(const dvi_mesh *share, const trial *t, int rank, char *wrong)
{
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  size_t size = 0;
  unsigned char *bytes = NULL;
  if (make(share, t, rank, NULL, &solid, &march) != DVI_OK ||
      dvi_march_load_memory(march, t->of_whole.bytes[0], t->of_whole.size) != DVI_OK ||
      dvi_march_advance(march, time_of_look(LOOKS - 2)) != DVI_OK ||
      dvi_march_advance(march, time_of_look(LOOKS - 1)) != DVI_OK)
    WRONG("loading: %.250s", dvi_last_error());
  else if ((bytes = state_of(march, &size)) == NULL ||
           memcmp(bytes, t->of_whole.bytes[LOOKS - 1], size) != 0)
    WRONG("the bytes after loading");
  free(bytes);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}

static void run_share(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  const int n = dvi_mesh_dimension(share);
  char *wrong = t->wrong[rank];
  double *u = calloc((size_t)(dvi_mesh_count(share, 0) * n), sizeof *u);
  shown here;
  run(share, t, rank, &here, u, wrong);
  if (*wrong == '\0') compare(&here, &t->of_whole, wrong);
  for (int64_t v = 0; v < dvi_mesh_count(share, 0) && *wrong == '\0'; v++)
    if (memcmp(u + v * n, t->u + whole_number(share, v) * n, (size_t)n * sizeof *u) != 0)
      WRONG("the displacement of vertex %lld", (long long)whole_number(share, v));
  forget(&here);
  free(u);
  go_on(share, t, rank, wrong);
}

/* Slices of the numbers, or cells at random. */
static int *owners_of(const dvi_mesh *mesh, int count, int style)
{
  const int64_t cells = dvi_mesh_count(mesh, dvi_mesh_dimension(mesh));
  unsigned long long state = 5;
  int *owner = malloc((size_t)cells * sizeof *owner);
  for (int64_t c = 0; c < cells; c++) {
    owner[c] = style == 0 ? (int)(c * count / cells) : (int)(count * random_number(&state));
    if (c < count) owner[c] = (int)c;
  }
  return owner;
}

static trial begin(int solid, int of_method)
{
  trial t = {.solid = solid, .method = of_method, .whole = mesh_of(solid)};
  char wrong[300] = "";
  t.u = calloc((size_t)(dvi_mesh_count(t.whole, 0) * 3), sizeof *t.u);
  run(t.whole, &t, 0, &t.of_whole, t.u, wrong);
  ck_assert_msg(*wrong == '\0', "%s", wrong);
  return t;
}

static void end(trial *t)
{
  dvi_mesh *whole = (dvi_mesh *)t->whole;
  forget(&t->of_whole);
  free(t->u);
  dvi_mesh_destroy(&whole);
}

static void check_divisions(trial *t, int most)
{
  for (int count = 1; count <= most; count++)
    for (int style = 0; style < 1 + (count > 1); style++) {
      int *owner = owners_of(t->whole, count, style);
      run_ranks(t->whole, count, owner, run_share, t);
      for (int r = 0; r < count; r++)
        ck_assert_msg(t->wrong[r][0] == '\0', "%s of solid %d, process %d of %d: %s",
                      method[t->method], t->solid, r, count, t->wrong[r]);
      free(owner);
    }
}

START_TEST(all_divisions_have_the_bytes_of_the_whole_mesh)
{
  trial t = begin(_i / METHODS, _i % METHODS);
  check_divisions(&t, MOST);
  end(&t);
}
END_TEST

/* Free steps have messages instead of slots, and one thread. */
START_TEST(threads_of_each_process_have_the_bytes_of_the_whole_mesh)
{
  trial t = begin(1 + _i / 2, _i % 2);
  t.threads = 2;
  check_divisions(&t, 2);
  end(&t);
}
END_TEST

/* ---- failures ---- */

/* Fail on one process, and keep where the march stands then. */
static void run_failing(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  size_t size = 0;
  int yes = 1;
  if (make(share, t, rank, rank == t->failing ? &yes : NULL, &solid, &march) == DVI_OK)
    t->end[rank] = dvi_march_advance(march, 0.3);
  t->stands[rank] = dvi_march_time(march);
  unsigned char *bytes = state_of(march, &size);
  if (rank == 0) t->of_whole.bytes[1] = bytes, t->of_whole.size = size;
  if (rank != 0) free(bytes);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}

/* All march on up to the last event before, as one process does. */
START_TEST(what_fails_on_one_process_fails_on_all)
{
  const int threaded = _i >= 3 * METHODS, i = _i - 3 * METHODS;
  trial t = {.solid = 2,
             .method = threaded ? i : _i % METHODS,
             .failing = threaded ? i : _i / METHODS,
             .threads = threaded ? 2 : 1,
             .whole = mesh_of(2)};
  int *owner = owners_of(t.whole, 3, 0);
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  size_t size = 0;
  run_ranks(t.whole, 3, owner, run_failing, &t);
  for (int r = 0; r < 3; r++) {
    ck_assert_int_eq(t.end[r], DVI_CALLBACK_FAILED);
    ck_assert_double_eq(t.stands[r], t.stands[0]);
  }
  ck_assert(t.stands[0] > 0.05 && t.stands[0] <= 0.15);
  ck_assert_int_eq(make(t.whole, &t, 0, NULL, &solid, &march), DVI_OK);
  ck_assert_int_eq(dvi_march_advance(march, t.stands[0]), DVI_OK);
  unsigned char *bytes = state_of(march, &size);
  ck_assert_uint_eq(size, t.of_whole.size);
  ck_assert_mem_eq(bytes, t.of_whole.bytes[1], size);
  free(bytes);
  free(owner);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  end(&t);
}
END_TEST

/* One process has no memory for its k-th array. */
static void run_without_memory(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  if (rank == t->failing % 3) dvi__fail_allocations_after(t->failing);
  t->end[rank] = make(share, t, rank, NULL, &solid, &march);
  if (t->end[rank] == DVI_OK) t->end[rank] = dvi_march_advance(march, 0.01);
  if (t->end[rank] == DVI_OK) t->end[rank] = dvi_march_save_memory(march, NULL, 0, &(size_t){0});
  dvi__fail_allocations_after(-1);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
}

START_TEST(memory_that_lacks_on_one_process_ends_all)
{
  trial t = {.solid = 3, .method = 0, .whole = mesh_of(3)};
  int *owner = owners_of(t.whole, 3, 1), is_over = 0;
  for (t.failing = 0; t.failing < 200 && !is_over; t.failing += 6) {
    run_ranks(t.whole, 3, owner, run_without_memory, &t);
    ck_assert_int_eq(t.end[1], t.end[0]);
    ck_assert_int_eq(t.end[2], t.end[0]);
    is_over = t.end[0] == DVI_OK;
  }
  ck_assert(is_over && t.failing > 30);
  free(owner);
  end(&t);
}
END_TEST

/* ---- what sharing costs ---- */

typedef struct cost {
  int is_free;
  int64_t slots, exchanges[MOST]; /* of classes */
  int64_t events, acts[MOST], acts_at_edges[MOST];
} cost;

/* Events of a cell up to a time. */
static int64_t events_of(const dvi__solid_avi *avi, int64_t c)
{
  return avi->is_free ? avi->state.count[c] : avi->clock.slot >> dvi__solid_class_of(avi, c);
}

static void count_costs(const dvi_mesh *share, int rank, void *user)
{
  cost *s = user;
  dvi_elastic *solid = NULL;
  dvi__solid_avi *avi;
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  const dvi_elastic_terms terms = {
      .size = sizeof terms, .mesh = share, .material = &material, .materials = 1};
  const dvi__solid_request request = {.fraction = 0.6, .threads = 1, .is_free = s->is_free};
  ck_assert_int_eq(dvi_elastic_create(&terms, &solid), DVI_OK);
  ck_assert_int_eq(dvi__solid_avi_create(solid, &request, &avi), DVI_OK);
  ck_assert_int_eq(dvi__solid_avi_start(avi, 0, NULL, NULL), DVI_OK);
  ck_assert_int_eq(dvi__solid_avi_advance(avi, 3 * avi->longest), DVI_OK);
  s->events = avi->clock.events;
  for (int64_t slot = 1; !s->is_free && slot <= avi->clock.slot; slot++)
    s->exchanges[rank] += dvi__solid_class_of_slot(avi, slot) >= avi->borders->first_class;
  s->slots = avi->clock.slot;
  for (int64_t c = 0; c < avi->active; c++) {
    int is_at_edge = 0;
    for (int a = 0; a <= avi->n; a++)
      is_at_edge |= dvi_mesh_share_owners(share, 0)[avi->cell[c].corner[a]] != rank;
    s->acts[rank] += events_of(avi, c);
    if (is_at_edge) s->acts_at_edges[rank] += events_of(avi, c);
  }
  dvi__solid_avi_destroy(&avi);
  dvi_elastic_destroy(&solid);
}

/* A bar that is graded along its length, and cut across it. */
static cost cost_of(int is_free, int64_t *messages, int64_t *numbers)
{
  const dvi_generator_options bar = {.cells = {24, 8, 8}, .extent = {3, 1, 1}, .grading = {2.5}};
  dvi_mesh *mesh = generated("kuhn", bar);
  const int64_t cells = dvi_mesh_count(mesh, 3);
  int *owner = malloc((size_t)cells * sizeof *owner);
  double *X = malloc((size_t)cells * 3 * sizeof *X);
  cost s = {.is_free = is_free};
  ck_assert_int_eq(dvi_mesh_centres(mesh, 3, X), DVI_OK);
  for (int64_t c = 0; c < cells; c++) owner[c] = X[3 * c] > 3 * pow(0.5, 2.5);
  count_letters(messages, numbers);
  run_ranks(mesh, 2, owner, count_costs, &s);
  count_letters(messages, numbers);
  free(owner);
  free(X);
  dvi_mesh_destroy(&mesh);
  return s;
}

/* Cells at edges are computed twice. With classes all other slots go by without a word, and with
 * free steps several places go in one message. */
START_TEST(neighbours_speak_of_what_they_share_alone)
{
  int64_t messages, numbers;
  const cost classes = cost_of(0, &messages, &numbers), free = cost_of(1, &messages, &numbers);
  ck_assert_int_eq(classes.slots, 192);
  for (int r = 0; r < 2; r++) ck_assert_int_eq(classes.exchanges[r], 3);
  ck_assert((double)(classes.acts[0] + classes.acts[1]) < 1.01 * (double)classes.events);
  ck_assert((double)(free.acts[0] + free.acts[1]) < 1.01 * (double)free.events);
  ck_assert(free.acts[0] + free.acts[1] > free.events);
  ck_assert_int_eq(free.acts_at_edges[0], free.acts_at_edges[1]);
  ck_assert_int_eq(numbers, 2 * 8 * free.acts_at_edges[0]);
  ck_assert(messages > 0 && 4 * messages < 3 * 2 * free.acts_at_edges[0]);
}
END_TEST

/* ---- what is refused ---- */

static dvi_status refused(const dvi_mesh *share, int what)
{
  dvi_elastic_material material = unit_material(DVI_ELASTIC_SVK);
  const dvi_elastic_condition condition = {.part = "boundary"};
  const dvi_elastic_load load = {.part = "right", .force = weigh};
  const dvi_obstacle floor = {
      .name = "floor", .kind = DVI_OBSTACLE_PLANE, .point = {0, 0, -1}, .normal = {0, 0, 1}};
  dvi_elastic_terms terms = {
      .size = sizeof terms, .mesh = share, .material = &material, .materials = 1};
  dvi_march_options options = {.size = sizeof options, .method = "avi"};
  dvi_elastic *solid = NULL;
  dvi_march *march = NULL;
  dvi_system *system = NULL;
  double omega;
  if (what == 0) terms.obstacle = &floor, terms.obstacles = 1;
  if (what == 1) material.beta = 0.1;
  if (what == 2) options.method = "avi:classes=no", options.threads = 2;
  if (what == 3) options.method = "verlet", options.step = 1;
  if (what == 4) material.part = "left";
  if (what == 5)
    terms.condition = &condition, terms.conditions = 1, terms.load = &load, terms.loads = 1;
  dvi_status status = dvi_elastic_create(&terms, &solid);
  if (status == DVI_OK && what == 6) status = dvi_elastic_modes(solid, NULL, &omega, NULL, NULL);
  if (status == DVI_OK && what == 7) status = dvi_elastic_system(solid, &system);
  if (status == DVI_OK) status = dvi_elastic_march_create(solid, &options, &march);
  dvi_march_destroy(&march);
  dvi_elastic_destroy(&solid);
  return status;
}

static void refuse(const dvi_mesh *share, int rank, void *user)
{
  trial *t = user;
  t->end[rank] = refused(share, t->failing);
  (void)snprintf(t->wrong[rank], sizeof t->wrong[rank], "%s", dvi_last_error());
}

START_TEST(what_needs_a_whole_mesh_is_refused)
{
  static const struct {
    dvi_status status;
    const char *words;
  } expected[] = {{DVI_UNSUPPORTED, "an obstacle needs a whole mesh"},
                  {DVI_UNSUPPORTED, "a damping beta needs a whole mesh"},
                  {DVI_UNSUPPORTED, "avi:classes=no on several threads needs a whole mesh"},
                  {DVI_BAD_ARGUMENT, "of cell 61 near (0, 0.666667, 0): take a shorter step"},
                  {DVI_BAD_ARGUMENT, "a material is set on part \"left\""},
                  {DVI_BAD_ARGUMENT, "the load on part \"right\" does nothing"},
                  {DVI_UNSUPPORTED, "modes needs a whole mesh"},
                  {DVI_UNSUPPORTED, "the mechanical system of a solid needs a whole mesh"}};
  trial t = {.failing = _i, .whole = mesh_of(0)};
  int *owner = owners_of(t.whole, 3, 0);
  run_ranks(t.whole, 3, owner, refuse, &t);
  for (int r = 0; r < 3; r++) {
    ck_assert_int_eq(t.end[r], expected[_i].status);
    ck_assert_msg(strstr(t.wrong[r], expected[_i].words) != NULL, "%s", t.wrong[r]);
  }
  free(owner);
  end(&t);
}
END_TEST

SUITE(elastic_shares)
{
  tcase_add_loop_test(tests, all_divisions_have_the_bytes_of_the_whole_mesh, 0, SOLIDS * METHODS);
  tcase_add_loop_test(tests, what_fails_on_one_process_fails_on_all, 0, 3 * METHODS + 2);
  tcase_add_loop_test(tests, threads_of_each_process_have_the_bytes_of_the_whole_mesh, 0, 4);
  tcase_add_test(tests, memory_that_lacks_on_one_process_ends_all);
  tcase_add_test(tests, neighbours_speak_of_what_they_share_alone);
  tcase_add_loop_test(tests, what_needs_a_whole_mesh_is_refused, 0, 8);
}
