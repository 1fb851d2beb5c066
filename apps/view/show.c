#include "view/show.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "cli/command.h"
#include "cli/file.h"
#include "view/page.h"

/* Trails are shown from the start for so few points. */
enum { TRAILS_USUAL = 12 };

int view_thin(int rows, long most, int **row)
{
  const int frames = rows <= most ? rows : (int)most;
  *row = calloc((size_t)frames + 1, sizeof **row);
  if (*row == NULL) return 0;
  for (int k = 1; k < frames; k++) (*row)[k] = (int)((int64_t)k * (rows - 1) / (frames - 1));
  return frames;
}

static double number_at(const view_run *run, int column, int row)
{
  return run->table->column[column].value[row];
}

/* ---- what moves ---- */

static void write_points(const view_run *run, page *p)
{
  const view_layout *layout = run->layout;
  (void)fputs(",\n\"points\":[", p->stream);
  for (int k = 0; k < layout->points; k++) {
    if (k > 0) (void)fputc(',', p->stream);
    page_text(p, layout->point[k].name);
  }
  (void)fputs("],\n\"positions\":", p->stream);
  page_floats_begin(p);
  for (int f = 0; f < run->frames; f++)
    for (int k = 0; k < layout->points; k++)
      for (int a = 0; a < 3; a++) {
        const int from = layout->point[k].from[a];
        page_float(p, from == VIEW_NONE ? layout->point[k].fixed[a]
                                        : number_at(run, run->column[from], run->row[f]));
      }
  page_list_end(p);
  (void)fputs(",\n\"links\":[", p->stream);
  for (int k = 0; k < layout->links; k++)
    (void)fprintf(p->stream, "%s[%d,%d]", k > 0 ? "," : "", layout->link[k].from,
                  layout->link[k].to);
  (void)fputc(']', p->stream);
}

static void write_body(const view_body *body, page *p)
{
  (void)fputs("{\"name\":", p->stream);
  page_text(p, body->name);
  (void)fprintf(p->stream, ",\"point\":%d,\"moments\":{\"mass\":%.9g,\"centre\":[%.9g,%.9g,%.9g]",
                body->point, body->mass, body->centre[0], body->centre[1], body->centre[2]);
  (void)fputs(",\"second\":[", p->stream);
  for (int k = 0; k < 6; k++) (void)fprintf(p->stream, "%s%.9g", k > 0 ? "," : "", body->second[k]);
  (void)fputs("]}}", p->stream);
}

static void write_bodies(const view_run *run, page *p)
{
  const view_layout *layout = run->layout;
  (void)fputs(",\n\"bodies\":[", p->stream);
  for (int k = 0; k < layout->bodies; k++) {
    if (k > 0) (void)fputc(',', p->stream);
    write_body(&layout->body[k], p);
  }
  (void)fputs("],\n\"rotations\":", p->stream);
  page_floats_begin(p);
  for (int f = 0; f < run->frames; f++)
    for (int k = 0; k < layout->bodies; k++)
      for (int e = 0; e < 9; e++)
        page_float(p, number_at(run, run->column[layout->body[k].rotation + e], run->row[f]));
  page_list_end(p);
}

/* ---- over time ---- */

/* Write curves as differences from their first numbers, whose small changes 32 bits can tell. */
static void write_curves(const view_run *run, page *p)
{
  (void)fputs(",\n\"curves\":[", p->stream);
  for (int k = 0; k < run->curves; k++) {
    const double first = number_at(run, run->curve[k], run->row[0]);
    (void)fputs(k > 0 ? ",\n{\"name\":" : "\n{\"name\":", p->stream);
    page_text(p, run->table->column[run->curve[k]].name);
    (void)fprintf(p->stream, ",\"first\":%.17g,\"changes\":", first);
    page_floats_begin(p);
    for (int f = 0; f < run->frames; f++)
      page_float(p, number_at(run, run->curve[k], run->row[f]) - first);
    page_list_end(p);
    (void)fputc('}', p->stream);
  }
  (void)fputc(']', p->stream);
}

static void write_times(const view_run *run, page *p)
{
  (void)fputs(",\n\"times\":[", p->stream);
  for (int f = 0; f < run->frames; f++)
    (void)fprintf(p->stream, "%s%.17g", f > 0 ? "," : "", run->time[run->row[f]]);
  (void)fputc(']', p->stream);
}

static void write_run(const view_run *run, page *p)
{
  const bool plane = run->layout != NULL ? run->layout->is_plane : grid_frames_are_flat(run->grids);
  (void)fputs("{\"title\":", p->stream);
  page_text(p, run->title);
  (void)fputs(",\n\"made\":", p->stream);
  page_text(p, run->made);
  (void)fprintf(p->stream, ",\n\"frames\":%d,\"isPlane\":%s,\"trails\":%s", run->frames,
                plane ? "true" : "false",
                run->layout != NULL && !run->layout->is_chain && run->layout->points <= TRAILS_USUAL
                    ? "true"
                    : "false");
  write_times(run, p);
  if (run->layout != NULL) {
    write_points(run, p);
    write_bodies(run, p);
  } else {
    (void)fputs(",\n\"points\":[],\"links\":[],\"bodies\":[],\n\"mesh\":", p->stream);
    grid_frames_write(run->grids, p);
  }
  write_curves(run, p);
  (void)fputc('}', p->stream);
}

/* ---- the file ---- */

/* Check the numbers of a column. Those that 32 bits cannot hold cannot be drawn. */
static bool column_is_good(const view_run *run, int column)
{
  for (int f = 0; f < run->frames; f++) {
    const double number = number_at(run, column, run->row[f]);
    if (isfinite((float)number)) continue;
    complain("view: row %d has no number in column '%s' that can be drawn", run->row[f] + 1,
             run->table->column[column].name);
    return false;
  }
  return true;
}

static bool numbers_are_good(const view_run *run)
{
  const view_layout *layout = run->layout;
  bool good = true;
  for (int k = 0; k < run->curves && good; k++) good = column_is_good(run, run->curve[k]);
  for (int k = 0; layout != NULL && k < layout->points && good; k++)
    for (int a = 0; a < 3 && good; a++)
      good = layout->point[k].from[a] == VIEW_NONE ||
             column_is_good(run, run->column[layout->point[k].from[a]]);
  for (int k = 0; layout != NULL && k < layout->bodies && good; k++)
    for (int e = 0; e < 9 && good; e++)
      good = column_is_good(run, run->column[layout->body[k].rotation + e]);
  return good;
}

int view_write(const view_run *run, const char *path)
{
  whole_file out;
  page p;
  if (!numbers_are_good(run) || !file_open(&out, path)) return FAILED;
  page_begin(&p, out.stream, run->title);
  write_run(run, &p);
  page_end(&p);
  return file_keep(&out) ? DONE : FAILED;
}
