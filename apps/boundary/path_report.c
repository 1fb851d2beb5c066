#include "boundary/path_report.h"

#include <math.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/file.h"
#include "csv/table.h"

/* ---- the report ---- */

static void print_variation(const dvi_path_report *r, FILE *stream)
{
  if (r->zero < 0)
    (void)fprintf(stream, "second variation  not defined for these ends, or not found\n");
  else if (r->negative < 0)
    (void)fprintf(stream,
                  "second variation  not resolved by these steps: %ld zero, but %d of symmetry; "
                  "take more steps\n",
                  r->zero, r->symmetries);
  else
    (void)fprintf(stream, "second variation  %s: %ld negative, %ld zero (%d of symmetry)\n",
                  r->negative > 0 ? "saddle" : "minimum", r->negative, r->zero, r->symmetries);
}

static void print_spread(const dvi_path_report *r, FILE *stream)
{
  const double relative = r->kinetic > 0.0 ? r->energy_spread / r->kinetic : 0.0;
  if (isnan(r->energy_spread))
    (void)fprintf(stream, "energy spread     not defined: the system depends on time\n");
  else
    (void)fprintf(
        stream,
        "energy spread     %.1e, %.1e of the kinetic energy; at most %.1e of it in a step\n",
        r->energy_spread, relative, r->energy_jump);
}

void print_report(const member *m, const path_request *request, FILE *stream)
{
  const dvi_path_report *r = &m->report;
  dvi_counters counters;
  dvi_path_counters(m->path, &counters);
  (void)fprintf(stream, "%s, ends %s, %d steps of %s\n", m->scene->name, request->ends,
                dvi_path_steps(m->path), dvi_path_method(m->path));
  (void)fprintf(stream, "action            %.15g\n", r->action);
  if (!isnan(r->energy)) (void)fprintf(stream, "energy            %.15g\n", r->energy);
  print_spread(r, stream);
  (void)fprintf(stream, "span              %.15g\n", r->span);
  (void)fprintf(stream, "gradient          %.1e of the largest momentum\n", r->gradient);
  print_variation(r, stream);
  (void)fprintf(stream, "solver            %d iterations, %ld factorizations, %ld symbolic\n",
                r->iterations, counters.factorizations, counters.symbolic);
}

/* ---- the nodes ---- */

static void path_write_header(const problem *scene, FILE *stream)
{
  (void)fputs("t", stream);
  for (int i = 0; i < 2 * scene->nq; i++) {
    (void)fputc(',', stream);
    csv_text(stream, i < scene->nq ? scene->coordinate[i] : scene->momentum[i - scene->nq]);
  }
  for (int i = 0; i < dvi_system_invariant_count(scene->system); i++) {
    (void)fputc(',', stream);
    csv_text(stream, dvi_system_invariant_name(scene->system, i));
  }
  (void)fputc('\n', stream);
}

static dvi_status path_write_rows(const member *m, double *invariant, FILE *stream)
{
  for (int k = 0; k <= dvi_path_steps(m->path); k++) {
    const double t = dvi_path_time(m->path, k), *q = dvi_path_q(m->path, k),
                 *p = dvi_path_p(m->path, k);
    const dvi_status status = dvi_system_invariants(m->scene->system, t, q, p, invariant);
    if (status != DVI_OK) return status;
    (void)fprintf(stream, "%.17g", t);
    for (int i = 0; i < m->scene->nq; i++) (void)fprintf(stream, ",%.17g", q[i]);
    for (int i = 0; i < m->scene->nq; i++) (void)fprintf(stream, ",%.17g", p[i]);
    for (int i = 0; i < dvi_system_invariant_count(m->scene->system); i++)
      (void)fprintf(stream, ",%.17g", invariant[i]);
    (void)fputc('\n', stream);
  }
  return DVI_OK;
}

int write_path(const member *m, const char *out)
{
  whole_file file = {0};
  double *invariant = calloc((size_t)dvi_system_invariant_count(m->scene->system),
                             sizeof *invariant);
  int code = invariant != NULL && file_open(&file, out) ? DONE : FAILED;
  if (invariant == NULL) complain("out of memory");
  if (code == DONE) {
    path_write_header(m->scene, file.stream);
    const dvi_status status = path_write_rows(m, invariant, file.stream);
    if (status != DVI_OK) code = library_error(status);
  }
  if (code == DONE && !file_keep(&file)) code = FAILED;
  file_discard(&file);
  free(invariant);
  return code;
}
