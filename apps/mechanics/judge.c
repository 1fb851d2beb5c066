#include "mechanics/judge.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "mechanics/judge_runs.h"
#include "cli/spelling.h"
#include "study/norms.h"

/* A judge that is off by more than this multiple of its own error is contradicted. */
static const double contradiction = 10.0;

/* With many coordinates IDA stops after fewer steps, as those that it takes where the rounding of
 * the equations is above its tolerance. The runs judge then. */
enum { MANY_COORDINATES = 64, STEPS_OF_COORDINATES = 2000000 };

static const char *const kinds[] = {[JUDGE_AUTO] = "auto",
                                    [JUDGE_EXACT] = "exact",
                                    [JUDGE_STORED] = "stored",
                                    [JUDGE_IDA] = "ida",
                                    [JUDGE_RUNS] = "runs"};
enum { KINDS = sizeof kinds / sizeof *kinds };

static const char *judge_kind_at(int k, const void *list)
{
  (void)list;
  return k < KINDS ? kinds[k] : NULL;
}

int judge_read(const char *where, const char *name, judge_kind *kind)
{
  char hint[64];
  for (int k = 0; k < KINDS; k++)
    if (strcmp(kinds[k], name) == 0) {
      *kind = (judge_kind)k;
      return DONE;
    }
  return usage_error("%s knows auto, exact, stored, ida and runs, not '%s'%s", where, name,
                     suggestion(name, judge_kind_at, NULL, hint, sizeof hint));
}

static void set_words(judgement *judge, const char *words)
{
  (void)snprintf(judge->words, sizeof judge->words, "%s", words);
}

/* Take the exact solution. p [n] is working memory. */
static bool ask_exact(judgement *judge, const problem *scene, double t_end, double *p)
{
  if (scene->exact == NULL || scene->exact(scene, t_end, judge->q, p) != 0) return false;
  set_words(judge, "exact solution");
  judge->error = 4.0 * DBL_EPSILON *
                 fmax(1.0,
                      /* some rounding errors in its evaluation */
                      norm_largest(scene->nq, judge->q));
  return true;
}

static bool ask_digits(judgement *judge, const problem *scene, double t_end)
{
  const bool far = scene->far_q != NULL && t_end == scene->far_t_end;
  const double *digits = far ? scene->far_q : t_end == scene->order_t_end ? scene->digits_q : NULL;
  if (digits == NULL) return false;
  memcpy(judge->q, digits, (size_t)scene->nq * sizeof *judge->q);
  set_words(judge, "stored quadruple-precision result");
  judge->error = fmax(DBL_EPSILON * norm_largest(scene->nq, judge->q),
                      far ? scene->far_error : 0.0); /* rounded to double */
  return true;
}

/* IDA takes Hessians. Of the same library CVODE's Adams methods take potentials without one. */
static dvi_reference_code code_for(const problem *scene)
{
  for (int k = 0; k < scene->terms->potential_count; k++)
    if (scene->terms->potentials[k].without_hessian) return DVI_CVODE_ADAMS;
  return DVI_IDA;
}

/* Ask IDA, with so many steps at most, or as many as the library allows if these are 0. */
static dvi_status ask_ida(judgement *judge, const problem *scene, double t_end, long most,
                          double *p)
{
  memcpy(judge->q, scene->q, (size_t)scene->nq * sizeof *judge->q);
  memcpy(p, scene->p, (size_t)scene->nv * sizeof *p);
  dvi_reference_report report;
  const dvi_reference_options options = {.code = code_for(scene), .max_steps = most};
  const dvi_status status = dvi_reference_judge(scene->system, 0.0, t_end, judge->q, p, &options,
                                                &report);
  if (status != DVI_OK) return status;
  set_words(judge, options.code == DVI_IDA ? "IDA, run at two tolerances"
                                           : "CVODE's Adams methods, run at two tolerances");
  judge->error = report.error;
  return DVI_OK;
}

/* Add IDA as a witness of the runs, which replaced its answer `ida`. If IDA contradicts the runs,
 * their error is the distance. */
static void add_witness(judgement *judge, const problem *scene, const double *ida, double ida_error)
{
  const double apart = norm_distance(scene->nq, judge->q, ida);
  const size_t length = strlen(judge->words);
  if (apart > contradiction * (ida_error + judge->error)) judge->error = apart;
  (void)snprintf(judge->words + length, sizeof judge->words - length,
                 " (%s, of error %.1e, is %.1e away)", code_for(scene) == DVI_IDA ? "IDA" : "CVODE",
                 ida_error, apart);
}

/* Ask IDA first, because it shares no code with the methods. Of its answer and that of the runs,
 * the one with the smaller error is taken. ida [n] is working memory. */
static dvi_status ask_ida_then_runs(judgement *judge, const problem *scene, double t_end,
                                    const judge_request *request, double *p, double *ida)
{
  const int n = scene->nq;
  const long most = n < MANY_COORDINATES ? 0 : STEPS_OF_COORDINATES / n;
  const dvi_status of_ida = ask_ida(judge, scene, t_end, most, p);
  if (of_ida == DVI_OK && judge->error <= request->wanted) return of_ida;
  const double ida_error = judge->error;
  memcpy(ida, judge->q, (size_t)n * sizeof *ida);
  const dvi_status status = judge_by_runs(judge, scene, t_end, request->progress);
  if (of_ida != DVI_OK) {
    const size_t length = strlen(judge->words);
    (void)snprintf(judge->words + length, sizeof judge->words - length,
                   " (IDA fails: they have no witness)");
    return status;
  }
  if (status == DVI_OK) add_witness(judge, scene, ida, ida_error);
  if (status == DVI_OK && judge->error < ida_error) return DVI_OK;
  free(judge->other);
  judge->other = NULL;
  memcpy(judge->q, ida, (size_t)n * sizeof *ida);
  judge->error = ida_error;
  set_words(judge, "IDA, run at two tolerances; two runs of another method do no better");
  return DVI_OK;
}

static int refuse_judge(const problem *scene, double t_end, const judge_request *request)
{
  if (request->kind == JUDGE_EXACT)
    return usage_error("--judge exact: %s has no known exact solution", scene->name);
  return usage_error(
      "--judge stored: there is no stored result of %s for these parameters at t = %g", scene->name,
      t_end);
}

/* Ask the judge of the request. p and ida [n] are working memory. */
static int judge_ask(judgement *judge, const problem *scene, double t_end,
                     const judge_request *request, double *p, double *ida)
{
  const judge_kind kind = request->kind;
  dvi_status status;
  if ((kind == JUDGE_AUTO || kind == JUDGE_EXACT) && ask_exact(judge, scene, t_end, p)) return DONE;
  if ((kind == JUDGE_AUTO || kind == JUDGE_STORED) && ask_digits(judge, scene, t_end)) return DONE;
  if (kind == JUDGE_EXACT || kind == JUDGE_STORED) return refuse_judge(scene, t_end, request);
  if (kind == JUDGE_RUNS)
    status = judge_by_runs(judge, scene, t_end, request->progress);
  else if (kind == JUDGE_IDA)
    status = ask_ida(judge, scene, t_end, 0, p);
  else
    status = ask_ida_then_runs(judge, scene, t_end, request, p, ida);
  if (status == DVI_OK) return DONE;
  complain("the judge, --judge %s, failed on %s to t = %g:", kinds[kind], scene->name, t_end);
  return library_error(status);
}

int judge_init(judgement *judge, const problem *scene, double t_end, const judge_request *request)
{
  const size_t n = (size_t)scene->nq;
  memset(judge, 0, sizeof *judge);
  judge->q = calloc(n, sizeof *judge->q);
  double *room = calloc(2 * n, sizeof *room);
  const int code = judge->q != NULL && room != NULL
                       ? judge_ask(judge, scene, t_end, request, room, room + n)
                       : library_error(DVI_NO_MEMORY);
  free(room);
  return code;
}

void judge_clear(judgement *judge)
{
  free(judge->q);
  free(judge->other);
  judge->q = NULL;
  judge->other = NULL;
}

double judge_error(const judgement *judge, const problem *scene, const double *q)
{
  const double error = norm_distance(scene->nq, q, judge->q);
  return judge->other == NULL ? error : fmax(error, norm_distance(scene->nq, q, judge->other));
}
