#include "cli/part.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "cli/command.h"

enum { PARTS_MAX = 10000000 };

/* Read a whole number from 0 that ends at the character `stop`. Returns what follows it, or NULL if
 * there is none. */
static const char *take_count(const char *text, char stop, long *count)
{
  if (text == NULL) return NULL;
  const size_t digits = strspn(text, "0123456789");
  if (digits == 0 || text[digits] != stop) return NULL;
  errno = 0;
  *count = strtol(text, NULL, 10);
  return errno == 0 && *count <= PARTS_MAX ? text + digits + 1 : NULL;
}

/* Read a variable of the environment, or take its default if it is not set. */
static bool read_variable(const char *name, long missing, long *number)
{
  const char *text = getenv(name);
  *number = missing;
  return text != NULL ? take_count(text, '\0', number) != NULL : missing >= 0;
}

static int read_slurm(const char *command, study_part *read)
{
  long id, least, most, step;
  const bool is_set = read_variable("SLURM_ARRAY_TASK_ID", -1, &id) &&
                      read_variable("SLURM_ARRAY_TASK_COUNT", -1, &read->parts) &&
                      read_variable("SLURM_ARRAY_TASK_MIN", -1, &least) &&
                      read_variable("SLURM_ARRAY_TASK_MAX", -1, &most) &&
                      read_variable("SLURM_ARRAY_TASK_STEP", 1, &step);
  if (!is_set)
    return usage_error("%s: --part slurm: the SLURM_ARRAY_TASK_ variables ID, COUNT, MIN and MAX "
                       "are not set to numbers: this is no task of a job array, sbatch "
                       "--array=1-N",
                       command);
  if (read->parts == 1)
    return usage_error("%s: --part slurm: an array of one task is the whole study; to run one "
                       "task again, give scontrol requeue, or --part K/N",
                       command);
  const long last = least + (read->parts - 1) * step;
  const bool even = read->parts > 1 && step > 0 && last <= most && most - last < step &&
                    id >= least && id <= last && (id - least) % step == 0;
  if (!even)
    return usage_error("%s: --part slurm: %ld tasks from %ld to %ld have no equal gaps of %ld; "
                       "give sbatch --array=1-N",
                       command, read->parts, least, most, step);
  read->part = (id - least) / step;
  return DONE;
}

int study_part_read(const char *command, const char *text, study_part *read)
{
  *read = (study_part){.part = 0, .parts = 1, .given = text != NULL};
  if (text == NULL) return DONE;
  if (strcmp(text, "slurm") == 0) return read_slurm(command, read);
  long k = 0;
  const bool good = take_count(take_count(text, '/', &k), '\0', &read->parts) != NULL;
  read->part = k - 1;
  if (good && k >= 1 && k <= read->parts) return DONE;
  return usage_error("%s: --part wants K/N with K from 1 to N, N at most %d, or slurm, not '%s'",
                     command, (int)PARTS_MAX, text);
}

long study_part_size(const study_part *part, long count)
{
  return count > part->part ? (count - part->part - 1) / part->parts + 1 : 0;
}
