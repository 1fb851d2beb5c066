/* dvi init, which writes an example of a scene. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/file.h"
#include "cli/options.h"
#include "load/scene.h"

/* The pendulum on a cart of docs/scenes.md, with a comment on each section. */
static const char example[] =
    "# A pendulum hangs from a cart on a rail. Run it:        dvi run cart.yaml --final\n"
    "# Compare its derivatives with differences:             dvi check cart.yaml\n"
    "# Go through the values under sweep:                    dvi sweep cart.yaml --out cart.csv\n"
    "title: a pendulum on a cart\n"
    "\n"
    "# Numbers with names, to be changed by --set l=0.7; also lists, and expressions of those "
    "above.\n"
    "parameters:\n"
    "  m: 0.2        # the bob\n"
    "  M: 1          # the cart\n"
    "  l: 0.5\n"
    "  g: 9.81\n"
    "\n"
    "# The configuration, in the order of the columns: scalar, vector(2), vector(3); x[5]: scalar "
    "is a family.\n"
    "coordinates:\n"
    "  x: scalar\n"
    "  theta: scalar\n"
    "\n"
    "# Names for expressions; bob' below is the rate of this one, by the chain rule.\n"
    "definitions:\n"
    "  bob: [x + l*sin(theta), -l*cos(theta)]\n"
    "\n"
    "# The Lagrangian as it stands on paper: x' is the velocity of x, bob[2] the second element of "
    "bob, t the time.\n"
    "lagrangian: |\n"
    "  M/2*x'^2 + m/2*dot(bob', bob')\n"
    "  - m*g*bob[2]\n"
    "\n"
    "# Fields along which nothing changes: their momentum is a column. Moving cart and bob along "
    "the rail is one.\n"
    "symmetries:\n"
    "  along_the_rail: {x: 1}\n"
    "\n"
    "# What else is to be watched: expressions in coordinates, velocities and momenta, p(x).\n"
    "invariants:\n"
    "  height: bob[2]\n"
    "\n"
    "# The start at t = 0; velocities, x': 1, are 0 unless they are given.\n"
    "initial:\n"
    "  x: 0\n"
    "  theta: 1\n"
    "\n"
    "# How to run it, if --method, --h and --t-end do not say otherwise; dvi list methods has all "
    "methods.\n"
    "method: galerkin:degree=2\n"
    "step: 0.02\n"
    "until: 20\n"
    "\n"
    "# For dvi sweep: all pairs of these.\n"
    "sweep:\n"
    "  l: [0.25, 0.5, 1]\n"
    "  m: {from: 0.1, to: 0.5, count: 3}\n";

static int write_example(const char *path)
{
  whole_file file;
  if (!file_open(&file, path)) return FAILED;
  (void)fputs(example, file.stream);
  return file_keep(&file) ? DONE : FAILED;
}

static const char *const details[] = {
    "The example is a pendulum on a cart; docs/scenes.md explains all that a scene may hold.\n",
    "Examples:\n"
    "  dvi init cart.yaml\n"
    "  dvi run cart.yaml --final\n",
    NULL,
};

static const option command_options[] = {{.name = NULL}};

static const command_line command = {
    .name = "init",
    .synopsis = "FILE.yaml",
    .operand = "FILE",
    .summary = "Write an example of a scene, with comments, to be changed into one's own; - is "
               "standard output. A file that is\n"
               "there is not overwritten.\n",
    .options = command_options,
    .details = details,
};

int init_command(int argc, char **argv)
{
  const char *path;
  int code;
  if (!options_parse(&command, argc, argv, NULL, &path, &code)) return code;
  if (strcmp(path, "-") == 0) return write_example(path);
  if (!scene_is_path(path))
    return usage_error("init: '%s' is no name of a scene: those end in .yaml or .yml", path);
  if (access(path, F_OK) == 0) {
    complain("init: '%s' is there already; give another name, or remove it", path);
    return FAILED;
  }
  return write_example(path);
}
