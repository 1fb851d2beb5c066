/* Find the subcommand of dvi that the command line names. Each subcommand has a file of its own. */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/signals.h"
#include "cli/spelling.h"

typedef struct subcommand {
  const char *name;
  int (*run)(int argc, char **argv);
} subcommand;

static const subcommand subcommands[] = {
    {"list", list_command},           {"explain", explain_command},     {"run", run_command},
    {"order", order_command},         {"bench", bench_command},         {"path", path_command},
    {"control", control_command},     {"gradient", gradient_command},   {"fit", fit_command},
    {"check", check_command},         {"init", init_command},           {"sweep", sweep_command},
    {"resonance", resonance_command}, {"emit-c", emit_c_command},       {"mesh", mesh_command},
    {"modes", modes_command},         {"stability", stability_command}, {"solve", solve_command},
    {"spectrum", spectrum_command},   {"plot", plot_command},           {"view", view_command},
    {"regge", regge_command},         {"curvature", curvature_command}, {NULL, NULL},
};

static const char help[] =
    "Usage: dvi COMMAND [ARGUMENTS]\n"
    "\n"
    "Discrete variational mechanics: integrate mechanical systems by making a discrete action "
    "stationary.\n"
    "\n"
    "Commands:\n"
    "  list methods|problems   what there is to choose from\n"
    "  explain PROBLEM ...     which kernel, solver and sparsity a method chooses for a problem, "
    "and why\n"
    "  run PROBLEM ...         compute a trajectory and its invariants as CSV\n"
    "  init FILE.yaml          write an example of a scene, to be changed into one's own\n"
    "  check PROBLEM           compare all derivatives with differences, and take one step\n"
    "  sweep PROBLEM ...       one run at each point of a grid of parameters, on all cores, as "
    "CSV\n"
    "  resonance PROBLEM ...   find the values of a parameter at which a method lets an invariant "
    "grow\n"
    "  plot FILE.csv ...       draw columns of a CSV file against each other: orbits, phase "
    "portraits\n"
    "  view PROBLEM ...        write a page that shows a run in a browser: what moves, fields, "
    "curves\n"
    "  spectrum FILE.csv ...   find frequencies, decay rates and amplitudes in columns of a CSV "
    "file\n"
    "  emit-c SCENE.yaml ...   write a C file that declares a scene's system by callbacks\n"
    "  path PROBLEM ...        find a path between given ends, or a periodic one, all its steps at "
    "once\n"
    "  control SCENE.yaml ...  find the controls that lead to an end at the least cost\n"
    "  gradient SCENE.yaml ... differentiate a run by its start and its parameters\n"
    "  fit SCENE.yaml ...      fit parameters and the start of a run to measurements\n"
    "  mesh FILE|GENERATOR ... audit a mesh: counts, holes, quality, dual cells, stable steps; "
    "repair it\n"
    "  curvature FILE|GENERATOR ...   curvature of a mesh by deficits and holonomy; fields of "
    "directions\n"
    "  regge FILE|GENERATOR    action, deficits and stationary lengths of a complex (Regge "
    "calculus)\n"
    "  modes SCENE.yaml ...    the modes of a field on a mesh: eigenvalues, frequencies, shapes\n"
    "  stability SCENE.yaml    how fast a field grows under asynchronous steps, before a run\n"
    "  solve SCENE.yaml ...    the static state of a field on a mesh\n"
    "  order PROBLEM ...       measure the order of methods against an independent judge\n"
    "  bench PROBLEM ...       measure speed against error, also beside SUNDIALS' integrators\n"
    "\n"
    "  A PROBLEM is a name of the catalogue or the path of a scene, a file that ends in .yaml or "
    ".yml: a Lagrangian as\n"
    "  it stands on paper, a start, a method (docs/scenes.md).\n"
    "\n"
    "  dvi COMMAND --help      options, columns and examples of a command\n"
    "  dvi --version           versions of dvi and of SUNDIALS\n"
    "\n"
    "A first session:\n"
    "  dvi list problems\n"
    "  dvi run kepler --method galerkin:degree=4 --h 0.1 --t-end 10 --out orbit.csv\n"
    "  dvi order kepler --method galerkin:degree=2 --method verlet --plot order.svg\n"
    "  dvi bench kepler --against cvode,ida --plot bench.svg\n"
    "\n"
    "A scene of one's own:\n"
    "  dvi init cart.yaml\n"
    "  dvi check cart.yaml\n"
    "  dvi run cart.yaml --final --plot cart.svg\n"
    "  dvi order cart.yaml --plot order.svg\n"
    "\n"
    "Exit codes: 0 done; 1 a numerical failure, or a file that cannot be read or written; 2 a "
    "wrong command line;\n"
    "3 a check failed; 129, 130 or 143: SIGHUP, Ctrl-C or SIGTERM ended it.\n";

static const char *subcommand_at(int k, const void *list)
{
  return ((const subcommand *)list)[k].name;
}

static void print_version(void)
{
  (void)printf("dvi %s (SUNDIALS %s)\n", dvi_version(), dvi_reference_version());
}

static int dispatch(int argc, char **argv)
{
  if (argc < 2) {
    (void)fputs(help, stderr);
    return USAGE;
  }
  const bool asks_version = strcmp(argv[1], "--version") == 0;
  const bool asks_help = strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
                         strcmp(argv[1], "help") == 0;
  if (argc > 2 && (asks_version || asks_help))
    return usage_error("'%s' stands alone, '%s' is too many; dvi COMMAND --help explains a command",
                       argv[1], argv[2]);
  if (asks_help) {
    (void)fputs(help, stdout);
    return DONE;
  }
  if (asks_version) {
    print_version();
    return DONE;
  }
  for (const subcommand *s = subcommands; s->name != NULL; s++)
    if (strcmp(argv[1], s->name) == 0) return s->run(argc - 2, argv + 2);
  char near[128];
  return usage_error("unknown command '%s'%s; see dvi --help", argv[1],
                     suggestion(argv[1], subcommand_at, subcommands, near, sizeof near));
}

int main(int argc, char **argv)
{
  /* A reader that goes away, and a file that outgrows its limit, become write errors with their
   * messages and clean-up. */
  (void)signal(SIGPIPE, SIG_IGN);
  (void)signal(SIGXFSZ, SIG_IGN);
  signals_end(false, NULL);
  const int code = dispatch(argc, argv);
  return output_flushed() || code != DONE ? code : FAILED;
}
