/* What marches of elastic solids cost, in wall time.
 *
 *   events    nanoseconds of an event of a cell, in cubes of 1e3, 1e4, .. tetrahedra: asynchronous
 *             steps by classes and free ones, and equal steps of verlet, where each cell has an
 *             event at each step
 *   graded    a bar with free sides whose layers grow from 1 to 20, and in it a wave of shear that
 *             is reflected by them, followed for a period: what asynchronous steps cost beside
 *             verlet. Errors are root mean squares of displacements beside those of the wave,
 *             "in_time" against a fine run on the same mesh, "error" against the exact wave.
 *             Fractions of verlet are of the bound of the whole solid, below which it is stable,
 *             those of avi of each cell's own bound. "rate" is the growth of the fastest small
 *             vibration under the schedule, on a bar of the same shape with 768 cells, and
 *             "stable" tells if it is one
 *
 * Times are the least of rounds, which take turns among the rows of a table. Usage: elastic_cost
 * [CELLS [BLOCK]], for example elastic_cost 1000000 96000 */
#define _POSIX_C_SOURCE 200809L
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { ROUNDS = 5, METHODS = 3, SIZES_MOST = 8, ROWS = 11 };

static const double pi = 3.141592653589793;

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void need(dvi_status status)
{
  if (status == DVI_OK) return;
  fprintf(stderr, "elastic_cost: %s\n", dvi_last_error());
  exit(1);
}

static double *numbers(int64_t count)
{
  double *made = (double *)calloc((size_t)count, sizeof *made);
  if (made == NULL) exit(1);
  return made;
}

/* ---- solids ---- */

static dvi_elastic *solid_of(const dvi_generator_options *block, dvi_elastic_law law,
                             const dvi_elastic_condition *condition, int conditions)
{
  const dvi_elastic_material material = {.part = "all", .law = law, .lambda = 1, .mu = 1, .rho = 1};
  dvi_mesh *mesh = NULL;
  dvi_elastic *elastic = NULL;
  need(dvi_mesh_generate("kuhn", block, &mesh));
  const dvi_elastic_terms terms = {.size = sizeof terms,
                                   .mesh = mesh,
                                   .material = &material,
                                   .materials = 1,
                                   .condition = condition,
                                   .conditions = conditions};
  need(dvi_elastic_create(&terms, &elastic));
  dvi_mesh_destroy(&mesh);
  return elastic;
}

static dvi_elastic *cube_of(long cells)
{
  const int side = (int)lround(cbrt((double)cells / 6));
  const dvi_generator_options block = {
      .size = sizeof block, .cells = {side, side, side}, .grading = {1.5, 1.5, 1.5}};
  return solid_of(&block, DVI_ELASTIC_NEO_HOOKEAN, NULL, 0);
}

static int64_t cells_of(const dvi_elastic *elastic)
{
  return dvi_mesh_count(dvi_elastic_mesh(elastic), 3);
}

/* Begin without displacements, and with rates [3*nodes], which are released. */
static dvi_march *begin(const dvi_elastic *elastic, const dvi_march_options *options, double *rate)
{
  const int64_t size = 3 * dvi_mesh_count(dvi_elastic_mesh(elastic), 0);
  for (int64_t i = 0; i < size; i++) rate[i] = -rate[i];
  const dvi_march_state start = {.size = sizeof start, .E = rate};
  dvi_march *march = NULL;
  need(dvi_elastic_march_create(elastic, options, &march));
  need(dvi_march_start(march, &start));
  free(rate);
  return march;
}

static dvi_march_facts facts_of(const dvi_march *march)
{
  dvi_march_facts facts;
  dvi_march_facts_of(march, &facts);
  return facts;
}

/* ---- events ---- */

static const char *method_name[METHODS] = {"avi", "avi:classes=no", "verlet"};

/* A cube that is stretched and sheared. */
static double *rates_of_cube(const dvi_elastic *elastic)
{
  const int64_t size = 3 * dvi_mesh_count(dvi_elastic_mesh(elastic), 0);
  const double *point = dvi_mesh_points(dvi_elastic_mesh(elastic));
  double *rate = numbers(size);
  for (int64_t i = 0; i < size; i += 3) {
    rate[i] = 0.1 * cos(pi * point[i]);
    rate[i + 1] = 0.05 * point[i] * point[i];
  }
  return rate;
}

/* Set ns to the time of an event, and rate to the number of events in a longest step. */
static void measure_events(const dvi_elastic *elastic, const char *method, long events, double *ns,
                           double *rate)
{
  const dvi_march_options options = {.size = sizeof options, .method = method};
  dvi_march *march = begin(elastic, &options, rates_of_cube(elastic));
  const double longest = facts_of(march).longest;
  need(dvi_march_advance(march, longest)); /* the first round makes all ready */
  *rate = (double)facts_of(march).updates;
  const double span = longest * ceil((double)events / *rate);
  *ns = INFINITY;
  for (int r = 0; r < ROUNDS; r++) {
    const int64_t before = facts_of(march).updates;
    const double start = seconds();
    need(dvi_march_advance(march, dvi_march_time(march) + span));
    *ns = fmin(*ns, 1e9 * (seconds() - start) / (double)(facts_of(march).updates - before));
  }
  dvi_march_destroy(&march);
}

/* The slope of a line through the logarithms. */
static double exponent(int count, const double *x, const double *y)
{
  double sum_x = 0, sum_y = 0, xx = 0, xy = 0;
  for (int i = 0; i < count; i++) {
    const double log_x = log(x[i]), log_y = log(y[i]);
    sum_x += log_x, sum_y += log_y, xx += log_x * log_x, xy += log_x * log_y;
  }
  return (xy - sum_x * sum_y / count) / (xx - sum_x * sum_x / count);
}

static void print_events(FILE *out, long most)
{
  double cells[SIZES_MOST], ns[METHODS][SIZES_MOST], rate[METHODS];
  int count = 0;
  fprintf(out, "events: "
               "cells,avi_ns,free_ns,verlet_ns,avi_events_a_cell,free_events_a_cell,"
               "verlet_events_a_cell\n");
  for (long n = most < 1000 ? most / 4 : 1000; n <= most && count < SIZES_MOST; n *= 10, count++) {
    dvi_elastic *elastic = cube_of(n);
    const long events = most < 1000 ? 2000 : n > 500000 ? 2 * n : 1000000;
    cells[count] = (double)cells_of(elastic);
    for (int k = 0; k < METHODS; k++)
      measure_events(elastic, method_name[k], events, &ns[k][count], &rate[k]);
    fprintf(out, "%.0f,%.0f,%.0f,%.0f,%.1f,%.1f,%.1f\n", cells[count], ns[0][count], ns[1][count],
            ns[2][count], rate[0] / cells[count], rate[1] / cells[count], rate[2] / cells[count]);
    fflush(out);
    dvi_elastic_destroy(&elastic);
  }
  if (count < 2) return;
  fprintf(out, "exponent,%.3f,%.3f,%.3f\n", exponent(count, cells, ns[0]),
          exponent(count, cells, ns[1]), exponent(count, cells, ns[2]));
}

/* ---- a graded block ---- */

/* Layers (i/m)^g of which the last one is 20 times as thick as the first. */
static double grading_of(int layers)
{
  double low = 1, high = 8;
  for (int i = 0; i < 60; i++) {
    const double g = (low + high) / 2, first = pow(layers, -g), last = 1 - pow(1 - 1.0 / layers, g);
    if (last < 20 * first)
      low = g;
    else
      high = g;
  }
  return low;
}

/* A bar of 16 times as many layers as cells across, which are twice as wide as the thickest layer.
 * Two sides are held along themselves, the others are free. */
typedef struct bar {
  dvi_elastic *elastic;
  int64_t size; /* 3*nodes */
  double k[3], omega;
  double grading;
  int layers, across;
} bar;

static bar bar_of(long cells)
{
  bar b = {.across = (int)lround(cbrt((double)cells / 96))};
  static const dvi_elastic_condition side[] = {
      {.part = "bottom", .component = {1, 0, 1}, .is_steady = 1},
      {.part = "top", .component = {1, 0, 1}, .is_steady = 1}};
  b.layers = 16 * b.across;
  b.grading = grading_of(b.layers);
  const double width = 2 * b.across * (1 - pow(1 - 1.0 / b.layers, b.grading));
  const dvi_generator_options block = {.size = sizeof block,
                                       .cells = {b.layers, b.across, b.across},
                                       .extent = {1, width, width},
                                       .grading = {b.grading, 1, 1}};
  b.elastic = solid_of(&block, DVI_ELASTIC_LINEAR, side, 2);
  b.size = 3 * dvi_mesh_count(dvi_elastic_mesh(b.elastic), 0);
  b.k[0] = 4 * pi, b.k[2] = pi / width;
  b.omega = hypot(b.k[0], b.k[2]);
  return b;
}

/* u_y = cos(k_1 x) cos(k_3 z) sin(omega t) has no stress on the free sides. */
static double *wave_of(const bar *b, double factor)
{
  const double *point = dvi_mesh_points(dvi_elastic_mesh(b->elastic));
  double *wave = numbers(b->size);
  for (int64_t i = 0; i < b->size; i += 3)
    wave[i + 1] = factor * cos(b->k[0] * point[i]) * cos(b->k[2] * point[i + 2]);
  return wave;
}

typedef struct row {
  const char *method;
  double fraction;
  int threads;
  double seconds, error, in_time, updates;
} row;

static dvi_march_options options_of(const row *r)
{
  dvi_march_options options = {.size = sizeof options};
  options.method = r->method;
  options.fraction = r->fraction;
  options.threads = r->threads;
  return options;
}

/* Run for a period, and give the displacements at its end. */
static double *end_of(const bar *b, row *r)
{
  const dvi_march_options options = options_of(r);
  dvi_march *march = begin(b->elastic, &options, wave_of(b, b->omega));
  const double start = seconds(), least = r->seconds > 0 ? r->seconds : (double)INFINITY;
  need(dvi_march_advance(march, 2 * pi / b->omega));
  r->seconds = fmin(least, seconds() - start);
  r->updates = (double)facts_of(march).updates;
  double *u = numbers(b->size);
  need(dvi_march_sample(march, DVI_FORM_A, 0, NULL, u));
  dvi_march_destroy(&march);
  return u;
}

/* After a period the exact displacements are 0. */
static void find_errors(const bar *b, const double *u, const double *fine, row *r)
{
  double *wave = wave_of(b, 1), sum[3] = {0};
  for (int64_t i = 0; i < b->size; i++) {
    sum[0] += wave[i] * wave[i];
    sum[1] += u[i] * u[i];
    sum[2] += (u[i] - fine[i]) * (u[i] - fine[i]);
  }
  r->error = sqrt(sum[1] / sum[0]);
  r->in_time = sqrt(sum[2] / sum[0]);
  free(wave);
}

/* Equal steps are stable below their bound. */
static void print_growth(FILE *out, const bar *small, const row *r)
{
  const dvi_march_options options = options_of(r);
  dvi_stability report = {.is_stable = 1, .growth = 1};
  if (strcmp(r->method, "verlet") != 0)
    need(dvi_elastic_stability(small->elastic, &options, 0, &report));
  fprintf(out, "%.1e,%s,", fabs(log(report.growth)), report.is_stable ? "yes" : "no");
}

static void print_rows(FILE *out, const bar *small, const row *rows)
{
  fprintf(out, "method,fraction,threads,seconds,evaluations,error,in_time,rate,stable,"
               "fewer_evaluations,less_time\n");
  for (const row *r = rows; r < rows + ROWS; r++) {
    fprintf(out, "%s,%g,%d,%.3f,%.4g,%.2e,%.2e,", r->method, r->fraction, r->threads, r->seconds,
            r->updates, r->error, r->in_time);
    print_growth(out, small, r);
    fprintf(out, "%.2f,%.2f\n", rows->updates / r->updates, rows->seconds / r->seconds);
    fflush(out);
  }
}

static void print_graded(FILE *out, long cells)
{
  row rows[ROWS] = {{"verlet", 0.9, 1, 0, 0, 0, 0},
                    {"verlet", 0.9, 2, 0, 0, 0, 0},
                    {"verlet", 0.5, 1, 0, 0, 0, 0},
                    {"avi", 0.9, 1, 0, 0, 0, 0},
                    {"avi", 0.9, 2, 0, 0, 0, 0},
                    {"avi", 0.8, 1, 0, 0, 0, 0},
                    {"avi", 0.5, 1, 0, 0, 0, 0},
                    {"avi", 0.5, 2, 0, 0, 0, 0},
                    {"avi:classes=no", 0.8, 1, 0, 0, 0, 0},
                    {"avi:classes=no", 0.5, 1, 0, 0, 0, 0},
                    {"avi:classes=no", 0.5, 2, 0, 0, 0, 0}};
  row finest = {"verlet", 0.25, 1, 0, 0, 0, 0};
  bar b = bar_of(cells), small = bar_of(cells > 10000 ? 768 : 96);
  double *fine = end_of(&b, &finest);
  fprintf(out, "graded: %lld cells in %d layers at (i/%d)^%.4f, %d across\n",
          (long long)cells_of(b.elastic), b.layers, b.layers, b.grading, b.across);
  for (int round = 0; round < (cells > 10000 ? 3 : 1); round++)
    for (row *r = rows; r < rows + ROWS; r++) {
      double *u = end_of(&b, r);
      find_errors(&b, u, fine, r);
      free(u);
    }
  print_rows(out, &small, rows);
  free(fine);
  dvi_elastic_destroy(&b.elastic);
  dvi_elastic_destroy(&small.elastic);
}

int main(int argc, char **argv)
{
  FILE *out = argc > 1 ? stdout : stderr; /* small solids show that it works */
  print_events(out, argc > 1 ? strtol(argv[1], NULL, 10) : 400);
  print_graded(out, argc > 2 ? strtol(argv[2], NULL, 10) : 1000);
  return 0;
}
