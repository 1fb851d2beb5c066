#include "scaling/ranks_report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bench/machine.h"
#include "cli/command.h"
#include "csv/table.h"
#include "plot/plot.h"
#include "scaling/ranks_limits.h"
#include "scaling/ranks_model.h"
#include "scaling/whole.h"

static const table_column columns[] = {
    {"scaling", NULL},
    {"problem", NULL},
    {"ranks", "%.0f"},
    {"rank_cells", "%.0f"},
    {"step_seconds", "%.3e"},
    {"efficiency", "%.3f"},
    {"exchange", "%.3f"},
    {"messages", "%.1f"},
    {"bytes", "%.0f"},
    {"measured_seconds", "%.3e"},
    {"measured_efficiency", "%.3f"},
    {"oversubscribed", "%.0f"},
    {"measured_lower", ""},
    {"measured_upper", ""},
    {"cells", ""},
    {NULL, NULL},
};

/* Two cores may have to share the bandwidth of one, and no less. */
static const double sharing_most = 2;

/* ---- the table ---- */

static void add_measured(result_table *rows, const ranks_bench *b, const dvi_study_spread *seconds,
                         const shared_run *run)
{
  const double gain = b->whole.seconds.median / seconds->median;
  const bool is_divided = run != NULL && !run->is_weak;
  table_number(rows, seconds->median);
  table_number(rows, is_divided ? gain / run->ranks : gain);
  table_number(rows, run != NULL && run->is_oversubscribed);
  table_number(rows, seconds->lower);
  table_number(rows, seconds->upper);
}

/* What was measured, if anything was. */
static void add_measurement(result_table *rows, const ranks_bench *b, double ranks, bool is_weak)
{
  if (ranks <= 1) {
    add_measured(rows, b, &b->whole.seconds, NULL);
    return;
  }
  for (int i = 0; i < b->shared; i++)
    if (b->run[i].ranks >= ranks && b->run[i].ranks <= ranks && b->run[i].is_weak == is_weak) {
      add_measured(rows, b, &b->run[i].seconds, b->run + i);
      return;
    }
  for (int i = 0; i < 5; i++) table_number(rows, (double)NAN);
}

static void add_row(result_table *rows, const ranks_bench *b, double ranks, bool is_weak)
{
  step_prediction p;
  double efficiency;
  if (!ranks_model_predict(b, ranks, is_weak, &p, &efficiency)) return;
  table_text(rows, is_weak ? "weak" : "strong");
  table_text(rows, b->request->timed.scene);
  table_number(rows, ranks);
  table_number(rows, p.cells);
  table_number(rows, p.seconds);
  table_number(rows, efficiency);
  table_number(rows, p.exchange / p.seconds);
  table_number(rows, p.messages);
  table_number(rows, p.bytes);
  add_measurement(rows, b, ranks, is_weak);
  table_number(rows, b->whole.cells * (is_weak ? ranks : 1));
}

/* Returns the number of rows with a mesh of constant size. */
static int fill_table(result_table *rows, const ranks_bench *b)
{
  for (int i = 0; i < b->asked.count; i++) add_row(rows, b, b->asked.number[i], false);
  const int strong = table_rows(rows);
  for (int i = 0; i < b->asked.count; i++) add_row(rows, b, b->asked.number[i], true);
  return strong;
}

/* ---- what was measured ---- */

static void print_alone(FILE *stream, const ranks_bench *b)
{
  double most = 0;
  (void)fprintf(stream,
                "\nOne rank of a cut, alone: the largest share, without messages\n"
                "  %8s %10s %10s %9s %11s %11s %9s\n",
                "parts", "share", "bytes", "messages", "step", "fitted", "off");
  for (int i = 0; i < b->cuts; i++) {
    const mesh_cut *c = &b->cut[i].cut;
    const double measured = b->cut[i].seconds.least;
    (void)fprintf(stream, "  %8.0f %10.0f %10.0f %9.3g %11.3e %11.3e %8.1f%%\n", c->parts, c->share,
                  c->bytes, c->messages, measured, measured * (1 + b->deviation[i]),
                  100 * b->deviation[i]);
    most = fmax(most, fabs(b->deviation[i]));
  }
  (void)fprintf(stream,
                "  fit: %.3g us a step and %.3g ns for 1000 bytes, that is %.1f GB/s; the largest "
                "deviation is %.1f %%\n",
                1e6 * b->cost.per_step / b->own, 1e12 * b->cost.per_byte / b->own,
                1e-9 * b->own / b->cost.per_byte, 100 * most);
  if (b->whole.kind == TIMED_FIELD)
    (void)fprintf(
        stream,
        "  scene: its own step takes %.3f times as long as that of a field without losses "
        "and sources\n",
        b->own);
}

static void print_triads(FILE *stream, const ranks_bench *b)
{
  (void)fprintf(stream, "triad a = b + s c: ");
  for (int i = 0; i < b->triads; i++)
    if (isfinite(b->triad[i].bandwidth))
      (void)fprintf(stream, "%s%.1f GB/s of %d process%s", i > 0 ? ", " : "",
                    1e-9 * b->triad[i].bandwidth, b->triad[i].ranks,
                    b->triad[i].ranks > 1 ? "es together" : "");
  (void)fprintf(stream, "; a step of the whole mesh moves %.1f GB/s\n",
                1e-9 * b->whole.bytes / b->whole.seconds.median);
}

/* A step of which parts come one after the other takes as much longer. */
static void print_turns(FILE *stream, const ranks_bench *b, const shared_run *r, double seconds)
{
  if (r->is_oversubscribed)
    (void)fprintf(stream, "  oversubscribed: in turns %.3e", seconds * r->ranks / b->cores);
  (void)fprintf(stream, "\n");
}

static void print_runs(FILE *stream, const ranks_bench *b)
{
  (void)fprintf(stream, "\nRanks that share\n  %6s %6s %10s %11s %11s %10s %10s %9s\n", "ranks",
                "mesh", "cells", "step", "model", "speed-up", "refresh", "messages");
  for (int i = 0; i < b->shared; i++) {
    const shared_run *r = b->run + i;
    step_prediction p;
    ranks_model_run(b, r, &p);
    const double gain = b->whole.seconds.median / r->seconds.median;
    (void)fprintf(stream, "  %6d %6s %10.0f %11.3e %11.3e %10.2f %10.2e %9.3g", r->ranks,
                  r->is_weak ? "grows" : "same", r->cells, r->seconds.median, p.seconds,
                  r->is_weak ? gain * r->ranks : gain, r->exchange, r->cut.messages);
    print_turns(stream, b, r, p.seconds);
  }
}

static void print_mesh(FILE *stream, const ranks_bench *b)
{
  (void)fprintf(stream, "%s: %.0f %s; a step moves %.4g bytes", whole_name(&b->whole),
                b->whole.cells, whole_unit(&b->whole), b->whole.bytes);
  if (isfinite(b->whole.flops)) (void)fprintf(stream, " and takes %.4g operations", b->whole.flops);
  (void)fprintf(stream, ", if each number comes from memory once\n");
  if (isfinite(b->mesh_bytes))
    (void)fprintf(stream, "start: the whole mesh takes %.4g bytes, %.0f a cell, in each process\n",
                  b->mesh_bytes, b->mesh_bytes / b->whole.cells);
  for (int i = 0; i < b->shared; i++)
    if (b->run[i].is_oversubscribed) {
      (void)fprintf(stream,
                    "oversubscribed: %d ranks on %d cores take turns; what they take tells nothing "
                    "of %d cores, and is left out of the model\n",
                    b->run[i].ranks, b->cores, b->run[i].ranks);
      break;
    }
}

/* ---- the model ---- */

static void print_network(FILE *stream, const ranks_bench *b)
{
  (void)fprintf(stream, "  network: messages between two processes %s take %.3g us and %.3g GB/s",
                b->is_one_machine ? "of this machine (shared memory)" : "of two machines",
                1e6 * b->latency, 1e-9 * b->bandwidth);
  if (!isnan(b->request->latency) || !isnan(b->request->bandwidth))
    (void)fprintf(stream, ";\n    the model has %.3g us and %.3g GB/s, as was asked for",
                  1e6 * b->cost.latency, 1e-9 * b->cost.bandwidth);
  else if (b->is_one_machine)
    (void)fprintf(stream, ", and no network\n    is so fast: give that of another one by --latency "
                          "and --bandwidth, as 1.5e-6 and 12.5e9");
  (void)fprintf(stream, "\n");
}

static void print_model(FILE *stream, const ranks_bench *b)
{
  const mesh_cut *last = &b->cut[b->cuts - 1].cut;
  (void)fprintf(stream, "\nThe model, and what it takes for granted\n"
                        "  cells: a rank takes the fit's time for its share, ");
  if (b->has_sharing)
    (void)fprintf(stream, "times %.3f, as measured where each core has a rank%s\n", b->cost.sharing,
                  b->cost.sharing > sharing_most ? ";\n    no memory explains so much: other "
                                                   "programs ran, or the mesh is too small"
                                                 : "");
  else
    (void)fprintf(stream, "whatever others do: no run had a core for each rank\n");
  if (b->cuts > 1 && b->whole.kind == TIMED_GRID)
    (void)fprintf(stream, "  surface: blocks are foreseen for each number of ranks; of a longer "
                          "grid ranks have slabs "
                          "between two others\n");
  else if (b->cuts > 1)
    (void)fprintf(stream,
                  "  surface: the shell of ghosts, their bytes and messages are those of cuts into "
                  "up to %.0f parts by the\n    partitioner in one process; ranks beyond have as "
                  "many around them, %.0f messages\n",
                  last->parts, last->messages);
  print_network(stream, b);
  (void)fprintf(stream,
                "  program: %.3g us a message and %.3g ns for 1000 bytes besides, from refreshes "
                "of two ranks and of those above;\n    messages come one after the other, and "
                "nothing is computed meanwhile; %.3g agreements of all ranks\n    in a step, of "
                "log2 N messages each\n",
                1e6 * b->cost.overhead, 1e12 * b->cost.packing, b->cost.agreements);
}

static void print_all(FILE *stream, const ranks_bench *b, const result_table *rows, int strong)
{
  (void)fprintf(stream, "Ranks that share %s, by %s\n", b->request->timed.scene, b->whole.method);
  machine_print(stream);
  (void)fprintf(stream, "cores: %d\n", b->cores);
  print_mesh(stream, b);
  print_triads(stream, b);
  print_alone(stream, b);
  print_runs(stream, b);
  print_model(stream, b);
  (void)fprintf(stream, "\nStrong scaling: the %s is divided\n", whole_name(&b->whole));
  table_print(rows, stream, 2, 0, strong);
  if (strong < b->asked.count)
    (void)fprintf(stream, "  more ranks than %s are left out\n",
                  b->whole.kind == TIMED_GRID ? "the grid has blocks for" : "cells");
  (void)fprintf(stream, "\nWeak scaling: each rank has as many %s as the %s\n",
                whole_unit(&b->whole), whole_name(&b->whole));
  table_print(rows, stream, 2, strong, table_rows(rows));
  (void)fprintf(
      stream,
      "\nstep_seconds: predicted; exchange: its part for messages; bytes: received by the "
      "rank that has most\nmeasured_seconds: elapsed time of a step, the median over %ld rounds, "
      "of which the model has the least;\noversubscribed: 1 where ranks had no core each\n",
      b->request->timed.rounds);
  ranks_limits_print(stream, b);
}

/* ---- the plot ---- */

static bool draw(const ranks_bench *b, const result_table *rows, int strong)
{
  enum { RANKS = 2, SECONDS = 4, MEASURED = 9 };
  const int all = table_rows(rows);
  double *x = calloc(3 * (size_t)all + 1, sizeof *x);
  if (x == NULL) {
    complain("out of memory for the plot");
    return false;
  }
  double *y = x + all, *measured = y + all;
  for (int i = 0; i < all; i++) {
    x[i] = table_number_at(rows, i, RANKS);
    y[i] = table_number_at(rows, i, SECONDS);
    measured[i] = table_number_at(rows, i, MEASURED);
  }
  const int weak = all - strong;
  const plot_curve curve[] = {
      {.label = "strong", .count = strong, .x = x, .y = y},
      {.label = "strong, measured", .count = strong, .x = x, .y = measured},
      {.label = "weak", .count = weak, .x = x + strong, .y = y + strong},
      {.label = "weak, measured", .count = weak, .x = x + strong, .y = measured + strong}};
  const plot_panel panel = {.title = "elapsed time of a step against the number of ranks",
                            .x_label = "ranks",
                            .y_label = "elapsed seconds of a step",
                            .logarithmic = true,
                            .curves = sizeof curve / sizeof *curve,
                            .curve = curve};
  const bool good = plot_write(b->request->plot, 1, &panel);
  free(x);
  return good;
}

int ranks_report(ranks_bench *b)
{
  const ranks_request *r = b->request;
  const bool csv_only = r->csv != NULL && strcmp(r->csv, "-") == 0;
  if (!ranks_model_fit(b)) return FAILED;
  result_table *rows = table_create(columns);
  const int strong = rows != NULL ? fill_table(rows, b) : 0;
  bool good = rows != NULL && table_good(rows);
  if (good) print_all(csv_only ? stderr : stdout, b, rows, strong);
  if (good && r->csv != NULL) good = table_write(rows, r->csv);
  if (good && r->plot != NULL) good = draw(b, rows, strong);
  table_destroy(&rows);
  return good ? DONE : FAILED;
}
