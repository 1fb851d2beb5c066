/* Checkpoints: everything that the next step depends on, in one file with a checksum.
 *
 * Callbacks cannot be saved, but the system can be known again: by what it declares (a hash), and by the Lagrangian's value and forces, and the
 * distance from the constraint, at the saved state, which other parameters would change.
 *
 * Layout, in the machine's own byte order (a mark tells a foreign one): the header, the specification, then numbers: the state and the one before it
 * with their carries, the method's memory. The checksum is FNV-1a over all that precedes it. */
#define _XOPEN_SOURCE 700 /* fsync, fileno, realpath */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/hash.h"
#include "core/memory.h"
#include "core/status.h"
#include "method/integrator_struct.h"
#include "num/finite.h"
#include "system/dirac.h"

/* The Lagrangian, or the Hamiltonian, at a state: its value, and one sum over its forces; the largest |phi| or |p - alpha(q)|; the sizes of the
 * summands tell rounding from difference. NaN if a callback fails there. */
typedef struct portrait {
  double value, value_size, force, force_size, distance, distance_size;
} portrait;

typedef struct header {
  char magic[8];
  uint32_t order_mark, version;
  uint64_t declared; /* hash of the system's terms */
  portrait system;
  int64_t n, memory_count, steps;
  double t, t_carry, last_t, last_t_carry, last_h;
  double density, energy; /* of steps in another time: z, E0 */
  char specification[DVI__SPECIFICATION_SIZE];
} header;

static const char magic[8] = {'d', 'v', 'i', 's', 't', 'a', 't', 'e'};
enum { ORDER_MARK = 0x01020304, VERSION = 4, MOST_NAMES = 1000 };

/* Another machine's mathematical functions differ by a few roundings; other parameters by more than this. */
static const double same_number = 1e-9;

static size_t file_size(const dvi_integrator *I)
{
  const size_t numbers = 8 * (size_t)I->system->n + I->stepper.memory_count;
  return sizeof(header) + numbers * sizeof(double) + sizeof(uint64_t);
}

/* ---- the system ---- */

/* What the system declares, and the monitor. */
static uint64_t declared(const dvi_integrator *I)
{
  if (I->pace == NULL) return I->system->hash;
  const uint64_t hash = dvi__hash(I->system->hash, sizeof I->pace->pacing, &I->pace->pacing);
  return dvi__hash(hash, strlen(I->pace->name), I->pace->name);
}

static dvi_status portray_constraint(const dvi_integrator *I, const double *q, const double *p, portrait *of)
{
  if (I->system->terms & DVI__HAMILTONIAN) {
    DVI_TRY(dvi__dirac_size(I->evaluator, q, p, &of->distance_size));
    return dvi__dirac_distance(I->evaluator, q, p, &of->distance);
  }
  if (!(I->system->terms & DVI__ONE_FORM)) return DVI_OK;
  DVI_TRY(dvi__form_size(I->evaluator, q, &of->distance_size));
  return dvi__form_distance(I->evaluator, q, p, &of->distance);
}

static portrait portray(const dvi_integrator *I, double t, const double *now, const double *last, double last_h)
{
  const int n = I->system->n;
  const double *q = now, *p_now = now + n;
  double *v = I->v, *forces = I->last_v;
  const double *second = I->system->terms & DVI__PHASE_SPACE ? p_now : v;
  portrait p = {0};
  if (I->system->cells == NULL) dvi__guess_velocity(n, q, last, last + n, last_h, v);
  if (dvi__legendre_inverse(I->evaluator, t, q, p_now, v) != DVI_OK ||
      dvi__state_lagrangian(I->evaluator, t, q, second, &p.value) != DVI_OK ||
      dvi__state_forces(I->evaluator, t, q, second, forces) != DVI_OK || portray_constraint(I, q, p_now, &p) != DVI_OK)
    return (portrait){(double)NAN, (double)NAN, (double)NAN, (double)NAN, (double)NAN, (double)NAN};
  p.value_size = fabs(p.value);
  for (int i = 0; i < n; i++) {
    p.value_size += fabs(p_now[i] * v[i]);
    p.force += (1 + i % 7) * forces[i];
    p.force_size += (1 + i % 7) * fabs(forces[i]);
  }
  return p;
}

/* What cannot be computed on one side does not speak against the other. */
static int same_lagrangian(const portrait *a, const portrait *b)
{
  return !(fabs(a->value - b->value) > same_number * (a->value_size + b->value_size)) &&
         !(fabs(a->force - b->force) > same_number * (a->force_size + b->force_size));
}

static int same_constraint(const portrait *a, const portrait *b)
{
  return !(fabs(a->distance - b->distance) > same_number * (a->distance_size + b->distance_size));
}

/* ---- save ---- */

static void pack(const dvi_integrator *I, unsigned char *file)
{
  const size_t n = (size_t)I->system->n, size = file_size(I) - sizeof(uint64_t);
  header head = {.order_mark = ORDER_MARK,
                 .version = VERSION,
                 .declared = declared(I),
                 .system = portray(I, I->now.t, I->now.q, I->last.q, I->last_h),
                 .n = I->system->n,
                 .memory_count = (int64_t)I->stepper.memory_count,
                 .steps = I->counters.steps,
                 .t = I->now.t,
                 .t_carry = I->now.t_carry,
                 .last_t = I->last.t,
                 .last_t_carry = I->last.t_carry,
                 .last_h = I->last_h,
                 .density = I->now.density,
                 .energy = I->pace != NULL ? I->pace->energy : 0};
  memcpy(head.magic, magic, sizeof magic);
  memcpy(head.specification, I->stepper.specification, sizeof head.specification);
  memcpy(file, &head, sizeof head);
  unsigned char *at = file + sizeof head;
  const size_t state = 4 * n * sizeof(double);
  memcpy(at, I->now.q, state);
  memcpy(at + state, I->last.q, state);
  memcpy(at + 2 * state, I->stepper.memory, I->stepper.memory_count * sizeof(double));
  const uint64_t sum = dvi__hash(DVI__HASH_START, size, file);
  memcpy(file + size, &sum, sizeof sum);
}

/* A new file beside path, of a name that nobody else takes: other processes by its number, other threads by the count. One that a killed process of
 * the same number has left behind is passed over. -1, and errno, if there is no such file. */
static int create_beside(const char *path, size_t size, char *beside)
{
  static atomic_ulong count;
  for (int i = 0; i < MOST_NAMES; i++) {
    const int length = snprintf(beside, size, "%s.part-%ld-%lu", path, (long)getpid(), atomic_fetch_add(&count, 1));
    if (length < 0 || (size_t)length >= size) {
      errno = ENAMETOOLONG;
      return -1;
    }
    const int descriptor = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

static FILE *open_beside(const char *path, size_t size, char *beside)
{
  const int descriptor = create_beside(path, size, beside);
  if (descriptor < 0) return NULL;
  struct stat old;
  if (stat(path, &old) == 0) (void)fchmod(descriptor, old.st_mode & 07777);
  FILE *stream = fdopen(descriptor, "wb");
  if (stream == NULL) (void)close(descriptor);
  return stream;
}

/* A device or a pipe would be replaced by a file of its name. */
static int is_no_file(const char *path)
{
  struct stat old;
  return stat(path, &old) == 0 && !S_ISREG(old.st_mode);
}

/* The file is written beside its place and then moved there: a full disk leaves the old one alone. A link is followed, not replaced. */
static dvi_status write_whole(const char *link, const unsigned char *file, size_t size)
{
  char beside[PATH_MAX + 64], real[PATH_MAX];
  const char *path = realpath(link, real) != NULL ? real : link;
  if (is_no_file(path)) return dvi__fail(DVI_IO_ERROR, "checkpoint: cannot write %s: it is not a regular file", link);
  FILE *stream = open_beside(path, sizeof beside, beside);
  if (stream == NULL) return dvi__fail(DVI_IO_ERROR, "checkpoint: cannot write a file beside %.256s: %s", link, strerror(errno));
  int failed = fwrite(file, 1, size, stream) != size || fflush(stream) != 0 || fsync(fileno(stream)) != 0;
  int reason = failed ? errno : 0;
  if (fclose(stream) != 0 && !failed) failed = 1, reason = errno;
  if (!failed && rename(beside, path) != 0) failed = 1, reason = errno;
  if (!failed) return DVI_OK;
  (void)remove(beside);
  return dvi__fail(DVI_IO_ERROR, "checkpoint: cannot write %s: %s", link, strerror(reason));
}

dvi_status dvi_integrator_save(const dvi_integrator *I, const char *path)
{
  if (I == NULL || path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "checkpoint: an argument is NULL");
  if (!I->started) return dvi__fail(DVI_BAD_STATE, "checkpoint: the integrator has no state yet; call dvi_integrator_start first");
  const size_t size = file_size(I);
  unsigned char *file = DVI_NEW(unsigned char, size);
  if (file == NULL) return dvi__fail(DVI_NO_MEMORY, "checkpoint: no memory for %zu bytes", size);
  pack(I, file);
  const dvi_status status = write_whole(path, file, size);
  dvi__release(file);
  return status;
}

/* ---- restore ---- */

static dvi_status other_system(const char *path)
{
  return dvi__fail(DVI_BAD_FILE,
                   "checkpoint %s: of a system that declares other terms, masses, patterns or names, or of steps in another time",
                   path);
}

static dvi_status check_system(const dvi_integrator *I, const char *path, const unsigned char *file)
{
  const double *numbers = (const double *)(const void *)(file + sizeof(header));
  header head;
  memcpy(&head, file, sizeof head);
  if (head.declared != declared(I)) return other_system(path);
  const portrait here = portray(I, head.t, numbers, numbers + 4 * (size_t)I->system->n, head.last_h);
  if (!same_lagrangian(&here, &head.system))
    return dvi__fail(DVI_BAD_FILE,
                     "checkpoint %s: of another system or other parameters; at its state the Lagrangian was %.9g, here it is %.9g",
                     path, head.system.value, here.value);
  if (same_constraint(&here, &head.system)) return DVI_OK;
  return dvi__fail(
      DVI_BAD_FILE,
      "checkpoint %s: of a system with another constraint or other parameters; its state was %.2g away from it, here it "
      "is %.2g away",
      path, head.system.distance, here.distance);
}

static dvi_status check_space(const dvi_integrator *I, const char *path, const unsigned char *file)
{
  const double *numbers = (const double *)(const void *)(file + sizeof(header));
  const dvi__method *method = I->stepper.method;
  if (method->recognizes == NULL || method->recognizes(&I->stepper, numbers + 8 * (size_t)I->system->n)) return DVI_OK;
  return dvi__fail(DVI_BAD_FILE, "checkpoint %s: of another function space of the same name, or for other coordinates", path);
}

static dvi_status check(const dvi_integrator *I, const char *path, const unsigned char *file, size_t got)
{
  header head;
  uint64_t sum;
  const size_t size = file_size(I);
  if (got < sizeof head) return dvi__fail(DVI_BAD_FILE, "checkpoint %s: cut short, %zu bytes", path, got);
  memcpy(&head, file, sizeof head);
  head.specification[DVI__SPECIFICATION_SIZE - 1] = 0;
  if (memcmp(head.magic, magic, sizeof magic) != 0) return dvi__fail(DVI_BAD_FILE, "%s is not a checkpoint", path);
  if (head.order_mark != ORDER_MARK || head.version != VERSION)
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: written on another kind of machine or by another version", path);
  if (!dvi__same_steps(head.specification, I->stepper.specification))
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: written by %s, not by %s", path, head.specification, I->stepper.specification);
  if (head.n != I->system->n)
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: %lld coordinates, not %d", path, (long long)head.n, I->system->n);
  if (got != size && head.declared != declared(I)) return other_system(path); /* what the method remembers differs, too */
  if (got != size)
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: cut short or too long, %zu bytes instead of %zu", path, got, size);
  memcpy(&sum, file + size - sizeof sum, sizeof sum);
  if (sum != dvi__hash(DVI__HASH_START, size - sizeof sum, file))
    return dvi__fail(DVI_BAD_FILE, "checkpoint %s: damaged (its checksum is wrong)", path);
  DVI_TRY(check_system(I, path, file));
  return check_space(I, path, file);
}

static void unpack(dvi_integrator *I, const unsigned char *file)
{
  const size_t n = (size_t)I->system->n;
  header head;
  memcpy(&head, file, sizeof head);
  I->now.t = head.t;
  I->now.t_carry = head.t_carry;
  I->last.t = head.last_t;
  I->last.t_carry = head.last_t_carry;
  I->last_h = head.last_h;
  I->now.density = head.density;
  I->now.side = 0;
  if (I->pace != NULL) dvi__pace_set_energy(I->pace, head.energy);
  I->counters.steps = (long)head.steps;
  const unsigned char *at = file + sizeof head;
  const size_t state = 4 * n * sizeof(double);
  memcpy(I->now.q, at, state);
  memcpy(I->last.q, at + state, state);
  memcpy(I->stepper.memory, at + 2 * state, I->stepper.memory_count * sizeof(double));
  I->started = 1;
}

static dvi_status read_into(const char *path, unsigned char *file, size_t most, size_t *got)
{
  FILE *stream = fopen(path, "rb");
  if (stream == NULL) return dvi__fail(DVI_IO_ERROR, "checkpoint: cannot read %s: %s", path, strerror(errno));
  *got = fread(file, 1, most, stream);
  const int failed = ferror(stream), reason = errno;
  (void)fclose(stream);
  return failed ? dvi__fail(DVI_IO_ERROR, "checkpoint: cannot read %s: %s", path, strerror(reason)) : DVI_OK;
}

dvi_status dvi_integrator_restore(dvi_integrator *I, const char *path)
{
  if (I == NULL || path == NULL) return dvi__fail(DVI_BAD_ARGUMENT, "checkpoint: an argument is NULL");
  const size_t room = file_size(I) + 1; /* one more byte shows a file that is too long */
  size_t got = 0;
  unsigned char *file = DVI_NEW(unsigned char, room);
  if (file == NULL) return dvi__fail(DVI_NO_MEMORY, "checkpoint: no memory for %zu bytes", room);
  dvi_status status = read_into(path, file, room, &got);
  if (status == DVI_OK) status = check(I, path, file, got);
  if (status == DVI_OK) unpack(I, file);
  dvi__release(file);
  return status;
}
