#include "mechanics/motion_study.h"

#include <dvi/scene.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "csv/balance.h"
#include "cli/command.h"
#include "mechanics/field_motion.h"
#include "mechanics/march.h"
#include "study/norms.h"

/* ---- words ---- */

const char *motion_say(study_phrase phrase, double t_end, char *text, size_t size)
{
  /* Factor of a shorter span, over which the errors of high orders follow their power. */
  static const double shorter = 0.25;
  switch (phrase) {
  case STUDY_REACH: (void)snprintf(text, size, "to t = %g", t_end); return text;
  case STUDY_PLACE: (void)snprintf(text, size, "at t = %g", t_end); return text;
  case STUDY_WHOLE: return "the span";
  case STUDY_ROUNDOFF:
    return "roundoff (what a change of the start in its last digit does to the end)";
  case STUDY_MORE: return "ask for --levels 6";
  case STUDY_FURTHER: return "ask for further levels, such as --levels 12, or for a smaller --h";
  case STUDY_FINER:
    (void)snprintf(text, size, "leave --h to the search, or shorten the span, --t-end %g",
                   shorter * t_end);
    return text;
  case STUDY_COARSER:
    (void)snprintf(text, size,
                   "leave --h and --judge to the search, or lengthen the span, --t-end %g",
                   t_end / shorter);
    return text;
  case STUDY_EQUAL:
    return "the method chooses its steps, and an error is no power of the first one; galerkin of "
           "this degree has steps of one length";
  case STUDY_NEARER:
    (void)snprintf(text, size, "try a shorter span, --t-end %g", shorter * t_end);
    return text;
  case STUDY_LOWER:
    return "spans show orders up to about 10 in doubles: try a method of a lower one";
  default: return NULL;
  }
}

const table_column motion_further[] = {{"energy_error", "%.3e"}, {NULL, NULL}};

const study_words *motion_words(const problem *scene)
{
  static const table_column with_manifold[] = {{"residuals", "%.0f"},
                                               {"jacobians", "%.0f"},
                                               {"factorizations", "%.0f"},
                                               {"distance", "%.1e"},
                                               {NULL, NULL}};
  static const table_column plain[] = {
      {"residuals", "%.0f"}, {"jacobians", "%.0f"}, {"factorizations", "%.0f"}, {NULL, NULL}};
  static const study_words on_lines = MOTION_WORDS("method", plain);
  static const study_words with_distance = MOTION_WORDS("method", with_manifold);
  return scene->velocity != NULL ? &with_distance : &on_lines;
}

enum { RESIDUALS, JACOBIANS, FACTORIZATIONS, DISTANCE };

/* ---- levels ---- */

/* Integrate from q [n] and the problem's momenta with so many equal steps. `options` may be
 * NULL. */
static dvi_status motion_integrate(motion_study *s, const double *q,
                                   const dvi_start_options *options, double steps)
{
  const dvi_status status = dvi_integrator_start_with(s->integrator, 0.0, q, s->motion.scene->p,
                                                      options);
  if (status != DVI_OK) return status;
  return march(s->integrator, s->subject.span / steps, lround(steps), s->motion.t_end, NULL, NULL,
               s->progress, s->subject.name);
}

static dvi_status motion_run(void *user, double steps, study_level *level)
{
  motion_study *s = user;
  dvi_counters before, after;
  dvi_integrator_counters(s->integrator, &before);
  level->parts = steps;
  level->length = s->subject.span / steps;
  const dvi_status status = motion_integrate(s, s->motion.scene->q, NULL, steps);
  if (status != DVI_OK) return status;
  level->error = judge_error(s->motion.judge, s->motion.scene, dvi_integrator_q(s->integrator));
  dvi_integrator_counters(s->integrator, &after);
  level->counted[RESIDUALS] = (double)(after.residuals - before.residuals);
  level->counted[JACOBIANS] = (double)(after.jacobians - before.jacobians);
  level->counted[FACTORIZATIONS] = (double)(after.factorizations - before.factorizations);
  if (s->subject.chooses) level->parts = (double)(after.steps - before.steps);
  return DVI_OK;
}

/* The quantities that are observed along a run. */
typedef struct watched {
  const dvi_system *system;
  double *value; /* [invariants] */
  double first;  /* energy at the start, or NaN before it */
  double energy_error, distance;
} watched;

static int motion_observe(dvi_integrator *integrator, void *user)
{
  watched *w = user;
  if (dvi_integrator_invariants(integrator, w->value) != DVI_OK) return -1;
  const double energy = balanced_value(integrator, 0, w->value[0]);
  if (isnan(w->first)) w->first = energy;
  w->energy_error = fmax(w->energy_error, fabs(energy - w->first));
  w->distance = fmax(w->distance, dvi_system_distance(w->system, dvi_integrator_q(integrator)));
  return 0;
}

static dvi_status motion_watch(void *user, double steps, study_level *level)
{
  motion_study *s = user;
  double *value = calloc((size_t)dvi_system_invariant_count(s->motion.scene->system),
                         sizeof *value);
  if (value == NULL) return DVI_NO_MEMORY;
  watched w = {.system = s->motion.scene->system, .value = value, .first = (double)NAN};
  dvi_status status = dvi_integrator_start(s->integrator, 0.0, s->motion.scene->q,
                                           s->motion.scene->p);
  if (status == DVI_OK && motion_observe(s->integrator, &w) != 0) status = DVI_NOT_FINITE;
  if (status == DVI_OK)
    status = march(s->integrator, s->subject.span / steps, lround(steps), s->motion.t_end,
                   motion_observe, &w, NULL, NULL);
  level->further[0] = w.energy_error;
  level->counted[DISTANCE] = w.distance;
  free(value);
  return status;
}

static dvi_status motion_repeat(void *user, double steps, double *preparation)
{
  motion_study *s = user;
  (void)preparation;
  return motion_integrate(s, s->motion.scene->q, NULL, steps);
}

/* Change the problem's start in the last place. */
static void disturb_start(const motion_study *s, double *q)
{
  for (int i = 0; i < s->motion.scene->nq; i++) {
    const double place = DBL_EPSILON * fmax(fabs(s->motion.scene->q[i]), 0.1 * s->subject.size);
    q[i] = s->motion.scene->q[i] + (i % 2 == 0 ? place : -place);
  }
}

/* Measure how far a change of the start in its last place moves the end. The disturbed start is
 * projected, because where a constraint consists of numbers that are 0, even the last place of the
 * other numbers violates it. */
static dvi_status motion_roundoff(void *user, double steps, double *moved)
{
  motion_study *s = user;
  const int n = s->motion.scene->nq;
  double *q = calloc(2 * (size_t)n, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  double *end = q + n;
  disturb_start(s, q);
  dvi_status status = motion_integrate(s, q, &(dvi_start_options){.project = 1}, steps);
  if (status == DVI_OK) {
    memcpy(end, dvi_integrator_q(s->integrator), (size_t)n * sizeof *end);
    status = motion_integrate(s, s->motion.scene->q, NULL, steps);
  }
  *moved = status == DVI_OK ? norm_distance(n, end, dvi_integrator_q(s->integrator)) : 0.0;
  free(q);
  return status;
}

/* ---- marches of fields ---- */

static dvi_status field_level(const motion_study *s, double steps, bool with_energy,
                              study_level *level)
{
  field_motion_end end;
  double *q = calloc((size_t)s->motion.scene->nq, sizeof *q);
  if (q == NULL) return DVI_NO_MEMORY;
  const dvi_status status = field_motion(s->motion.scene, s->march, steps, s->motion.t_end,
                                         with_energy, q, &end);
  if (status == DVI_OK && with_energy) level->further[0] = end.energy_error;
  if (status == DVI_OK && !with_energy) {
    level->error = judge_error(s->motion.judge, s->motion.scene, q);
    level->counted[RESIDUALS] = end.updates;
  }
  free(q);
  return status > 0 || status == DVI_OK ? status : DVI_NOT_FINITE;
}

static dvi_status field_run_level(void *user, double steps, study_level *level)
{
  const motion_study *s = user;
  level->parts = steps;
  level->length = s->subject.span / steps;
  return field_level(s, steps, false, level);
}

static dvi_status field_watch_level(void *user, double steps, study_level *level)
{
  return field_level(user, steps, true, level);
}

static dvi_status field_repeat(void *user, double steps, double *preparation)
{
  const motion_study *s = user;
  (void)preparation;
  return field_motion(s->motion.scene, s->march, steps, s->motion.t_end, false, NULL, NULL);
}

static const char *motion_reason(void *user)
{
  (void)user;
  return dvi_last_error();
}

/* ---- the study ---- */

int motion_study_refuse(const char *name, double t_end)
{
  complain("%s: its steps do not lead to the solution at t = %g; is the monitor finite and above 0 "
           "all the way?",
           name, t_end);
  return FAILED;
}

/* Return the size of the solution at the end in the maximum norm, or 1 if it is 0. */
static double solution_size(const judged_motion *motion)
{
  const double size = norm_largest(motion->scene->nq, motion->judge->q);
  return size > 0.0 ? size : 1.0;
}

static int init_march(motion_study *study, const char *method, const char *name)
{
  const problem *scene = study->motion.scene;
  const double t_end = study->motion.t_end;
  if (!(t_end > 0))
    return usage_error("%s: a march of a field goes forward, not to t = %g", name, t_end);
  study->march = method;
  study->subject = (study_subject){.name = name,
                                   .problem = scene->name,
                                   .words = motion_words(scene),
                                   .extent = t_end,
                                   .order = dvi_scene_march_order(scene->scene, method),
                                   .span = t_end,
                                   .first_parts = t_end / scene->order_h,
                                   .size = solution_size(&study->motion),
                                   .judge = study->motion.judge->words,
                                   .judge_error = study->motion.judge->error,
                                   .run = field_run_level,
                                   .watch = field_watch_level,
                                   .repeat = field_repeat,
                                   .reason = motion_reason,
                                   .user = study};
  return DONE;
}

int motion_study_init(motion_study *study, const judged_motion *motion, const char *method,
                      const pacing *how, const char *name)
{
  const problem *scene = motion->scene;
  const double t_end = motion->t_end;
  *study = (motion_study){.motion = *motion};
  if (dvi_scene_marches(scene->scene, method)) return init_march(study, method, name);
  int code = open_paced(scene, method, how, &study->integrator);
  if (code != DONE) return code;
  double span;
  const dvi_status status = march_span(study->integrator, scene->q, scene->p, scene->order_h, t_end,
                                       &span);
  if (status != DVI_OK || isnan(span)) {
    motion_study_clear(study);
    return status != DVI_OK ? library_error(status) : motion_study_refuse(method, t_end);
  }
  study->subject = (study_subject){.name = name,
                                   .problem = scene->name,
                                   .words = motion_words(scene),
                                   .extent = t_end,
                                   .order = dvi_integrator_order(study->integrator),
                                   .span = span,
                                   .first_parts = fabs(span) / scene->order_h,
                                   .size = solution_size(motion),
                                   .judge = motion->judge->words,
                                   .judge_error = motion->judge->error,
                                   .chooses = dvi_integrator_chooses_steps(study->integrator),
                                   .may_miss = dvi_integrator_monitor(study->integrator) != NULL,
                                   .run = motion_run,
                                   .watch = motion_watch,
                                   .repeat = motion_repeat,
                                   .roundoff = motion_roundoff,
                                   .reason = motion_reason,
                                   .user = study};
  return DONE;
}

void motion_study_clear(motion_study *study)
{
  dvi_integrator_destroy(&study->integrator);
}
