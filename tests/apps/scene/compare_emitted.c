/* How fast an emitted scene is: whole trajectories of it beside the problem of the catalogue that
 * is written in C, one after the other in one process. Usage: compare_emitted PROBLEM METHOD H
 * STEPS ROUNDS [NAME=VALUE] Prints the least seconds of both, their ratio, and by how much the last
 * positions differ. */
#include <dvi/dvi.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "problem.h"

dvi_status emitted_create(dvi_system **system);

static double seconds(void)
{
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Times one run of `steps` steps. Returns less than 0 if it fails. */
static double run(dvi_integrator *integrator, const problem *problem, double h, long steps)
{
  if (dvi_integrator_start(integrator, 0.0, problem->q, problem->p) != DVI_OK) return -1.0;
  const double begin = seconds();
  for (long i = 0; i < steps; i++)
    if (dvi_integrator_step(integrator, h) != DVI_OK) return -1.0;
  return seconds() - begin;
}

static double difference(int n, const double *a, const double *b)
{
  double most = 0.0;
  for (int i = 0; i < n; i++) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

int main(int argc, char **argv)
{
  char message[400];
  problem *written;
  dvi_system *system;
  dvi_integrator *by_hand, *emitted;
  const char *setting = argc > 6 ? argv[6] : NULL;
  if (argc < 6 ||
      problem_create(argv[1], argc > 6, &setting, &written, message, sizeof message) != DVI_OK ||
      emitted_create(&system) != DVI_OK ||
      dvi_integrator_create(written->system, argv[2], &by_hand) != DVI_OK ||
      dvi_integrator_create(system, argv[2], &emitted) != DVI_OK) {
    (void)fprintf(stderr, "compare_emitted: no such comparison\n");
    return 1;
  }
  const double h = strtod(argv[3], NULL);
  double least[2] = {INFINITY, INFINITY};
  for (long rounds = strtol(argv[5], NULL, 10), i = 0; i < rounds; i++) {
    least[0] = fmin(least[0], run(by_hand, written, h, strtol(argv[4], NULL, 10)));
    least[1] = fmin(least[1], run(emitted, written, h, strtol(argv[4], NULL, 10)));
  }
  printf("%s, %s: written %.3e s, emitted %.3e s, ratio %.2f; positions differ by %.0e\n", argv[1],
         argv[2], least[0], least[1], least[1] / least[0],
         difference(written->nq, dvi_integrator_q(by_hand), dvi_integrator_q(emitted)));
  dvi_integrator_destroy(&emitted);
  dvi_integrator_destroy(&by_hand);
  dvi_system_destroy(&system);
  problem_destroy(&written);
  return least[0] >= 0.0 && least[1] >= 0.0 ? 0 : 1;
}
