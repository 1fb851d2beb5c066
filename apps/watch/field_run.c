#include "watch/field_run.h"

#include <dvi/scene.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "cli/progress.h"
#include "cli/signals.h"
#include "load/density.h"
#include "load/elastic.h"
#include "load/open_march.h"
#include "module/ranks.h"
#include "store/row_output.h"
#include "watch/field_columns.h"
#include "watch/field_map.h"
#include "watch/field_trace.h"
#include "frames/frames.h"
#include "watch/run_end.h"
#include "watch/run_head.h"

/* Steps after which a signal and the progress are looked at. */
enum { STEPS_AT_ONCE = 64 };

/* A run. A unit of time is a step, of asynchronous methods the longest one. */
typedef struct journey {
  const run_request *request;
  const problem *scene;
  dvi_march *march;
  field_columns columns;
  field_trace trace;
  frame_list frames;
  double *vector;      /* [cells*3] room of the frames */
  density_views views; /* of a density, which has coefficients and coordinates in that room */
  field_map map;
  row_output out;
  run_head head;
  progress_line progress;
  double unit, t_start;
  long unit_count;                    /* units from t = 0 */
  double t_saved;                     /* the time of the last checkpoint, once one is saved */
  bool row_written, is_saved, beyond; /* a bound, which was told */
  const volatile sig_atomic_t *caught;
  int signal; /* that one of the processes has caught, or 0 */
} journey;

/* ---- checks ---- */

static int refuse_options(const run_request *r)
{
  const struct {
    bool given;
    const char *name;
  } list[] = {{r->momenta != NULL, "momenta"},
              {r->events != NULL, "events"},
              {r->project, "project"},
              {r->alarms.count > 0, "alarm"},
              {r->how.transform != NULL, "time-transform"},
              {r->how.control != NULL, "step-control"}};
  if (r->verify)
    return usage_error(
        "run: --verify is for mechanical methods such as midpoint%s; compare the rows of "
        "%s, a march of a field, with those of --h at half the step",
        ranks_count() > 1 ? " in one process" : "", r->method);
  for (size_t i = 0; i < sizeof list / sizeof *list; i++)
    if (list[i].given)
      return usage_error("run: --%s is for mechanical methods such as midpoint%s; %s is a march of "
                         "a field",
                         list[i].name, ranks_count() > 1 ? " in one process" : "", r->method);
  if (!isnan(r->h) && !(r->h > 0))
    return usage_error("run: --h %g: a march of a field goes forward", r->h);
  if (!isnan(r->t_end) && !(r->t_end >= 0))
    return usage_error("run: --t-end %g: a march of a field goes forward", r->t_end);
  return DONE;
}

/* ---- a march ---- */

/* A step that is a fraction divides the span, and another end has another step. */
static int refuse_state(dvi_status status, const journey *j)
{
  const int code = library_error(status);
  if (status == DVI_BAD_FILE && strstr(dvi_last_error(), "step") != NULL && isnan(j->request->h) &&
      dvi_scene_plan_of(j->scene->scene)->fraction > 0)
    complain("run: a step by a fraction is fitted to the end: resume with the scene and the end of "
             "the run that wrote it, or give both runs the same --h");
  return code;
}

/* A mesh has the materials of the middles of its cells, and a grid their averages. */
static void tell_if_on_mesh(const problem *scene, const char *method, const char *found)
{
  if (method == NULL) method = scene->method;
  if (method != NULL && strcmp(method, "yee") == 0 && strcmp(found, "yee") != 0)
    complain("run: yee is leapfrog on the mesh of the boxes here, with the materials at their "
             "middles: a start by A and probes of parts need the mesh");
}

/* Warn of steps beyond a bound, at the start or at the end, where another density may stand. */
static void warn_of_bound(journey *j)
{
  dvi_march_facts facts;
  dvi_march_facts_of(j->march, &facts);
  if (facts.step <= facts.bound || j->beyond) return;
  j->beyond = true;
  complain(
      "run: steps of %.3g are beyond the bound %.3g of the density at t = %.6g; noise may grow "
      "by resonance, and the energy with it: take steps below it, midpoint or gauss",
      facts.step, facts.bound, dvi_march_time(j->march));
}

/* Refuse states in parts of marches that have none, and get ready for others. */
static int prepare_states(const journey *j)
{
  const char *const path[] = {j->request->checkpoint, j->request->resume};
  static const char *const with_parts[] = {"leapfrog", "midpoint", "imex", "galerkin"};
  dvi_march_facts facts;
  dvi_march_facts_of(j->march, &facts);
  bool has_parts = elastic_of(j->scene) != NULL;
  for (size_t i = 0; i < sizeof with_parts / sizeof *with_parts; i++)
    has_parts = has_parts || strcmp(facts.method, with_parts[i]) == 0;
  for (int i = 0; i < 2; i++) {
    if (ranks_part_state(path[i]) && !has_parts)
      return usage_error(
          "run: '%s' is a state in parts by its name, which fields by leapfrog and "
          "implicit methods on meshes, and solids, have, and %s has not; give another name",
          path[i], facts.method);
    const int code = ranks_prepare_state(path[i]);
    if (code != DONE) return code;
  }
  return DONE;
}

static int make_march(journey *j)
{
  const run_request *r = j->request;
  const dvi_march_options options = {.size = sizeof options,
                                     .method = r->method,
                                     .step = isnan(r->h) ? 0 : r->h,
                                     .span = r->t_end,
                                     .threads = (int)r->threads};
  dvi_march_facts facts;
  int code = open_march(j->scene, &options, &j->march);
  if (code == DONE) code = prepare_states(j);
  if (code != DONE) return code;
  if (r->resume != NULL) {
    const dvi_status loaded = ranks_load(j->march, r->resume);
    if (loaded != DVI_OK) return refuse_state(loaded, j);
    if (dvi_march_time(j->march) > r->t_end)
      return usage_error("run: '%s' stands at t = %.17g, past --t-end %g", r->resume,
                         dvi_march_time(j->march), r->t_end);
  }
  dvi_march_facts_of(j->march, &facts);
  tell_if_on_mesh(j->scene, r->method, facts.method);
  j->unit = facts.longest;
  j->t_start = dvi_march_time(j->march);
  j->unit_count = (long)floor(j->t_start / j->unit + 1e-6);
  warn_of_bound(j);
  return DONE;
}

/* ---- rows ---- */

/* Write the components of a field with a density. */
static bool write_components(journey *j)
{
  const dvi_density *density = density_of(j->scene);
  const double t = dvi_march_time(j->march);
  double *U = j->vector, *q = U + density_coefficients(density);
  dvi_status status = dvi_scene_march_state(j->scene->scene, j->march, q, NULL);
  if (status == DVI_OK) status = dvi_density_lift(density, t, q, U);
  if (status != DVI_OK) return library_error(status) == DONE;
  return density_views_fill(&j->views, U) == DONE &&
         frames_add(&j->frames, t, j->views.count, j->views.view);
}

/* Write a solid, with the nodes where they are. */
static bool write_solid(journey *j)
{
  const int64_t numbers = dvi_march_size(j->march, DVI_FORM_A);
  double *u = j->vector, *velocity = u + numbers;
  elastic_views now = {.count = 0};
  dvi_status status = dvi_march_sample(j->march, DVI_FORM_A, 0, NULL, u);
  if (status == DVI_OK) status = dvi_march_sample(j->march, DVI_FORM_E, 0, NULL, velocity);
  if (ranks_agree(status == DVI_OK ? DONE : library_error(status)) != DONE) return false;
  for (int64_t i = 0; i < numbers; i++) velocity[i] = -velocity[i];
  bool good = ranks_agree(elastic_views_make(j->scene, u, velocity, &now)) == DONE;
  frames_move(&j->frames, j->frames.mesh, now.point);
  good = good && frames_add(&j->frames, dvi_march_time(j->march), now.count, now.view);
  elastic_views_clear(&now);
  return good;
}

/* Write the fields at the time of a row: E and B in the cells, or u of a wave at the vertices. */
static bool write_frame(journey *j)
{
  const dvi_scene *scene = j->scene->scene;
  if (!frames_are_wanted(&j->frames)) return true;
  if (density_of(j->scene) != NULL) return write_components(j);
  if (elastic_of(j->scene) != NULL) return write_solid(j);
  const int n = dvi_mesh_dimension(j->frames.mesh);
  double *E = j->vector, *B = E + 3 * (size_t)dvi_mesh_count(j->frames.mesh, n);
  const dvi_view vectors[] = {{"E", E, 3, n}, {"B", B, 3, n}}, value = {"u", j->vector, 1, 0};
  dvi_status status = dvi_scene_vectors(scene, j->march, DVI_FORM_E, E);
  const bool is_wave = status == DVI_UNSUPPORTED;
  if (is_wave)
    status = dvi_march_sample(j->march, DVI_FORM_A, 0, NULL, j->vector);
  else if (status == DVI_OK)
    status = dvi_scene_vectors(scene, j->march, DVI_FORM_B, B);
  if (ranks_agree(status == DVI_OK ? DONE : library_error(status)) != DONE) return false;
  return frames_add(&j->frames, dvi_march_time(j->march), is_wave ? 1 : 2,
                    is_wave ? &value : vectors);
}

static bool write_row(journey *j)
{
  field_columns_row(&j->columns, j->out.row);
  j->row_written = true;
  return row_output_add(&j->out) && write_frame(j);
}

static bool look(journey *j, bool row)
{
  j->row_written = false;
  if (!field_map_add_march(&j->map, j->march)) return false;
  if (!row && j->trace.t == NULL) return true;
  if (!field_columns_measure(&j->columns)) return false;
  field_trace_add(&j->trace);
  return !row || write_row(j);
}

/* ---- the way ---- */

/* Return the number of units at which something is due next. */
static long next_stop(const journey *j)
{
  const run_request *r = j->request;
  const long every = r->every, saved = r->checkpoint_every;
  long next = j->unit_count + STEPS_AT_ONCE;
  if (!r->final || j->trace.t != NULL || r->map != NULL)
    next = next < (j->unit_count / every + 1) * every ? next : (j->unit_count / every + 1) * every;
  if (saved > 0 && next > (j->unit_count / saved + 1) * saved)
    next = (j->unit_count / saved + 1) * saved;
  return next;
}

/* Save a checkpoint, and before that the rows that lead to it. */
static bool save(journey *j)
{
  const run_request *r = j->request;
  if (r->checkpoint == NULL) return true;
  if (ranks_agree(row_output_flush(&j->out) ? DONE : FAILED) != DONE) return false;
  const double t = dvi_march_time(j->march), *before = j->is_saved ? &j->t_saved : NULL;
  run_tell_checkpoint(r, before, &t);
  const dvi_status status = ranks_save(j->march, r->checkpoint);
  if (status != DVI_OK) return library_error(status) == DONE;
  j->t_saved = t;
  j->is_saved = true;
  run_tell_checkpoint(r, &t, NULL);
  return true;
}

static bool advance(journey *j, bool *ended)
{
  const run_request *r = j->request;
  const long next = next_stop(j);
  double t = (double)next * j->unit;
  *ended = t >= r->t_end - 1e-9 * j->unit;
  if (*ended) t = r->t_end;
  const dvi_status status = dvi_march_advance(j->march, t);
  if (status != DVI_OK) return library_error(status) == DONE;
  j->unit_count = next;
  const bool due = !*ended && next % r->every == 0;
  if (!look(j, due && !r->final)) return false;
  const bool saves = r->checkpoint_every > 0 && !*ended && next % r->checkpoint_every == 0;
  const bool good = !saves || save(j);
  progress_show(&j->progress, (t - j->t_start) / (r->t_end - j->t_start), "dvi run");
  return good;
}

/* Tell how many steps of different lengths there were, and which. */
static void tell_events(const journey *j)
{
  dvi_march_facts facts;
  dvi_march_facts_of(j->march, &facts);
  if (facts.longest > facts.step)
    complain("run: %lld events, with steps from %.3g to %.3g", (long long)facts.steps, facts.step,
             facts.longest);
}

/* Tell if an uninterrupted run has a row at the start of this one. */
static bool start_has_row(const journey *j)
{
  const bool is_whole = fabs(j->t_start / j->unit - (double)j->unit_count) < 1e-6;
  return is_whole && j->unit_count % j->request->every == 0;
}

/* A run that appends its rows to those of another one begins as an uninterrupted run would go
 * on. */
static bool first_row_is_due(const journey *j)
{
  if (j->request->final || j->out.has_row) return false;
  return !j->out.is_appended || start_has_row(j);
}

/* Agree with other processes whether the run goes on. A signal may have reached one of them. */
static bool goes_on(journey *j, bool *good)
{
  *good = ranks_agree(*good ? DONE : FAILED) == DONE;
  if (*good) j->signal = ranks_largest((int)*j->caught);
  return *good && j->signal == 0;
}

static int travel(journey *j)
{
  const run_request *r = j->request;
  bool ended = dvi_march_time(j->march) >= r->t_end, good = true;
  progress_start(&j->progress, r->final || j->out.file.stream != stdout);
  good = look(j, first_row_is_due(j));
  j->row_written = j->row_written || j->out.has_row;
  while (goes_on(j, &good) && !ended) good = advance(j, &ended);
  progress_end(&j->progress);
  if (good && !j->row_written) good = field_columns_measure(&j->columns) && write_row(j);
  good = save(j) && good;
  if (!good) return FAILED;
  tell_events(j);
  warn_of_bound(j);
  return j->signal == 0 ? DONE : run_interrupted(r, j->signal, dvi_march_time(j->march));
}

/* ---- files ---- */

static int start_frames(journey *j)
{
  /* the first process alone draws a grid without a mesh */
  const bool draws = ranks_is_first() || dvi_scene_grid_only(j->scene->scene) == NULL;
  const dvi_mesh *mesh = draws ? dvi_scene_mesh(j->scene->scene) : NULL;
  const int code = frames_start(&j->frames, j->scene->name, mesh, j->request->pvd);
  if (code != DONE) return code;
  const dvi_density *density = density_of(j->scene);
  const int n = dvi_mesh_dimension(mesh);
  const int64_t cells = dvi_mesh_count(mesh, n), vertices = dvi_mesh_count(mesh, 0),
                numbers = density != NULL ? density_coefficients(density) + field_unknowns(j->scene)
                                          : 6 * cells + 2 * n * vertices + 1;
  j->vector = calloc((size_t)numbers, sizeof *j->vector);
  if (j->vector != NULL && density != NULL) return density_views_make(j->scene, 1, &j->views);
  if (j->vector != NULL) return DONE;
  complain("out of memory");
  return FAILED;
}

/* List the names of the shown columns. */
static const char *column_name_at(int k, const void *list)
{
  const field_columns *columns = list;
  return k < columns->count ? columns->column[k].name : NULL;
}

/* Open the rows. Those of a resumed run may go on in the file of the run before it. The first of
 * several processes has them, and tells the others what is there. */
static int open_rows(journey *j)
{
  const run_request *r = j->request;
  const hdf5_state state = {.t = j->t_start,
                            .direction = 1,
                            .gap = (double)r->every * j->unit * (1 + 1e-9),
                            .has_row = start_has_row(j)};
  bool good = run_head_make(&j->head, r, j->scene, j->unit, column_name_at, &j->columns);
  j->frames.head = &j->head.rows;
  good = good && row_output_open(&j->out, r->out, &j->head.rows,
                                 r->resume != NULL && !r->final ? &state : NULL);
  const int code = ranks_agree(good ? DONE : FAILED);
  if (code != DONE) return code;
  j->out.is_appended = ranks_largest(j->out.is_appended);
  j->out.has_row = ranks_largest(j->out.has_row);
  return DONE;
}

static int write_files(journey *j)
{
  const run_request *r = j->request;
  if (r->plot != NULL && !field_trace_start(&j->trace, &j->columns)) return FAILED;
  int code = open_rows(j);
  if (code == DONE) code = travel(j);
  if (!row_output_close(&j->out, run_keeps_files(code))) code = FAILED;
  if (!ranks_is_first()) return code;
  if (run_keeps_files(code) && !frames_keep(&j->frames)) code = FAILED;
  if (run_keeps_files(code) && r->plot != NULL && !field_trace_plot(&j->trace, r->plot))
    code = FAILED;
  if (run_keeps_files(code) && !field_map_draw(&j->map)) code = FAILED;
  return code;
}

int field_run(run_request *request, const problem *scene)
{
  journey j = {.request = request, .scene = scene};
  if (isnan(request->t_end)) request->t_end = scene->t_end;
  if (request->every == 0) request->every = scene->every > 0 ? scene->every : 1;
  int code = refuse_options(request);
  if (code == DONE) code = make_march(&j);
  if (code == DONE) code = field_columns_choose(&j.columns, scene, j.march, request->columns);
  if (code == DONE && request->pvd != NULL) code = start_frames(&j);
  if (code == DONE) code = field_map_start(&j.map, scene, request->map, request->map_of);
  code = ranks_agree(code);
  run_tell_checkpoint(request, NULL, NULL);
  j.caught = signals_note(run_ended_again);
  if (code == DONE) code = write_files(&j);
  field_trace_clear(&j.trace);
  field_columns_clear(&j.columns);
  run_head_clear(&j.head);
  frames_clear(&j.frames);
  field_map_clear(&j.map);
  density_views_clear(&j.views);
  free(j.vector);
  dvi_march_destroy(&j.march);
  return code;
}
