/* Asynchronous steps on arrays: equal bits of classes and queue, of cuts, threads, and restarts. */
#include <math.h>
#include <stdlib.h>

#include "core/memory.h"
#include "support/field/steps.h"
#include "support/suite.h"

START_TEST(classes_have_the_bits_of_the_queue)
{
  for (int i = 0; i < STEPPED_MESHES; i++) {
    loaded l = {.s = mesh_of_case(i)};
    load_steps(&l, 2, 1);
    dvi__avi_terms queued = l.s.terms;
    queued.is_queued = 1;
    dvi__avi *a = ran_steps(&l.s.terms, &l.s, 2.345), *b = ran_steps(&queued, &l.s, 2.345);
    check_same(&l.s, a, b);
    ck_assert(energy_of(a) == energy_of(b));
    dvi__avi_destroy(&a), dvi__avi_destroy(&b);
    end_loaded(&l);
  }
}
END_TEST

/* Cuts at times of events, between them, and a rounding beside them. */
START_TEST(cuts_and_observations_change_no_bit)
{
  for (int i = 0; i < 2 * STEPPED_MESHES; i++) {
    loaded l = {.s = mesh_of_case(i / 2)};
    load_steps(&l, 2, 1);
    l.s.terms.is_free = i % 2;
    dvi_march_facts facts;
    dvi__avi *whole = ran_steps(&l.s.terms, &l.s, 1.5), *cut = avi_of(&l.s.terms);
    dvi__avi_facts(whole, &facts);
    start_at_random(&l.s, cut, 7);
    for (int n = 1; n * facts.step < 1.5; n++) {
      advance_to(cut, n * facts.step);
      advance_to(cut, n * facts.step * (1 + 4e-16));
      free(forms_of(&l.s, cut));
      advance_to(cut, fmin((n + 0.3) * facts.step, 1.5));
      (void)energy_of(cut);
    }
    advance_to(cut, 1.5);
    check_same(&l.s, whole, cut);
    dvi__avi_destroy(&whole), dvi__avi_destroy(&cut);
    end_loaded(&l);
  }
}
END_TEST

START_TEST(threads_change_no_bit)
{
  const int cells = is_short_run() ? 50 : 80;
  loaded l = {.s = stepped_mesh(grid_mesh("box", 2, cells, 1.5), 1, 1)};
  load_steps(&l, 1, 1);
  dvi__avi_terms several = l.s.terms;
  several.threads = 3;
  dvi__avi *a = ran_steps(&l.s.terms, &l.s, 0.05), *b = ran_steps(&several, &l.s, 0.05);
  check_same(&l.s, a, b);
  dvi__avi_destroy(&a), dvi__avi_destroy(&b);
  end_loaded(&l);
}
END_TEST

START_TEST(a_loaded_state_goes_on_with_the_same_bits)
{
  for (int i = 0; i < 2 * STEPPED_MESHES; i++) {
    loaded l = {.s = mesh_of_case(i / 2)};
    load_steps(&l, 2, 1);
    l.s.terms.is_free = i % 2;
    dvi__avi *whole = ran_steps(&l.s.terms, &l.s, 0.7),
             *restored = ran_steps(&l.s.terms, &l.s, 0.2);
    reload_steps(whole, restored);
    ck_assert(dvi__avi_time(restored) == 0.7);
    advance_to(whole, 1.9);
    advance_to(restored, 1.9);
    check_same(&l.s, whole, restored);
    ck_assert(dvi__avi_gauss(whole) == dvi__avi_gauss(restored));
    dvi__avi_destroy(&whole), dvi__avi_destroy(&restored);
    end_loaded(&l);
  }
}
END_TEST

static void check_stranger(const dvi__sections *sections, const dvi__avi_terms *terms,
                           const stepped *s)
{
  dvi__avi *stranger = ran_steps(terms, s, 0.2);
  const double before = energy_of(stranger);
  ck_assert_int_eq(dvi__avi_load(stranger, sections), DVI_BAD_FILE);
  check_words("other stars, steps or currents");
  ck_assert(dvi__avi_time(stranger) == 0.2 && energy_of(stranger) == before);
  dvi__avi_destroy(&stranger);
}

START_TEST(states_of_other_steps_are_refused)
{
  loaded l = {.s = mesh_of_case(0)};
  load_steps(&l, 2, 1);
  dvi__sections_writer writer;
  dvi__sections sections = {0};
  dvi__avi *avi = ran_steps(&l.s.terms, &l.s, 0.7);
  dvi__sections_start(&writer, 100);
  dvi__avi_save(avi, &writer);
  ck_assert_int_eq(dvi__sections_finish(&writer), DVI_OK);
  ck_assert_int_eq(dvi__sections_check(&sections, "state", writer.bytes, writer.size), DVI_OK);
  dvi__avi_terms other = l.s.terms;
  other.fraction = 0.4;
  check_stranger(&sections, &other, &l.s);
  other = l.s.terms;
  other.is_queued = 1;
  check_stranger(&sections, &other, &l.s);
  other = l.s.terms;
  other.currents = 1;
  check_stranger(&sections, &other, &l.s);
  dvi__sections_clear(&sections);
  dvi__release(writer.bytes);
  dvi__avi_destroy(&avi);
  end_loaded(&l);
}
END_TEST

SUITE(avi_bits)
{
  tcase_add_test(tests, classes_have_the_bits_of_the_queue);
  tcase_add_test(tests, cuts_and_observations_change_no_bit);
  tcase_add_test(tests, threads_change_no_bit);
  tcase_add_test(tests, a_loaded_state_goes_on_with_the_same_bits);
  tcase_add_test(tests, states_of_other_steps_are_refused);
}
