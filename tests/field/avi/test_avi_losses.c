/* Asynchronous steps with losses, from weak ones to good conductors. */
#include <dvi/forms.h>
#include <dvi/march.h>
#include <dvi/maxwell.h>
#include <math.h>
#include <stdlib.h>

#include "field/avi/engine.h"
#include "support/field/marches.h"
#include "support/field/steps.h"
#include "support/meshes.h"
#include "support/suite.h"

static const double pi = 3.14159265358979323846;

/* ---- one passage ---- */

/* Give an edge a state, and let it pass. */
static dvi__avi_passage pass(dvi__avi *avi, int64_t e, double A, double D, double span,
                             const double *half)
{
  avi->A[e] = A;
  avi->D[e] = D;
  return dvi__avi_passage_of(avi, e, span, half);
}

/* Under a constant current a passage is the exact one, so that it consists of two halves, for all
 * sizes of z = c h from roundings to infinity. What C A - D changes by is the current alone, also
 * if its halves differ, and the way back is a passage, too. */
static void check_passages(dvi__avi *avi, int64_t e, double z)
{
  const double C = avi->extras[avi->extra[e]].damping, h = z / (C * avi->inverse[e]),
               profile = avi->push[avi->extras[avi->extra[e]].push].profile,
               even[] = {0.3 / profile, 0.3 / profile},
               short_even[] = {0.15 / profile, 0.15 / profile},
               uneven[] = {0.2 / profile, 0.7 / profile}, back[] = {-0.7 / profile, -0.2 / profile};
  const dvi__avi_passage whole = pass(avi, e, 0.4, 0.9, h, even),
                         first = pass(avi, e, 0.4, 0.9, 0.5 * h, short_even),
                         second = pass(avi, e, first.A, first.D, 0.5 * h, short_even);
  const double size = fmax(fabs(whole.A), 1);
  ck_assert_double_eq_tol(second.A, whole.A, 1e-14 * size);
  ck_assert_double_eq_tol(second.D, whole.D, 1e-14);
  ck_assert_double_eq_tol(first.delivered + second.delivered, whole.delivered, 1e-14);
  const dvi__avi_passage there = pass(avi, e, 0.4, 0.9, h, uneven);
  ck_assert_double_eq_tol(there.D - 0.9, C * (there.A - 0.4) - 0.9, 2e-15 * (1 + C * size));
  ck_assert_double_eq_tol(there.D + there.delivered, 0.9, 1e-15);
  if (z > 5) return; /* the way back makes roundings larger by exp(z) */
  const dvi__avi_passage home = pass(avi, e, there.A, there.D, -h, back);
  ck_assert_double_eq_tol(home.A, 0.4, 1e-12 * size);
  ck_assert_double_eq_tol(home.D, 0.9, 1e-12);
}

START_TEST(passages_consist_of_passages)
{
  loaded l = {.s = mesh_of_case(0)};
  load_steps(&l, 1, 1);
  dvi__avi *avi = avi_of(&l.s.terms);
  int64_t e = 0;
  while (avi->extra[e] < 0) e++;
  for (int power = -36; power <= 24; power++) check_passages(avi, e, pow(10, 0.5 * power));
  dvi__avi_destroy(&avi);
  end_loaded(&l);
}
END_TEST

/* ---- order ---- */

START_TEST(losses_keep_the_order_two)
{
  static const double damping[] = {0.7, 7, 70};
  for (int i = 0; i < 3; i++) {
    double exact[STRING_VALUES], coarse = 0;
    run_string(0, damping[i], 0.4 / 512, exact);
    for (int k = 0; k < 4; k++) {
      const double fine = string_error(0, damping[i], 0.1 * exp2(-k), exact);
      if (k > 0) ck_assert_double_eq_tol(log2(coarse / fine), 2, k == 1 ? 0.25 : 0.06);
      coarse = fine;
    }
  }
}
END_TEST

/* Give E.C E. */
static double power_of(const loaded *l, const dvi__avi *avi)
{
  double E[13], sum = 0;
  take_form(avi, DVI_FORM_E, E);
  for (int e = 0; e < 13; e++) sum += E[e] * E[e] * l->damping[e];
  return sum;
}

/* The energy that is left after a time, with that which the losses took, beside the first one. */
static double balance(double damping, double fraction)
{
  enum { SAMPLES = 2000 };
  loaded l = {.s = mesh_of_case(2)};
  load_steps(&l, 0, damping);
  l.s.terms.fraction = fraction;
  double A[13], lost = 0;
  for (int e = 0; e < 13; e++) A[e] = sin(pi * dvi_mesh_points(l.s.mesh)[e]);
  dvi__avi *avi = avi_of(&l.s.terms);
  ck_assert_int_eq(dvi__avi_start(avi, 0, A, NULL, NULL), DVI_OK);
  const double start = energy_of(avi);
  for (int n = 1; n <= SAMPLES; n++) {
    lost += 0.5 * power_of(&l, avi) / SAMPLES;
    advance_to(avi, (double)n / SAMPLES);
    lost += 0.5 * power_of(&l, avi) / SAMPLES;
  }
  const double sum = (energy_of(avi) + lost) / start;
  dvi__avi_destroy(&avi);
  end_loaded(&l);
  return sum;
}

START_TEST(losses_are_what_the_energy_lacks)
{
  static const double damping[] = {0.7, 7, 70};
  for (int i = 0; i < 3; i++) {
    const double coarse = balance(damping[i], 0.1) - 1, fine = balance(damping[i], 0.025) - 1;
    ck_assert_double_lt(fabs(fine), 2e-5);
    ck_assert_double_eq_tol(coarse / fine, 16, 0.5);
  }
}
END_TEST

/* ---- conductors ---- */

static int field_lines(const double *x, double *B, void *user)
{
  (void)user;
  B[0] = cos(pi * x[0]) * cos(pi * x[1]);
  return 0;
}

/* A graded box with a conductor where x < inside. */
static dvi_field *conducting_box(double sigma, double inside)
{
  dvi_mesh *mesh = grid_mesh("box", 2, 8, 2.5);
  const dvi_wall pec = {.part = "boundary", .kind = DVI_PEC};
  double conductivity[64];
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  for (int c = 0; c < 64; c++) {
    double x = 0;
    int width;
    const int *vertex = dvi_mesh_vertices(mesh, 2, &width);
    for (int i = 0; i < 4; i++) x += dvi_mesh_points(mesh)[2 * vertex[4 * c + i]] / 4;
    conductivity[c] = x < inside ? sigma : 0;
  }
  ck_assert_int_eq(dvi_star_create(mesh, NULL, &star), DVI_OK);
  const dvi_maxwell_terms terms = {
      .size = sizeof terms, .star = star, .wall = &pec, .walls = 1, .conductivity = conductivity};
  ck_assert_msg(dvi_maxwell_create(&terms, &field) == DVI_OK, "%s", dvi_last_error());
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return field;
}

/* Start from E = 0 and a B that varies. */
static dvi_march *diffusing(const dvi_field *field, const char *method, double fraction)
{
  const dvi_march_options options = {
      .size = sizeof options, .method = method, .fraction = fraction, .span = 1};
  dvi_march *march = NULL;
  ck_assert_msg(dvi_march_create(field, &options, &march) == DVI_OK, "%s", dvi_last_error());
  const int64_t faces = dvi_march_size(march, DVI_FORM_B);
  double *B = zeros(faces);
  dvi_mesh *mesh = grid_mesh("box", 2, 8, 2.5);
  ck_assert_int_eq(dvi_form_integrate(mesh, 2, field_lines, NULL, B), DVI_OK);
  const dvi_march_state state = {.size = sizeof state, .B = B};
  ck_assert_msg(dvi_march_start(march, &state) == DVI_OK, "%s", dvi_last_error());
  dvi_mesh_destroy(&mesh);
  free(B);
  return march;
}

/* The energy is looked at at the ends of the longest steps, and between them. It swings a little
 * where no conductor is, as that of all asynchronous steps. */
START_TEST(passive_conductors_gain_no_energy)
{
  for (int part = 0; part < 2; part++)
    for (int power = 0; power <= 9; power++) {
      dvi_field *field = conducting_box(pow(10, power), part == 0 ? 1 : 0.6);
      dvi_march *march = diffusing(field, "avi", 0.5);
      dvi_march_facts facts;
      dvi_march_facts_of(march, &facts);
      const double start = observe_march(march, "energy");
      double last = start, rise = 0, most = 0;
      for (int n = 1; n <= repeats(1600); n++) {
        advance_march(march, n * 0.4 * facts.longest);
        const double now = observe_march(march, "energy");
        rise = fmax(rise, now / last - 1);
        most = fmax(most, now / start - 1);
        last = now;
      }
      ck_assert_double_lt(most, part == 0 ? 1e-14 : 3e-3);
      if (part == 0 && power >= 2) ck_assert_double_lt(rise, 1e-14);
      dvi_march_destroy(&march);
      dvi_field_destroy(&field);
    }
}
END_TEST

/* The largest difference of E beside the largest E. */
static double difference(const dvi_march *a, const dvi_march *b)
{
  double *of_a = sample_march(a, DVI_FORM_E), *of_b = sample_march(b, DVI_FORM_E), worst = 0,
         largest = 0;
  for (int64_t e = 0; e < dvi_march_size(a, DVI_FORM_E); e++) {
    worst = fmax(worst, fabs(of_a[e] - of_b[e]));
    largest = fmax(largest, fabs(of_b[e]));
  }
  free(of_a), free(of_b);
  return worst / largest;
}

/* In the middle of a step leapfrog shows what it has. */
START_TEST(fields_in_conductors_are_those_of_leapfrog)
{
  for (int part = 0; part < 2; part++)
    for (int power = 0; power <= 9; power++) {
      dvi_field *field = conducting_box(pow(10, power), part == 0 ? 1 : 0.6);
      dvi_march *judge = diffusing(field, "leapfrog", 0.1);
      const double t = 1 + 0.5 * step_of_march(judge);
      advance_march(judge, t);
      for (int k = 0; k < 2; k++) {
        dvi_march *avi = diffusing(field, "avi", k == 0 ? 1.0 / 16 : 1.0 / 32);
        advance_march(avi, t);
        ck_assert_double_lt(difference(avi, judge), k == 0 ? 0.02 : 0.006);
        dvi_march_destroy(&avi);
      }
      dvi_march_destroy(&judge);
      dvi_field_destroy(&field);
    }
}
END_TEST

SUITE(avi_losses)
{
  tcase_add_test(tests, passages_consist_of_passages);
  tcase_add_test(tests, losses_keep_the_order_two);
  tcase_add_test(tests, losses_are_what_the_energy_lacks);
  tcase_add_test(tests, passive_conductors_gain_no_energy);
  tcase_add_test(tests, fields_in_conductors_are_those_of_leapfrog);
}
