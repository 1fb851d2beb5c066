/** Meshes and grids that are divided among the processes of MPI, by PETSc.
 *
 *  This header is not part of <dvi/dvi.h>, and the only one that includes MPI's. Link dvi::petsc
 *  (dvi-petsc). A binary that is linked to Debian's PETSc may be passed on under the GPL only,
 *  because that PETSc is linked to FFTW.
 *
 *  MPI and PETSc are started by the program, by PetscInitialize. A program that calls MPI_Init
 *  itself sets SCOTCH_PTHREAD_NUMBER=1 before, because threads of PT-Scotch 7.0 may wait for each
 *  other without end otherwise. All processes of the communicator make the same calls. */
#ifndef DVI_PETSC_H
#define DVI_PETSC_H
#include <dvi/field.h>
#include <dvi/march.h>
#include <dvi/mesh.h>
#include <dvi/yee.h>
#include <mpi.h>

/** What joins the share of a process to the others. */
typedef struct dvi_division dvi_division;

/** How a mesh is divided. Zero means the default. */
typedef struct dvi_division_options {
  size_t size; /**< sizeof(dvi_division_options) */
  /** The processes. Default (where it is MPI_COMM_NULL or 0): all of them */
  MPI_Comm comm;
  /** "ptscotch" and others of PETSc's, for few neighbours; "blocks" for cells in the order of their
   *  numbers. Default: ptscotch if PETSc has it, otherwise blocks */
  const char *partitioner;
} dvi_division_options;

/** What a process has received from others. */
typedef struct dvi_division_traffic {
  int64_t messages, bytes; /**< from one process each: values of ghosts, and places of nodes */
  int64_t sums;            /**< of the solver, over all processes, of 568 bytes each */
  int64_t gathers;         /**< of the solver's coarsest unknowns from all processes */
} dvi_division_traffic;

/** Facts about the share of a process. */
typedef struct dvi_division_facts {
  int rank, ranks;                              /**< this process, and how many there are */
  const char *partitioner;                      /**< its name */
  int64_t owned[DVI_MESH_DIMENSION_MAX + 1];    /**< k-cells that belong to this process */
  int64_t ghosts[DVI_MESH_DIMENSION_MAX + 1];   /**< those that belong to others */
  int64_t bytes_in[DVI_MESH_DIMENSION_MAX + 1]; /**< that a refresh of a k-form receives */
  int messages_in[DVI_MESH_DIMENSION_MAX + 1];  /**< in as many messages */
  int neighbours;                               /**< processes that own ghosts */
  int64_t agreements; /**< so far, in which all processes have added or compared numbers */
  dvi_division_traffic traffic;    /**< so far, as PETSc counts it in this process */
  int64_t corrections, iterations; /**< of implicit equations so far, and in conjugate gradients */
  dvi_division_traffic iteration;  /**< of one of these, the last one */
} dvi_division_facts;

/** What the modes of a divided field took. */
typedef struct dvi_modes_facts {
  int64_t unknowns;   /**< of all processes */
  int64_t zeros;      /**< zero eigenvalues, which are left out, as of dvi_field_modes */
  const char *solver; /**< of the equations with K - shift M: "mumps" factors the matrix; "ams",
                           "boomeramg" and "gamg" are multigrid methods in conjugate gradients */
  int64_t solutions;  /**< of these equations */
  int64_t iterations; /**< of conjugate gradients for them. 0 with a factor */
  double residual;    /**< the largest |K x - lambda M x|/lambda, in the norm of M^-1. An eigenvalue
                           is at most as far away, beside lambda */
} dvi_modes_facts;

#ifdef __cplusplus
extern "C" {
#endif

/** Divide a mesh, and cut this process's share out of it (dvi_mesh_cut).
 *
 *  @param mesh  the whole mesh, the same on all processes. It is not needed afterwards
 *  @param options  NULL for the defaults
 *  @param[out] share  for dvi_mesh_destroy
 *  @param[out] division  for dvi_division_destroy after the share
 *  If one process fails, all of them do, with its status.
 *
 *  @retval DVI_BAD_OPTION    PETSc has no such partitioner
 *  @retval DVI_BAD_ARGUMENT  PETSc has not been started, there are more processes than cells, the
 *                            partitioner leaves a process without cells, or the mesh is not the
 *                            same on all processes
 *  @retval DVI_BAD_SIZE      PetscInt cannot number the neighbours of the cells of a process
 *  @retval DVI_NO_MEMORY     there is no memory
 *  @retval DVI_SOLVER_FAILED PETSc or MPI failed */
dvi_status dvi_mesh_divide(const dvi_mesh *mesh, const dvi_division_options *options,
                           dvi_mesh **share, dvi_division **division);

/** Write a whole mesh to a file of HDF5 that dvi_mesh_read_divided reads in parts.
 *
 *  One process writes it, which needs neither MPI nor PETSc to be started. A file of this name is
 *  replaced only when all is written.
 *
 *  @retval DVI_IO_ERROR     the file could not be written
 *  @retval DVI_UNSUPPORTED  the mesh is a share
 *  @retval DVI_BAD_ARGUMENT a mesh and a path are needed
 *  @retval DVI_NO_MEMORY    there is no memory */
dvi_status dvi_mesh_write_divided(const dvi_mesh *mesh, const char *path);

/** Read this process's share of a mesh from a file of dvi_mesh_write_divided. It is the one of
 *  dvi_mesh_divide, but no process holds the whole mesh at any time: each of them reads a part of
 *  the file, and gets the cells of its share from those that have read them.
 *
 *  @param path  the file, the same for all processes
 *  @param options, share, division  as for dvi_mesh_divide
 *  If one process fails, all of them do, with its status.
 *
 *  @retval DVI_IO_ERROR  the file could not be opened
 *  @retval DVI_BAD_FILE  it is cut short, or no file of a mesh
 *  @retval (others)      as dvi_mesh_divide, and as dvi_mesh_create for the cells of a share */
dvi_status dvi_mesh_read_divided(const char *path, const dvi_division_options *options,
                                 dvi_mesh **share, dvi_division **division);

/** Read the whole mesh of such a file, in a process that needs no others.
 *
 *  @param[out] mesh  for dvi_mesh_destroy
 *
 *  @retval (all)  as dvi_mesh_read_divided */
dvi_status dvi_mesh_read_whole(const char *path, dvi_mesh **mesh);

/** Write the state of a march to a file of HDF5, of which each process writes a block of each
 *  array. No process holds the whole state, and any number of processes goes on from the file with
 *  the same bits. All processes of the division call it.
 *
 *  An old file is replaced only when all is written. If one process fails, all of them do.
 *
 *  @param march  of a field on a mesh by leapfrog, midpoint, imex or galerkin, or of a solid
 *  @param division  that of the march's mesh. NULL for a whole mesh in one process, which needs
 *                   neither MPI nor PETSc to be started
 *  @retval DVI_UNSUPPORTED   other marches
 *  @retval DVI_IO_ERROR      the file could not be written
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or the division is of another mesh
 *  @retval DVI_BAD_STATE     the march has not been started
 *  @retval DVI_NO_MEMORY     there is no memory
 *  @retval DVI_SOLVER_FAILED PETSc or MPI failed */
dvi_status dvi_march_write_divided(const dvi_march *march, const dvi_division *division,
                                   const char *path);

/** Read such a state. The march goes on as the one that wrote it, and stays as it was after a
 *  failure, on all processes.
 *
 *  @retval DVI_BAD_FILE  the file is no such state, damaged, cut short, or of another march
 *  @retval (others)      as dvi_march_write_divided */
dvi_status dvi_march_read_divided(dvi_march *march, const dvi_division *division, const char *path);

/** Find owners of the n-cells of a mesh, among any number of processes. Few may foresee how many
 *  would share it: the owners are not the ones that dvi_mesh_divide finds on another number of
 *  processes, and there are as many cells and neighbours.
 *
 *  @param mesh  the whole mesh, the same on all processes of the communicator
 *  @param options  NULL for the defaults
 *  @param parts  the number of owners, 1 or more
 *  @param[out] owner  [n-cells] their owners, from 0
 *  @retval (others)  as dvi_mesh_divide */
dvi_status dvi_mesh_partition(const dvi_mesh *mesh, const dvi_division_options *options, int parts,
                              int *owner);

/** Set the values of a form at the cells that others own to those that the owners have, as a step
 *  does. All processes of the division call it.
 *
 *  @param         degree  k
 *  @param[in,out] values  [k-cells of the share]
 *  @retval DVI_BAD_ARGUMENT  an argument is missing, or there are no cells of that degree
 *  @retval DVI_SOLVER_FAILED the processes could not speak with each other */
dvi_status dvi_division_refresh(dvi_division *division, int degree, double *values);

/** Give facts about the share of this process. */
void dvi_division_facts_of(const dvi_division *division, dvi_division_facts *facts);

/** Compute the modes of a field on this process's share, by SLEPc. They are those of
 *  dvi_field_modes for the whole mesh, with the same options, to roundings. The last digits depend
 *  on the number of processes.
 *
 *  @param field  on the share, or on one that has been shared. Its star is diagonal
 *  @param options  the same on all processes. NULL for the defaults
 *  @param[out] eigenvalue  [count] ascending, the same on all processes
 *  @param[out] mode  [count][k-cells of the share] with x.M x = 1. May be NULL
 *  @param[out] facts  may be NULL
 *  If one process fails, all of them do, and only `mode` may have changed.
 *
 *  @retval DVI_UNSUPPORTED    there is no SLEPc, or no solver in PETSc, for it
 *  @retval DVI_BAD_ARGUMENT   an argument is missing, the field is on another mesh, or the shift is
 *                             not finite
 *  @retval DVI_BAD_SIZE       count is not from 1 to the number of modes
 *  @retval DVI_SINGULAR       K - shift M is singular, or M is not positive definite
 *  @retval DVI_NOT_CONVERGED  an iteration did not converge
 *  @retval DVI_NO_MEMORY      there is no memory
 *  @retval DVI_SOLVER_FAILED  PETSc, SLEPc or MPI failed */
dvi_status dvi_division_modes(dvi_division *division, const dvi_field *field,
                              const dvi_modes_options *options, double *eigenvalue, double *mode,
                              dvi_modes_facts *facts);

/** Release the division before PetscFinalize, and set the pointer to NULL. NULL is allowed. */
void dvi_division_destroy(dvi_division **division);

/** Let the processes of a communicator divide grids of boxes among them (dvi_yee_terms). This needs
 *  MPI alone.
 *
 *  @param comm  the processes, for as long as there are marches. MPI_COMM_NULL for all of them
 *  @param[out] ranks  for dvi_yee_ranks_destroy, after the marches
 *  @retval DVI_BAD_ARGUMENT  MPI has not been started, or there is no place for the result
 *  @retval DVI_SOLVER_FAILED MPI failed
 *  @retval DVI_NO_MEMORY     there is no memory */
dvi_status dvi_yee_ranks_create(MPI_Comm comm, dvi_yee_ranks **ranks);

/** Release them, and set the pointer to NULL. NULL is allowed. */
void dvi_yee_ranks_destroy(dvi_yee_ranks **ranks);

#ifdef __cplusplus
}
#endif
#endif
