#include "boundary/control_report.h"

#include <dvi/scene.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/file.h"
#include "csv/table.h"

void control_print(const controlled *c, FILE *stream)
{
  const dvi_control_report *r = &c->report;
  (void)fprintf(stream, "%s, %d steps of %s\n", c->scene->name, dvi_control_steps(c->control),
                dvi_control_method(c->control));
  (void)fprintf(stream, "cost              %.15g\n", r->cost);
  (void)fprintf(stream, "span              %.15g\n", r->span);
  if (r->barrier > 0)
    (void)fprintf(stream, "barrier           %.1e of the bounds, in units of the cost\n",
                  r->barrier);
  if (r->is_minimum < 0)
    (void)fprintf(stream, "second variation  not found\n");
  else
    (void)fprintf(stream, "second variation  %s: %ld negative for %ld multipliers, %ld zero\n",
                  r->is_minimum ? "minimum" : "saddle", r->negative, r->multipliers, r->zero);
  (void)fprintf(stream, "gradient          %.1e of the largest momentum\n", r->gradient);
  (void)fprintf(stream, "solver            %d iterations\n", r->iterations);
}

static void write_titles(const controlled *c, FILE *stream)
{
  const int n = c->scene->nq;
  (void)fputs("t", stream);
  for (int i = 0; i < 4 * n + c->count; i++) {
    const int costate = i - 2 * n - c->count;
    (void)fputs(costate >= 0 ? ",costate_" : ",", stream);
    if (i >= 2 * n && costate < 0) {
      csv_text(stream, dvi_scene_control(c->scene->scene, i - 2 * n));
      continue;
    }
    const int k = costate >= 0 ? costate : i;
    csv_text(stream, k < n ? c->scene->coordinate[k] : c->scene->momentum[k - n]);
  }
  (void)fputc('\n', stream);
}

static void write_numbers(int count, const double *number, FILE *stream)
{
  for (int i = 0; i < count; i++) (void)fprintf(stream, ",%.17g", number[i]);
}

/* room is [2 n + controls]. */
static dvi_status write_rows(const controlled *c, double *room, FILE *stream)
{
  const int n = c->scene->nq;
  double *u = room + 2 * n;
  for (int k = 0; k <= dvi_control_steps(c->control); k++) {
    dvi_status status = dvi_control_u(c->control, k, u);
    if (status == DVI_OK) status = dvi_control_costate(c->control, k, room, room + n);
    if (status != DVI_OK) return status;
    (void)fprintf(stream, "%.17g", dvi_control_time(c->control, k));
    write_numbers(n, dvi_control_q(c->control, k), stream);
    write_numbers(n, dvi_control_p(c->control, k), stream);
    write_numbers(c->count, u, stream);
    write_numbers(2 * n, room, stream);
    (void)fputc('\n', stream);
  }
  return DVI_OK;
}

int control_write(const controlled *c, const char *out)
{
  whole_file file = {0};
  double *room = calloc(2 * (size_t)c->scene->nq + (size_t)c->count, sizeof *room);
  int code = room != NULL && file_open(&file, out) ? DONE : FAILED;
  if (room == NULL) complain("out of memory");
  if (code == DONE) {
    write_titles(c, file.stream);
    const dvi_status status = write_rows(c, room, file.stream);
    if (status != DVI_OK) code = library_error(status);
  }
  if (code == DONE && !file_keep(&file)) code = FAILED;
  file_discard(&file);
  free(room);
  return code;
}
