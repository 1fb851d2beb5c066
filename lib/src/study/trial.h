/* One method at one step: its runs from the start to the end of a study. */
#ifndef DVI_STUDY_TRIAL_H
#define DVI_STUDY_TRIAL_H
#include <dvi/study.h>

/* A method at a step, with the result of its first run. */
typedef struct dvi__trial {
  const dvi_study_runs *runs;
  dvi_integrator *integrator;
  double h; /* step without sign, which divides the span */
  double seconds;
  dvi_counters counters;
} dvi__trial;

/* Return DVI_OK if the runs can be made, as far as that is seen without one. */
dvi_status dvi__runs_check(const dvi_system *system, const dvi_study_runs *runs);

/* Return whether the study is to end. A run may then have ended before its time. */
int dvi__runs_cancelled(const dvi_study_runs *runs);

/* Return the number of equal steps, at least 1, whose length is nearest to h > 0. */
double dvi__runs_steps(const dvi_study_runs *runs, double h);

/* Make an integrator, and run it once in so many steps. On failure nothing is to be closed. */
dvi_status dvi__trial_open(const dvi_system *system, const char *method, const dvi_study_runs *runs,
                           double steps, dvi__trial *trial);
void dvi__trial_close(dvi__trial *trial);

/* Run as often as the clock needs for a measurement. *seconds is the process time of one run. */
dvi_status dvi__trial_time(dvi__trial *trial, long repeats, double *seconds);

/* Run once more, and find the largest change of the energy since the start. */
dvi_status dvi__trial_energy(dvi__trial *trial, double *change);

/* Find the solution q [nq] at the end that the runs name, and the error of the reference. */
dvi_status dvi__judge(const dvi_system *system, const dvi_study_runs *runs, double *q,
                      double *error);

/* Return whether the runs name a solution. */
int dvi__has_judge(const dvi_study_runs *runs);

/* Return the largest |a_i - b_i|. b NULL is 0. */
double dvi__distance(int n, const double *a, const double *b);
#endif
