/** The module dvi_petsc, by which the processes that mpirun or srun started share a mesh.
 *
 *  The command loads it when there are several processes: PETSc and MPI take longer to start than
 *  most runs, and only a command that loads them falls under the licence of Debian's PETSc. */
#ifndef PETSC_MODULE_H
#define PETSC_MODULE_H
#include <dvi/field.h>
#include <dvi/march.h>
#include <dvi/yee.h>
#include <stdbool.h>
#include <stddef.h>

/** The share of a process: its cells of highest degree, and what it receives from others. */
typedef struct mesh_division {
  const char *partitioner;
  int64_t owned, ghosts; /**< cells */
  int64_t bytes_in;      /**< of a form, once */
  int messages_in;       /**< that bring them */
  int neighbours;        /**< processes that own ghosts */
  int64_t agreements;    /**< of all processes so far */
} mesh_division;

/** What a process has received so far. */
typedef struct mesh_traffic {
  int64_t messages, bytes;         /**< from one process each */
  int64_t agreements;              /**< in which all processes have added or compared numbers */
  int64_t sums, gathers;           /**< of implicit equations, over all processes */
  int64_t corrections, iterations; /**< of these */
  /** in the last one of the iterations alone */
  int64_t iteration_messages, iteration_bytes, iteration_sums, iteration_gathers;
} mesh_traffic;

/** What the modes of a divided field took. */
typedef struct mode_search {
  int64_t unknowns, zeros; /**< of the whole field, and its modes of frequency zero */
  const char *solver;      /**< of the equations in the iteration */
  int64_t solutions;       /**< of these */
  double residual;         /**< the largest one, beside the eigenvalue */
} mode_search;

/** What a process has at its end. */
typedef struct rank_end {
  int code;     /**< its exit code */
  bool is_echo; /**< it only fails because another one did */
} rank_end;

/** The functions of the module. */
typedef struct petsc_module {
  /** Start MPI and PETSc, whose handlers of signals are left out. Returns whether it worked. */
  bool (*start)(int *rank, int *count);

  /** Give memory of head + count*each bytes, all 0, that the processes of this machine have in
   *  common, with their number and this process's place among them. Called once by all processes,
   *  until whose end it stays. NULL if there is none. */
  void *(*share_memory)(size_t head, size_t each, int *own, int *count);

  /** Wait until all processes are here. Returns whether they have come. */
  bool (*wait_for_all)(void);

  /** Divide a mesh among all processes. The share is for dvi_mesh_destroy before the end. One mesh
   *  can be divided at a time. */
  dvi_status (*divide)(const dvi_mesh *mesh, dvi_mesh **share);

  /** Read a share of the mesh in a file of HDF5 likewise, in parts. */
  dvi_status (*read)(const char *path, dvi_mesh **share);

  /** Read the whole mesh of such a file. */
  dvi_status (*read_whole)(const char *path, dvi_mesh **mesh);

  /** Write a whole mesh to such a file. The module need not be started. */
  dvi_status (*write)(const dvi_mesh *mesh, const char *path);

  /** Write or read the state of a march on the mesh that was divided, in parts, or in one process
   *  of a march on a whole mesh. Then the module need not be started. */
  dvi_status (*save)(const dvi_march *march, const char *path);
  dvi_status (*load)(dvi_march *march, const char *path);

  /** Give what divides grids among all processes, until the end. Called by all. NULL if that
   *  failed. */
  const dvi_yee_ranks *(*grid)(void);

  /** Give the division of process `rank`, with the bytes that a form of a degree receives. Called
   *  by all processes. */
  void (*tell)(int rank, int degree, mesh_division *division);

  /** Give what this process has received so far. */
  void (*count)(mesh_traffic *traffic);

  /** Find the modes of a field on the share, as dvi_field_modes does. */
  dvi_status (*modes)(const dvi_field *field, const dvi_modes_options *options, double *eigenvalue,
                      mode_search *search);

  /** Find the largest of all processes' numbers. A process that has failed waits for the others for
   *  some seconds only, because they may wait for it elsewhere. Returns whether they have come. */
  bool (*largest)(int number, bool has_failed, int *all);

  /** Give the ends [count] of all processes. Waits and returns likewise. */
  bool (*meet)(const rank_end *own, rank_end *all);

  /** Let the first `count` processes divide meshes, and gather, from now on. Called by all
   * processes. Gives whether this one is among them. Returns whether it worked. */
  bool (*among)(int count, bool *takes_part);

  /** Find the largest of all processes' numbers. Those that take no part in the work of others
   *  sleep until they come. Returns whether they have come. */
  bool (*rest)(int number, int *all);

  /** Gather what each of the processes among which there is work has, of a size in bytes. */
  bool (*gather)(const void *own, size_t size, void *all);

  /** Give the most of these processes that share one machine. */
  bool (*on_machine)(int *most);

  /** Refresh a form of the division. */
  dvi_status (*refresh)(int degree, double *values);

  /** Measure the seconds in which bytes [size] get from the first process to the second one, half
   *  of the way there and back, the least of a few means. Called by these two. NaN if it failed. */
  double (*ping)(void *bytes, int size, int times);

  /** Find owners of a mesh's cells of highest degree, among any number of processes, in this one
   * alone. */
  dvi_status (*partition)(const dvi_mesh *mesh, int parts, int *owner);
  const char *partitioner; /**< the name of what finds them */

  /** Release the division, and end PETSc and MPI. */
  void (*end)(void);

  /** End all processes at once, with an exit code. */
  void (*abandon)(int code);
} petsc_module;

/** The module's only symbol. */
extern const petsc_module dvi_petsc __attribute__((visibility("default")));
#endif
