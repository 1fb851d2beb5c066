/* Find the subcommand of dvi that the command line names. Each subcommand has a file of its own. */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>
#include <stdio.h>
#include <string.h>

#include "cli/command.h"
#include "cli/signals.h"
#include "cli/spelling.h"
#include "cli/started.h"

typedef struct subcommand {
  const char *name;
  int (*run)(int argc, char **argv);
  /* what to do instead of starting several processes, NULL if they share the work */
  const char *alone;
  const char *part; /* the option by which each of them has its own, or NULL */
} subcommand;

/* What several processes do together is told by docs/fields/processes.md. */
static const char alone[] = "leave mpirun out",
                  by_threads[] = "leave mpirun out: its threads take all cores",
                  by_parts[] = "leave mpirun out, and share the points by --part K/N",
                  by_methods[] = "leave mpirun out, and start it once for each method",
                  of_meshes[] = "leave mpirun out, and let dvi run share the mesh.h5 that --write "
                                "makes";

static const subcommand subcommands[] = {
    {"list", list_command, alone, NULL},
    {"explain", explain_command, NULL, NULL},
    {"run", run_command, NULL, NULL},
    {"order", order_command, by_methods, NULL},
    {"bench", bench_command, NULL, NULL},
    {"path", path_command, alone, NULL},
    {"control", control_command, alone, NULL},
    {"gradient", gradient_command, alone, NULL},
    {"fit", fit_command, alone, NULL},
    {"check", check_command, alone, NULL},
    {"init", init_command, alone, NULL},
    {"sweep", sweep_command, by_parts, "--part"},
    {"resonance", resonance_command, by_threads, NULL},
    {"emit-c", emit_c_command, alone, NULL},
    {"mesh", mesh_command, of_meshes, NULL},
    {"modes", modes_command, NULL, NULL},
    {"stability", stability_command, alone, NULL},
    {"solve", solve_command, alone, NULL},
    {"spectrum", spectrum_command, alone, NULL},
    {"plot", plot_command, alone, NULL},
    {"view", view_command, alone, NULL},
    {"regge", regge_command, alone, NULL},
    {"curvature", curvature_command, alone, NULL},
    {NULL, NULL, NULL, NULL},
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
    "  mpirun -np N dvi run SCENE.yaml   N processes share the mesh of a field; dvi explain, modes "
    "and bench do so, too\n"
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

static bool has_part(const subcommand *s, int argc, char **argv)
{
  for (int i = 0; s->part != NULL && i < argc; i++)
    if (strncmp(argv[i], s->part, strlen(s->part)) == 0) return true;
  return false;
}

/* Processes that share nothing would compute, and write, the same. */
static int start(const subcommand *s, int argc, char **argv)
{
  int rank;
  const int count = started_processes(&rank);
  if (count < 2 || s->alone == NULL || has_part(s, argc, argv)) return s->run(argc, argv);
  if (rank > 0) return DONE;
  return usage_error("%s: %d processes were started, and all would do the same; %s", s->name, count,
                     s->alone);
}

/* What is no command is told by the first process alone. */
static bool is_silent(void)
{
  int rank;
  return started_processes(&rank) > 1 && rank > 0;
}

static int dispatch(int argc, char **argv)
{
  for (const subcommand *s = subcommands; argc > 1 && s->name != NULL; s++)
    if (strcmp(argv[1], s->name) == 0) return start(s, argc - 2, argv + 2);
  if (is_silent()) return DONE;
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
