/** Processes that mpirun or srun started, which share the mesh of one run.
 *
 *  The first one speaks for all. What the others print is kept, and is seen if one of them alone
 *  fails. In a process that is alone these functions do nothing. */
#ifndef RANKS_H
#define RANKS_H
#include <dvi/mesh.h>
#include <stdbool.h>

#include "petsc/petsc_module.h"

/** Join the others, if there are any. Returns DONE, or complains and returns the exit code. */
int ranks_begin(void);

/** Start what processes share meshes by, in a process without others, which cuts meshes for them
 * (ranks_partition). Returns DONE, or complains and returns the exit code. */
int ranks_begin_alone(void);

/** Check that this dvi could join others. Returns DONE, or complains and returns USAGE. */
int ranks_check_module(void);

/** Return the number of processes, 1 without others. */
int ranks_count(void);

/** Return the number of this process, from 0. */
int ranks_number(void);

/** Tell if this process is the first one, which writes files. */
bool ranks_is_first(void);

/** Return the largest number of all processes, none of which has failed. */
int ranks_largest(int number);

/** Agree with the others on an exit code. Returns this process's own if that is not DONE, and
 *  otherwise the largest one. */
int ranks_agree(int code);

/** Set what is said if another process is killed: how to go on. Copied. */
void ranks_remedy(const char *remedy);

/** Divide a mesh, as the callback of dvi_scene_division. */
dvi_status ranks_divide(const dvi_mesh *mesh, dvi_mesh **share, void *user);

/** Read a share from a file of HDF5 in parts, as its other callback. */
dvi_status ranks_read(const char *path, dvi_mesh **share, void *user);

/** Read the whole mesh of such a file in a process that is alone, as the same callback. Without a
 *  module for it *mesh stays as it is. */
dvi_status ranks_read_whole(const char *path, dvi_mesh **mesh, void *user);

/** Read the whole mesh of such a file in a process that is alone. Returns DONE, or complains and
 * returns the exit code. */
int ranks_read_mesh(const char *path, dvi_mesh **mesh);

/** Write a mesh to such a file. Returns DONE, or complains and returns the exit code. */
int ranks_write_mesh(const dvi_mesh *mesh, const char *path);

/** Tell if a state is written in parts, because the file's name ends in .h5. NULL is none. */
bool ranks_part_state(const char *path);

/** Get ready for such a state. Returns DONE, or complains and returns the exit code. */
int ranks_prepare_state(const char *path);

/** Save and load the state of a march on the mesh that was divided last, or on a whole one, in
 *  parts if ranks_part_state says so, after ranks_prepare_state. Called by all processes. */
dvi_status ranks_save(const dvi_march *march, const char *path);
dvi_status ranks_load(dvi_march *march, const char *path);

/** Give what divides grids among the processes, NULL without others or if that failed. Called by
 *  all. */
const dvi_yee_ranks *ranks_grid(void);

/** Give the share of process `rank`, of forms of a degree. Called by all processes. */
void ranks_tell(int rank, int degree, mesh_division *division);

/** Give what this process has received so far. */
void ranks_received(mesh_traffic *traffic);

/** Find modes of the field on this process's share, as dvi_field_modes does. Called by all. */
dvi_status ranks_modes(const dvi_field *field, const dvi_modes_options *options, double *eigenvalue,
                       mode_search *search);

/* ---- measurements among some of the processes ---- */

/** Let the first `count` processes work from now on: ranks_divide, ranks_tell and what follows is
 *  for them. Called by all processes. Returns whether this one is among them. */
bool ranks_among(int count);

/** Agree with all processes on an exit code, as ranks_agree. Those without work sleep until the
 *  others come. */
int ranks_rest(int code);

/** Gather what each of the working processes has, of a size in bytes. Returns false, and complains,
 *  if they cannot be reached. */
bool ranks_gather(const void *own, size_t size, void *all);

/** Return the most of the working processes that share one machine, or 0. */
int ranks_on_machine(void);

/** Refresh a form of the mesh that was divided last. */
dvi_status ranks_refresh(int degree, double *values);

/** Return the seconds in which bytes [size] get from the first process to the second one. NaN in
 *  other processes, and if it failed. Called by all processes that work. */
double ranks_ping(void *bytes, int size, int times);

/** Find owners [cells of the highest degree] among any number of processes, in this one alone. */
dvi_status ranks_partition(const dvi_mesh *mesh, int parts, int *owner);

/** Return the name of what finds them. */
const char *ranks_partitioner(void);

/* ---- the end ---- */

/** Leave the others, with this process's exit code. Returns that of the whole: it is not DONE in
 *  the first process alone. Does not return if the others cannot be reached any more. */
int ranks_end(int code);
#endif
