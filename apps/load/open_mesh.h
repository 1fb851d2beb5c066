/** Meshes that a command line names: those of generators, and those of files. */
#ifndef OPEN_MESH_H
#define OPEN_MESH_H
#include <dvi/mesh.h>

#include "cli/options.h"

/** Sizes of a generated mesh, as they are given, or NULL. */
typedef struct mesh_sizes {
  const char *cells, *size, *origin, *grading, *periodic;
} mesh_sizes;

/** The options of a request of this type that has the sizes as a member. */
#define MESH_SIZE_OPTIONS(type, member)                                       \
  {.name = "cells",                                                           \
   OPTION_AT(type, member.cells),                                             \
   .value = "N,...",                                                          \
   .help = "of a generator: cells along each axis, or its own numbers"},      \
      {.name = "size",                                                        \
       OPTION_AT(type, member.size),                                          \
       .value = "L,...",                                                      \
       .help = "of a generator: lengths, or radii"},                          \
      {.name = "origin",                                                      \
       OPTION_AT(type, member.origin),                                        \
       .value = "X,...",                                                      \
       .help = "of a generator"},                                             \
      {.name = "grading",                                                     \
       OPTION_AT(type, member.grading),                                       \
       .value = "G,...",                                                      \
       .help = "of a grid: node i of m is at (i/m)^G of its axis"},           \
  {                                                                           \
    .name = "periodic", OPTION_AT(type, member.periodic), .value = "0|1,...", \
    .help = "of a grid: axes along which it repeats itself"                   \
  }

/** Open the mesh of a generator or a file. Returns DONE, or complains in the name of the command
 *  and returns the exit code. */
int open_mesh(const char *command, const mesh_sizes *sizes, const char *name, dvi_mesh **mesh);
#endif
