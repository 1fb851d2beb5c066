/* What a step of Yee's method costs: millions of boxes a second of a cube, with one step at a time
 * and with several together, without and with absorbing layers, and with a material. The bytes that
 * a step at a time moves are 96 a box, six numbers read and written. Their rate is beside that of a
 * triad, a = b + 3 c, of the same run, which measures the memory.
 * Usage: yee_cost [CELLS [THREADS [SECONDS]]], for example yee_cost 256 */
#define _POSIX_C_SOURCE 200809L
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

/* One thread is measured by the time that it had the processor. */
static clockid_t used_clock = CLOCK_PROCESS_CPUTIME_ID;

static double seconds(void)
{
  struct timespec now;
  clock_gettime(used_clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void need(dvi_status status)
{
  if (status == DVI_OK) return;
  fprintf(stderr, "yee_cost: %s\n", dvi_last_error());
  exit(1);
}

/* Bytes a second of the best of some runs through three arrays that no cache holds. */
static double triad_rate(size_t count)
{
  enum { RUNS = 8 };
  double *a = (double *)malloc(3 * count * sizeof(double)), best = INFINITY;
  if (a == NULL) exit(1);
  double *b = a + count, *c = b + count;
  for (size_t i = 0; i < 3 * count; i++) a[i] = (double)i;
  for (int run = 0; run < RUNS; run++) {
    const double start = seconds();
    for (size_t i = 0; i < count; i++) a[i] = b[i] + (3 + run) * c[i];
    best = fmin(best, seconds() - start);
  }
  const double used = a[count / 2];
  free(a);
  return used > 0 ? 24 * (double)count / best : 0;
}

static int glass(const double *x, double *value, void *user)
{
  (void)user;
  *value = x[0] > 0.4 && x[0] < 0.6 ? 2.25 : 1;
  return 0;
}

/* What is measured. */
typedef struct job {
  const char *name;
  int together, layers, has_medium;
} job;

static const job jobs[] = {{"one step at a time", 1, 0, 0}, {"together", 0, 0, 0},
                           {"one, 10 layers", 1, 10, 0},    {"together, 10 layers", 0, 10, 0},
                           {"one, medium", 1, 0, 1},        {"together, medium", 0, 0, 1}};
enum { JOBS = sizeof jobs / sizeof *jobs };

/* Steps a second, the best of some rounds. */
static double steps_rate(const job *j, int cells, int threads, double least)
{
  const dvi_yee_end end = {.kind = j->layers > 0 ? DVI_YEE_CPML : DVI_YEE_PEC, .layers = j->layers};
  dvi_yee_terms terms = {
      .size = sizeof terms, .axes = 3, .degree = 1, .threads = threads, .together = j->together};
  const dvi_yee_axis axis = {.cells = cells, .end = {end, end}};
  for (int l = 0; l < 3; l++) terms.axis[l] = axis;
  if (j->has_medium) terms.eps.at = glass;
  const int steps = 16; /* at once */
  const dvi_march_state start = {.size = sizeof start};
  dvi_march *march = NULL;
  dvi_march_facts facts;
  double best = 0;
  need(dvi_yee_create(&terms, &march));
  need(dvi_march_start(march, &start));
  dvi_march_facts_of(march, &facts);
  const double begin = seconds();
  for (int64_t n = 0; n == 0 || seconds() - begin < least;) {
    const double from = seconds();
    n += steps;
    need(dvi_march_advance(march, (double)n * facts.step));
    best = fmax(best, steps / (seconds() - from));
  }
  dvi_march_destroy(&march);
  return best;
}

int main(int argc, char **argv)
{
  FILE *out = argc > 1 ? stdout : stderr; /* a small cube shows that it works */
  const int cells = argc > 1 ? (int)strtol(argv[1], NULL, 10) : 24,
            threads = argc > 2 ? (int)strtol(argv[2], NULL, 10) : 1;
  const double least = argc > 3   ? (double)strtol(argv[3], NULL, 10)
                       : argc > 1 ? 5
                                  : 0,
               boxes = pow(cells, 3), triad = triad_rate(argc > 1 ? 16000000 : 100000);
  if (threads > 1) used_clock = CLOCK_MONOTONIC;
  fprintf(out, "cells %d^3, threads %d, triad %.1f GB/s\n", cells, threads, triad / 1e9);
  fprintf(out, "job,Mcell/s,GB/s_of_96_bytes,of_triad\n");
  for (int i = 0; i < JOBS; i++) {
    const double rate = boxes * steps_rate(&jobs[i], cells, threads, least);
    fprintf(out, "%s,%.0f,%.1f,%.2f\n", jobs[i].name, rate / 1e6, 96 * rate / 1e9,
            96 * rate / triad);
    fflush(out);
  }
  return 0;
}
