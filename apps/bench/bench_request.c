/* The options of dvi bench, their help, and the checks before anything runs. */
#include "bench/bench_request.h"

#include <dvi/study.h>
#include <math.h>
#include <string.h>

#include "cli/command.h"
#include "cli/file.h"
#include "cli/outputs.h"
#include "load/scene.h"

enum { ROUNDS_DEFAULT = 5 };

static int bench_check_outputs(const bench_outputs *outputs, const char *name)
{
  const char *const paths[] = {outputs->csv, outputs->plot, outputs->at_csv};
  const named_file files[] = {{.option = "csv", .path = outputs->csv},
                              {.option = "plot", .path = outputs->plot},
                              {.option = "at-csv", .path = outputs->at_csv}};
  enum { FILES = sizeof files / sizeof *files };
  int code = outputs_plot("bench", "plot", outputs->plot);
  if (code == DONE) code = scene_spared("bench", name, FILES, files);
  if (code == DONE) code = outputs_distinct("bench", FILES, files);
  if (code != DONE) return code;
  if (outputs->csv != NULL && outputs->at_csv != NULL && strcmp(outputs->csv, "-") == 0 &&
      strcmp(outputs->at_csv, "-") == 0)
    return usage_error("bench: --csv - and --at-csv - would mix two tables on standard output");
  for (int i = 0; i < FILES; i++)
    if (paths[i] != NULL && !file_writable(paths[i])) return FAILED;
  return DONE;
}

/* Check the options of the two modes. With --scale every method takes the same few steps, and
 * nothing has an error. */
static int bench_check_modes(const bench_request *r)
{
  static const char reason[] = "--scale measures single steps";
  if (r->scale == NULL && !isnan(r->h))
    return usage_error("bench: --h goes with --scale; else the steps are chosen by the error");
  if (r->scale == NULL && r->steps > 0)
    return usage_error(
        "bench: --steps goes with --scale; else their number follows from the error");
  if (r->outputs.at_csv != NULL && r->at == NULL)
    return usage_error("bench: --at-csv needs the errors: --at 1e-6,1e-9");
  if (r->scale == NULL) return DONE;
  if (r->at != NULL) return usage_error("bench: %s: --at has no meaning there", reason);
  if (r->against.count > 0)
    return usage_error("bench: %s: the codes of --against choose their own", reason);
  if (r->judged_by != NULL) return usage_error("bench: %s: --judge has no meaning there", reason);
  if (r->transforms.count > 0)
    return usage_error("bench: %s: --time-transform has no meaning there", reason);
  if (r->axes.count > 0) return usage_error("bench: %s: --axes has no meaning there", reason);
  if (r->levels > 0) return usage_error("bench: %s: --levels has no meaning there", reason);
  if (!isnan(r->t_end)) return usage_error("bench: %s: --t-end has no meaning there", reason);
  return r->h == 0.0 ? usage_error("bench: --h 0 leads nowhere") : DONE;
}

static int bench_check_request(bench_request *request)
{
  if (request->levels > WORK_LEVELS_MAX)
    return usage_error("bench: --levels %ld is too many, %d are possible", request->levels,
                       (int)WORK_LEVELS_MAX);
  if (request->rounds > DVI_STUDY_ROUNDS_MAX)
    return usage_error("bench: --rounds %ld is too many, %d are possible", request->rounds,
                       (int)DVI_STUDY_ROUNDS_MAX);
  if (request->steps > STEPS_MAX)
    return usage_error("bench: --steps %ld is too many, %d are possible", request->steps,
                       (int)STEPS_MAX);
  if (request->t_end == 0.0) return usage_error("bench: --t-end 0 leaves nothing to do");
  int code = bench_check_modes(request);
  if (code == DONE) code = words_distinct("bench", "method", &request->methods);
  if (code == DONE) code = words_distinct("bench", "time-transform", &request->transforms);
  if (code == DONE && request->at != NULL)
    code = numbers_read("bench: --at", request->at, &request->outputs.asked);
  if (code == DONE && request->judged_by != NULL)
    code = judge_read("bench: --judge", request->judged_by, &request->judge);
  work_columns(&whole_job_words, request->outputs.columns);
  if (code == DONE)
    code = axes_read("bench", &request->axes, request->outputs.plot, "error:cpu_seconds",
                     request->outputs.columns, &request->outputs.axes);
  if (code == DONE) code = peers_read(&request->against, &request->peers);
  return code == DONE ? bench_check_outputs(&request->outputs, request->name) : code;
}

static const char *const details[] = {
    "Columns: "
    "integrator,problem,setting,error,energy_error,cpu_seconds,evaluations,cpu_lower,cpu_upper,"
    "steps,create_seconds,\n"
    "calibration_seconds,calibration_least (the last two in CSV alone).\n"
    "  setting       h=STEP of a method, tol=TOLERANCE of a peer\n"
    "  error         largest error of a coordinate at the end, against the judge\n"
    "  energy_error  largest |energy - energy at the start|: of methods over all steps, of peers "
    "at 8 evenly spaced times,\n"
    "                the end included\n"
    "  cpu_seconds   process time of one whole job, creation included and diagnostics excluded: "
    "the median over the\n"
    "                rounds; every round runs every setting, repeated until 0.02 s have passed\n"
    "  evaluations   points at which the gradient was evaluated\n"
    "  cpu_lower, cpu_upper   quartiles over the rounds\n"
    "  steps         as they were taken: also those that a peer, sem or another time chose\n"
    "  create_seconds   the part of cpu_seconds that creates the integrator; empty for peers\n"
    "  calibration_seconds, calibration_least   of 1e8 dependent multiplications: median and least "
    "over the rounds\n",
    "--time-transform: methods appear once for each, as METHOD @ MONITOR, in a fictitious time in "
    "which their h is measured; of "
    "the\n"
    "selection, explicit methods are left out then. --time-transform none puts the same methods "
    "beside them with steps of time.\n",
    "--against: cvode (cvode-adams), cvode-bdf, arkode and ida of SUNDIALS, and bare.\n"
    "bare is a loop of Gauss' method, with the steps, iterations and callbacks of each "
    "galerkin:degree=S, but without any check,\n"
    "retry or compensated sum, for constant masses and potentials alone. What the checks cost is "
    "printed, at equal steps.\n"
    "The others run at tolerances from 1e-4 to 1e-12, and down to 1e-14 if --at asks for more. "
    "Every "
    "integrator gets the same\n"
    "callbacks: batches, or one point a call with --one-point (peers always ask for one point).\n",
    "--judge: exact (the exact solution); stored (a quadruple-precision result, for the problem's "
    "own parameters and some\n"
    "ends); ida (IDA at two tolerances); runs (two runs, galerkin of degree 16 and of degree 12 "
    "with other steps, refined\n"
    "until two levels of both come no closer: the largest distance is the judge's error, and a "
    "method's error is its\n"
    "distance from the farther run, so that degree 16 is not judged by itself alone). auto takes "
    "exact, else stored, else\n"
    "IDA; where IDA's error is above a tenth of the smallest error of --at (1e-10 without --at) it "
    "takes the runs, with\n"
    "IDA as their witness. The report names the judge and its error.\n",
    "--at: for each integrator, seconds and evaluations at these errors. Of its settings those "
    "count that no other one\n"
    "beats in both error and cost; between two neighbours the logarithms are interpolated, beyond "
    "the ends nothing is.\n"
    "Unless --levels is given, longer steps come first, as far as they are about as good, and "
    "smaller ones follow until the\n"
    "smallest of these errors is met, and while they get cheaper, 20 levels at most. Columns of "
    "--at-csv:\n"
    "asked_error,problem,judged,integrator,cpu_seconds,ratio,evaluations,answer,create_seconds,"
    "calibration_seconds,\n"
    "calibration_least.\n"
    "  judged        yes; no if the judge's own error is above a tenth of the asked one\n"
    "  ratio         seconds over those of the fastest integrator at this error\n"
    "  answer        interpolated; at most (the cheapest setting is already better); not reached\n",
    "--scale: what is varied, and the values at which a step is measured: a parameter that changes "
    "the number of\n"
    "coordinates n, or degree or threads, keys that every --method gets. The exponents of cost "
    "against n or the degree are\n"
    "printed; with threads elapsed time is measured, and the speed-up is printed. The first 32 "
    "(--steps) steps from the\n"
    "start are run again and again. Columns: "
    "method,problem,parameter,value,n,h,step_seconds,step_lower,step_upper,bytes,\n"
    "create_seconds,first_seconds,step_evaluations,step_residuals,step_factorizations,"
    "calibration_seconds,calibration_least;\n"
    "bytes is what the integrator holds of the heap (mallinfo2; empty where there is no such "
    "function). create_seconds is for\n"
    "the creation and the start, first_seconds for the first step, with the analysis of matrices "
    "and all else that it prepares.\n"
    "Of methods that know how many bytes a step moves, those of a second are printed beside what "
    "an in-place axpy,\n"
    "y <- y + a x, of as many numbers moves on one thread in the same round.\n",
    "--scale members=1,64,4096: members of an ensemble instead, near the problem's start (with "
    "factors or constraints of other\n"
    "speeds alone), beside runs one after the other.\n"
    "The first 64 (--steps) steps, the start included. Columns: "
    "method,problem,members,n,h,step_seconds,step_lower,\n"
    "step_upper,alone_seconds,alone_lower,alone_upper,gain,step_evaluations; seconds are those of "
    "one step of one member,\n"
    "on one thread, and gain is their ratio.\n",
    "--scale ranks=1,2,4,...,1e5: ranks that share the mesh of a wave or of Maxwell's field by "
    "leapfrog, of a solid by verlet, or a\n"
    "grid by yee. Those that mpirun started are measured; without mpirun, dvi starts as many as "
    "there are cores, 4 at most. A model\n"
    "predicts the others (docs/fields/scaling.md): the largest share of cuts of the mesh marches "
    "alone, messages between two\n"
    "processes are timed, and the triad of STREAM beside them. Runs with more ranks than cores "
    "are in the table, and not in the\n"
    "model. "
    "--weak n multiplies the\n"
    "parameter n by the number of ranks in runs of their own, so that cells grow with the ranks. "
    "Columns: scaling,problem,ranks,\n"
    "rank_cells,step_seconds,efficiency,exchange,messages,bytes,measured_seconds,"
    "measured_efficiency,oversubscribed,\n"
    "measured_lower,measured_upper,cells (the last three in CSV alone).\n",
    "Processor, compiler and flags are printed, and the time of 1e8 dependent multiplications, "
    "measured once a round:\n"
    "it tells times of two machines or two hours apart. Beside codes of SUNDIALS the report has "
    "its "
    "version, its folder, and\n"
    "whether it was compiled with optimisation, which is measured. Debian's package 6.4.1 was not, "
    "and its codes are several\n"
    "times slower than they can be. CMAKE_PREFIX_PATH chooses another build of SUNDIALS.\n",
    "Examples:\n"
    "  dvi bench kepler --against cvode,arkode,ida --at 1e-6,1e-9 --plot bench.svg\n"
    "  dvi bench outer-solar --t-end 500000 --method galerkin:degree=8 --method "
    "galerkin:degree=8,solver=certified --at 1e-9\n"
    "  dvi bench kepler --set e=0.99 --time-transform none --time-transform distance --against "
    "cvode,ida --at 1e-6\n"
    "  dvi bench fpu --method galerkin:degree=2 --method galerkin:degree=4 --scale "
    "ell=100,1000,10000\n"
    "  dvi bench fpu --method galerkin --scale degree=1,2,4,8,16\n"
    "  dvi bench chain --set n=1e6 --method verlet --method composition:order=8 --scale "
    "threads=1,2\n"
    "  dvi bench kepler --method verlet --method galerkin:degree=2 --scale members=1,64,4096\n"
    "  mpirun -np 4 dvi bench box.yaml --scale ranks=1,2,4,...,1e5 --weak n --latency 1.5e-6 "
    "--bandwidth 12.5e9\n",
    NULL,
};

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(bench_request, methods),
     .value = "SPEC",
     .help = "a method; may be repeated; default: the scene's, else a selection"},
    {.name = "time-transform",
     OPTION_AT(bench_request, transforms),
     .value = "MONITOR",
     .help = "every method in this time (see dvi run --help), or in none; may be repeated; "
             "default: none"},
    {.name = "against",
     OPTION_AT(bench_request, against),
     .value = "CODES",
     .help = "codes beside them: of cvode,cvode-bdf,arkode,ida,bare"},
    {.name = "judge",
     OPTION_AT(bench_request, judged_by),
     .value = "WHO",
     .help = "auto, exact, stored, ida or runs; default: auto"},
    {.name = "one-point",
     OPTION_AT(bench_request, one_point),
     .help = "give the problem's callbacks one point a call, not a batch"},
    {.name = "at",
     OPTION_AT(bench_request, at),
     .value = "ERRORS",
     .help = "compare at these errors, for example 1e-6,1e-9"},
    {.name = "at-csv",
     OPTION_AT(bench_request, outputs.at_csv),
     .value = "-|FILE",
     .help = "write that comparison as CSV",
     .is_csv = true},
    {.name = "scale",
     OPTION_AT(bench_request, scale),
     .value = "NAME=V,V...",
     .help = "measure steps instead, as a parameter, the degree, the threads, an ensemble or the "
             "ranks grow"},
    {.name = "weak",
     OPTION_AT(bench_request, weak),
     .value = "NAME",
     .help = "of --scale ranks: measure ranks with this parameter times their number, too"},
    {.name = "latency",
     OPTION_AT(bench_request, latency),
     .value = "SECONDS",
     .help = "of --scale ranks: of a message in the network to be predicted; default: measured"},
    {.name = "bandwidth",
     OPTION_AT(bench_request, bandwidth),
     .value = "BYTES",
     .help = "of --scale ranks: its bytes a second; default: measured"},
    {.name = "h",
     OPTION_AT(bench_request, h),
     .value = "H",
     .help = "the step of --scale; default: the problem's"},
    {.name = "steps",
     OPTION_AT(bench_request, steps),
     .value = "N",
     .help = "how many steps --scale times at once; default: 32, 64 of members"},
    {.name = "levels",
     OPTION_AT(bench_request, levels),
     .value = "N",
     .help = "how many step sizes of each method; default: 6, or more for --at"},
    {.name = "rounds",
     OPTION_AT(bench_request, rounds),
     .value = "N",
     .help = "how often everything is measured; default: 5"},
    {.name = "t-end",
     OPTION_AT(bench_request, t_end),
     .value = "T",
     .help = "the end; default: the problem's for order studies"},
    {.name = "set",
     OPTION_AT(bench_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the problem; may be repeated"},
    {.name = "csv",
     OPTION_AT(bench_request, outputs.csv),
     .value = "-|FILE",
     .help = "write the table as CSV; -: to standard output, words to stderr",
     .is_csv = true},
    {.name = "plot",
     OPTION_AT(bench_request, outputs.plot),
     .value = "FILE.svg",
     .help = "draw CPU time against error, or against what is varied"},
    {.name = "axes",
     OPTION_AT(bench_request, axes),
     .value = "X:Y",
     .help = "draw these columns of the table instead; may be repeated"},
    {.name = NULL},
};

static const command_line command = {
    .name = "bench",
    .synopsis =
        "PROBLEM|SCENE.yaml [--method SPEC ...] [--against cvode,arkode,ida,bare] [OPTIONS]",
    .operand = "PROBLEM",
    .summary = "Measure speed against error, of methods and of other codes, all in one run; or "
               "the cost of a step against size.\n",
    .options = command_options,
    .details = details,
};

bool bench_request_read(int argc, char **argv, bench_request *r, int *exit_code)
{
  *r = (bench_request){.latency = (double)NAN,
                       .bandwidth = (double)NAN,
                       .t_end = (double)NAN,
                       .h = (double)NAN,
                       .rounds = ROUNDS_DEFAULT};
  if (!options_parse(&command, argc, argv, r, &r->name, exit_code)) return false;
  *exit_code = bench_check_request(r);
  return *exit_code == DONE;
}
