/* labels: unit */
/* Recordings of marches of all kinds are what the marches show by hand, bit for bit. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/memory.h"
#include "support/field/marches.h"
#include "support/field/schroedinger.h"
#include "support/field/solids.h"
#include "support/meshes.h"
#include "support/suite.h"
#include "support/waves/boxes.h"
#include "support/waves/lattices.h"

static const double start_at[] = {1, 0.5};

/* A march, and what it is of. */
typedef struct moved {
  dvi_march *march;
  dvi_field *field;
  dvi_elastic *solid;
  quantum quantum;
  lattice lattice;
} moved;

static void start_random(dvi_march *march)
{
  double *E = random_values(dvi_march_size(march, DVI_FORM_E), 7);
  const dvi_march_state state = {.size = sizeof state, .t = 0.25, .E = E};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
  free(E);
}

static void make_maxwell(moved *m, const char *method)
{
  static const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};
  static const dvi_field_probe ear = {
      .name = "ear", .of = "E", .at = {0.4, 0.6}, .along = {1, 0.5}};
  dvi_mesh *mesh = staggered_mesh(4, 5);
  const dvi_star_options options = {.size = sizeof options};
  const dvi_march_options how = {.size = sizeof how, .method = method};
  dvi_star *star = NULL;
  ck_assert_int_eq(dvi_star_create(mesh, &options, &star), DVI_OK);
  const dvi_maxwell_terms terms = {
      .size = sizeof terms, .star = star, .wall = &pec, .walls = 1, .probe = &ear, .probes = 1};
  ck_assert_int_eq(dvi_maxwell_create(&terms, &m->field), DVI_OK);
  ck_assert_msg(dvi_march_create(m->field, &how, &m->march) == DVI_OK, "%s", dvi_last_error());
  start_random(m->march);
  dvi_mesh_destroy(&mesh);
  dvi_star_destroy(&star);
}

/* Boxes with a source at their middle, if a signal is given. */
static dvi_march *sourced_boxes(dvi_yee_signal *signal)
{
  const dvi_yee_dipole dipole = {.at = {0.5, 0.5, 0}, .along = {1, 1, 0}, .signal = signal};
  const dvi_yee_terms terms = {.size = sizeof terms,
                               .axes = 2,
                               .degree = 1,
                               .axis = {{.cells = 4}, {.cells = 4}},
                               .dipole = &dipole,
                               .dipoles = signal != NULL};
  dvi_march *march = box_march(&terms);
  start_random(march);
  return march;
}

static void make_solid(moved *m, const char *method)
{
  double rate[3 * 64];
  m->solid = block(3, 2, 1, DVI_ELASTIC_SVK);
  m->march = march_of_solid(m->solid, method, 0.5);
  spin_block(m->solid, 1, rate);
  start_march_of_solid(m->march, NULL, rate);
}

static double hump(double t, const double *x, const void *of)
{
  (void)of;
  return exp(cos(x[0])) + .5 * sin(x[0] + t);
}

static void make_lattice(moved *m)
{
  m->lattice = (lattice){.axes = 1, .cells = 15, .V = "sine", .step = .13};
  m->march = lattice_march(&m->lattice);
  lattice_start(m->march, &m->lattice, hump, NULL);
}

static void make_wave(moved *m)
{
  m->quantum = quantum_on_line("fem:degree=3,cells=10,lumped=yes", -8, 8, 0, harmonic, 1);
  m->march = quantum_march(&m->quantum, "split:order=4", 0.05);
  start_wave(m->march, &m->quantum, packet, start_at);
}

enum { LEAPFROG, AVI, TENTS, BOXES, SOLID, VERLET, LATTICE, WAVE, KINDS };

static void make(int kind, moved *m)
{
  *m = (moved){.march = NULL};
  switch (kind) {
  case LEAPFROG: make_maxwell(m, "leapfrog"); break;
  case AVI: make_maxwell(m, "avi"); break;
  case TENTS: make_maxwell(m, "tents"); break;
  case BOXES: m->march = sourced_boxes(NULL); break;
  case SOLID: make_solid(m, "avi"); break;
  case VERLET: make_solid(m, "verlet"); break;
  case LATTICE: make_lattice(m); break;
  default: make_wave(m); break;
  }
}

static void end(moved *m)
{
  dvi_march_destroy(&m->march);
  dvi_field_destroy(&m->field);
  dvi_elastic_destroy(&m->solid);
  free_quantum(&m->quantum);
}

/* Give the forms that a march has. */
static unsigned forms_of(const dvi_march *march)
{
  unsigned found = 0;
  for (int form = 0; form < 3; form++)
    if (dvi_march_size(march, (dvi_march_form)form) > 0) found |= (unsigned)DVI_RECORD_A << form;
  return found;
}

static dvi_recording *record(dvi_march *march, dvi_march_record_options options)
{
  dvi_recording *made = NULL;
  options.size = sizeof options;
  const dvi_status status = dvi_march_record(march, &options, &made);
  ck_assert_msg(status == DVI_OK, "%s", dvi_last_error());
  return made;
}

static const double *part(const dvi_recording *made, unsigned which, int *width)
{
  const double *rows = dvi_recording_part(made, (dvi_record_part)which, width);
  ck_assert_ptr_nonnull(rows);
  return rows;
}

/* Require that a row is what a march shows. */
static void check_row(const dvi_recording *made, int64_t row, const dvi_march *march)
{
  int width, observables;
  ck_assert_double_eq(part(made, DVI_RECORD_T, &width)[row], dvi_march_time(march));
  for (int form = 0; form < 3; form++) {
    if (dvi_march_size(march, (dvi_march_form)form) == 0) continue;
    const double *rows = part(made, (unsigned)DVI_RECORD_A << form, &width);
    double *now = sample_march(march, (dvi_march_form)form);
    ck_assert_int_eq(width, dvi_march_size(march, (dvi_march_form)form));
    ck_assert_mem_eq(rows + row * width, now, (size_t)width * sizeof *now);
    free(now);
  }
  const double *observed = part(made, DVI_RECORD_OBSERVABLES, &observables);
  ck_assert_ptr_null(dvi_march_observable(march, observables));
  for (int i = 0; i < observables; i++)
    ck_assert_double_eq(observed[row * observables + i],
                        observe_march(march, dvi_march_observable(march, i)));
}

/* ---- rows ---- */

START_TEST(rows_are_what_every_kind_of_march_shows_by_hand)
{
  enum { ROWS = 6 };
  moved a, b, whole;
  volatile int cancel = 0;
  make(_i, &a);
  make(_i, &b);
  make(_i, &whole);
  const double t0 = dvi_march_time(a.march), every = 0.21, t_end = t0 + 1;
  dvi_march_facts before, after;
  dvi_march_facts_of(a.march, &before);
  ck_assert_double_gt(before.longest, 0);
  dvi_recording *made = record(
      a.march, (dvi_march_record_options){.t_end = t_end,
                                          .every = every,
                                          .parts = forms_of(a.march) | DVI_RECORD_OBSERVABLES,
                                          .cancel = _i % 2 ? &cancel : NULL});
  ck_assert_int_eq(dvi_recording_rows(made), ROWS);
  for (int k = 0; k < ROWS; k++) {
    if (k > 0) advance_march(b.march, k < ROWS - 1 ? t0 + k * every : t_end);
    check_row(made, k, b.march);
  }
  advance_march(whole.march, t_end);
  check_row(made, ROWS - 1, whole.march);
  dvi_march_facts_of(a.march, &after);
  ck_assert_int_eq(dvi_recording_report(made)->steps, after.steps - before.steps);
  ck_assert_int_eq(dvi_recording_report(made)->end, DVI_RUN_COMPLETE);
  end(&a); /* the recording outlives the march */
  ck_assert_int_eq(dvi_recording_rows(made), ROWS);
  dvi_recording_destroy(&made);
  end(&b);
  end(&whole);
}
END_TEST

START_TEST(rows_stand_at_given_times_and_have_the_chosen_columns)
{
  static const double times[] = {0.25, 0.5, 0.5, 0.9};
  static const int cell[] = {7, 3, 3}, energy[] = {0};
  moved a, b;
  int width;
  make(LEAPFROG, &a);
  make(LEAPFROG, &b);
  dvi_recording *made = record(
      a.march, (dvi_march_record_options){.t_end = 1.5,
                                          .times = times,
                                          .time_count = 4,
                                          .parts = DVI_RECORD_E | DVI_RECORD_OBSERVABLES,
                                          .cell = {NULL, cell},
                                          .cell_count = {0, 3},
                                          .observable = energy,
                                          .observable_count = 1});
  ck_assert_int_eq(dvi_recording_rows(made), 4);
  ck_assert_double_eq(dvi_march_time(a.march), 1.5);
  ck_assert_mem_eq(part(made, DVI_RECORD_T, &width), times, sizeof times);
  for (int k = 0; k < 4; k++) {
    double E[3];
    advance_march(b.march, times[k]);
    ck_assert_int_eq(dvi_march_sample(b.march, DVI_FORM_E, 3, cell, E), DVI_OK);
    ck_assert_mem_eq(part(made, DVI_RECORD_E, &width) + 3 * k, E, sizeof E);
    ck_assert_int_eq(width, 3);
    ck_assert_double_eq(part(made, DVI_RECORD_OBSERVABLES, &width)[k],
                        observe_march(b.march, "energy"));
    ck_assert_int_eq(width, 1);
  }
  ck_assert_ptr_null(dvi_recording_part(made, DVI_RECORD_B, NULL));
  ck_assert_ptr_null(dvi_recording_part(made, DVI_RECORD_Q, NULL));
  ck_assert_ptr_null(dvi_recording_event(made, 0));
  ck_assert_int_eq(dvi_recording_derive(made, DVI_RECORD_V), DVI_BAD_ARGUMENT);
  dvi_recording_destroy(&made);
  end(&a);
  end(&b);
}
END_TEST

static void check_times(dvi_march *march, double t_end, double every, int rows)
{
  const double t0 = dvi_march_time(march);
  dvi_recording *made = record(march, (dvi_march_record_options){.t_end = t_end, .every = every});
  const double *t = part(made, DVI_RECORD_T, NULL);
  ck_assert_int_eq(dvi_recording_rows(made), rows);
  ck_assert_double_eq(t[0], t0);
  ck_assert_double_eq(t[rows - 1], t_end);
  for (int k = 1; k < rows - 1; k++) ck_assert_double_eq(t[k], t0 + k * every);
  dvi_recording_destroy(&made);
}

START_TEST(the_last_row_is_the_end)
{
  moved m;
  make(LEAPFROG, &m);
  check_times(m.march, 0.25, 0, 1);
  check_times(m.march, 0.25, 1, 1);
  check_times(m.march, 0.3, 0, 2);
  check_times(m.march, 0.4, 1, 2);
  check_times(m.march, 0.7, 0.1, 4); /* roundings leave no row just before the end */
  check_times(m.march, 1, 0.07, 6);
  end(&m);
}
END_TEST

/* ---- ends before the end ---- */

static volatile int cancelled;

/* Cancel the run from t = 1 on. */
static int cancelling(double t, double *value, void *user)
{
  (void)user;
  *value = 0.1;
  if (t > 1) cancelled = 1;
  return 0;
}

START_TEST(a_cancelled_run_ends_with_a_row_where_it_stands)
{
  static const double times[] = {0.25, 2e6};
  for (int given = 0; given < 2; given++) {
    dvi_march *march = sourced_boxes(cancelling);
    cancelled = 0;
    dvi_recording *made = record(march, (dvi_march_record_options){.t_end = 2e6,
                                                                   .times = given ? times : NULL,
                                                                   .time_count = 2 * given,
                                                                   .cancel = &cancelled});
    const double end = dvi_march_time(march);
    ck_assert_int_eq(dvi_recording_report(made)->end, DVI_RUN_CANCELLED);
    ck_assert_int_eq(dvi_recording_rows(made), 2 - given);
    ck_assert(end > 0.9 && end < 1.1 + 32 * step_of_march(march));
    if (!given) ck_assert_double_eq(part(made, DVI_RECORD_T, NULL)[1], end);
    dvi_recording_destroy(&made);
    dvi_march_destroy(&march);
  }
}
END_TEST

START_TEST(a_run_that_is_cancelled_before_it_begins_has_its_start)
{
  moved m;
  const int set = 1;
  make(AVI, &m);
  dvi_recording *made = record(m.march,
                               (dvi_march_record_options){.t_end = 9, .every = 1, .cancel = &set});
  ck_assert_int_eq(dvi_recording_rows(made), 2);
  ck_assert_double_eq(dvi_march_time(m.march), 0.25);
  ck_assert_int_eq(dvi_recording_report(made)->steps, 0);
  dvi_recording_destroy(&made);
  end(&m);
}
END_TEST

/* A current whose signal fails from t = 1 on. */
static int failing(double t, double *value, void *user)
{
  (void)user;
  *value = 0.1;
  return t > 1 ? -7 : 0;
}

START_TEST(a_failed_run_has_the_rows_before)
{
  dvi_march *march = sourced_boxes(failing);
  dvi_recording *made = NULL;
  const dvi_march_record_options options = {
      .size = sizeof options, .t_end = 2.25, .every = 0.25, .parts = DVI_RECORD_E};
  ck_assert_int_eq(dvi_march_record(march, &options, &made), DVI_CALLBACK_FAILED);
  check_words("-7");
  const int64_t rows = dvi_recording_rows(made);
  ck_assert(rows == 3 || rows == 4); /* the signal may be looked at half a step before */
  ck_assert_int_eq(dvi_recording_report(made)->end, DVI_RUN_FAILED);
  ck_assert_int_gt(dvi_recording_report(made)->steps, 0);
  ck_assert_double_ge(dvi_march_time(march), part(made, DVI_RECORD_T, NULL)[rows - 1]);
  dvi_recording_destroy(&made);
  dvi_march_destroy(&march);
}
END_TEST

START_TEST(a_recording_without_memory_fails_and_leaks_nothing)
{
  moved m;
  dvi_recording *made = NULL;
  make(LEAPFROG, &m);
  const dvi_march_record_options options = {
      .size = sizeof options, .t_end = 0.5, .every = 0.1, .parts = DVI_RECORD_E};
  dvi_status status = DVI_NO_MEMORY;
  for (int successes = 0; status != DVI_OK; successes++) {
    ck_assert_int_lt(successes, 20);
    dvi__fail_allocations_after(successes);
    status = dvi_march_record(m.march, &options, &made);
    dvi__fail_allocations_after(-1);
    ck_assert(status == DVI_OK || status == DVI_NO_MEMORY);
    if (status != DVI_OK) ck_assert_ptr_null(made);
  }
  dvi_recording_destroy(&made);
  end(&m);
}
END_TEST

/* ---- refused ---- */

static void check_refused(dvi_march *march, dvi_march_record_options options, dvi_status expected,
                          const char *words)
{
  dvi_recording *made = NULL;
  const double t = dvi_march_time(march);
  options.size = sizeof options;
  ck_assert_int_eq(dvi_march_record(march, &options, &made), expected);
  check_words(words);
  ck_assert_ptr_null(made);
  ck_assert_double_eq(dvi_march_time(march), t);
}

START_TEST(times_that_make_no_sense_are_refused)
{
  static const double back[] = {0.5, 0.4}, late[] = {0.5, 1.5}, early[] = {0.1}, none[] = {NAN};
  moved m;
  make(LEAPFROG, &m);
  const double *const wrong[] = {back, late, early, none};
  for (int i = 0; i < 4; i++)
    check_refused(
        m.march,
        (dvi_march_record_options){.t_end = 1, .times = wrong[i], .time_count = 1 + (i < 2)},
        DVI_BAD_ARGUMENT, "times must go on from");
  check_refused(m.march, (dvi_march_record_options){.t_end = 1, .times = back}, DVI_BAD_ARGUMENT,
                "0 times, and their list is given");
  check_refused(m.march, (dvi_march_record_options){.t_end = 1, .time_count = 2}, DVI_BAD_ARGUMENT,
                "2 times, and their list is NULL");
  check_refused(m.march, (dvi_march_record_options){.t_end = 0.2}, DVI_BAD_ARGUMENT, "t_end");
  check_refused(m.march, (dvi_march_record_options){.t_end = NAN}, DVI_BAD_ARGUMENT, "t_end");
  check_refused(m.march, (dvi_march_record_options){.t_end = 1, .every = -1}, DVI_BAD_ARGUMENT,
                "every = -1");
  check_refused(m.march, (dvi_march_record_options){.t_end = 1, .every = NAN}, DVI_BAD_ARGUMENT,
                "every");
  check_refused(m.march,
                (dvi_march_record_options){.t_end = 1, .every = 1, .times = back, .time_count = 1},
                DVI_BAD_ARGUMENT, "and times are given");
  check_refused(m.march, (dvi_march_record_options){.t_end = 1e9, .every = 1e-9}, DVI_BAD_SIZE,
                "2^53");
  end(&m);
}
END_TEST

START_TEST(columns_that_do_not_exist_are_refused)
{
  static const int beyond[] = {0, 1000}, first[] = {0};
  moved m;
  make(LEAPFROG, &m);
  dvi_march_record_options options = {.t_end = 1, .parts = DVI_RECORD_Q};
  check_refused(m.march, options, DVI_BAD_ARGUMENT, "no march has");
  options.parts = DVI_RECORD_A;
  check_refused(m.march, options, DVI_UNSUPPORTED, "no form A");
  options = (dvi_march_record_options){
      .t_end = 1, .parts = DVI_RECORD_B, .cell = {NULL, NULL, beyond}, .cell_count = {0, 0, 2}};
  check_refused(m.march, options, DVI_BAD_ARGUMENT, "cell 1000 of B is not from 0 to");
  options.parts = DVI_RECORD_E;
  check_refused(m.march, options, DVI_BAD_ARGUMENT, "2 cells of B, whose list is given, and it");
  options = (dvi_march_record_options){.t_end = 1, .parts = DVI_RECORD_E, .cell_count = {0, -1}};
  check_refused(m.march, options, DVI_BAD_ARGUMENT, "-1 cells of E, whose list is NULL");
  options = (dvi_march_record_options){.t_end = 1, .observable = beyond, .observable_count = 2};
  check_refused(m.march, options, DVI_BAD_ARGUMENT, "observable 1000 is not from 0 to");
  options = (dvi_march_record_options){
      .t_end = 1, .parts = DVI_RECORD_E, .observable = first, .observable_count = 1};
  check_refused(m.march, options, DVI_BAD_ARGUMENT, "1 observables, whose list is given, and they");
  end(&m);
}
END_TEST

START_TEST(missing_arguments_and_starts_are_refused)
{
  moved m;
  dvi_recording *made = NULL;
  const dvi_march_record_options options = {.size = sizeof options, .t_end = 1}, unsized = {0};
  make(LEAPFROG, &m);
  ck_assert_int_eq(dvi_march_record(NULL, &options, &made), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_march_record(m.march, NULL, &made), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_march_record(m.march, &options, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_march_record(m.march, &unsized, &made), DVI_BAD_ARGUMENT);
  check_words("sizeof(dvi_march_record_options)");
  dvi_march *other = NULL;
  const dvi_march_options how = {.size = sizeof how};
  ck_assert_int_eq(dvi_march_create(m.field, &how, &other), DVI_OK);
  ck_assert_int_eq(dvi_march_record(other, &options, &made), DVI_BAD_STATE);
  dvi_march_destroy(&other);
  end(&m);
}
END_TEST

/* ---- states in memory ---- */

static unsigned char *saved(const dvi_march *march, size_t *size)
{
  ck_assert_int_eq(dvi_march_save_memory(march, NULL, 0, size), DVI_OK);
  unsigned char *bytes = malloc(*size);
  ck_assert_int_eq(dvi_march_save_memory(march, bytes, *size - 1, size), DVI_BAD_SIZE);
  check_words("are needed");
  ck_assert_int_eq(dvi_march_save_memory(march, bytes, *size, size), DVI_OK);
  return bytes;
}

START_TEST(a_state_in_memory_goes_on_with_the_same_bits)
{
  moved a, b;
  size_t size;
  make(_i, &a);
  make(_i, &b);
  const double t_end = dvi_march_time(a.march) + 1;
  advance_march(a.march, t_end - 0.6);
  unsigned char *bytes = saved(a.march, &size);
  const size_t cuts[] = {0, 1, 8, size / 3, size / 2, size - 8, size - 1};
  for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
    ck_assert_int_eq(dvi_march_load_memory(b.march, bytes, cuts[i]), DVI_BAD_FILE);
    check_words("checkpoint in memory: cut short");
    ck_assert_double_eq(dvi_march_time(b.march), t_end - 1);
  }
  bytes[size / 2] ^= 1;
  ck_assert_int_eq(dvi_march_load_memory(b.march, bytes, size), DVI_BAD_FILE);
  bytes[size / 2] ^= 1;
  ck_assert_int_eq(dvi_march_load_memory(b.march, bytes, size), DVI_OK);
  advance_march(a.march, t_end);
  dvi_recording *made = record(
      b.march, (dvi_march_record_options){.t_end = t_end,
                                          .parts = forms_of(b.march) | DVI_RECORD_OBSERVABLES});
  check_row(made, 1, a.march);
  dvi_recording_destroy(&made);
  free(bytes);
  end(&a);
  end(&b);
}
END_TEST

START_TEST(states_without_a_place_are_refused)
{
  moved m;
  size_t size;
  char byte = 0;
  make(LEAPFROG, &m);
  ck_assert_int_eq(dvi_march_save_memory(NULL, NULL, 0, &size), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_march_save_memory(m.march, NULL, 0, NULL), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_march_load_memory(NULL, &byte, 1), DVI_BAD_ARGUMENT);
  ck_assert_int_eq(dvi_march_load_memory(m.march, NULL, 1), DVI_BAD_ARGUMENT);
  end(&m);
}
END_TEST

SUITE(record_march)
{
  tcase_add_loop_test(tests, rows_are_what_every_kind_of_march_shows_by_hand, 0, KINDS);
  tcase_add_test(tests, rows_stand_at_given_times_and_have_the_chosen_columns);
  tcase_add_test(tests, the_last_row_is_the_end);
  tcase_add_test(tests, a_cancelled_run_ends_with_a_row_where_it_stands);
  tcase_add_test(tests, a_run_that_is_cancelled_before_it_begins_has_its_start);
  tcase_add_test(tests, a_failed_run_has_the_rows_before);
  tcase_add_test(tests, a_recording_without_memory_fails_and_leaks_nothing);
  tcase_add_test(tests, times_that_make_no_sense_are_refused);
  tcase_add_test(tests, columns_that_do_not_exist_are_refused);
  tcase_add_test(tests, missing_arguments_and_starts_are_refused);
  tcase_add_loop_test(tests, a_state_in_memory_goes_on_with_the_same_bits, 0, KINDS);
  tcase_add_test(tests, states_without_a_place_are_refused);
}
