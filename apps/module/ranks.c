#define _POSIX_C_SOURCE 200809L
#include "module/ranks.h"

#include <dlfcn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/command.h"
#include "cli/signals.h"
#include "cli/started.h"
#include "module/loss.h"

static const char module_name[] = "dvi_petsc.so", symbol_name[] = "dvi_petsc";

static const char ended_first[] =
    "dvi: a signal came before all processes had been started; nothing was written\n";

static bool is_echo;               /* this process fails because another one did */
static const petsc_module *module; /* NULL in a process that is alone */
static int own_rank, rank_count = 1;
static FILE *kept;      /* what a process prints that is not the first one */
static int spoken = -1; /* its standard error */

/* ---- the start ---- */

/* The first process says why, and the others end in silence. */
static int refuse(int rank, int count, const char *reason, const char *remedy)
{
  if (rank > 0) exit(DONE);
  return usage_error("%d processes were started, and %s; %s, or leave mpirun out", count, reason,
                     remedy);
}

static int refuse_missing(int rank, int count)
{
  char reason[512];
  (void)snprintf(reason, sizeof reason, "this dvi has no module for them (%s)", dlerror());
  return refuse(rank, count, reason, "build dvi with -DDVI_PETSC=ON");
}

static int refuse_count(int rank, int count, const petsc_module *found)
{
  char reason[64];
  (void)snprintf(reason, sizeof reason, "MPI knows of %d", rank_count);
  found->end();
  rank_count = 1;
  return refuse(rank, count, reason, "start them by the mpirun of the MPI that PETSc is linked to");
}

/* Keep what this process prints. */
static bool keep_output(void)
{
  kept = tmpfile();
  spoken = dup(STDERR_FILENO);
  return kept != NULL && spoken >= 0 && fflush(stdout) == 0 &&
         freopen("/dev/null", "w", stdout) != NULL && dup2(fileno(kept), STDERR_FILENO) >= 0;
}

/* Load the module, once. The parts of MPI that are loaded later look for its names. */
static const petsc_module *load(void)
{
  static const petsc_module *loaded;
  if (loaded != NULL) return loaded;
  void *library = dlopen(module_name, RTLD_NOW | RTLD_GLOBAL);
  if (library != NULL) loaded = dlsym(library, symbol_name);
  return loaded;
}

int ranks_begin(void)
{
  int rank = 0;
  const int count = started_processes(&rank);
  if (count < 2) return DONE;
  if (rank == 0) signals_end(true, ended_first);
  const petsc_module *found = load();
  if (found == NULL) return refuse_missing(rank, count);
  if (!found->start(&own_rank, &rank_count)) {
    complain("MPI and PETSc could not be started");
    return FAILED;
  }
  if (rank_count != count) return refuse_count(rank, count, found);
  module = found;
  if ((own_rank == 0 || keep_output()) &&
      loss_watch(found, own_rank, own_rank == 0 ? STDERR_FILENO : spoken))
    return DONE;
  complain("out of memory");
  return FAILED;
}

/* Load the module, or complain. */
static const petsc_module *load_alone(void)
{
  const petsc_module *found = load();
  if (found == NULL)
    (void)usage_error("this dvi has no module for processes that share a mesh (%s); build dvi with "
                      "-DDVI_PETSC=ON",
                      dlerror());
  return found;
}

int ranks_check_module(void)
{
  return load_alone() != NULL ? DONE : USAGE;
}

int ranks_begin_alone(void)
{
  const petsc_module *found = load_alone();
  if (found == NULL) return USAGE;
  if (!found->start(&own_rank, &rank_count)) {
    complain("MPI and PETSc could not be started");
    return FAILED;
  }
  module = found;
  return DONE;
}

/* ---- the run ---- */

int ranks_count(void)
{
  return rank_count;
}

int ranks_number(void)
{
  return own_rank;
}

bool ranks_is_first(void)
{
  return own_rank == 0;
}

/* Print what has been kept. */
static void speak(void)
{
  char text[1024];
  if (kept == NULL) return;
  rewind(kept);
  for (size_t size; (size = fread(text, 1, sizeof text, kept)) > 0;) {
    const ssize_t written = write(spoken, text, size);
    (void)written;
  }
}

/* End all processes, which do not wait for this one where it waits for them. */
static void abandon(int code)
{
  if (loss_may_speak()) speak();
  module->abandon(code);
}

static int largest(int number, bool has_failed)
{
  int all = number;
  if (module != NULL && !module->largest(number, has_failed, &all))
    abandon(has_failed ? number : FAILED);
  return all;
}

int ranks_largest(int number)
{
  return largest(number, false);
}

int ranks_agree(int code)
{
  const int worst = largest(code, code != DONE);
  is_echo = code == DONE && worst != DONE;
  return code != DONE ? code : worst;
}

void ranks_remedy(const char *remedy)
{
  if (module != NULL) loss_remedy(remedy);
}

dvi_status ranks_divide(const dvi_mesh *mesh, dvi_mesh **share, void *user)
{
  (void)user;
  return module->divide(mesh, share);
}

dvi_status ranks_read(const char *path, dvi_mesh **share, void *user)
{
  (void)user;
  return module->read(path, share);
}

/* Complain if files in parts cannot be written. */
static int check_writer(const char *path, const char *what)
{
  return load() != NULL
             ? DONE
             : usage_error("'%s' is a %s that several processes read in parts, and this dvi has no "
                           "module for it (%s); build dvi with -DDVI_PETSC=ON",
                           path, what, dlerror());
}

static bool reads; /* MPI has been started, for files in parts, in a process that is alone */

static void end_reading(void)
{
  load()->end();
}

/* MPI can be started once in a process, and ends with it. */
static void start_reading(void)
{
  int rank, count;
  reads = load() != NULL && load()->start(&rank, &count);
  if (reads) (void)atexit(end_reading);
}

dvi_status ranks_read_whole(const char *path, dvi_mesh **mesh, void *user)
{
  (void)user;
  if (!reads) start_reading();
  return reads ? load()->read_whole(path, mesh) : DVI_OK;
}

int ranks_read_mesh(const char *path, dvi_mesh **mesh)
{
  if (load_alone() == NULL) return USAGE;
  const dvi_status status = ranks_read_whole(path, mesh, NULL);
  if (reads) return status == DVI_OK ? DONE : library_error(status);
  complain("MPI and PETSc could not be started");
  return FAILED;
}

int ranks_write_mesh(const dvi_mesh *mesh, const char *path)
{
  const int code = check_writer(path, "mesh");
  if (code != DONE) return code;
  const dvi_status status = load()->write(mesh, path);
  return status == DVI_OK ? DONE : library_error(status);
}

bool ranks_part_state(const char *path)
{
  static const char ending[] = ".h5";
  const size_t length = path != NULL ? strlen(path) : 0, end = sizeof ending - 1;
  return length > end && strcmp(path + length - end, ending) == 0;
}

int ranks_prepare_state(const char *path)
{
  return ranks_part_state(path) ? check_writer(path, "state") : DONE;
}

dvi_status ranks_save(const dvi_march *march, const char *path)
{
  return ranks_part_state(path) ? load()->save(march, path) : dvi_march_save(march, path);
}

dvi_status ranks_load(dvi_march *march, const char *path)
{
  return ranks_part_state(path) ? load()->load(march, path) : dvi_march_load(march, path);
}

const dvi_yee_ranks *ranks_grid(void)
{
  return module != NULL ? module->grid() : NULL;
}

void ranks_tell(int rank, int degree, mesh_division *division)
{
  module->tell(rank, degree, division);
}

void ranks_received(mesh_traffic *traffic)
{
  module->count(traffic);
}

dvi_status ranks_modes(const dvi_field *field, const dvi_modes_options *options, double *eigenvalue,
                       mode_search *search)
{
  return module->modes(field, options, eigenvalue, search);
}

/* ---- measurements among some of the processes ---- */

bool ranks_among(int count)
{
  bool takes_part = false;
  if (!module->among(count, &takes_part)) abandon(FAILED);
  return takes_part;
}

int ranks_rest(int code)
{
  int worst = code;
  if (!module->rest(code, &worst)) abandon(code != DONE ? code : FAILED);
  is_echo = code == DONE && worst != DONE;
  return code != DONE ? code : worst;
}

bool ranks_gather(const void *own, size_t size, void *all)
{
  if (module->gather(own, size, all)) return true;
  complain("the processes could not speak with each other");
  return false;
}

int ranks_on_machine(void)
{
  int most = 0;
  return module->on_machine(&most) ? most : 0;
}

dvi_status ranks_refresh(int degree, double *values)
{
  return module->refresh(degree, values);
}

double ranks_ping(void *bytes, int size, int times)
{
  return own_rank < 2 ? module->ping(bytes, size, times) : (double)NAN;
}

dvi_status ranks_partition(const dvi_mesh *mesh, int parts, int *owner)
{
  return module->partition(mesh, parts, owner);
}

const char *ranks_partitioner(void)
{
  return module->partitioner;
}

/* ---- the end ---- */

/* Return the process whose failure is the others' reason, or -1. */
static int find_culprit(const rank_end *all)
{
  int failed = -1;
  for (int r = rank_count - 1; r >= 0; r--)
    if (all[r].code != DONE && (!all[r].is_echo || failed < 0)) failed = r;
  return failed;
}

int ranks_end(int code)
{
  if (module == NULL) return code;
  const rank_end own = {.code = code, .is_echo = is_echo || library_failed_elsewhere()};
  rank_end *all = calloc((size_t)rank_count, sizeof *all);
  (void)fflush(stderr);
  (void)fflush(stdout);
  if (all == NULL || !module->meet(&own, all)) abandon(code != DONE ? code : FAILED);
  loss_end();
  const int culprit = all != NULL ? find_culprit(all) : -1;
  if (culprit == own_rank) speak();
  if (culprit >= 0) code = all[culprit].code;
  free(all);
  module->end();
  return ranks_is_first() ? code : DONE;
}
