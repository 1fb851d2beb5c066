/* What steps of electromagnetic fields on meshes of tetrahedra cost: leapfrog on a body-centred
 * torus beside the 150 bytes that a tetrahedron moves at least, at the rate of a triad
 * a = b + 3 c, and asynchronous steps beside equal ones on a graded mesh.
 * Usage: maxwell_cost [CELLS [THREADS]], for example maxwell_cost 44: 12*44^3 tetrahedra */
#define _POSIX_C_SOURCE 200809L
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void need(dvi_status status)
{
  if (status == DVI_OK) return;
  fprintf(stderr, "maxwell_cost: %s\n", dvi_last_error());
  exit(1);
}

/* Bytes a second of the best of some runs through three arrays that no cache holds. */
static double triad_rate(void)
{
  enum { COUNT = 8000000, RUNS = 8 };
  double *a = (double *)malloc(3 * sizeof(double) * COUNT), best = INFINITY;
  if (a == NULL) exit(1);
  double *b = a + COUNT, *c = b + COUNT;
  for (int i = 0; i < 3 * COUNT; i++) a[i] = i;
  for (int run = 0; run < RUNS; run++) {
    const double start = seconds();
    for (int i = 0; i < COUNT; i++) a[i] = b[i] + (3 + run) * c[i];
    best = fmin(best, seconds() - start);
  }
  const double used = a[COUNT / 2];
  free(a);
  return used > 0 ? 24 * (double)COUNT / best : 0;
}

static dvi_field *make_field(const char *generator, const dvi_generator_options *options)
{
  dvi_mesh *mesh = NULL;
  dvi_star *star = NULL;
  dvi_field *field = NULL;
  need(dvi_mesh_generate(generator, options, &mesh));
  need(dvi_star_create(mesh, NULL, &star));
  const dvi_maxwell_terms terms = {.size = sizeof terms, .star = star};
  need(dvi_maxwell_create(&terms, &field));
  dvi_star_destroy(&star);
  dvi_mesh_destroy(&mesh);
  return field;
}

/* Start from a form that is no mode. */
static dvi_march *start(const dvi_field *field, const dvi_march_options *options)
{
  dvi_march *march = NULL;
  need(dvi_march_create(field, options, &march));
  const int64_t edges = dvi_march_size(march, DVI_FORM_E);
  double *E = (double *)malloc((size_t)edges * sizeof *E);
  if (E == NULL) exit(1);
  for (int64_t e = 0; e < edges; e++) E[e] = sin(0.01 * (double)e);
  const dvi_march_state state = {.size = sizeof state, .E = E};
  need(dvi_march_start(march, &state));
  free(E);
  return march;
}

/* Give the seconds of a step, the best of some portions, or those of a unit of time. */
static double time_march(dvi_march *march, double portion, int portions)
{
  double best = INFINITY;
  for (int i = 1; i <= portions; i++) {
    const double began = seconds();
    need(dvi_march_advance(march, portion * i));
    best = fmin(best, seconds() - began);
  }
  return best;
}

static void leapfrog(int cells, int threads, double triad, FILE *out)
{
  const int portions = 6;
  const double steps = 5; /* in a portion */
  const dvi_generator_options options = {.size = sizeof options, .cells = {cells, cells, cells}};
  dvi_field *field = make_field("bcc-torus", &options);
  const dvi_march_options how = {.size = sizeof how, .fraction = 0.9, .threads = threads};
  dvi_march *march = start(field, &how);
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  const double tetrahedra = 12 * pow(cells, 3),
               step = time_march(march, steps * facts.step, portions) / steps;
  fprintf(out, "leapfrog,%.0f,%d,%.3e,%.2f,%.2f\n", tetrahedra, threads, step,
          1e-6 * tetrahedra / step, 150 * tetrahedra / step / triad);
  dvi_march_destroy(&march);
  dvi_field_destroy(&field);
}

/* A square whose cells grow 1:16 along both axes. */
static void graded(int cells, FILE *out)
{
  static const char *const method[] = {"leapfrog", "avi"};
  double cost[2], updates[2];
  const dvi_generator_options options = {
      .size = sizeof options, .cells = {cells, cells}, .grading = {1.47, 1.47}};
  dvi_field *field = make_field("box", &options);
  for (int i = 0; i < 2; i++) {
    dvi_march_facts facts;
    const dvi_march_options how = {.size = sizeof how, .method = method[i], .fraction = 0.5};
    dvi_march *march = start(field, &how);
    dvi_march_facts_of(march, &facts);
    cost[i] = time_march(march, 40 * facts.longest, 3) / (40 * facts.longest);
    dvi_march_facts_of(march, &facts);
    updates[i] = (double)facts.updates / (120 * facts.longest);
    fprintf(out, "%s on a graded square,%d,1,%.3e,%.2f,\n", method[i], cells * cells, cost[i],
            1e-6 * updates[i] / cost[i]);
    dvi_march_destroy(&march);
  }
  fprintf(out, "avi: %.2f times fewer updates, %.2f times less time\n", updates[0] / updates[1],
          cost[0] / cost[1]);
  dvi_field_destroy(&field);
}

int main(int argc, char **argv)
{
  FILE *out = argc > 1 ? stdout : stderr; /* small meshes show that it works */
  const int cells = argc > 1 ? (int)strtol(argv[1], NULL, 10) : 6,
            threads = argc > 2 ? (int)strtol(argv[2], NULL, 10) : 1;
  const double triad = triad_rate();
  fprintf(out, "triad: %.2f GB/s\n", 1e-9 * triad);
  fprintf(out, "march,cells,threads,seconds,million updates a second,part of triad\n");
  leapfrog(cells, threads, triad, out);
  graded(argc > 1 ? 4 * cells : 16, out);
  return 0;
}
