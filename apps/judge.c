#include "judge.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static double largest(int n, const double *x)
{
  double size = 0.0;
  for (int i = 0; i < n; i++) size = fmax(size, fabs(x[i]));
  return size;
}

static bool ask_exact(judgement *judge, const problem *scene, double t_end)
{
  if (scene->exact == NULL || scene->exact(scene, t_end, judge->q, judge->p) != 0) return false;
  judge->kind = "exact solution";
  judge->error = 4.0 * DBL_EPSILON * fmax(1.0, largest(scene->n, judge->q)); /* some roundings in its evaluation */
  return true;
}

static bool ask_digits(judgement *judge, const problem *scene, double t_end)
{
  if (scene->digits_q == NULL || scene->digits_p == NULL || t_end != scene->order_t_end) return false;
  memcpy(judge->q, scene->digits_q, (size_t)scene->n * sizeof *judge->q);
  memcpy(judge->p, scene->digits_p, (size_t)scene->n * sizeof *judge->p);
  judge->kind = "stored quadruple-precision result";
  judge->error = DBL_EPSILON * largest(scene->n, judge->q); /* rounded to double */
  return true;
}

static dvi_status ask_ida(judgement *judge, const problem *scene, double t_end)
{
  memcpy(judge->q, scene->q, (size_t)scene->n * sizeof *judge->q);
  memcpy(judge->p, scene->p, (size_t)scene->n * sizeof *judge->p);
  dvi_reference_report report;
  const dvi_status status = dvi_reference_judge(scene->system, 0.0, t_end, judge->q, judge->p, NULL, &report);
  if (status != DVI_OK) return status;
  judge->kind = "IDA, run at two tolerances";
  judge->error = report.error;
  return DVI_OK;
}

dvi_status judge_init(judgement *judge, const problem *scene, double t_end)
{
  memset(judge, 0, sizeof *judge);
  judge->q = calloc((size_t)scene->n, sizeof *judge->q);
  judge->p = calloc((size_t)scene->n, sizeof *judge->p);
  if (judge->q == NULL || judge->p == NULL) return DVI_NO_MEMORY;
  if (ask_exact(judge, scene, t_end) || ask_digits(judge, scene, t_end)) return DVI_OK;
  return ask_ida(judge, scene, t_end);
}

void judge_clear(judgement *judge)
{
  free(judge->q);
  free(judge->p);
  judge->q = NULL;
  judge->p = NULL;
}

double judge_error(const judgement *judge, const problem *scene, const double *q)
{
  double error = 0.0;
  for (int i = 0; i < scene->n; i++) error = fmax(error, fabs(q[i] - judge->q[i]));
  return error;
}
