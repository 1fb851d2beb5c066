/* dvi path, which finds a whole path at once, between ends or closed. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "boundary/path_ends.h"
#include "boundary/path_report.h"
#include "cli/command.h"
#include "cli/file.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "csv/events.h"
#include "load/scene.h"

/* Refuse an option that these ends would ignore. */
static int path_check_uses(const path_request *r)
{
  const dvi_ends ends = ends_from_name(r->ends);
  const struct {
    const char *option;
    bool given;
    unsigned used_by; /* bits of dvi_ends */
  } uses[] = {{"to", r->to != NULL, 1U << DVI_ENDS_FIXED},
              {"from", r->from != NULL, 1U << DVI_ENDS_FIXED | 1U << DVI_ENDS_INITIAL},
              {"momentum", r->momentum != NULL, 1U << DVI_ENDS_INITIAL},
              {"t-end", !isnan(r->t_end), 1U << DVI_ENDS_FIXED | 1U << DVI_ENDS_INITIAL},
              {"period", !isnan(r->period), 1U << DVI_ENDS_PERIODIC},
              {"free-period", r->free_period, 1U << DVI_ENDS_PERIODIC},
              {"symmetry", r->symmetry != NULL, 1U << DVI_ENDS_PERIODIC}};
  for (size_t k = 0; k < sizeof uses / sizeof *uses; k++)
    if (uses[k].given && !(uses[k].used_by & 1U << ends))
      return usage_error("path: --%s has no use with --ends %s", uses[k].option, r->ends);
  if (!isnan(r->energy) && !r->free_period)
    return usage_error("path: --energy is for --free-period: a given period has its energy");
  return DONE;
}

static int path_check_request(const path_request *r, const char *name)
{
  if (r->ends == NULL) return usage_error("path: --ends is missing: fixed, periodic or initial");
  if (ends_from_name(r->ends) == 0)
    return usage_error("path: --ends %s: there are fixed, periodic and initial", r->ends);
  if (r->steps == 0) return usage_error("path: --steps is missing");
  if (r->steps > 0x7fffffff) return usage_error("path: --steps %ld are too many", r->steps);
  const double span = !isnan(r->period) ? r->period : r->t_end;
  if (span <= 0.0)
    return usage_error("path: --%s %g is not a positive time",
                       !isnan(r->period) ? "period" : "t-end", span);
  const named_file out = {.option = "out", .path = r->out};
  const int code = scene_spared("path", name, 1, &out);
  return code == DONE ? path_check_uses(r) : code;
}

static const char *const details[] = {
    "Ends: fixed asks Hamilton's principle itself: --from and --to are given, everything between "
    "is unknown. periodic closes\n"
    "the path, so that it comes back to its start in position and momentum. initial joins steps "
    "forward, from --from with\n"
    "--momentum, into one system; it gives what dvi run gives.\n",
    "The guess may be rough: some points, joined by straight lines. Left out: the straight line "
    "between fixed ends; else as\n"
    "many steps forward by the method from the problem's start. Newton's method with line search "
    "(KINSOL) leads from there\n"
    "to a stationary path, which need not be the nearest; dvi says whether the action has a "
    "minimum there or a saddle.\n",
    "Steps that follow a motion keep its energy. A path over which, or in a step of which, it\n"
    "changes by more than a tenth of the kinetic energy is printed, but not called solved: dvi "
    "says\n"
    "where it changes most and how many steps to try, writes no FILE, and the exit code is 1. A\n"
    "system that depends on time keeps no energy, and is not tested.\n",
    "--symmetry 3,4,5,6,1,2 says that coordinate 1 of the last node is coordinate 3 of the first "
    "one, and so on (-3: its\n"
    "negative): three bodies in a plane that take each other's places, after one third of the "
    "period of the whole.\n"
    "--free-period finds the period that belongs to an energy. --continue e=0.1:0.9:8 solves at e "
    "= 0.1, 0.2, .. 0.9, each\n"
    "guessed from the two before; the last one is reported.\n",
    "Columns of FILE: t, the coordinates, their momenta, energy, the other invariants, at the N+1 "
    "nodes; a FILE of dvi run or\n"
    "dvi path may be the guess of another one.\n",
    "Examples:\n"
    "  dvi path pendulum --method midpoint --ends fixed --to 2 --t-end 2 --steps 100 --out "
    "path.csv\n"
    "  dvi path kepler --method galerkin:degree=4 --ends fixed --from 1,0 --to=-0.5,1 --t-end 3 "
    "--steps 30\n"
    "  dvi path figure-eight --method galerkin:degree=8 --ends periodic --steps 24\n"
    "  dvi path figure-eight --method galerkin:degree=8 --ends periodic --symmetry 3,4,5,6,1,2 "
    "--period 2.2 --steps 8 \\\n"
    "    --guess sketch.csv\n",
    NULL,
};

static int path_run(const char *name, const path_request *request)
{
  family values = {.parts = 0};
  member found = {0};
  int code = path_check_request(request, name);
  if (code == DONE) code = read_family(request, &values);
  if (code == DONE && request->out != NULL && strcmp(request->out, "-") != 0 &&
      !file_writable(request->out))
    return FAILED;
  if (code == DONE) code = solve_family(name, request, &values, &found);
  const bool rows_on_output = request->out != NULL && strcmp(request->out, "-") == 0;
  if (code == DONE) events_passed("path", found.scene);
  if (found.found) print_report(&found, request, rows_on_output ? stderr : stdout);
  if (code == DONE && request->out != NULL) code = write_path(&found, request->out);
  member_destroy(&found);
  return code;
}

static const option command_options[] = {
    {.name = "method",
     OPTION_AT(path_request, method),
     .value = "SPEC",
     .help = "galerkin, midpoint, trapezoidal, or hp or hamiltonian of types 1 to 3; default: "
             "the scene's"},
    {.name = "ends",
     OPTION_AT(path_request, ends),
     .value = "KIND",
     .help = "fixed, periodic or initial"},
    {.name = "steps",
     OPTION_AT(path_request, steps),
     .value = "N",
     .help = "how many steps the path has"},
    {.name = "t-end",
     OPTION_AT(path_request, t_end),
     .value = "T",
     .help = "the end, from t = 0; default: the problem's"},
    {.name = "period",
     OPTION_AT(path_request, period),
     .value = "T",
     .help = "of periodic ends, or its guess; default: the problem's end"},
    {.name = "from",
     OPTION_AT(path_request, from),
     .value = "Q",
     .help = "the first node, \"1,0.5\"; default: the problem's or the guess's start"},
    {.name = "to",
     OPTION_AT(path_request, to),
     .value = "Q",
     .help = "the last node; default: the guess's end, or of a density the scene's section final"},
    {.name = "momentum",
     OPTION_AT(path_request, momentum),
     .value = "P",
     .help = "the first momentum; default: the problem's"},
    {.name = "symmetry",
     OPTION_AT(path_request, symmetry),
     .value = "LIST",
     .help = "which coordinate each one ends as; see below"},
    {.name = "free-period",
     OPTION_AT(path_request, free_period),
     .help = "the period is unknown, the energy is given"},
    {.name = "energy",
     OPTION_AT(path_request, energy),
     .value = "E",
     .help = "that energy; default: that of the problem's start"},
    {.name = "guess",
     OPTION_AT(path_request, guess),
     .value = "FILE",
     .help = "points of a guess: CSV or HDF5 with t and the coordinates"},
    {.name = "continue",
     OPTION_AT(path_request, follow),
     .value = "NAME=FROM:TO:PARTS",
     .help = "follow the path as a parameter changes"},
    {.name = "set",
     OPTION_AT(path_request, settings),
     .value = "NAME=VALUE",
     .help = "set a parameter of the problem; may be repeated"},
    {.name = "out",
     OPTION_AT(path_request, out),
     .value = "FILE",
     .help = "write the nodes there; -: standard output; default: nowhere",
     .is_csv = true},
    {.name = NULL},
};

static const command_line command = {
    .name = "path",
    .synopsis = "PROBLEM|SCENE.yaml [--method SPEC] --ends KIND --steps N [OPTIONS]",
    .operand = "PROBLEM",
    .summary = "Make the action of a whole path stationary: boundary value problems and periodic "
               "orbits.\n",
    .options = command_options,
    .details = details,
};

int path_command(int argc, char **argv)
{
  path_request r = {.t_end = (double)NAN, .period = (double)NAN, .energy = (double)NAN};
  const char *name;
  int code;
  if (!options_parse(&command, argc, argv, &r, &name, &code)) return code;
  return path_run(name, &r);
}
