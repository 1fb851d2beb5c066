/* labels: unit */
/* The order in which a checkpoint gets to the disk: the file, then its name, then the folder. A
 * save that fails leaves no file behind. */
#define _GNU_SOURCE /* syscall */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "support/files.h"
#include "support/heap.h"
#include "support/runs.h"
#include "support/suite.h"

/* ---- the system's calls, seen: these two stand before those of the C library ---- */

static char calls[64];
static const char *failing;
static int reason;

/* Notes a call, and returns 1 if it is to fail. */
static int fails(const char *call)
{
  (void)snprintf(calls + strlen(calls), sizeof calls - strlen(calls), "%s ", call);
  if (failing == NULL || strcmp(failing, call) != 0) return 0;
  errno = reason;
  return 1;
}

int fsync(int descriptor)
{
  struct stat about;
  const int is_folder = fstat(descriptor, &about) == 0 && S_ISDIR(about.st_mode);
  return fails(is_folder ? "folder" : "file") ? -1 : (int)syscall(SYS_fsync, descriptor);
}

int rename(const char *from, const char *to)
{
  return fails("name") ? -1 : renameat(AT_FDCWD, from, AT_FDCWD, to);
}

static dvi_status save_failing(const dvi_integrator *integrator, const char *path, const char *call,
                               int with)
{
  calls[0] = 0;
  failing = call, reason = with;
  const dvi_status status = dvi_integrator_save(integrator, path);
  failing = NULL;
  return status;
}

START_TEST(the_file_is_flushed_then_named_then_its_folder_is_flushed)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "verlet");
  ck_assert_int_eq(save_failing(integrator, path_in_folder("state"), NULL, 0), DVI_OK);
  ck_assert_str_eq(calls, "file name folder ");
  ck_assert_int_eq(chdir(path_in_folder(".")), 0);
  ck_assert_int_eq(save_failing(integrator, "state", NULL, 0), DVI_OK);
  ck_assert_str_eq(calls, "file name folder ");
  ck_assert_int_eq(chdir("/"), 0);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_call_that_fails_leaves_the_old_file_and_no_part)
{
  const char *call[] = {"file", "name"};
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "verlet");
  ck_assert_int_eq(dvi_integrator_save(integrator, path_in_folder("state")), DVI_OK);
  const bytes old = read_bytes(path_in_folder("state"));
  advance(integrator, 0.1, 1);
  ck_assert_int_eq(save_failing(integrator, path_in_folder("state"), call[_i], ENOSPC),
                   DVI_IO_ERROR);
  check_words("No space left");
  ck_assert_int_eq(count_files_in_folder(), 1);
  const bytes now = read_bytes(path_in_folder("state"));
  ck_assert_uint_eq(now.count, old.count);
  ck_assert_mem_eq(now.at, old.at, old.count);
  free(now.at);
  free(old.at);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

/* Some file systems cannot flush a folder, which is no failure. A broken disk is one. */
START_TEST(a_folder_that_cannot_be_flushed_is_told_if_it_could)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "verlet");
  ck_assert_int_eq(save_failing(integrator, path_in_folder("state"), "folder", EINVAL), DVI_OK);
  ck_assert_int_eq(save_failing(integrator, path_in_folder("state"), "folder", EIO), DVI_IO_ERROR);
  check_words("its folder cannot be flushed");
  ck_assert_int_eq(count_files_in_folder(), 1);
  ck_assert_int_eq(dvi_integrator_restore(integrator, path_in_folder("state")), DVI_OK);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

START_TEST(a_save_without_memory_leaves_no_part)
{
  problem *model = create_problem("kepler", NULL);
  dvi_integrator *integrator = start_integrator(model, "verlet");
  ck_assert_int_eq(dvi_integrator_save(integrator, path_in_folder("state")), DVI_OK);
  for (long successes = 0; successes < 8; successes++) {
    heap_fail_after(successes);
    const dvi_status status = dvi_integrator_save(integrator, path_in_folder("state"));
    heap_fail_after(-1);
    ck_assert_msg(status == DVI_OK || status == DVI_NO_MEMORY || status == DVI_IO_ERROR, "%s",
                  dvi_last_error());
    ck_assert_int_eq(count_files_in_folder(), 1);
  }
  ck_assert_int_eq(dvi_integrator_restore(integrator, path_in_folder("state")), DVI_OK);
  dvi_integrator_destroy(&integrator);
  problem_destroy(&model);
}
END_TEST

SUITE(checkpoint_disk)
{
  tcase_set_timeout(tests, 120); /* every file is flushed to the disk, which may be busy */
  tcase_add_checked_fixture(tests, make_folder, remove_folder);
  tcase_add_test(tests, the_file_is_flushed_then_named_then_its_folder_is_flushed);
  tcase_add_loop_test(tests, a_call_that_fails_leaves_the_old_file_and_no_part, 0, 2);
  tcase_add_test(tests, a_folder_that_cannot_be_flushed_is_told_if_it_could);
  if (heap_is_counted()) tcase_add_test(tests, a_save_without_memory_leaves_no_part);
}
