#include "watch/verify_report.h"

#include <math.h>
#include <string.h>

#include "cli/command.h"
#include "watch/energy_report.h"
#include "csv/table.h"
#include "study/trust.h"
#include "study/norms.h"

enum { ROWS_MOST = 64 };

static const table_column titles[] = {{"column", NULL},   {"value", "%.15g"}, {"error", "%.1e"},
                                      {"digits", "%.0f"}, {"size", ""},       {NULL, NULL}};

static void report_add_row(result_table *table, const char *name, double value, double error,
                           double size)
{
  table_text(table, name);
  table_number(table, value);
  table_number(table, error);
  table_number(table, trust_digits(error, size));
  table_number(table, size);
}

/* Add a row for several numbers, with their largest error and largest magnitude. */
static void report_add_norm(result_table *table, const char *name, const trust_numbers *all,
                            int first, int count)
{
  report_add_row(table, name, (double)NAN, norm_largest(count, all->error + first),
                 norm_largest(count, all->size + first));
}

/* Return whether a column has a true value. Columns that measure the method instead of the motion
 * have none. */
static bool is_of_motion(const shown_column *column)
{
  return column->kind == COLUMN_COORDINATE || column->kind == COLUMN_VELOCITY ||
         column->kind == COLUMN_MOMENTUM || column->kind == COLUMN_INVARIANT;
}

static result_table *report_table(const problem *scene, const run_columns *columns,
                                  const trust_numbers *all, bool by_event)
{
  const int first = 1 + scene->nq + scene->nv;
  result_table *table = table_create(titles);
  report_add_norm(table, "all coordinates", all, 1, scene->nq);
  report_add_norm(table, "all momenta", all, 1 + scene->nq, scene->nv);
  if (by_event) report_add_row(table, "t", all->value[0], all->error[0], all->size[0]);
  for (int k = 0; k < columns->count; k++)
    if (is_of_motion(&columns->column[k]))
      report_add_row(table, columns->column[k].name, all->value[first + k], all->error[first + k],
                     all->size[first + k]);
  return table;
}

/* Return the fewest digits of the state, and of the columns if they were asked for by name. */
static int fewest_digits(const result_table *table, bool columns_too)
{
  enum { STATE_ROWS = 2, DIGITS = 3 };
  double fewest = TRUST_DIGITS_MOST;
  for (int row = 0; row < (columns_too ? table_rows(table) : STATE_ROWS); row++)
    fewest = fmin(fewest, table_number_at(table, row, DIGITS));
  return (int)fewest;
}

static void print_witness(const run_request *request, const verify_verdict *verdict)
{
  if (verdict->by_event)
    (void)printf("no second method: an event ended the run\n");
  else if (verdict->too_large)
    (void)printf(
        "no second method: IDA is asked for %d coordinates at most, and may take long for more\n",
        WITNESS_COORDINATES);
  else if (verdict->refused)
    (void)printf("no second method: IDA does not take such a system\n");
  else if (!verdict->trust.witness)
    (void)printf("no second method: IDA did not come to t = %g in the time that it is given\n",
                 request->t_end);
  else
    (void)printf("second method: IDA, which shares no code, ends %.1e away in the %s, its own "
                 "error about %.1e%s\n",
                 verdict->trust.apart, verdict->trust.part, verdict->trust.witness_error,
                 verdict->trust.contradicted ? ": it contradicts, and errors are at least that"
                                             : "");
}

static void report_print(const run_request *request, const problem *scene,
                         const dvi_integrator *integrator, const result_table *table,
                         const verify_verdict *verdict)
{
  const int rows = table_rows(table), hidden = rows > ROWS_MOST ? rows - ROWS_MOST : 0;
  (void)printf("%s by %s with --h %g to t = %g, against --h %g and %g\n", scene->name,
               request->method, request->h, request->t_end, request->h / 2, request->h / 4);
  table_print(table, stdout, 0, 0, rows - hidden);
  if (hidden > 0) (void)printf("and %d columns more; see --columns and --csv\n", hidden);
  if (trust_falls(verdict->trust.ratio))
    (void)printf("halving the step divides the error by %.3g; order %d makes that %.3g\n",
                 1.0 / verdict->trust.ratio, dvi_integrator_order(integrator),
                 ldexp(1.0, dvi_integrator_order(integrator)));
  else
    (void)printf("halving the step does not halve the error: it is roundoff, the motion is "
                 "chaotic, or --h is too large\n");
  print_witness(request, verdict);
}

/* Advise a step. Where errors fall, a step with so many digits more is known. A step that is far
 * too short also gathers roundoff. A higher order then has the digits at the present step. */
static void advise_step(const run_request *request, const problem *scene,
                        const dvi_integrator *integrator, int digits)
{
  static const double shortest = 1e-3;
  const double part = pow(10.0, (double)(digits - request->digits - 1));
  const double step = energy_shorter_step(request->h, dvi_integrator_order(integrator), part,
                                          fabs(request->h));
  if (fabs(step) < shortest * fabs(request->h))
    complain("run: --h %g would do, at %.0f times the cost; try --method %s --h %g", step,
             request->h / step, energy_better_method(scene->terms), request->h);
  else
    complain("run: try --h %g", step);
}

static int report_fewer_digits(const run_request *request, const problem *scene,
                               const dvi_integrator *integrator, int digits,
                               const verify_verdict *verdict)
{
  complain("run: --digits %ld: %d can be trusted%s", request->digits, digits,
           trust_falls(verdict->trust.ratio)
               ? ""
               : "; see whether a step much smaller, or a method of another order, has more");
  if (trust_falls(verdict->trust.ratio)) advise_step(request, scene, integrator, digits);
  return CHECK_FAILED;
}

int verify_tell(const run_request *request, const problem *scene, const dvi_integrator *integrator,
                const run_columns *columns, const trust_numbers *numbers,
                const verify_verdict *verdict)
{
  result_table *table = report_table(scene, columns, numbers, verdict->by_event);
  bool good = table_good(table);
  if (good && (request->csv == NULL || strcmp(request->csv, "-") != 0))
    report_print(request, scene, integrator, table, verdict);
  if (good && request->csv != NULL) good = table_write(table, request->csv);
  const int digits = good ? fewest_digits(table, request->columns != NULL) : 0;
  table_destroy(&table);
  if (!good) return FAILED;
  if (digits >= request->digits) return DONE;
  return output_flushed() ? report_fewer_digits(request, scene, integrator, digits, verdict)
                          : FAILED;
}
